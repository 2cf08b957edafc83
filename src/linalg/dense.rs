//! All eigenpairs of a small pencil.

use super::symmetric::symmetric_eigen;
use super::{FactorError, SymSparse};
use faer::linalg::solvers::Llt;
use faer::{Mat, Side};
use nalgebra::DMatrix;

/// Why a small pencil has no complete solution.
pub type DenseError = FactorError;

/// Share of the largest eigenvalue of the scaled mass matrix below which a direction has no mass:
/// rounding of n ≤ 1000 sums stays below it, and no real distribution of mass comes near it.
const MASSLESS: f64 = 1e-12;

/// All finite eigenvalues of K φ = λ M φ, ascending, and M-orthonormal vectors, n×r with r the
/// rank of M, by Cholesky of K − σM = L Lᵀ and the eigenvalues θ = 1/(λ − σ) of L⁻¹ M L⁻ᵀ
/// (Golub & Van Loan, sec. 8.7, with the roles of the matrices exchanged so that the lowest λ are
/// the most accurate and M may be singular). σ must lie below every eigenvalue.
///
/// # Errors
/// [`FactorError::NotDefinite`] when K − σM is not positive definite.
pub fn dense_pencil(k: &SymSparse, m: &SymSparse, shift: f64) -> Result<(Vec<f64>, DMatrix<f64>), DenseError> {
    let n = k.order();
    if m.order() != n {
        return Err(FactorError::OrderMismatch { stiffness: n, mass: m.order() });
    }
    let mass = full(m);
    let stiffness = full(k);
    let shifted = Mat::from_fn(n, n, |i, j| stiffness[(i, j)] - shift * mass[(i, j)]);
    let factor = Llt::new(shifted.as_ref(), Side::Lower).map_err(|_| FactorError::NotDefinite { row: 0 })?;
    let mut inner = mass.clone();
    factor.L().solve_lower_triangular_in_place(inner.as_mut());
    let mut inner = inner.transpose().to_owned();
    factor.L().solve_lower_triangular_in_place(inner.as_mut());
    let (values, turned) = symmetric_eigen(&inner).ok_or(FactorError::Singular { row: 0 })?;
    let rank = mass_rank(&mass);
    let mut vectors = Mat::from_fn(n, rank, |i, c| turned[(i, n - 1 - c)]);
    factor.L().transpose().solve_upper_triangular_in_place(vectors.as_mut());
    let mut lambda = Vec::with_capacity(rank);
    let mut columns = Vec::with_capacity(rank);
    for c in 0..rank {
        let theta = values[n - 1 - c];
        if theta > 0.0 {
            lambda.push(shift + 1.0 / theta);
            columns.push((c, 1.0 / theta.sqrt()));
        }
    }
    let vectors = DMatrix::from_fn(n, columns.len(), |i, c| vectors[(i, columns[c].0)] * columns[c].1);
    Ok((lambda, vectors))
}

fn full(a: &SymSparse) -> Mat<f64> {
    let mut dense = Mat::zeros(a.order(), a.order());
    for j in 0..a.order() {
        for (i, v) in a.column(j) {
            dense[(i, j)] = v;
            dense[(j, i)] = v;
        }
    }
    dense
}

/// Rank of M, with its diagonal scaled to one so that units do not matter.
fn mass_rank(mass: &Mat<f64>) -> usize {
    let n = mass.nrows();
    let scale: Vec<f64> = (0..n).map(|i| mass[(i, i)]).map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }).collect();
    let scaled = Mat::from_fn(n, n, |i, j| mass[(i, j)] * scale[i] * scale[j]);
    match scaled.self_adjoint_eigenvalues(Side::Lower) {
        Ok(values) => {
            let largest = values.iter().fold(0.0f64, |a, v| a.max(v.abs()));
            values.iter().filter(|&&v| v > MASSLESS * largest).count()
        }
        Err(_) => 0,
    }
}
