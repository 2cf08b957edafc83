//! Refinement of eigenpairs, residuals, and the proof that none is missing.

use super::pairs::Pairs;
use crate::linalg::{ShiftedFactor, SymSparse};
use crate::model::{Completeness, FeModel};
use nalgebra::DMatrix;

/// Residual above which a mode gets a step of refinement.
const REFINE_ABOVE: f64 = 1e-9;
/// Stored entries of K up to which every product is made in twice the precision: it costs nothing.
const SMALL: usize = 2_000_000;
/// Two ω² closer than this, relative, are one cluster: no shift between them could be trusted.
pub(super) const CLUSTER: f64 = 1e-6;
/// Distance of μ above the last ω², relative: near enough that an estimate of the next one, which
/// may be too high, does not let it slip below; far enough for rounding.
const NEAR: f64 = 1e-4;
/// Largest |entry of L| with which an inertia count is believed: rounding is multiplied by its
/// square at worst, and μ stands further from every ω² than 10⁻⁷ of it.
const GROWTH: f64 = 1e6;

/// Kφ and Mφ of some vectors. Kφ is summed in twice the working precision where plain summation
/// would show in the residual (above a tenth of what is asked), or everywhere on small models.
pub(super) fn products(k: &SymSparse, m: &SymSparse, vectors: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let heavy = m.mul_block(vectors);
    if k.stored() < SMALL {
        return (k.mul_block_compensated(vectors), heavy);
    }
    let mut stiff = k.mul_block(vectors);
    let chosen: Vec<usize> = (0..vectors.ncols())
        .filter(|&c| {
            let lambda = vectors.column(c).dot(&stiff.column(c)) / vectors.column(c).dot(&heavy.column(c));
            (stiff.column(c) - heavy.column(c) * lambda).norm() > 0.1 * REFINE_ABOVE * stiff.column(c).norm()
        })
        .collect();
    if !chosen.is_empty() {
        let exact = k.mul_block_compensated(&vectors.select_columns(&chosen));
        for (at, &c) in chosen.iter().enumerate() {
            stiff.set_column(c, &exact.column(at));
        }
    }
    (stiff, heavy)
}

/// Turns the elastic vectors so that ΦᵀKΦ is diagonal (Rayleigh–Ritz): the projected operator of
/// the iteration carries the rounding of its largest θ, which mixes close modes of small θ.
fn separate(k: &SymSparse, m: &SymSparse, pairs: &mut Pairs, first: usize) {
    let count = pairs.lambda.len() - first;
    if count < 2 {
        return;
    }
    let vectors = pairs.vectors.columns(first, count).into_owned();
    let stiff = vectors.transpose() * k.mul_block(&vectors);
    let Some(gram) = (vectors.transpose() * m.mul_block(&vectors)).cholesky() else { return };
    let Some(inner) = gram.l().solve_lower_triangular(&stiff) else { return };
    let Some(inner) = gram.l().solve_lower_triangular(&inner.transpose()) else { return };
    let eigen = ((&inner + inner.transpose()) * 0.5).symmetric_eigen();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let turn = eigen.eigenvectors.select_columns(&order);
    let Some(turn) = gram.l().transpose().solve_upper_triangular(&turn) else { return };
    pairs.vectors.columns_mut(first, count).copy_from(&(vectors * turn));
}

/// Two steps of inverse iteration with the residual in twice the working precision,
/// φ ← φ − (K − σM)⁻¹(Kφ − λMφ), for the modes that need it; λ by Rayleigh quotients. Returns how
/// many modes were refined.
pub(super) fn refine(fe: &FeModel, pairs: &mut Pairs, first: usize) -> usize {
    let (k, m) = (&fe.stiffness, &fe.mass);
    let mut columns: Vec<usize> = (first..pairs.lambda.len()).collect();
    let mut refined = 0;
    separate(k, m, pairs, first);
    for round in 0..3 {
        let vectors = pairs.vectors.select_columns(&columns);
        let (stiff, heavy) = products(k, m, &vectors);
        let mut chosen = Vec::new();
        for (at, &c) in columns.iter().enumerate() {
            let lambda = vectors.column(at).dot(&stiff.column(at)) / vectors.column(at).dot(&heavy.column(at));
            pairs.lambda[c] = lambda;
            let residual = stiff.column(at) - heavy.column(at) * lambda;
            if residual.norm() > REFINE_ABOVE * stiff.column(at).norm() {
                chosen.push((c, residual));
            }
        }
        if round == 0 {
            refined = chosen.len();
        }
        let Some(factor) = pairs.factor.as_ref().filter(|_| !chosen.is_empty() && round < 2) else { break };
        let mut correction = DMatrix::from_columns(&chosen.iter().map(|c| c.1.clone()).collect::<Vec<_>>());
        factor.solve_in_place(&mut correction);
        for (at, (c, _)) in chosen.iter().enumerate() {
            let mut column = pairs.vectors.column_mut(*c);
            column -= correction.column(at);
        }
        columns = chosen.into_iter().map(|c| c.0).collect();
    }
    refined
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
        Some(next) if next - last > CLUSTER * next.abs() => {
            last + (0.5 * (next - last)).min(NEAR * last.max(pairs.shift.abs()))
        }
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
