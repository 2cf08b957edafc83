//! Where to shift: a negative number of the size of the first elastic ω².

use super::rigid::{RigidMotions, orthonormal};
use crate::linalg::SymSparse;
use crate::model::FeModel;
use nalgebra::DMatrix;

/// An estimate of the first elastic ω², (rad/s)²: an upper bound by Rayleigh–Ritz with the
/// displacement fields that are quadratic in the coordinates (bending, twist, stretch) where the
/// mesh is there, which is right within a few times for any slender or chunky body; otherwise from
/// the matrices' diagonals alone, which is right within several powers of ten only.
pub(super) fn estimate(fe: &FeModel, rigid: Option<&RigidMotions>, free: usize) -> f64 {
    rigid.and_then(|r| from_mesh(fe, r, free)).unwrap_or_else(|| from_diagonals(&fe.stiffness, &fe.mass))
}

fn from_mesh(fe: &FeModel, rigid: &RigidMotions, free: usize) -> Option<f64> {
    if free == 0 {
        return None;
    }
    let labels = fe.dofs.labels();
    let n = labels.len();
    let p: Vec<[f64; 3]> = labels.iter().map(|d| fe.nodes.get(&d.node).copied()).collect::<Option<_>>()?;
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for q in &p {
        for d in 0..3 {
            low[d] = low[d].min(q[d]);
            high[d] = high[d].max(q[d]);
        }
    }
    let size = (0..3).map(|d| high[d] - low[d]).fold(0.0f64, f64::max);
    if size <= 0.0 {
        return None;
    }
    // Monomials of degree 1 and 2 in each translation; rotations are left at rest.
    let place = |i: usize, d: usize| (p[i][d] - 0.5 * (low[d] + high[d])) / size;
    let monomials: [(usize, Option<usize>); 9] = [
        (0, None),
        (1, None),
        (2, None),
        (0, Some(0)),
        (1, Some(1)),
        (2, Some(2)),
        (0, Some(1)),
        (1, Some(2)),
        (0, Some(2)),
    ];
    let trial = DMatrix::from_fn(n, 27, |i, c| {
        let (a, b) = monomials[c / 3];
        if labels[i].axis.index() != c % 3 { 0.0 } else { place(i, a) * b.map_or(1.0, |b| place(i, b)) }
    });
    let mut all = DMatrix::zeros(n, free + 27);
    all.columns_mut(0, free).copy_from(&rigid.shapes.columns(0, free));
    all.columns_mut(free, 27).copy_from(&trial);
    let basis = orthonormal(&fe.mass, all)?;
    let projected = basis.transpose() * fe.stiffness.mul_block(&basis);
    let mut values: Vec<f64> = projected.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values.get(free).copied().filter(|v| v.is_finite() && *v > 0.0)
}

/// Between the stiffness a node feels and the whole body's lie N² (stretch) to N⁴ (bending) with N
/// the elements along it; the middle of that range for N = n^(1/3).
fn from_diagonals(k: &SymSparse, m: &SymSparse) -> f64 {
    let (k, m) = (k.diagonal(), m.diagonal());
    let ratio: Vec<f64> = k.iter().zip(&m).filter(|(k, m)| **k > 0.0 && **m > 0.0).map(|(k, m)| k / m).collect();
    if ratio.is_empty() {
        return 1.0;
    }
    let mean = ratio.iter().map(|r| r.ln()).sum::<f64>() / ratio.len() as f64;
    mean.exp() / (ratio.len() as f64).max(2.0)
}
