//! Eigenpairs of a small dense symmetric matrix of any scale.

use faer::{Mat, Side};

/// θ ascending and orthonormal S with A S = S Θ to rounding of ‖A‖; `None` for NaN or infinity.
///
/// A is scaled to a largest entry between one and two first, by a power of two, so without
/// rounding. faer's divide-and-conquer deflates below 8ε·max(‖D‖, ‖z‖) with z part of a unit vector
/// (Gu & Eisenstat 1995; LAPACK's dlaed2, whose caller dstedc scales for this reason): on a matrix
/// of θ = 1/(ω² − σ) ≈ 10⁻⁹ that is 10⁻⁷ of ‖A‖ instead of ε, and eigenvectors mix although the
/// residual estimates made from their last rows are small.
pub(super) fn symmetric_eigen(a: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let n = a.nrows();
    let mut largest = 0.0f64;
    for j in 0..n {
        for i in j..n {
            let entry = a[(i, j)];
            if !entry.is_finite() {
                return None;
            }
            largest = largest.max(entry.abs());
        }
    }
    // Kept away from the ends of the exponent range, so that the scale and its inverse are normal.
    let scale = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 };
    let inverse = 1.0 / scale;
    let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * inverse);
    let eigen = scaled.self_adjoint_eigen(Side::Lower).ok()?;
    let values = eigen.S().column_vector().iter().map(|v| v * scale).collect();
    Some((values, eigen.U().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Like a projected operator: θ from 5·10⁻⁹ down to 5·10⁻¹⁵, turned by reflections.
    fn graded(n: usize, size: f64) -> Mat<f64> {
        let mut a = Mat::from_fn(n, n, |i, j| if i == j { size * 0.95f64.powi(i as i32) } else { 0.0 });
        for turn in 1..4 {
            let raw: Vec<f64> = (0..n).map(|i| ((i * i * turn + 7 * i) as f64).sin()).collect();
            let square: f64 = raw.iter().map(|x| x * x).sum();
            let reflect = Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - 2.0 * raw[i] * raw[j] / square);
            a = &reflect * &a * &reflect;
        }
        Mat::from_fn(n, n, |i, j| 0.5 * (a[(i, j)] + a[(j, i)]))
    }

    #[test]
    fn residual_is_rounding_of_the_norm_at_any_scale() {
        for size in [5e-9, 1.0, 3e12] {
            let a = graded(272, size);
            let (values, vectors) = symmetric_eigen(&a).expect("finite");
            let product = &a * &vectors;
            let mut worst = 0.0f64;
            for c in 0..a.ncols() {
                for r in 0..a.nrows() {
                    worst = worst.max((product[(r, c)] - values[c] * vectors[(r, c)]).abs());
                }
            }
            // 272 sums of rounding 1.1e-16.
            assert!(worst <= 1e-13 * size, "{worst:e} at size {size:e}");
        }
    }

    #[test]
    fn not_a_number_is_told() {
        assert!(symmetric_eigen(&Mat::from_fn(2, 2, |_, _| f64::NAN)).is_none());
        assert_eq!(symmetric_eigen(&Mat::zeros(2, 2)).map(|e| e.0), Some(vec![0.0; 2]));
    }
}
