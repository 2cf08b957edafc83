//! Whole models: files that belong together, in SI units.

use super::{Folder, assert_says, leaf};
use ferrom::format::{FeFiles, FileUnits, read_fe_model};
use ferrom::model::{Axis, NodeId, Progress, Silent};
use std::sync::Mutex;

const K: &str = "1 1 10.0\n1 2 -4.0\n2 2 8.0\n";
const M: &str = "1 1 2.0\n1 2 0.5\n2 2 3.0\n";

fn small(folder: &Folder, k: &str, m: &str, dofs: &str, mesh: &str) -> FeFiles {
    FeFiles {
        name: "small".into(),
        stiffness: folder.write("k.sti", k),
        mass: folder.write("m.mas", m),
        dofs: Some(folder.write("d.dof", dofs)),
        mesh: Some(folder.write("mesh.inp", mesh)),
        units: FileUnits::default(),
    }
}

#[test]
fn the_leaf_is_read_whole() {
    let files = FeFiles {
        name: "leaf".into(),
        stiffness: leaf("leaf.sti.gz"),
        mass: leaf("leaf.mas.gz"),
        dofs: Some(leaf("leaf.dof.gz")),
        mesh: Some(leaf("leaf_mesh.inp")),
        units: FileUnits::default(),
    };
    let fe = read_fe_model(&files, &Silent).expect("the leaf");
    assert_eq!((fe.dofs.len(), fe.nodes.len(), fe.stiffness.order(), fe.mass.order()), (8604, 2868, 8604, 8604));
    let roles: Vec<&str> = fe.sources.iter().map(|s| s.role.as_str()).collect();
    assert_eq!(roles, ["stiffness", "mass", "dofs", "mesh"]);
    // Mass of the leaf by a unit translation in z: MODELS.md gives 6.699475 kg to seven digits.
    let z: Vec<f64> = fe.dofs.labels().iter().map(|d| if d.axis == Axis::Z { 1.0 } else { 0.0 }).collect();
    let mass: f64 = fe.mass.mul(&z).iter().zip(&z).map(|(a, b)| a * b).sum();
    assert!((mass - 6.699475).abs() < 5e-7, "{mass}");
}

#[test]
fn files_that_do_not_belong_together_are_refused() {
    let folder = Folder::new();
    let (dofs, mesh) = ("5.1\n5.2\n", "*NODE\n5, 0, 0, 0\n");
    let read = |k: &str, m: &str, dofs: &str, mesh: &str| read_fe_model(&small(&folder, k, m, dofs, mesh), &Silent);
    assert!(read(K, M, dofs, mesh).is_ok());
    assert_says(read(K, "1 1 2.0\n", dofs, mesh), 0, &["m.mas", "mass matrix has 1 rows", "expected 2", "k.sti"]);
    assert_says(read("1 1 10.0\n", M, dofs, mesh), 0, &["mass matrix has 2 rows", "expected 1"]);
    assert_says(read(K, M, "5.1\n", mesh), 0, &["d.dof", "dof list has 1 rows", "expected 2"]);
    assert_says(read(K, M, "5.1\n6.1\n", mesh), 0, &["d.dof", "dof 6.x of row 2", "mesh.inp"]);
    assert_says(read("1 1 nan\n", M, dofs, mesh), 1, &["k.sti"]);
    assert_says(read(K, M, "5.1\n5.1\n", mesh), 2, &["d.dof"]);
}

#[test]
fn rows_without_labels_and_models_without_mesh() {
    let folder = Folder::new();
    let files = FeFiles { dofs: None, mesh: None, ..small(&folder, K, M, "", "") };
    let fe = read_fe_model(&files, &Silent).expect("good");
    assert_eq!((fe.dofs.len(), fe.dofs.is_labelled(), fe.nodes.len(), fe.sources.len()), (2, false, 0, 2));
}

/// A dof pair (translation, rotation) in millimetre, tonne, second: forces are newtons, moments
/// N·mm, masses tonnes, inertias t·mm².
#[test]
fn millimetre_tonne_second_becomes_si() {
    let folder = Folder::new();
    let mut files = small(&folder, K, M, "5.3\n5.5\n", "*NODE\n5, 1000, 20, 3\n");
    files.units = FileUnits { length: 1e-3, mass: 1e3, time: 1.0 };
    let fe = read_fe_model(&files, &Silent).expect("good");
    let entries = |m: &ferrom::linalg::SymSparse| {
        (0..2).flat_map(|j| m.column(j).collect::<Vec<_>>()).map(|e| e.1).collect::<Vec<_>>()
    };
    // 10 N/mm = 10^4 N/m; −4 N = −4 N; 8 N·mm = 0.008 N·m. 2 t = 2000 kg; 0.5 t·mm = 0.5 kg·m; 3 t·mm² = 0.003 kg·m².
    for (found, expected) in entries(&fe.stiffness).iter().zip([1e4, -4.0, 8e-3]) {
        assert!((found / expected - 1.0).abs() < 1e-15, "{found} {expected}: two roundings");
    }
    for (found, expected) in entries(&fe.mass).iter().zip([2e3, 0.5, 3e-3]) {
        assert!((found / expected - 1.0).abs() < 1e-15, "{found} {expected}: two roundings");
    }
    assert_eq!(fe.nodes[&NodeId(5)], [1.0, 0.02, 0.003]);
    // A unit of time of 1 ms: stiffness per 1e-6 s².
    files.units = FileUnits { length: 1.0, mass: 1.0, time: 1e-3 };
    let fe = read_fe_model(&files, &Silent).expect("good");
    assert!((entries(&fe.stiffness)[0] / 1e7 - 1.0).abs() < 1e-15);
    assert_eq!(entries(&fe.mass)[0], 2.0);
}

#[test]
fn reading_tells_its_progress() {
    struct Heard(Mutex<Vec<(String, usize, usize)>>);
    impl Progress for Heard {
        fn report(&self, stage: &str, done: usize, total: usize) {
            self.0.lock().expect("no panic").push((stage.into(), done, total));
        }
    }
    let folder = Folder::new();
    let heard = Heard(Mutex::new(Vec::new()));
    read_fe_model(&small(&folder, K, M, "5.1\n5.2\n", "*NODE\n5, 0, 0, 0\n"), &heard).expect("good");
    let heard = heard.0.into_inner().expect("no panic");
    assert!(heard.contains(&("read stiffness".into(), K.len(), K.len())), "{heard:?}");
    assert!(heard.contains(&("read mass".into(), M.len(), M.len())), "{heard:?}");
}
