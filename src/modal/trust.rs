//! Refinement of eigenpairs, residuals, and the proof that none is missing.

use super::pairs::Pairs;
use crate::linalg::{ShiftedFactor, SymSparse};
use crate::model::{Completeness, FeModel};
use nalgebra::DMatrix;

/// Residual above which a mode gets a step of refinement.
const REFINE_ABOVE: f64 = 1e-9;
/// Two ω² closer than this, relative, are one cluster: no shift between them could be trusted.
pub(super) const CLUSTER: f64 = 1e-6;
/// Largest |entry of L| with which an inertia count is believed: rounding is multiplied by its
/// square at worst, and μ stands further from every ω² than 10⁻⁷ of it.
const GROWTH: f64 = 1e6;

/// One step of inverse iteration with the residual in twice the working precision,
/// φ ← φ − (K − σM)⁻¹(Kφ − λMφ), for the modes that need it; λ by Rayleigh quotients.
pub(super) fn refine(fe: &FeModel, pairs: &mut Pairs, first: usize) -> usize {
    let (k, m) = (&fe.stiffness, &fe.mass);
    let elastic = pairs.lambda.len() - first;
    let vectors = pairs.vectors.columns(first, elastic).into_owned();
    let stiff = k.mul_block_compensated(&vectors);
    let heavy = m.mul_block(&vectors);
    let mut chosen = Vec::new();
    for c in 0..elastic {
        let lambda = vectors.column(c).dot(&stiff.column(c)) / vectors.column(c).dot(&heavy.column(c));
        pairs.lambda[first + c] = lambda;
        let residual = stiff.column(c) - heavy.column(c) * lambda;
        if residual.norm() > REFINE_ABOVE * stiff.column(c).norm() {
            chosen.push((c, residual));
        }
    }
    if chosen.is_empty() {
        return 0;
    }
    let mut correction = DMatrix::from_columns(&chosen.iter().map(|c| c.1.clone()).collect::<Vec<_>>());
    pairs.factor.solve_in_place(&mut correction);
    for (at, (c, _)) in chosen.iter().enumerate() {
        let mut column = pairs.vectors.column_mut(first + c);
        column -= correction.column(at);
    }
    chosen.len()
}

/// Makes the columns M-orthonormal one after the other, Φ ← Φ R⁻¹ with ΦᵀMΦ = RᵀR: a low mode
/// takes nothing from the higher ones, whose large ω² would spoil its residual, and what a high
/// mode loses to the lower ones is the error inverse iteration leaves in it. Returns max |ΦᵀMΦ − I|.
pub(super) fn orthonormalise(m: &SymSparse, shapes: &mut DMatrix<f64>) -> f64 {
    let count = shapes.ncols();
    let mut worst = f64::INFINITY;
    // Twice is enough (Yamamoto et al. 2015, CholeskyQR2); the third look only measures.
    for round in 0..3 {
        let gram = shapes.transpose() * m.mul_block(shapes);
        let defect = (&gram - DMatrix::identity(count, count)).amax();
        // 1e-14 is the rounding of the products themselves.
        if round == 2 || defect < 1e-14 {
            return defect;
        }
        worst = defect;
        let Some(factor) = gram.cholesky() else { break };
        let Some(inverse) = factor.l().transpose().solve_upper_triangular(&DMatrix::identity(count, count)) else {
            break;
        };
        *shapes = &*shapes * inverse;
    }
    worst
}

/// Counts the eigenvalues below a μ placed between the last mode returned and the next one.
/// Returns the proof and warnings.
pub(super) fn complete(fe: &FeModel, pairs: &Pairs, count: usize) -> (Completeness, Vec<String>) {
    let last = pairs.lambda[count - 1].max(0.0);
    let next = pairs.lambda.get(count).copied().or(pairs.next);
    let mut warnings = Vec::new();
    let above = match next {
        Some(next) if next - last > CLUSTER * next.abs() => 0.5 * (last + next),
        Some(_) => {
            warnings.push(format!(
                "mode {} and the next lie within {CLUSTER:e} of each other; the set may split a cluster, and its completeness cannot be proved",
                count
            ));
            return (Completeness { proved: false, count, below: last.sqrt() }, warnings);
        }
        None => 2.0 * last + pairs.shift.abs(),
    };
    match ShiftedFactor::inertia(&pairs.analysis, &fe.stiffness, &fe.mass, above) {
        Ok(inertia) => {
            let proved = inertia.negative == count && inertia.growth < GROWTH;
            if inertia.negative != count {
                warnings.push(format!(
                    "{} modes were found below {:.6e} rad/s, but the inertia of K − μM counts {}",
                    count,
                    above.sqrt(),
                    inertia.negative
                ));
            } else if !proved {
                warnings.push(format!("the inertia count is not trusted: growth {:.1e} in the factor", inertia.growth));
            }
            (Completeness { proved, count: inertia.negative, below: above.sqrt() }, warnings)
        }
        Err(error) => {
            warnings.push(format!("completeness could not be proved: {error}"));
            (Completeness { proved: false, count, below: last.sqrt() }, warnings)
        }
    }
}
