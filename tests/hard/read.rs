//! CalculiX matrices and nodes, read in the plainest way.

use ferrom::linalg::SymSparse;
use ferrom::model::{Axis, Dof, DofMap, FeModel, NodeId};
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn text(path: &Path) -> String {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    if path.extension().is_some_and(|e| e == "gz") {
        let mut out = String::new();
        GzDecoder::new(bytes.as_slice()).read_to_string(&mut out).expect("gzip text");
        out
    } else {
        String::from_utf8(bytes).expect("text")
    }
}

fn matrix(path: &Path, order: usize) -> SymSparse {
    let entries: Vec<(usize, usize, f64)> = text(path)
        .lines()
        .map(|line| {
            let mut field = line.split_ascii_whitespace();
            let mut next = || field.next().expect("three fields");
            let row: usize = next().parse().expect("row");
            let col: usize = next().parse().expect("column");
            (row - 1, col - 1, next().parse().expect("value"))
        })
        .collect();
    SymSparse::from_triplets(order, &entries).expect("a symmetric matrix")
}

/// K, M, dofs of `STEM.sti.gz` …, nodes of `mesh` when given.
pub fn export(stem: &str, mesh: Option<&str>) -> FeModel {
    let file = |end: &str| repository(&format!("{stem}.{end}"));
    let labels: Vec<Dof> = text(&file("dof.gz"))
        .lines()
        .map(|line| {
            let (node, axis) = line.trim().split_once('.').expect("node.direction");
            let axis = Axis::from_number(axis.parse().expect("direction")).expect("1 … 6");
            Dof { node: NodeId(node.parse().expect("node")), axis }
        })
        .collect();
    let n = labels.len();
    FeModel {
        name: stem.into(),
        nodes: mesh.map(|m| nodes(&repository(m))).unwrap_or_default(),
        dofs: DofMap::labelled(labels).expect("no repeated labels"),
        stiffness: matrix(&file("sti.gz"), n),
        mass: matrix(&file("mas.gz"), n),
        node_sets: BTreeMap::new(),
        sources: Vec::new(),
    }
}

fn nodes(path: &Path) -> BTreeMap<NodeId, [f64; 3]> {
    let mut out = BTreeMap::new();
    let mut inside = false;
    for line in text(path).lines() {
        if line.starts_with('*') {
            inside = line.to_ascii_uppercase().starts_with("*NODE") && !line.to_ascii_uppercase().starts_with("*NODE ");
            continue;
        }
        if inside {
            let mut field = line.split(',').map(str::trim);
            let id = field.next().expect("label").parse().expect("label");
            let mut x = || field.next().expect("coordinate").parse::<f64>().expect("coordinate");
            out.insert(NodeId(id), [x(), x(), x()]);
        }
    }
    out
}

/// λ and its relative uncertainty, mode by mode.
pub fn reference(path: &str) -> Vec<(f64, f64)> {
    text(&repository(path))
        .lines()
        .skip(1)
        .map(|line| {
            let field: Vec<f64> = line.split(',').map(|f| f.parse().expect("number")).collect();
            (field[1], field[3])
        })
        .collect()
}

/// A model of bare matrices.
pub fn bare(stiffness: SymSparse, mass: SymSparse) -> FeModel {
    FeModel {
        name: "bare".into(),
        nodes: BTreeMap::new(),
        dofs: DofMap::unlabelled(stiffness.order()),
        stiffness,
        mass,
        node_sets: BTreeMap::new(),
        sources: Vec::new(),
    }
}
