//! Rigid-body motions from node positions.

use super::digits::noise;
use crate::linalg::SymSparse;
use crate::model::{Axis, FeModel, RigidBody};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Directions of rigid motion whose mass is below this share of the largest do not exist in the
/// model (a chain along one axis has no rotations): rounding of coordinates is far below it.
const MASSLESS: f64 = 1e-9;

/// Rigid motions of the model's own degrees of freedom.
pub(super) struct RigidMotions {
    /// M-orthonormal motions, n×r: translations, then rotations about the principal axes through
    /// the centre of mass, where the model has them all; else an M-orthonormal basis.
    pub(super) shapes: DMatrix<f64>,
    /// rᵀKr of each, (rad/s)²: zero to rounding when the motion is free.
    pub(super) energy: Vec<f64>,
    /// What rounding of the entries of K can make of that zero (standard deviation).
    pub(super) noise: Vec<f64>,
}

/// The motions, or `None` without a mesh and labels for every row.
pub(super) fn rigid_motions(fe: &FeModel, relative: f64) -> Option<RigidMotions> {
    let labels = fe.dofs.labels();
    if labels.is_empty() || fe.nodes.is_empty() {
        return None;
    }
    let positions: Option<Vec<[f64; 3]>> = labels.iter().map(|d| fe.nodes.get(&d.node).copied()).collect();
    let positions = positions?;
    let at = |centre: [f64; 3]| {
        DMatrix::from_fn(labels.len(), 6, |i, c| {
            let (axis, arm) = (labels[i].axis, Vector3::from(positions[i]) - Vector3::from(centre));
            motion(axis, c, arm)
        })
    };
    let raw = at([0.0; 3]);
    let gram = raw.transpose() * fe.mass.mul_block(&raw);
    let shapes = match body(&gram) {
        Some(body) => {
            let about = at(body.centre);
            let turn = body.motion_at(body.centre);
            // Rigid coordinates → motion of the centre: the columns of motion_at there.
            about * turn
        }
        None => raw,
    };
    let shapes = orthonormal(&fe.mass, shapes)?;
    let stiff = fe.stiffness.mul_block(&shapes);
    let energy = shapes.transpose() * stiff;
    let (shapes, energy) = separate(shapes, energy, &fe.stiffness, relative);
    let noise = (0..shapes.ncols()).map(|c| noise(&fe.stiffness, shapes.column(c).as_slice(), relative)).collect();
    Some(RigidMotions { shapes, energy, noise })
}

/// Component along `axis` of rigid motion c (x y z rx ry rz, about the reference point).
fn motion(axis: Axis, c: usize, arm: Vector3<f64>) -> f64 {
    let d = axis.index();
    if c < 3 {
        return if d == c { 1.0 } else { 0.0 };
    }
    let turn = Vector3::ith(c - 3, 1.0);
    if d < 3 { turn.cross(&arm)[d] } else { turn[d - 3] }
}

/// Mass, centre and inertia from the 6×6 mass of the rigid motions about the origin; `None` when
/// the model lacks a direction, so that it is no body in space.
fn body(gram: &DMatrix<f64>) -> Option<RigidBody> {
    let mass = gram[(0, 0)];
    let equal = |a: f64| (a - mass).abs() <= 1e-6 * mass;
    if mass <= 0.0 || !equal(gram[(1, 1)]) || !equal(gram[(2, 2)]) {
        return None;
    }
    // M of a unit translation along y about rotation z is m·x_c, and so on in turn.
    let centre = [gram[(1, 5)] / mass, gram[(2, 3)] / mass, gram[(0, 4)] / mass];
    let c = Vector3::from(centre);
    let about_origin = Matrix3::from_fn(|i, j| 0.5 * (gram[(3 + i, 3 + j)] + gram[(3 + j, 3 + i)]));
    let inertia = about_origin - (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * mass;
    Some(RigidBody { mass, centre, inertia })
}

/// M-orthonormal columns by two rounds of Gram–Schmidt; columns that vanish are dropped.
pub(super) fn orthonormal(mass: &SymSparse, shapes: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let mut kept: Vec<(DVector<f64>, DVector<f64>)> = Vec::new();
    let norms: Vec<f64> =
        shapes.column_iter().map(|c| c.dot(&DVector::from(mass.mul(c.clone_owned().as_slice())))).collect();
    let largest = norms.iter().fold(0.0f64, |a, b| a.max(*b));
    if largest <= 0.0 {
        return None;
    }
    for (c, &before) in norms.iter().enumerate() {
        if before <= MASSLESS * largest * 1e-6 {
            continue;
        }
        let mut v = shapes.column(c).clone_owned() / before.sqrt();
        for _ in 0..2 {
            for (u, mu) in &kept {
                let part = mu.dot(&v);
                v.axpy(-part, u, 1.0);
            }
        }
        let mv = DVector::from(mass.mul(v.as_slice()));
        let square = v.dot(&mv);
        if square > MASSLESS {
            let scale = 1.0 / square.sqrt();
            kept.push((v * scale, mv * scale));
        }
    }
    let columns: Vec<DVector<f64>> = kept.into_iter().map(|p| p.0).collect();
    (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
}

/// Turns the motions so that free ones and held ones do not mix, when some are held. Motions that
/// are all free to rounding are left as they are.
fn separate(shapes: DMatrix<f64>, energy: DMatrix<f64>, k: &SymSparse, relative: f64) -> (DMatrix<f64>, Vec<f64>) {
    let diagonal: Vec<f64> = energy.diagonal().iter().copied().collect();
    let free = (0..shapes.ncols()).all(|c| diagonal[c].abs() <= FREE * noise(k, shapes.column(c).as_slice(), relative));
    if free {
        return (shapes, diagonal);
    }
    let eigen = energy.symmetric_eigen();
    let mut order: Vec<usize> = (0..shapes.ncols()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let turned = &shapes * DMatrix::from_fn(shapes.ncols(), shapes.ncols(), |r, c| eigen.eigenvectors[(r, order[c])]);
    (turned, order.iter().map(|&e| eigen.eigenvalues[e]).collect())
}

/// Standard deviations of rounding within which a motion counts as free. Rounding errors of the
/// entries of a node are not quite independent, and node positions are rounded too.
pub(super) const FREE: f64 = 100.0;
