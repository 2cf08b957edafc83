//! .sti, .mas and .dof.

use super::{Folder, assert_says, leaf};
use ferrom::format::{read_dof_map, read_symmetric};
use ferrom::model::{Axis, NodeId};
use flate2::Compression;
use flate2::write::GzEncoder;
use proptest::prelude::*;
use std::io::Write;

const GOOD: &str = "1 1  2.0000000000000e+00\n1 2 -1.5000000000000e+00\n2 2  3.0000000000000e+00\n2 3  0.0000000000000e+00\n3 3  4.0000000000000e+00\n";

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("in memory");
    encoder.finish().expect("in memory")
}

/// Order, stored and full counts, trace, Σ|value| (triangle) and SHA-256 by an independent reading:
/// `a = numpy.loadtxt(gzip.open(f, "rt"))`, `i, j, v = a.T`, explicit off-diagonal zeros dropped,
/// `v[i == j].sum()`, `abs(v).sum()`, `hashlib.sha256(gzip.open(f).read())`.
#[test]
fn the_leaf_is_read_as_numpy_reads_it() {
    let expected = [
        ("leaf.sti.gz", 471813, 935022, 227528598169132.38, 961317446584078.5, "57c344ee24b9"),
        ("leaf.mas.gz", 160218, 311832, 18.675843641368793, 98.531_483_434_329_72, "a5b6526dfa6b"),
    ];
    for (name, stored, full, trace, sum, hash) in expected {
        let (matrix, source) = read_symmetric(&leaf(name), "stiffness").expect("the leaf");
        assert_eq!((matrix.order(), matrix.stored(), matrix.nonzeros()), (8604, stored, full), "{name}");
        // Both sides add a few 1e5 numbers in different order: 1e5 · 1.1e-16.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b;
        assert!(near(matrix.trace(), trace), "{name} {}", matrix.trace());
        assert!(near(matrix.values().iter().map(|v| v.abs()).sum(), sum), "{name}");
        assert!(source.sha256.starts_with(hash) && source.sha256.len() == 64, "{}", source.sha256);
        assert_eq!(source.role, "stiffness");
    }
    let (k, _) = read_symmetric(&leaf("leaf.sti.gz"), "stiffness").expect("the leaf");
    let first: Vec<_> = k.column(1).collect();
    assert_eq!(first, [(0, -15042795.328613), (1, 7414654997.9272)]);
}

#[test]
fn the_leafs_dof_list_is_complete() {
    let (dofs, _) = read_dof_map(&leaf("leaf.dof.gz")).expect("the leaf");
    assert_eq!(dofs.len(), 8604);
    assert_eq!(dofs.row(NodeId(1), Axis::X), Some(0));
    assert_eq!(dofs.row(NodeId(2868), Axis::Z), Some(8603));
}

#[test]
fn plain_gzip_crlf_blank_lines_and_fortran_exponents_read_the_same() {
    let folder = Folder::new();
    let (expected, plain) = read_symmetric(&folder.write("a.sti", GOOD), "k").expect("good");
    assert_eq!(expected.order(), 3);
    assert_eq!(expected.stored(), 4, "the explicit off-diagonal zero is dropped");
    let (packed, source) = read_symmetric(&folder.write("b.sti", gzip(GOOD.as_bytes())), "k").expect("gzip");
    assert_eq!((&packed, &source.sha256), (&expected, &plain.sha256), "the hash is that of the content");
    let variants = [
        GOOD.replace('\n', "\r\n"),
        GOOD.replace('\n', "\n\n"),
        format!("\n  \n{GOOD}\n\t\n"),
        GOOD.replace("e+00", "D+00"),
        GOOD.replace("e+00", "+000"),
        GOOD.replace(' ', "\t"),
        GOOD.replace("1 2 ", "2 1 ").replace("2 3 ", "3 2 "),
        GOOD.replace("2 2 ", "2 1 -1.5000000000000e+00\n2 2 "),
    ];
    for text in variants {
        let (matrix, _) = read_symmetric(&folder.write("c.sti", &text), "k").unwrap_or_else(|e| panic!("{e}: {text}"));
        assert_eq!(matrix, expected, "{text}");
    }
}

#[test]
fn every_bad_line_is_named() {
    let folder = Folder::new();
    let cases: [(&str, usize, &[&str]); 17] = [
        ("1 1 2.0\n1 2 nan\n2 2 1.0\n", 2, &["(1, 2)", "NaN", "finite"]),
        ("1 1 2.0\n2 2 -inf\n", 2, &["(2, 2)", "-inf"]),
        ("1 1 2.0\n2 2 1e999\n", 2, &["inf"]),
        ("1 1 2.0\n0 2 1.0\n", 2, &["index 0", "counted from 1"]),
        ("1 1 2.0\n2 2 1.0 7\n", 2, &["`2 2 1.0 7`", "row number"]),
        ("1 1 2.0\n2 2\n", 2, &["`2 2`"]),
        ("1 1 2.0\n2 2 x\n", 2, &["`2 2 x`"]),
        ("1 1 2.0\n2.5 2 1\n", 2, &["`2.5 2 1`"]),
        ("1 1 2.0\n-2 2 1\n", 2, &["`-2 2 1`"]),
        ("1 1 2.0\n12 1.0\n", 2, &["`12 1.0`"]),
        ("1 1 2.0\n5000000000 2 1\n", 2, &["5000000000", "largest possible"]),
        ("1 1 2.0\n99999999999999999999 2 1\n", 2, &["9999"]),
        ("1 1 2.0\n1 2 1.0\n2 2 1.0\n2 1 1.5\n", 4, &["not symmetric", "(1, 2) is 1e0, (2, 1) is 1.5e0"]),
        ("1 1 2.0\n1 2 1.0\n1 2 1.0\n2 2 1.0\n", 3, &["(1, 2) stands twice"]),
        ("1 1 2.0\n2 2 1.0\n1 1 2.0\n", 3, &["stands twice"]),
        ("1 1 2.0\n1 3 1.0\n3 3 1.0\n", 3, &["diagonal entry for row 2 of 3"]),
        ("1 1 2.0\n2 2 1.0\n4000000000 4000000000 1.0\n", 3, &["diagonal entry for row 3 of 4000000000"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_symmetric(&folder.write("bad.sti", text), "k"), line, words);
    }
}

#[test]
fn what_is_no_matrix_file_is_refused() {
    let folder = Folder::new();
    assert_says(read_symmetric(&folder.path("none.sti"), "k"), 0, &["cannot be read", "check the path"]);
    assert_says(read_symmetric(&folder.path(""), "k"), 0, &["cannot be read"]);
    assert_says(read_symmetric(&folder.write("a.sti", ""), "k"), 0, &["empty"]);
    assert_says(read_symmetric(&folder.write("b.sti", " \n\r\n"), "k"), 0, &["empty"]);
    assert_says(read_symmetric(&folder.write("c.sti", [0u8; 100]), "k"), 0, &["binary"]);
    assert_says(read_symmetric(&folder.write("d.sti", "<html>\n"), "k"), 1, &["`<html>`"]);
    let endless = vec![b'1'; 17 << 20];
    assert_says(read_symmetric(&folder.write("e.sti", endless), "k"), 0, &["line is longer"]);
}

#[test]
fn a_file_cut_at_any_byte_is_refused() {
    let folder = Folder::new();
    for cut in 0..GOOD.len() {
        let text = &GOOD[..cut];
        let path = folder.write("cut.sti", text);
        // Cut behind the diagonal of column 1 or 2, what is left is a smaller matrix; only the dof
        // list can tell (see fe_model).
        let whole_columns = text.ends_with('\n') && (text.contains("2 2 ") && !text.contains("2 3 ") || cut == 25);
        assert_eq!(read_symmetric(&path, "k").is_ok(), whole_columns, "cut at {cut}: {text}");
    }
    let (cut, packed) = (GOOD.len() - 3, gzip(GOOD.as_bytes()));
    assert_says(read_symmetric(&folder.write("a.sti", &GOOD[..cut]), "k"), 5, &["middle of a line", "cut short"]);
    let middle = "1 1 2.0\n1 2 1.0\n2 2 1.0\n1 3 0.5\n";
    assert_says(read_symmetric(&folder.write("b.sti", middle), "k"), 4, &["before the diagonal of column 3"]);
    for cut in 2..packed.len() {
        assert_says(read_symmetric(&folder.write("c.gz", &packed[..cut]), "k"), 0, &["compressed", "cut short"]);
    }
}

#[test]
fn dof_lists_split_at_the_dot_and_refuse_repeats() {
    let folder = Folder::new();
    let (dofs, _) = read_dof_map(&folder.write("a.dof", "7.1\r\n7.2\r\n\r\n 70.6 \r\n")).expect("good");
    let labels: Vec<String> = dofs.labels().iter().map(ToString::to_string).collect();
    assert_eq!(labels, ["7.x", "7.y", "70.rz"]);
    let cases: [(&str, usize, &[&str]); 8] = [
        ("7.1\n7.2\n7.1\n", 3, &["dof 7.x also stands on line 1", "shells and beams"]),
        ("7.1\n\n7.1\n", 3, &["line 1"]),
        ("7.1\n7.10\n", 2, &["direction 10"]),
        ("7.1\n7.0\n", 2, &["direction 0"]),
        ("7.1\n7\n", 2, &["`7`", "node.direction"]),
        ("7.1\n7.2.3\n", 2, &["`7.2.3`"]),
        ("7.1\n99999999999.1\n", 2, &["99999999999"]),
        ("7.1\n7.2", 2, &["middle of a line"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_dof_map(&folder.write("bad.dof", text)), line, words);
    }
    assert_says(read_dof_map(&folder.write("empty.dof", "\n")), 0, &["empty"]);
}

proptest! {
    /// Any symmetric matrix written as CalculiX writes it comes back (14 digits are printed, so
    /// values with so many digits come back to the same bits).
    #[test]
    fn random_matrices_round_trip(order in 1usize..12, seed in proptest::collection::vec((0usize..144, -1e15f64..1e15), 0..60)) {
        let mut entries = std::collections::BTreeMap::new();
        for j in 0..order { entries.insert((j, j), 1.0); }
        for (place, value) in seed {
            let (i, j) = (place / 12 % order, place % order);
            let printed: f64 = format!("{value:.13e}").parse().expect("a number");
            entries.insert((i.max(j), i.min(j)), printed);
        }
        let mut text = String::new();
        for ((j, i), value) in &entries { text += &format!("{} {} {value:20.13e}\n", i + 1, j + 1); }
        let folder = Folder::new();
        let (matrix, _) = read_symmetric(&folder.write("a.sti", text), "k").expect("good");
        let back: std::collections::BTreeMap<_, _> =
            (0..order).flat_map(|j| matrix.column(j).map(move |(i, v)| ((j, i), v)).collect::<Vec<_>>()).collect();
        entries.retain(|&(j, i), v| *v != 0.0 || i == j);
        prop_assert_eq!(back, entries);
    }

    /// Flipped bytes never panic, and never give a matrix larger than the file could hold.
    #[test]
    fn flipped_bytes_never_panic(at in 0usize..GOOD.len(), byte in any::<u8>()) {
        let mut bytes = GOOD.as_bytes().to_vec();
        bytes[at] = byte;
        let folder = Folder::new();
        if let Ok((matrix, _)) = read_symmetric(&folder.write("a.sti", &bytes), "k") {
            prop_assert!(matrix.order() <= 5);
        }
        let _ = read_dof_map(&folder.write("a.dof", &bytes));
    }
}
