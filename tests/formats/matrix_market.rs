//! MatrixMarket coordinate files.

use super::{Folder, assert_says};
use ferrom::format::{read_symmetric, symmetric_to_matrix_market};
use ferrom::linalg::SymSparse;
use proptest::prelude::*;

const BANNER: &str = "%%MatrixMarket matrix coordinate real symmetric\n";
const GENERAL: &str = "%%MatrixMarket matrix coordinate real general\n";

#[test]
fn symmetric_general_and_integer_files_give_one_matrix() {
    let folder = Folder::new();
    let expected = SymSparse::from_triplets(3, &[(0, 0, 2.0), (1, 0, -1.0), (1, 1, 3.0), (2, 2, 4.0)]).expect("valid");
    let cases = [
        format!("{BANNER}% a comment\n%\n\n3 3 4\n1 1 2\n2 1 -1\n2 2 3\n3 3 4\n"),
        format!("{BANNER}3 3 4\n1 1 2\n1 2 -1\n2 2 3\n3 3 4\n"),
        format!("{BANNER}3 3 5\n\n3 3 4\n2 2 3.0\n\n3 1 0\n2 1 -1e0\n1 1 2D0\n"),
        format!("{GENERAL}3 3 5\n1 1 2\n2 1 -1\n1 2 -1\n2 2 3\n3 3 4\n"),
        "%%matrixmarket MATRIX Coordinate Integer Symmetric\r\n3 3 4\r\n1 1 2\r\n2 1 -1\r\n2 2 3\r\n3 3 4\r\n"
            .to_owned(),
    ];
    for text in cases {
        let (matrix, _) = read_symmetric(&folder.write("a.mtx", &text), "k").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(matrix, expected, "{text}");
    }
}

#[test]
fn rows_without_entries_count() {
    let folder = Folder::new();
    let (m, _) = read_symmetric(&folder.write("m.mtx", format!("{BANNER}4 4 1\n2 2 1.5\n")), "mass").expect("good");
    assert_eq!((m.order(), m.stored(), m.trace()), (4, 1, 1.5));
}

#[test]
fn rounding_between_the_triangles_is_averaged_away() {
    let folder = Folder::new();
    let text = format!("{GENERAL}2 2 4\n1 1 1\n1 2 0.12345678901\n2 1 0.12345678903\n2 2 1\n");
    let (m, _) = read_symmetric(&folder.write("a.mtx", text), "k").expect("good");
    assert_eq!(m.column(1).next(), Some((0, 0.12345678902)));
}

#[test]
fn every_bad_file_is_named() {
    let folder = Folder::new();
    let b = |text: &str| format!("{BANNER}{text}");
    let cases: Vec<(String, usize, &[&str])> = vec![
        (b("2 2 2\n1 1 1\n2 2 nan\n"), 4, &["NaN"]),
        (b("2 2 2\n1 1 1\n3 2 1\n"), 4, &["(3, 2) lies outside", "line 2"]),
        (b("2 2 2\n1 1 1\n0 2 1\n"), 4, &["index 0"]),
        (b("2 2 3\n1 1 1\n2 2 1\n"), 4, &["ends after 2 entries", "expected 3", "cut short"]),
        (b("2 2 1\n1 1 1\n2 2 1\n"), 4, &["one more entry"]),
        (b("2 2 3\n1 1 1\n2 1 1\n1 2 1\n"), 5, &["both sides"]),
        (b("2 2 3\n1 1 1\n2 2 1\n1 1 1\n"), 5, &["stands twice"]),
        (b("2 3 1\n1 1 1\n"), 2, &["2 rows and 3 columns", "square"]),
        (b("2 2\n1 1 1\n"), 2, &["`2 2`", "rows, columns and entries"]),
        (b("2 2 9\n1 1 1\n"), 2, &["9 entries in a matrix of order 2"]),
        (b("99999999999 99999999999 1\n1 1 1\n"), 2, &["99999999999 rows", "at most"]),
        (b("4000000000 4000000000 1\n1 1 1\n"), 2, &["4000000000 rows but only 1"]),
        (b("4000000000 4000000000 9999999999\n1 1 1\n"), 3, &["ends after 1"]),
        (b("2 2 99999999999999999999999\n1 1 1\n"), 2, &["rows, columns and entries"]),
        (b("% only comments\n"), 2, &["before its size line"]),
        (b("2 2 2\n1 1 1\n2 2 1"), 4, &["middle of a line"]),
        (format!("{GENERAL}2 2 3\n1 1 1\n1 2 1\n2 2 1\n"), 4, &["not symmetric", "(1, 2) is 1e0, (2, 1) is 0e0"]),
        (format!("{GENERAL}2 2 4\n1 1 1\n1 2 1\n2 2 1\n2 1 1.001\n"), 6, &["not symmetric"]),
        ("%%MatrixMarket junk coordinate real general\n".into(), 1, &["`junk`"]),
        ("%%MatrixMarket matrix junk real general\n".into(), 1, &["`junk`"]),
        ("%%MatrixMarket matrix array real general\n2 2\n".into(), 1, &["`array`", "sparse"]),
        ("%%MatrixMarket matrix coordinate complex symmetric\n".into(), 1, &["`complex`", "without it"]),
        ("%%MatrixMarket matrix coordinate pattern symmetric\n".into(), 1, &["`pattern`", "no values"]),
        ("%%MatrixMarket matrix coordinate real skew-symmetric\n".into(), 1, &["skew", "gyroscopic"]),
        ("%%MatrixMarket matrix coordinate real\n".into(), 1, &["expected"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_symmetric(&folder.write("bad.mtx", &text), "k"), line, words);
    }
}

#[test]
fn a_file_cut_at_any_byte_is_refused() {
    let folder = Folder::new();
    let text = format!("{BANNER}% note\n3 3 4\n1 1 2.0\n2 1 -1.0\n2 2 3.0\n3 3 4.0\n");
    for cut in 0..text.len() {
        assert!(read_symmetric(&folder.write("cut.mtx", &text[..cut]), "k").is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn written_matrices_read_back_to_the_bit(order in 1usize..9, seed in proptest::collection::vec((0usize..9, 0usize..9, any::<f64>()), 0..40)) {
        let mut entries = std::collections::BTreeMap::new();
        for (i, j, value) in seed {
            if value.is_finite() {
                let (i, j) = (i % order, j % order);
                entries.insert((i.min(j), i.max(j)), value);
            }
        }
        let entries: Vec<_> = entries.into_iter().map(|((i, j), v)| (i, j, v)).collect();
        let matrix = SymSparse::from_triplets(order, &entries).expect("valid");
        let folder = Folder::new();
        let (back, _) = read_symmetric(&folder.write("a.mtx", symmetric_to_matrix_market(&matrix)), "k").expect("readable");
        prop_assert_eq!(back.col_starts(), matrix.col_starts());
        prop_assert_eq!(back.rows(), matrix.rows());
        let bits = |m: &SymSparse| m.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&back), bits(&matrix));
    }
}
