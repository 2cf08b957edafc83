//! Universal files.

use super::{Folder, assert_says, shared};
use ferrom::format::{TestMode, read_uff, uff55_to_text};
use ferrom::model::NodeId;
use nalgebra::Complex;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// The truth the synthetic test was made from stands beside it.
#[test]
fn the_leafs_synthetic_test_holds_its_five_modes() {
    let Some(path) = shared("models/leaf-spring/test_modes.unv") else { return };
    let (test, _) = read_uff(&path).expect("the test");
    let text =
        std::fs::read_to_string(shared("models/leaf-spring/test_modes_truth.json").expect("there")).expect("text");
    let truth: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let labels: Vec<u64> = truth["nodes"].as_array().expect("list").iter().filter_map(|n| n.as_u64()).collect();
    assert_eq!(test.nodes.keys().map(|n| u64::from(n.0)).collect::<Vec<_>>(), labels);
    assert_eq!(test.nodes[&NodeId(97)], [0.0, -7.76205e-1, -1.97416e-1]);
    assert_eq!(test.modes.len(), 5);
    for (mode, said) in test.modes.iter().zip(truth["modes"].as_array().expect("list")) {
        let value = |key: &str| said[key].as_f64().expect("a number");
        // Six digits are written.
        assert!((mode.omega / value("omega") - 1.0).abs() < 5e-6, "mode {}", mode.number);
        assert_eq!((mode.zeta, mode.complex, mode.shape.len()), (value("zeta"), false, 13));
    }
    assert!(test.warnings.iter().any(|w| w.contains("164")), "no units in that file: {:?}", test.warnings);
}

#[test]
fn trap_3_columns_abut_and_text_lines_may_look_like_numbers() {
    let Some(path) = shared("formats/uff/uff55_sample_test_record10.uff") else { return };
    let (test, _) = read_uff(&path).expect("readable");
    let mode = &test.modes[0];
    // Oracle: pyuff 2.5.8, eig, modal_a and r2.
    assert_eq!(mode.modal_mass, Complex::new(4111.111, -3111.111));
    assert_eq!(
        mode.shape[0],
        (
            NodeId(111_111),
            vec![Complex::new(0.0, 0.0), Complex::new(0.1111111, 0.09111111), Complex::new(0.007111111, 0.004111111)]
        )
    );
    assert_eq!(mode.shape[1].1[2], Complex::new(-0.04111111, -0.01111111));
    assert!(mode.complex);
}

#[test]
fn trap_4_complex_modes_give_their_eigenvalue_normal_modes_their_frequency() {
    let Some(path) = shared("formats/uff/uff55_sample_test_record10.uff") else { return };
    let (test, _) = read_uff(&path).expect("readable");
    let size = 0.1111111f64.hypot(41.11111);
    assert_eq!(test.modes[0].omega, size);
    assert_eq!(test.modes[0].zeta, 0.1111111 / size);
    let (test, _) = read_uff(&shared("formats/uff/uff55_translation.uff").expect("there")).expect("readable");
    let hertz: Vec<f64> = test.modes.iter().map(|m| m.omega / TAU).collect();
    assert!(
        hertz.iter().zip([10.0, 12.0, 13.0]).all(|(f, g)| (f - g).abs() < 1e-14 * g),
        "{hertz:?}: times and over 2π"
    );
    assert_eq!(test.modes[1].shape[3], (NodeId(4), vec![Complex::new(1.98289, 0.0); 3]));
}

#[test]
fn trap_6_positions_are_divided_by_the_length_factor() {
    let Some(path) = shared("formats/uff/heat_engine_housing.uff") else { return };
    let (test, _) = read_uff(&path).expect("readable");
    assert_eq!(test.nodes[&NodeId(1)][0], -171.1755676269531 / 1000.0);
    assert_eq!(test.passed.iter().copied().collect::<Vec<_>>(), [2412, 2414]);
    assert!(test.program.starts_with("VKI"), "{}", test.program);
    let Some(path) = shared("formats/uff/TestLab_161_164_18_15_82.uff") else { return };
    let (test, _) = read_uff(&path).expect("readable");
    assert!(test.nodes.len() > 30, "code 9, user defined, factor 1: {}", test.nodes.len());
}

#[test]
fn trap_7_binary_datasets_are_passed_over_by_their_byte_count() {
    for name in ["binary8byte.uff", "Sample_UFF58b_bin.uff"] {
        let Some(path) = shared(&format!("formats/uff/{name}")) else { return };
        let (test, _) = read_uff(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(test.passed.iter().copied().collect::<Vec<_>>(), [58], "{name}");
    }
}

#[test]
fn every_universal_file_of_the_collection_is_walked_to_its_end() {
    let Some(folder) = shared("formats/uff") else { return };
    for file in std::fs::read_dir(folder).expect("a folder") {
        let path = file.expect("a file").path();
        let (test, _) = read_uff(&path).unwrap_or_else(|e| panic!("{e}"));
        assert!(!(test.nodes.is_empty() && test.modes.is_empty() && test.passed.is_empty()), "{}", path.display());
        assert_eq!(ferrom::format::detect(&path).expect("readable").map(|f| f.name), Some("uff"), "{}", path.display());
    }
}

fn mode(number: i64, complex: bool, width: usize) -> TestMode {
    let part = |k: usize| if complex { (k as f64).cos() } else { 0.0 };
    let shape = (1..4u32)
        .map(|n| {
            (NodeId(n * 30), (0..width).map(|k| Complex::new((n as f64 + k as f64).sin() * 1e-4, part(k))).collect())
        })
        .collect();
    TestMode {
        number,
        omega: 107.0 * TAU,
        zeta: 0.012,
        modal_mass: Complex::new(1.5, 0.0),
        quantity: 8,
        complex,
        shape,
    }
}

#[test]
fn written_modes_read_back_to_the_digits_written() {
    let folder = Folder::new();
    let modes = vec![mode(1, false, 3), mode(2, true, 3), mode(3, false, 6), mode(4, true, 6)];
    let text = uff55_to_text(&modes, "leaf ζ").expect("writable");
    let (back, _) = read_uff(&folder.write("a.unv", &text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(back.modes.len(), 4);
    for (a, b) in back.modes.iter().zip(&modes) {
        assert_eq!((a.number, a.quantity, a.complex, a.modal_mass), (b.number, b.quantity, b.complex, b.modal_mass));
        assert!((a.omega / b.omega - 1.0).abs() < 5e-6 && a.zeta == b.zeta);
        for (x, y) in a.shape.iter().zip(&b.shape) {
            assert_eq!(x.0, y.0);
            assert!(
                x.1.iter().zip(&y.1).all(|(p, q)| (p - q).norm() <= 5.1e-6 * (q.re.abs() + q.im.abs())),
                "six digits"
            );
        }
    }
    // What is read is written again to the same text.
    assert_eq!(uff55_to_text(&back.modes, "leaf ").expect("writable"), text);
    let uneven = TestMode { shape: vec![(NodeId(1), vec![])], ..mode(1, false, 3) };
    assert!(uff55_to_text(&[uneven], "").is_err());
}

#[test]
fn every_bad_dataset_is_named() {
    let folder = Folder::new();
    let good = uff55_to_text(&[mode(1, false, 3)], "x").expect("writable");
    let cases: Vec<(String, usize, &[&str])> = vec![
        ("hello\n".into(), 1, &["`hello`", "-1 in columns"]),
        (String::new(), 0, &["no dataset"]),
        ("    -1\n   abc\n".into(), 2, &["dataset number"]),
        ("    -1\n    58\ntext\n".into(), 3, &["the file ends before the end of dataset 58", "cut short"]),
        (
            good.replacen("         1         2         2", "         1         5         2", 1),
            8,
            &["analysis type 5", "export modes"],
        ),
        (good.replacen("         2         3\n", "         4         3\n", 1), 8, &["data type 4"]),
        (good.replacen("1.07000E+02", "      x.y  ", 1), 10, &["frequency"]),
        (good.replacen("1.07000E+02", "        nan", 1), 10, &["frequency"]),
        (good.replacen("        30\n", "        -3\n", 1), 11, &["node number"]),
        (good.replacen("        60\n", "    -1\n", 1), 14, &["-1 in columns"]),
        ("    -1\n    15\n         1         0         0         1  0.0\n    -1\n".into(), 3, &["x y z"]),
        ("    -1\n  2411\n         1         0         0         1\n    -1\n".into(), 4, &["ends before the position"]),
        ("    -1\n   164\n         9USER\n  0.0\n    -1\n".into(), 4, &["positive factor"]),
        ("    -1\n    58b     1     2          11        2000     0\n".into(), 2, &["the file ends before"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_uff(&folder.write("bad.unv", text)), line, words);
    }
    for cut in 8..good.len() - 7 {
        assert!(read_uff(&folder.write("cut.unv", &good[..cut])).is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn flipped_bytes_never_panic(at in 0.0..1.0f64, byte in any::<u8>()) {
        let mut bytes = uff55_to_text(&[mode(1, true, 6)], "x").expect("writable").into_bytes();
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] = byte;
        let folder = Folder::new();
        let _ = read_uff(&folder.write("a.unv", bytes));
    }
}
