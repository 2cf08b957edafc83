//! .inp meshes.

use super::{Folder, assert_says, leaf};
use ferrom::format::{Mesh, read_mesh};
use ferrom::model::NodeId;
use proptest::prelude::*;

fn set(mesh: &Mesh, name: &str) -> Vec<u32> {
    mesh.node_sets.get(name).unwrap_or_else(|| panic!("no set {name}")).iter().map(|n| n.0).collect()
}

#[test]
fn the_leafs_mesh_has_its_nodes_and_joint_sets() {
    let (mesh, source) = read_mesh(&leaf("leaf_mesh.inp")).expect("the leaf");
    assert_eq!(mesh.nodes.len(), 2868);
    assert_eq!(source.role, "mesh");
    assert_eq!(mesh.nodes[&NodeId(12)], [0.0, -7.926643621360e-01, -2.511776339636e-01]);
    assert_eq!(set(&mesh, "JOINT_D"), (2841..=2868).collect::<Vec<_>>());
    assert_eq!(set(&mesh, "JOINT_C"), (1..=28).collect::<Vec<_>>());
    assert_eq!(set(&mesh, "N_D"), [2852]);
    assert_eq!(set(&mesh, "NALL").len(), 2868);
    // The mean of the cross-section lies on the mid-plane (MODELS.md: c, d at y = ∓0.802, z = −0.242131).
    let mean = |axis: usize| set(&mesh, "JOINT_D").iter().map(|&n| mesh.nodes[&NodeId(n)][axis]).sum::<f64>() / 28.0;
    assert!((mean(1) - 0.802).abs() < 1e-6 && (mean(2) + 0.242131).abs() < 1e-6, "six digits are given");
}

#[test]
fn sets_includes_and_continuations() {
    let folder = Folder::new();
    folder
        .write("sub/nodes.inp", "*node, nset = all\n1, 0., 0., 0.\n2,1.0D0,0,0\n 3 , 0, 1\n*INCLUDE, INPUT=more.inp\n");
    folder.write("sub/more.inp", "** inside the folder of nodes.inp\n*NODE\n10, 5, 5, 5\n");
    let main = "*HEADING\nanything, at all\n*Include, input=\"sub/nodes.inp\"\n*NSET,\nNSET=Tip,\n** a comment between\nUNSORTED\n2, 3,\n\n10\n*nset, nset=both\nTIP, 1\n*NSET, GENERATE, NSET=range\n1, 9, 2\n10, 10\n*NSET, NSET=tip\n1\n*ELEMENT, TYPE=C3D20, ELSET=E\n1, 1, 2, 3,\n10\n*NSET, NSET=FROM_ELEMENTS, ELSET=E\n";
    for text in [main.to_owned(), main.replace('\n', "\r\n")] {
        let (mesh, source) = read_mesh(&folder.write("main.inp", text)).expect("good");
        assert_eq!(mesh.nodes.len(), 4);
        assert_eq!(mesh.nodes[&NodeId(3)], [0.0, 1.0, 0.0], "a missing coordinate is zero");
        assert_eq!(set(&mesh, "ALL"), [1, 2, 3]);
        assert_eq!(set(&mesh, "TIP"), [1, 2, 3, 10], "a later card adds to the set");
        assert_eq!(set(&mesh, "BOTH"), [1, 2, 3, 10]);
        assert_eq!(set(&mesh, "RANGE"), [1, 3, 10], "of a range, the labels that are nodes");
        assert!(!mesh.node_sets.contains_key("FROM_ELEMENTS"));
        assert_eq!(source.sha256.len(), 64);
    }
}

#[test]
fn node_files_and_other_coordinates() {
    let folder = Folder::new();
    folder.write("n.txt", "1, 2.0, 90.0, 3.0\n");
    let text = "*NODE, SYSTEM=C, INPUT=n.txt, NSET=ROUND\n*NODE, SYSTEM=S\n2, 2.0, 0.0, 90.0\n";
    let (mesh, _) = read_mesh(&folder.write("a.inp", text)).expect("good");
    // cos 90° is 6e-17 in floating point.
    let near = |id: u32, p: [f64; 3]| mesh.nodes[&NodeId(id)].iter().zip(p).all(|(a, b)| (a - b).abs() < 1e-15);
    assert!(near(1, [0.0, 2.0, 3.0]) && near(2, [0.0, 0.0, 2.0]), "{:?}", mesh.nodes);
    assert_eq!(set(&mesh, "ROUND"), [1]);
}

#[test]
fn every_bad_card_is_named() {
    let folder = Folder::new();
    let cases: [(&str, usize, &[&str]); 17] = [
        ("*NODE\n1, 0, 0, 0\n1.5, 0, 0, 0\n", 3, &["`1.5, 0, 0, 0`", "label, x, y, z"]),
        ("*NODE\n1, 0, x, 0\n", 2, &["label, x, y, z"]),
        ("*NODE\n0, 0, 0, 0\n", 2, &["label"]),
        ("*NODE\n1, 0, nan, 0\n", 2, &["NaN", "finite"]),
        ("*NODE\n1, 0, 0, 0\n1, 0, 0, 1\n", 3, &["node 1 also stands at", "bad.inp:2", "instances"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A\n1, 7\n", 4, &["set A holds node 7"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A, GENERATE\n5, 4294967295\n", 4, &["nodes 5 to 4294967295"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A, GENERATE\n5, 1, 1\n", 4, &["first, last, step"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A, GENERATE\n1, 5, 0\n", 4, &["first, last, step"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A\nB\n", 4, &["set A names `B`", "earlier"]),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A\nA\n", 4, &["set A names `A`"]),
        ("*NODE\n1, 0, 0, 0\n*NSET\n1\n", 3, &["without a name"]),
        ("*NODE\n1, 0, 0, 0\n*NGEN\n1, 5\n", 3, &["*NGEN makes or moves nodes", "flat"]),
        ("*NODE, SYSTEM=Q\n1, 0, 0, 0\n", 1, &["SYSTEM=Q"]),
        ("*NODE, NSET=\"A\n1, 0, 0, 0\n*INCLUDE\n", 3, &["*INCLUDE without a file"]),
        ("*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=bad.inp\n", 3, &["included again"]),
        ("*=\n", 1, &["*KEYWORD"]),
    ];
    for (text, line, words) in cases {
        assert_says(read_mesh(&folder.write("bad.inp", text)), line, words);
    }
    assert_says(read_mesh(&folder.write("a.inp", "*HEADING\n")), 0, &["no *NODE card"]);
    assert_says(read_mesh(&folder.write("b.inp", "*INCLUDE, INPUT=none.inp\n")), 0, &["none.inp", "cannot be read"]);
}

#[test]
fn includes_that_run_in_a_circle_are_refused_in_the_file_that_closes_it() {
    let folder = Folder::new();
    let path = folder.write("a.inp", "*INCLUDE, INPUT=b.inp\n");
    folder.write("b.inp", "*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=./a.inp\n");
    assert_says(read_mesh(&path), 3, &["b.inp", "included again"]);
    // Doubling at every level would read 2^40 files.
    for k in 0..40 {
        folder.write(&format!("n{k}.inp"), format!("*INCLUDE, INPUT=n{}.inp\n", k + 1).repeat(2));
    }
    folder.write("n40.inp", "*NODE\n1, 0, 0, 0\n");
    assert_says(read_mesh(&folder.path("n0.inp")), 2, &["again"]);
}

#[test]
fn a_mesh_cut_at_any_byte_never_panics() {
    let folder = Folder::new();
    let text =
        "** x\n*NODE, NSET=ALL\n1, 0.5, 1e0, -2\n2, 1, 1, 1\n*NSET, NSET=S, GENERATE\n1, 2, 1\n*NSET,\nNSET=T\nS\n";
    for cut in 0..text.len() {
        let _ = read_mesh(&folder.write("cut.inp", &text[..cut]));
    }
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in "[*A-Z,=0-9 .\n\r\"-]{0,200}") {
        let folder = Folder::new();
        let _ = read_mesh(&folder.write("a.inp", text));
    }
}
