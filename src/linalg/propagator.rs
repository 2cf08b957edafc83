//! Exact propagation of linear systems over a step, inputs varying linearly in it.

use nalgebra::DMatrix;

/// ẋ = A x + B u over a step h with u linear from u₀ to u₁ (first-order hold):
/// x₁ = E x₀ + G₀ u₀ + G₁ u₁, exact (Franklin, Powell, Workman, Digital Control of Dynamic Systems,
/// 3rd ed., sec. 6.3.2).
#[derive(Clone, Debug)]
pub struct Propagator {
    /// e^{Ah}, n×n.
    pub transition: DMatrix<f64>,
    /// G₀, n×p.
    pub start: DMatrix<f64>,
    /// G₁, n×p.
    pub end: DMatrix<f64>,
}

impl Propagator {
    /// A is n×n in 1/s, B n×p, h in s. Scale the states so that A has entries of the size of the
    /// frequencies: the exponential then loses no digits to squaring.
    pub fn first_order_hold(a: &DMatrix<f64>, b: &DMatrix<f64>, h: f64) -> Self {
        let (n, p) = b.shape();
        let mut augmented = DMatrix::zeros(n + 2 * p, n + 2 * p);
        augmented.view_mut((0, 0), (n, n)).copy_from(&(a * h));
        augmented.view_mut((0, n), (n, p)).copy_from(&(b * h));
        augmented.view_mut((n, n + p), (p, p)).fill_with_identity();
        let exponential = augmented.exp();
        let whole = exponential.view((0, n), (n, p));
        let ramp = exponential.view((0, n + p), (n, p)).into_owned();
        Self { transition: exponential.view((0, 0), (n, n)).into_owned(), start: whole - &ramp, end: ramp }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DVector, dmatrix, dvector};

    /// An oscillator under a force ramp: w(t) = w₀cos ωt + (v₀ − r/ω²)/ω·sin ωt + (f₀ + r t)/ω² with
    /// w₀ measured from f₀/ω².
    #[test]
    fn oscillator_under_a_ramp_is_exact_at_any_step() {
        let omega = 3849.0_f64;
        for h in [1e-5, 1e-3, 1e-1] {
            let a = dmatrix![0.0, omega; -omega, 0.0];
            let b = dmatrix![0.0; 1.0];
            let p = Propagator::first_order_hold(&a, &b, h);
            let (f0, f1, w0, v0) = (2.0, 5.0, 1e-6, 0.3);
            let x = &p.transition * dvector![omega * w0, v0]
                + &p.start * DVector::from_element(1, f0)
                + &p.end * DVector::from_element(1, f1);
            let rate = (f1 - f0) / h;
            let square = omega * omega;
            let (c, s) = ((omega * h).cos(), (omega * h).sin());
            let w = (w0 - f0 / square) * c + (v0 - rate / square) / omega * s + f1 / square;
            let v = -(w0 - f0 / square) * omega * s + (v0 - rate / square) * c + rate / square;
            // The phase ωh carries ωh·ε; a few hundred operations on top.
            let bound = 1e-14 * (10.0 + omega * h) * (v0 + f1 / omega);
            assert!((x[0] - omega * w).abs() < bound && (x[1] - v).abs() < bound, "h = {h}");
        }
    }
}
