//! Harwell-Boeing and Rutherford-Boeing matrices.

use super::{Folder, assert_says};
use ferrom::format::read_symmetric;
use ferrom::linalg::SymSparse;
use proptest::prelude::*;

/// The lower triangle of [2 −1 0; −1 3 0; 0 0 4] as ANSYS HBMAT writes it: one field per line.
fn hbmat() -> String {
    let header = |kind: &str| format!("{kind}{:11}{:14}{:14}{:14}{:14}\n", "", 3, 3, 4, 0);
    let mut text = format!("{:72}{:8}\n{:14}{:14}{:14}{:14}{:14}\n", "stiffness", "K", 12, 4, 4, 4, 0);
    text += &header("RSA");
    text += &format!("{:16}{:16}{:20}{:20}\n", "(I14)", "(I14)", "(d25.15)", "(d25.15)");
    for whole in [1, 3, 4, 5, 1, 2, 2, 3] {
        text += &format!("{whole:14}\n");
    }
    for value in ["2.0D+00", "-1.0D+00", "3.0D 00", "4.0D+00"] {
        text += &format!("{value:>25}\n");
    }
    text
}

#[test]
fn one_field_per_line_reads_as_several() {
    let folder = Folder::new();
    let expected = SymSparse::from_triplets(3, &[(0, 0, 2.0), (1, 0, -1.0), (1, 1, 3.0), (2, 2, 4.0)]).expect("valid");
    let (matrix, _) = read_symmetric(&folder.write("k.rsa", hbmat()), "k").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(matrix, expected);
    assert_eq!(ferrom::format::detect(&folder.path("k.rsa")).expect("there").map(|f| f.name), Some("harwell-boeing"));
    // Rutherford-Boeing: four counts, no right-hand side format.
    let text = "title\n             6             1             1             4\nrsa                        3             3             4             0\n(4I5)           (4I5)           (1P,2E12.4)\n    1    3    4    5\n    1    2    2    3\n  2.0000E+00 -1.0000E+00\n  3.0000E+00  4.0000E+00\n";
    let (matrix, _) = read_symmetric(&folder.write("k.rb", text), "k").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(matrix, expected);
    // A full matrix with equal triangles, CRLF line ends, and a fifth header line for right-hand sides.
    let text = "title\r\n             7             1             1             5             1\r\nRUA                        3             3             5             0\r\n(4I5)           (5I5)           (5F6.1)             (5F6.1)\r\nF                          1             0\r\n    1    3    5    6\r\n    1    2    1    2    3\r\n   2.0  -1.0  -1.0   3.0   4.0\r\n   1.0   1.0   1.0\r\n";
    let (matrix, _) = read_symmetric(&folder.write("k.rua", text), "k").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(matrix, expected);
}

#[test]
fn every_bad_file_is_named() {
    let folder = Folder::new();
    let good = hbmat();
    let swap = |from: &str, to: &str| good.replacen(from, to, 1);
    let cases: Vec<(String, usize, &[&str])> = vec![
        (swap("RSA", "PSA"), 3, &["PSA", "no values"]),
        (swap("RSA", "CSA"), 3, &["CSA", "complex"]),
        (swap("RSA", "RSE"), 3, &["assembled"]),
        (swap("RSA", "RZA"), 3, &["gyroscopic"]),
        (swap("RSA                        3", "RSA                        2"), 3, &["2 rows and 3 columns"]),
        (
            swap("RSA                        3             3", "RSA                900000000     900000000"),
            3,
            &["in a file of"],
        ),
        (swap("(d25.15)", "(x25.15)"), 4, &["Fortran format"]),
        (swap("             5\n             1\n", "             6\n             1\n"), 8, &["ascending from 1 to 5"]),
        (swap("             5\n             1\n", "             x\n             1\n"), 8, &["`x`"]),
        (swap("             2\n             2\n", "             2\n             9\n"), 15, &["row 9", "1 to 3"]),
        (swap("             2\n             2\n", "             1\n             2\n"), 14, &["(1, 1) stands twice"]),
        (swap("-1.0D+00", "     nan"), 14, &["finite number"]),
        (swap("-1.0D+00", "-1000000"), 14, &["decimal point"]),
        (swap("-1.0D+00", "        "), 14, &["0 fields of the values"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_symmetric(&folder.write("bad.rsa", text), "k"), line, words);
    }
    for cut in 0..good.len() {
        assert!(read_symmetric(&folder.write("cut.rsa", &good[..cut]), "k").is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn flipped_bytes_never_panic(at in 0.0..1.0f64, byte in any::<u8>()) {
        let mut bytes = hbmat().into_bytes();
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] = byte;
        let folder = Folder::new();
        let _ = read_symmetric(&folder.write("a.rsa", bytes), "k");
    }
}
