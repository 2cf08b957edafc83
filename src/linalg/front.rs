//! Dense partial factorisation of one front.

use super::FactorError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::{lblt, llt};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::prelude::*;
use faer::{Accum, Auto, MatMut, Par, Spec};

/// How pivots are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pivoting {
    /// L Lᵀ: every pivot must be positive.
    Definite,
    /// P L B Lᵀ Pᵀ with 1×1 and 2×2 pivots (Bunch & Kaufman 1977), chosen inside each front.
    Indefinite,
}

/// The pivots of one front's columns; all slices as long as the front is wide.
pub(super) struct Pivots<'a> {
    /// Diagonal of B.
    pub(super) diagonal: &'a mut [f64],
    /// Subdiagonal of B; nonzero at the first column of a 2×2 pivot.
    pub(super) off: &'a mut [f64],
    /// Which of the front's columns each pivot was.
    pub(super) from: &'a mut [u32],
}

/// What a front leaves besides its panel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrontOutcome {
    /// Negative pivots.
    pub(super) negative: usize,
    /// Largest |pivot block entry| or update, as a measure of growth.
    pub(super) largest: f64,
}

/// Scratch reused from front to front.
#[derive(Default)]
pub(super) struct Scratch {
    product: Vec<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
}

/// Eliminates the first `width` columns of a front given as a panel (height×width, column-major,
/// lower part) and writes the update −L₂₁ B L₂₁ᵀ into the lower triangle of `update`
/// ((height − width)², column-major), overwriting it. The panel becomes [L₁₁; L₂₁].
///
/// # Errors
/// [`FactorError::NotDefinite`] for a pivot ≤ 0 when `Definite`, [`FactorError::Singular`] for a
/// zero pivot block; the column is counted from the front's first.
pub(super) fn eliminate(
    panel: &mut [f64],
    width: usize,
    update: &mut [f64],
    pivoting: Pivoting,
    pivots: &mut Pivots<'_>,
    scratch: &mut Scratch,
    par: Par,
) -> Result<FrontOutcome, FactorError> {
    let height = panel.len() / width;
    let under = height - width;
    let front = MatMut::from_column_major_slice_mut(panel, height, width);
    let (mut pivot, mut lower) = front.split_at_row_mut(width);
    let update = MatMut::from_column_major_slice_mut(update, under, under);
    let mut outcome = FrontOutcome::default();
    match pivoting {
        Pivoting::Definite => {
            let params: Spec<llt::factor::LltParams, f64> = Spec::new(Auto::<f64>::auto());
            let mut memory = MemBuffer::new(llt::factor::cholesky_in_place_scratch::<f64>(width, par, params));
            llt::factor::cholesky_in_place(pivot.rb_mut(), Default::default(), par, MemStack::new(&mut memory), params)
                .map_err(|llt::factor::LltError::NonPositivePivot { index }| FactorError::NotDefinite { row: index })?;
            if under > 0 {
                solve_lower_triangular_in_place(pivot.rb(), lower.rb_mut().transpose_mut(), par);
                matmul(
                    update,
                    BlockStructure::TriangularLower,
                    Accum::Replace,
                    lower.rb(),
                    BlockStructure::Rectangular,
                    lower.rb().transpose(),
                    BlockStructure::Rectangular,
                    -1.0,
                    par,
                );
            }
        }
        Pivoting::Indefinite => {
            outcome = bunch_kaufman_block(pivot.rb_mut(), pivots, scratch, par)?;
            if under > 0 {
                permute_columns(&mut lower, pivots.from, &mut scratch.product);
                solve_unit_lower_triangular_in_place(pivot.rb(), lower.rb_mut().transpose_mut(), par);
                // W = L₂₁ B is kept beside L₂₁ for the update L₂₁ B L₂₁ᵀ = L₂₁ Wᵀ.
                scratch.product.resize((under * width).max(scratch.product.len()), 0.0);
                let product = &mut scratch.product[..under * width];
                for c in 0..width {
                    product[c * under..(c + 1) * under]
                        .iter_mut()
                        .zip(lower.rb().col(c).iter())
                        .for_each(|(w, &l)| *w = l);
                }
                divide_by_pivots(&mut lower, pivots);
                let product = MatMut::from_column_major_slice_mut(product, under, width);
                matmul(
                    update,
                    BlockStructure::TriangularLower,
                    Accum::Replace,
                    lower.rb(),
                    BlockStructure::Rectangular,
                    product.rb().transpose(),
                    BlockStructure::Rectangular,
                    -1.0,
                    par,
                );
                for c in 0..width {
                    let grown = lower.rb().col(c).iter().fold(0.0f64, |g, &l| g.max(l.abs()));
                    outcome.largest = outcome.largest.max(grown);
                }
            }
        }
    }
    Ok(outcome)
}

/// Factors the pivot block and counts the negative eigenvalues of B.
fn bunch_kaufman_block(
    mut block: MatMut<'_, f64>,
    pivots: &mut Pivots<'_>,
    scratch: &mut Scratch,
    par: Par,
) -> Result<FrontOutcome, FactorError> {
    let width = block.nrows();
    scratch.forward.resize(width, 0);
    scratch.backward.resize(width, 0);
    let params: Spec<lblt::factor::LbltParams, f64> = Spec::new(Auto::<f64>::auto());
    let request = lblt::factor::cholesky_in_place_scratch::<usize, f64>(width, par, params);
    let mut memory = MemBuffer::new(request);
    let mut sub = faer::diag::Diag::<f64>::zeros(width);
    lblt::factor::cholesky_in_place(
        block.rb_mut(),
        sub.as_mut(),
        &mut scratch.forward[..width],
        &mut scratch.backward[..width],
        par,
        MemStack::new(&mut memory),
        params,
    );
    let mut outcome = FrontOutcome::default();
    let mut c = 0;
    while c < width {
        let (a, b) = (block[(c, c)], sub[c]);
        pivots.from[c] = scratch.forward[c] as u32;
        pivots.diagonal[c] = a;
        pivots.off[c] = b;
        if b == 0.0 || c + 1 == width {
            if a == 0.0 || !a.is_finite() {
                return Err(FactorError::Singular { row: scratch.forward[c] });
            }
            outcome.negative += usize::from(a < 0.0);
            c += 1;
        } else {
            let d = block[(c + 1, c + 1)];
            let determinant = a * d - b * b;
            if determinant == 0.0 || !determinant.is_finite() {
                return Err(FactorError::Singular { row: scratch.forward[c] });
            }
            // Opposite signs when the determinant is negative, else both of the trace's sign.
            outcome.negative += if determinant < 0.0 { 1 } else { 2 * usize::from(a + d < 0.0) };
            pivots.from[c + 1] = scratch.forward[c + 1] as u32;
            pivots.diagonal[c + 1] = d;
            pivots.off[c + 1] = 0.0;
            c += 2;
        }
    }
    Ok(outcome)
}

/// Brings the columns of L₂₁ into pivot order.
fn permute_columns(lower: &mut MatMut<'_, f64>, from: &[u32], buffer: &mut Vec<f64>) {
    if from.iter().enumerate().all(|(c, &f)| c == f as usize) {
        return;
    }
    let (rows, width) = (lower.nrows(), lower.ncols());
    buffer.resize((rows * width).max(buffer.len()), 0.0);
    for c in 0..width {
        let column = &mut buffer[c * rows..(c + 1) * rows];
        column.iter_mut().zip(lower.as_ref().col(c).iter()).for_each(|(b, &l)| *b = l);
    }
    for (c, &f) in from.iter().enumerate() {
        let source = &buffer[f as usize * rows..(f as usize + 1) * rows];
        lower.rb_mut().col_mut(c).iter_mut().zip(source).for_each(|(l, &b)| *l = b);
    }
}

/// L₂₁ = W B⁻¹, one pivot at a time.
fn divide_by_pivots(lower: &mut MatMut<'_, f64>, pivots: &Pivots<'_>) {
    let width = lower.ncols();
    let mut c = 0;
    while c < width {
        let (a, b) = (pivots.diagonal[c], pivots.off[c]);
        if b == 0.0 {
            lower.rb_mut().col_mut(c).iter_mut().for_each(|l| *l /= a);
            c += 1;
        } else {
            let d = pivots.diagonal[c + 1];
            // Scaled by b so that neither product overflows nor cancels early.
            let (p, q) = (a / b, d / b);
            let scale = 1.0 / (b * (p * q - 1.0));
            let (left, right) = lower.rb_mut().split_at_col_mut(c + 1);
            let first = left.col_mut(c);
            let second = right.col_mut(0);
            for (x, y) in first.iter_mut().zip(second.iter_mut()) {
                let (u, v) = (*x, *y);
                *x = (q * u - v) * scale;
                *y = (p * v - u) * scale;
            }
            c += 2;
        }
    }
}
