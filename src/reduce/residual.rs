//! Residual flexibility: what the kept modes leave out, exact for static loads at the joints.

use crate::linalg::{FactorError, ShiftedFactor};
use crate::model::{FeModel, InterfaceNode, Modes, Residual, Role};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Why the static responses cannot be had.
#[derive(Debug, Error)]
pub enum ResidualError {
    /// K − σM cannot be factorised.
    #[error("residual flexibility: {0}")]
    Factor(#[from] FactorError),
    /// The correction of the shift does not settle.
    #[error(
        "residual flexibility: the static solution still changes by {change:.1e} after {iterations} corrections of the shift; compute more modes ([modal] count)"
    )]
    NoConvergence {
        /// Relative change at the end.
        change: f64,
        /// Corrections made.
        iterations: usize,
    },
}

/// Corrections of the shift; each gains a factor |σ|/(ω²_next − σ), at worst one half for a shift of
/// the size of the first elastic ω² and no computed elastic mode, so 60 reach rounding;
/// the rest is for finding that shift.
const MOST_CORRECTIONS: usize = 80;

/// Corrections between looks at the shift: soft motions show only once the stiff ones have settled.
const MOVE_EVERY: usize = 4;

/// Directions of the static response whose strain energy is below this share of the largest (after
/// scaling each response to unit energy) are combinations of the others plus rounding.
const DEPENDENT: f64 = 1e-10;

/// For a unit force at each joint degree of freedom (columns of F): the inertia-relief response of
/// all modes but the kept and the rigid ones,
///
/// r = Σ_{not kept} φ φᵀ f / ω² = P (K − σM)⁻¹ (Pᵀ f − σ M r),
///
/// P projecting off every computed mode (MacNeal 1971, Rubin 1975; the shift is removed by fixed
/// point), plus the computed modes that were not kept. Then A = Fᵀ r is the residual flexibility,
/// and the generalised eigenvectors of (rᵀKr, rᵀMr) = (A, rᵀMr) are the residual vectors.
pub(super) fn residual(
    fe: &FeModel,
    modes: &Modes,
    kept: &[usize],
    nodes: &[InterfaceNode],
    rows: &[&[(usize, f64)]],
) -> Result<Residual, ResidualError> {
    let n = fe.dofs.len();
    let roles = nodes.iter().flat_map(|node| node.axes.iter().map(|_| node.role));
    let joint_rows: Vec<usize> = roles.enumerate().filter(|r| r.1 == Role::Joint).map(|r| r.0).collect();
    let mut force = DMatrix::zeros(n, joint_rows.len());
    for (c, &k) in joint_rows.iter().enumerate() {
        for &(row, w) in rows[k] {
            force[(row, c)] += w;
        }
    }
    let response = static_response(fe, modes, kept, &force)?;
    let energy = symmetric(&(force.transpose() * &response));
    let kinetic = symmetric(&(response.transpose() * fe.mass.mul_block(&response)));
    let basis = residual_vectors(&energy, &kinetic);
    let at_kept = DMatrix::from_fn(rows.len(), response.ncols(), |k, c| {
        rows[k].iter().map(|&(row, w)| w * response[(row, c)]).sum::<f64>()
    });
    let shapes = &at_kept * &basis.vectors;
    let compliance = DMatrix::from_diagonal(&basis.omega.map(|w| 1.0 / (w * w)));
    let unit = unit_translations(fe);
    Ok(Residual {
        flexibility: &shapes * compliance * shapes.transpose(),
        omega: basis.omega.as_slice().to_vec(),
        zeta: vec![f64::NAN; basis.omega.len()],
        participation: (fe.mass.mul_block(&response) * &basis.vectors).transpose() * unit,
        shapes,
    })
}

/// The response r of the doc above, n×f.
fn static_response(
    fe: &FeModel,
    modes: &Modes,
    kept: &[usize],
    force: &DMatrix<f64>,
) -> Result<DMatrix<f64>, ResidualError> {
    let shift = if modes.shift < 0.0 { modes.shift } else { -first_elastic(modes) };
    let mut shift = shift;
    let mut factor = ShiftedFactor::new(&fe.stiffness, &fe.mass, shift)?;
    let phi = &modes.shapes;
    let mass_phi = fe.mass.mul_block(phi);
    let gains = phi.transpose() * force;
    let free_force = force - &mass_phi * &gains;
    let mut response: DMatrix<f64> = DMatrix::zeros(force.nrows(), force.ncols());
    // With every mode computed nothing is left but rounding: changes count against the whole response.
    let mut unprojected = force.clone();
    factor.solve_in_place(&mut unprojected);
    let whole = unprojected.norm();
    let mut change = f64::INFINITY;
    let mut iterations = 0;
    // A change below a few roundings of the response is as converged as doubles can show.
    while change > 1e-14 {
        if iterations == MOST_CORRECTIONS {
            if change < 1e-9 {
                break;
            }
            return Err(ResidualError::NoConvergence { change, iterations });
        }
        let mut next = &free_force - fe.mass.mul_block(&response) * shift;
        factor.solve_in_place(&mut next);
        let drift = mass_phi.transpose() * &next;
        next -= phi * drift;
        if iterations % MOVE_EVERY == 0 && iterations < 4 * MOVE_EVERY {
            // With few modes computed the shift may be far above the next ω²: each correction would
            // gain next to nothing. The softest response tells where it should be.
            let softest = (0..next.ncols())
                .map(|c| next.column(c).into_owned())
                .map(|u| {
                    u.dot(&DVector::from(fe.stiffness.mul(u.as_slice())))
                        / u.dot(&DVector::from(fe.mass.mul(u.as_slice())))
                })
                .filter(|l| l.is_finite() && *l > 0.0)
                .fold(f64::INFINITY, f64::min);
            if softest < -0.1 * shift {
                shift = -softest;
                factor = ShiftedFactor::new(&fe.stiffness, &fe.mass, shift)?;
            }
        }
        change = (&next - &response).norm() / whole.max(f64::MIN_POSITIVE);
        response = next;
        iterations += 1;
    }
    for c in (modes.rigid..modes.len()).filter(|c| !kept.contains(c)) {
        let scaled = gains.row(c) / modes.omega[c].powi(2);
        response += phi.column(c) * scaled;
    }
    Ok(response)
}

fn first_elastic(modes: &Modes) -> f64 {
    modes.omega.get(modes.rigid).map_or(1.0, |w| w * w)
}

fn symmetric(a: &DMatrix<f64>) -> DMatrix<f64> {
    (a + a.transpose()) * 0.5
}

/// Unit translations along x, y, z at every labelled degree of freedom, n×3.
fn unit_translations(fe: &FeModel) -> DMatrix<f64> {
    let mut unit = DMatrix::zeros(fe.dofs.len(), 3);
    for (row, dof) in fe.dofs.labels().iter().enumerate() {
        if !dof.axis.is_rotation() {
            unit[(row, dof.axis.index())] = 1.0;
        }
    }
    unit
}

struct Basis {
    /// rad/s, ascending.
    omega: DVector<f64>,
    /// Combinations of the responses, f×t, mass-normalised.
    vectors: DMatrix<f64>,
}

/// Solves A v = ω² B v on the space where A (strain energy) is not zero to rounding.
fn residual_vectors(energy: &DMatrix<f64>, kinetic: &DMatrix<f64>) -> Basis {
    let count = energy.nrows();
    let scale = DVector::from_fn(count, |k, _| {
        let e = energy[(k, k)];
        if e > 0.0 { 1.0 / e.sqrt() } else { 0.0 }
    });
    let scaling = DMatrix::from_diagonal(&scale);
    let eigen = (&scaling * energy * &scaling).symmetric_eigen();
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let keep: Vec<usize> = (0..count).filter(|&k| eigen.eigenvalues[k] > DEPENDENT * largest).collect();
    let whiten = DMatrix::from_fn(count, keep.len(), |r, c| {
        eigen.eigenvectors[(r, keep[c])] / eigen.eigenvalues[keep[c]].sqrt()
    });
    let whiten = scaling * whiten;
    let inner = symmetric(&(whiten.transpose() * kinetic * &whiten)).symmetric_eigen();
    let mut order: Vec<usize> = (0..keep.len()).filter(|&k| inner.eigenvalues[k] > 0.0).collect();
    order.sort_by(|&a, &b| inner.eigenvalues[b].total_cmp(&inner.eigenvalues[a]));
    let omega = DVector::from_iterator(order.len(), order.iter().map(|&k| 1.0 / inner.eigenvalues[k].sqrt()));
    let mut vectors = DMatrix::from_fn(keep.len(), order.len(), |r, c| {
        inner.eigenvectors[(r, order[c])] / inner.eigenvalues[order[c]].sqrt()
    });
    vectors = whiten * vectors;
    for mut column in vectors.column_iter_mut() {
        // An eigenvector and its opposite are the same: fix the sign, so that files do not depend on it.
        if column[column.iamax()] < 0.0 {
            column.neg_mut();
        }
    }
    Basis { omega, vectors }
}
