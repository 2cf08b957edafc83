//! Reduced models as HDF5 and as a readable summary.

use super::{Folder, assert_says};
use ferrom::format::{read_reduced, read_summary, reduced_to_bytes, summary_to_text, write_atomically};
use ferrom::model::{
    Axis, KeptDof, KeptMode, KeptNode, ModeNo, NodeId, Origin, Ranking, ReducedModel, Residual, RigidBody, RigidPart,
    Role, Score, Selection, Source, StateSpace,
};
use nalgebra::{DMatrix, Matrix3};
use proptest::prelude::*;

/// A model with every field filled: r modes at 2 nodes (6 + 3 dofs), values from a formula.
pub fn sample(r: usize, residual: bool) -> ReducedModel {
    let filled = |rows: usize, cols: usize, phase: f64| {
        DMatrix::from_fn(rows, cols, |i, j| ((1 + i + 7 * j) as f64 * 1.37 + phase).sin() / 3.0)
    };
    let dofs: Vec<KeptDof> = Axis::ALL
        .into_iter()
        .map(|axis| KeptDof { node: 0, axis })
        .chain(Axis::ALL[..3].iter().map(|&axis| KeptDof { node: 1, axis }))
        .collect();
    let k = dofs.len();
    ReducedModel {
        name: "sämple".into(),
        modes: (0..r)
            .map(|i| KeptMode {
                number: ModeNo(7 + i as u32),
                omega: 107.071_234_567_89 * (1.0 + i as f64).sqrt(),
                zeta: 0.03,
                origin: if i == 1 { Origin::Measured } else { Origin::Computed },
            })
            .collect(),
        shapes: filled(k, r, 0.1),
        participation: filled(r, 3, 0.2),
        dofs,
        nodes: vec![
            KeptNode {
                name: "d".into(),
                role: Role::Joint,
                position: [1e-17, 0.802, -0.242131],
                labels: (2841..=2868).map(NodeId).collect(),
            },
            KeptNode { name: "tip".into(), role: Role::Measured, position: [0.0; 3], labels: vec![NodeId(3)] },
        ],
        rigid: RigidPart {
            body: RigidBody {
                mass: 6.699475,
                centre: [0.0, 1e-12, -0.1],
                inertia: Matrix3::new(1.0, 0.1, -0.2, 0.1, 2.0, 0.3, -0.2, 0.3, 3.0),
            },
            shapes: filled(k, 6, 0.3),
            participation: filled(6, 3, 0.4),
        },
        residual: residual.then(|| Residual {
            flexibility: filled(k, k, 0.5),
            omega: vec![1e4, 2e4],
            zeta: vec![0.03, f64::NAN.copysign(1.0)].into_iter().map(|z| if z.is_nan() { 1.0 } else { z }).collect(),
            shapes: filled(k, 2, 0.6),
            participation: filled(2, 3, 0.7),
        }),
        ranking: Ranking {
            criterion: "peak-gain".into(),
            input: "d:z".into(),
            output: "d:z".into(),
            unit: "m/N".into(),
            scores: (0..r as u32 + 1)
                .map(|i| Score {
                    mode: ModeNo(7 + i),
                    score: 1e-3 / f64::from(i * i + 1),
                    relative: 1.0 / f64::from(i * i + 1),
                })
                .collect(),
        },
        selection: Selection {
            modes: (0..r as u32).map(|i| ModeNo(7 + i)).collect(),
            reason: "last-above 2e-4: \"mode\" 8 is the last".into(),
            warnings: vec!["mode 18 outranks 16".into(), String::new()],
        },
        full_dofs: 8604,
        sources: vec![Source { role: "stiffness".into(), path: "leaf.sti.gz".into(), sha256: "57c3".repeat(16) }],
        recipe: "name = \"leaf\"\n# ζ\n".into(),
        tool: "ferrom 0.1.0".into(),
    }
}

#[test]
fn reduced_models_round_trip_to_the_bit() {
    let folder = Folder::new();
    for (r, residual) in [(0, false), (0, true), (1, false), (3, true), (11, true)] {
        let model = sample(r, residual);
        let bytes = reduced_to_bytes(&model, None).expect("writable");
        assert_eq!(bytes, reduced_to_bytes(&model, None).expect("writable"), "the same model gives the same bytes");
        let back = read_reduced(&folder.write("a.h5", &bytes)).expect("readable");
        assert_eq!(back, model);
        let bits = |m: &DMatrix<f64>| m.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back.shapes), bits(&model.shapes));
    }
}

/// Four joints of six dofs, 11 modes, 24 residual vectors, sets of 28 labels: the reference leaf.
#[test]
fn a_reduced_model_of_the_leafs_size_takes_tens_of_kilobytes() {
    let mut model = sample(11, true);
    let node = model.nodes[0].clone();
    model.nodes = vec![node; 4];
    model.dofs = (0..4).flat_map(|node| Axis::ALL.map(|axis| KeptDof { node, axis })).collect();
    model.shapes = DMatrix::from_element(24, 11, 0.1);
    model.rigid.shapes = DMatrix::from_element(24, 6, 0.1);
    model.residual = Some(Residual {
        flexibility: DMatrix::from_element(24, 24, 1e-6),
        omega: vec![1e4; 24],
        zeta: vec![0.03; 24],
        shapes: DMatrix::from_element(24, 24, 0.1),
        participation: DMatrix::zeros(24, 3),
    });
    let bytes = reduced_to_bytes(&model, None).expect("writable");
    assert!(bytes.len() < 40_000, "{} bytes", bytes.len());
}

#[test]
fn the_state_space_is_written_on_request() {
    let model = sample(2, true);
    let space = StateSpace::new(&model, &[2], &[2, 8]);
    let bytes = reduced_to_bytes(&model, Some(&space)).expect("writable");
    let file = hdf5_pure::File::from_bytes(bytes).expect("HDF5");
    let shape = |name: &str| file.dataset(name).and_then(|d| d.shape()).expect("there");
    assert_eq!((shape("state_space/A"), shape("state_space/B")), (vec![4, 4], vec![4, 1]));
    assert_eq!((shape("state_space/C"), shape("state_space/D")), (vec![6, 4], vec![6, 1]));
    let a = file.dataset("state_space/A").and_then(|d| d.read_f64()).expect("there");
    assert_eq!(a[2 * 4], space.a[(2, 0)], "row by row");
    let inputs = file.dataset("state_space/inputs").and_then(|d| d.read_string()).expect("there");
    assert_eq!(inputs, ["d:z N"]);
}

#[test]
fn damaged_files_give_one_error_and_never_panic() {
    let folder = Folder::new();
    let bytes = reduced_to_bytes(&sample(2, true), None).expect("writable");
    for cut in (0..bytes.len()).step_by(61).chain(bytes.len() - 20..bytes.len()) {
        assert!(read_reduced(&folder.write("cut.h5", &bytes[..cut])).is_err(), "cut at {cut} of {}", bytes.len());
    }
    assert_says(read_reduced(&folder.write("a.h5", "no HDF5")), 0, &["cannot be read as HDF5", "another format"]);
    assert_says(read_reduced(&folder.path("none.h5")), 0, &["cannot be read", "check the path"]);
}

#[test]
fn missing_and_misshapen_datasets_are_named() {
    let folder = Folder::new();
    let mut model = sample(2, true);
    model.participation = DMatrix::zeros(2, 2);
    let bytes = reduced_to_bytes(&model, None).expect("writable");
    let words = ["/modes/participation", "[2, 2]", "expected [2, 3]"];
    assert_says(read_reduced(&folder.write("shape.h5", bytes)), 0, &words);
    let mut empty = hdf5_pure::FileBuilder::new();
    empty.set_attr("format", hdf5_pure::AttrValue::String("ferrom reduced model 1".into()));
    let path = folder.write("missing.h5", empty.finish().expect("writable"));
    assert_says(read_reduced(&path), 0, &["/modes/number", "ferrom reduce"]);
    let mut other = hdf5_pure::FileBuilder::new();
    other.set_attr("format", hdf5_pure::AttrValue::String("another".into()));
    let path = folder.write("other.h5", other.finish().expect("writable"));
    assert_says(read_reduced(&path), 0, &["`another`", "ferrom reduced model 1"]);
    model = sample(2, true);
    model.dofs[0].node = 9;
    assert_says(reduced_to_bytes(&model, None), 0, &["node 9 of 2"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn flipped_bytes_never_panic(at in 0.0..1.0f64, byte in any::<u8>()) {
        let mut bytes = reduced_to_bytes(&sample(2, true), None).expect("writable");
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] = byte;
        let folder = Folder::new();
        let _ = read_reduced(&folder.write("a.h5", bytes));
    }
}

#[test]
fn the_summary_reads_back_what_it_says() {
    let folder = Folder::new();
    let model = sample(3, true);
    let text = summary_to_text(&model);
    assert_eq!(text, summary_to_text(&model));
    let summary = read_summary(&folder.write("a.toml", &text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!((summary.name.as_str(), summary.full_dofs, summary.kept_dofs), ("sämple", 8604, 9));
    assert_eq!(summary.residual_vectors, 2);
    assert_eq!(summary.selection.modes, "7-9");
    assert_eq!(summary.selection.reason, model.selection.reason);
    assert_eq!(summary.selection.warnings, model.selection.warnings);
    for (said, mode) in summary.modes.iter().zip(&model.modes) {
        assert_eq!((said.number, said.zeta, said.origin), (mode.number, mode.zeta, mode.origin));
        // 11 digits are written.
        assert!((said.omega / mode.omega - 1.0).abs() <= 5e-11);
    }
    assert_eq!(summary.scores.len(), 4);
    assert_eq!(summary.scores.iter().map(|s| s.kept).collect::<Vec<_>>(), [true, true, true, false]);
    assert_eq!(summary.nodes[0].labels, "2841-2868");
    assert_eq!(summary.nodes[1].axes, "x y z");
    assert_eq!(summary.nodes[0].position, [0.0, 0.802, -0.242131], "rounding noise is not written");
    assert_eq!(summary.rigid.inertia, [1.0, 2.0, 3.0, 0.1, -0.2, 0.3]);
    assert_eq!(summary.sources, model.sources);
    assert_says(read_summary(&folder.write("b.toml", text.replace("kept-dofs", "kept-dof"))), 5, &["kept-dof"]);
}

#[test]
fn a_file_is_replaced_whole_or_not_at_all() {
    let folder = Folder::new();
    let path = folder.path("deep/er/a.bin");
    write_atomically(&path, b"one").expect("written");
    write_atomically(&path, b"two").expect("written");
    assert_eq!(std::fs::read(&path).expect("there"), b"two");
    let around = std::fs::read_dir(path.parent().expect("folder")).expect("there").count();
    assert_eq!(around, 1, "no temporary file stays");
    std::fs::create_dir(folder.path("taken")).expect("made");
    assert_says(write_atomically(&folder.path("taken"), b"x"), 0, &["cannot be written", "folder"]);
    assert_eq!(std::fs::read_dir(folder.path("")).expect("there").count(), 2, "no temporary file stays");
    folder.write("file", "x");
    assert_says(write_atomically(&folder.path("file/below"), b"x"), 0, &["cannot be written"]);
}
