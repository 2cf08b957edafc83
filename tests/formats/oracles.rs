//! Matrices of the collection beside the repository, compared with what independent readers get.

use super::{assert_says, shared};
use ferrom::format::read_symmetric;
use serde_json::Value;

fn oracle(name: &str) -> Option<Value> {
    let text = std::fs::read_to_string(shared(&format!("formats/oracles/{name}.json"))?).expect("readable");
    Some(serde_json::from_str(&text).expect("JSON"))
}

/// Compares order, count, Frobenius norm, trace and the entries the oracle lists.
#[allow(clippy::print_stdout)] // the table of what was compared
fn agrees(file: &str, expected: &Value) {
    let Some(path) = shared(&format!("formats/{file}")) else { return };
    let (matrix, _) = read_symmetric(&path, "matrix").unwrap_or_else(|e| panic!("{e}"));
    let number = |key: &str| expected[key].as_f64().expect("a number");
    assert_eq!(matrix.order() as u64, expected["shape"][0].as_u64().expect("a number"), "{file}");
    let full = |power: i32| -> f64 {
        (0..matrix.order())
            .flat_map(|j| {
                matrix
                    .column(j)
                    .map(move |(i, v)| if i == j { v.powi(power) } else { 2.0 * v.powi(power) })
                    .collect::<Vec<_>>()
            })
            .sum()
    };
    // Both readers add up at most 1e5 numbers, in different order.
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b.abs();
    assert!(near(full(2).sqrt(), number("fro")), "{file}: {} {}", full(2).sqrt(), number("fro"));
    assert!(near(matrix.trace(), number("trace")), "{file}: trace");
    let stored_zeros = matrix.diagonal().iter().filter(|&&d| d == 0.0).count();
    assert_eq!(
        (matrix.nonzeros() - stored_zeros) as u64,
        expected["nnz_nonzero"].as_u64().expect("a number"),
        "{file}"
    );
    for entry in expected["entries_1based"].as_array().expect("entries") {
        let index = |k: usize| entry[k].as_u64().expect("an index") as usize - 1;
        let (row, col) = (index(0).min(index(1)), index(0).max(index(1)));
        let found = matrix.column(col).find(|e| e.0 == row).map_or(0.0, |e| e.1);
        assert_eq!(found, entry[2].as_f64().expect("a value"), "{file}: ({row}, {col}) from 0");
    }
    println!("{file}: order {}, {} entries: ok", matrix.order(), matrix.nonzeros());
}

#[test]
fn trap_12_abaqus_coordinate_files_have_no_header_and_both_triangles() {
    for (pair, stem) in
        [("blockC3D4_pair", "blockC3D4_"), ("blockC3D8_pair", "blockC3D8_"), ("rotorDiscTestpair", "rotorDiscTest")]
    {
        let Some(expected) = oracle(&format!("abaqus_mtx_coordinate__{pair}")) else { return };
        agrees(&format!("abaqus_mtx_coordinate/{stem}STIF1.mtx"), &expected["K"]);
        agrees(&format!("abaqus_mtx_coordinate/{stem}MASS1.mtx"), &expected["M"]);
    }
}

#[test]
fn trap_9_ansys_matrix_market_has_a_creator_block_and_a_trailing_blank() {
    for name in ["rotorAnsysMassMatrixSparse.txt", "rotorAnsysStiffnessMatrixSparse.txt"] {
        let Some(expected) = oracle(&format!("ansys_mmf__{name}")) else { return };
        agrees(&format!("ansys_mmf/{name}"), &expected["matrix"]);
    }
}

#[test]
fn trap_19_matrix_market_junk_is_refused_and_real_files_are_read() {
    for name in ["lund_a.mtx", "lund_b.mtx"] {
        let Some(expected) = oracle(&format!("matrixmarket__{name}")) else { return };
        agrees(&format!("matrixmarket/{name}"), &expected["matrix"]);
    }
    let refused: [(&str, usize, &[&str]); 6] = [
        ("invalid_mangle1.mtx", 1, &["`junk`"]),
        ("invalid_mangle2.mtx", 1, &["`junk`"]),
        ("invalid_wrong.mtx", 2, &["2 rows and 3 columns"]),
        ("can___24.mtx", 1, &["`pattern`"]),
        ("jgl009.mtx", 1, &["`pattern`"]),
        ("pores_1.mtx", 0, &["not symmetric"]),
    ];
    for (name, line, words) in refused {
        let Some(path) = shared(&format!("formats/matrixmarket/{name}")) else { return };
        let result = read_symmetric(&path, "matrix");
        let line = if line == 0 { result.as_ref().err().and_then(|e| e.line()).expect("a line") } else { line };
        assert_says(result, line, words);
    }
}

#[test]
fn trap_11_harwell_boeing_formats_and_the_fifth_header_line() {
    for name in ["bcsstk01.rsa", "lund_a.rsa"] {
        let Some(expected) = oracle(&format!("harwellboeing__{name}")) else { return };
        agrees(&format!("harwellboeing/{name}"), &expected["matrix"]);
    }
    let refused: [(&str, usize, &[&str]); 3] = [
        ("harwellboeing/utm300.rua", 0, &["not symmetric"]),
        ("harwellboeing/well1850.rra", 3, &["RRA", "square"]),
        ("rutherfordboeing/commanche_dual.rb", 3, &["PSA", "no values"]),
    ];
    for (name, line, words) in refused {
        let Some(path) = shared(&format!("formats/{name}")) else { return };
        assert_says(read_symmetric(&path, "matrix"), line, words);
    }
}
