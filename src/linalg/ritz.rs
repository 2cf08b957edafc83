//! The projected problem of the Lanczos iteration and its Ritz pairs.

use super::basis::Step;
use super::symmetric::symmetric_eigen;
use faer::Mat;

/// T = Vᵀ M (K − σM)⁻¹ M V of the finished blocks, dense and symmetric.
pub(super) struct Projected {
    t: Vec<Vec<f64>>,
}

/// Ritz pairs, λ ascending.
pub(super) struct Ritz {
    /// σ + 1/θ; pairs with θ ≤ 0 to rounding (infinite λ) are left out.
    pub(super) lambda: Vec<f64>,
    /// θ of each pair.
    pub(super) theta: Vec<f64>,
    /// Column of `vectors` of each pair.
    pub(super) column: Vec<usize>,
    /// Eigenvectors of T, dims×dims.
    pub(super) vectors: Mat<f64>,
    /// B s: the coupling of each pair to the next block.
    pub(super) coupling: Vec<Vec<f64>>,
    /// ‖B s‖ / θ · (λ − σ)/|λ|: the residual ‖Kφ − λMφ‖/‖Kφ‖ after purification.
    pub(super) estimate: Vec<f64>,
}

impl Projected {
    pub(super) fn new() -> Self {
        Self { t: Vec::new() }
    }

    /// Rows of T.
    pub(super) fn order(&self) -> usize {
        self.t.len()
    }

    /// T[row of block `j`, column of block `i`] as a P×P matrix, zero outside what is known.
    pub(super) fn block<const P: usize>(&self, i: usize, j: usize) -> [[f64; P]; P] {
        let at = |r: usize, c: usize| self.t.get(r).and_then(|row| row.get(c)).copied().unwrap_or(0.0);
        std::array::from_fn(|r| std::array::from_fn(|c| at(i * P + r, j * P + c)))
    }

    /// Enters the diagonal block of a finished step.
    pub(super) fn close<const P: usize>(&mut self, step: &Step<P>) {
        let dims = (step.index + 1) * P;
        self.grow(dims);
        for r in 0..P {
            for c in 0..P {
                self.t[dims - P + r][dims - P + c] = 0.5 * (step.diagonal[r][c] + step.diagonal[c][r]);
            }
        }
    }

    /// Couples block `index + 1` to block `index` by B.
    pub(super) fn couple<const P: usize>(&mut self, step: &Step<P>) {
        let dims = (step.index + 2) * P;
        self.grow(dims);
        for r in 0..P {
            for c in 0..P {
                let (row, col) = (dims - P + r, dims - 2 * P + c);
                self.t[row][col] = step.next[r][c];
                self.t[col][row] = step.next[r][c];
            }
        }
    }

    fn grow(&mut self, dims: usize) {
        for row in &mut self.t {
            row.resize(dims, 0.0);
        }
        while self.t.len() < dims {
            self.t.push(vec![0.0; dims]);
        }
    }

    /// Eigenpairs of T with their residuals for the step's B.
    pub(super) fn ritz<const P: usize>(&self, shift: f64, step: &Step<P>) -> Ritz {
        let dims = self.order();
        let t = Mat::from_fn(dims, dims, |r, c| self.t[r][c]);
        // Only NaN gives none; it is reported as nothing converged.
        let (values, vectors) = symmetric_eigen(&t).unwrap_or_else(|| (vec![0.0; dims], Mat::zeros(dims, dims)));
        let largest = values.iter().fold(0.0f64, |m: f64, v: &f64| m.max(v.abs()));
        let mut ritz = Ritz {
            lambda: Vec::new(),
            theta: Vec::new(),
            column: Vec::new(),
            vectors,
            coupling: Vec::new(),
            estimate: Vec::new(),
        };
        for c in (0..dims).rev() {
            let theta: f64 = values[c];
            // Rounding of T leaves infinite eigenvalues (θ = 0) at this size.
            if theta <= 1e-15 * largest {
                continue;
            }
            let lambda = shift + 1.0 / theta;
            let coupling: Vec<f64> =
                (0..P).map(|r| (0..P).map(|q| step.next[r][q] * ritz.vectors[(dims - P + q, c)]).sum()).collect();
            let norm = coupling.iter().map(|x| x * x).sum::<f64>().sqrt();
            // Rigid modes have λ ≈ 0: their residual is measured against σ, the size of the first elastic λ.
            let against = lambda.abs().max(shift.abs()).max(f64::MIN_POSITIVE);
            ritz.estimate.push(norm / theta * (lambda - shift) / against);
            ritz.lambda.push(lambda);
            ritz.theta.push(theta);
            ritz.column.push(c);
            ritz.coupling.push(coupling);
        }
        ritz
    }

    /// T after a thick restart: the kept θ on the diagonal; the next block is coupled to all of them.
    pub(super) fn restarted<const P: usize>(ritz: &Ritz, keep: usize) -> Self {
        let mut projected = Self::new();
        projected.grow(keep + P);
        for k in 0..keep.min(ritz.theta.len()) {
            projected.t[k][k] = ritz.theta[k];
            for r in 0..P {
                projected.t[keep + r][k] = ritz.coupling[k][r];
                projected.t[k][keep + r] = ritz.coupling[k][r];
            }
        }
        projected
    }
}

/// Ritz values closer than this, relative, are taken for one cluster.
const CLUSTER: f64 = 1e-6;

impl Ritz {
    /// `wanted`, and up to `more` pairs after it that belong to the same cluster.
    pub(super) fn whole(&self, wanted: usize, more: usize) -> usize {
        let close = |k: usize| match (self.lambda.get(k - 1), self.lambda.get(k)) {
            (Some(a), Some(b)) => b - a <= CLUSTER * b.abs(),
            _ => false,
        };
        (wanted..wanted + more).take_while(|&k| k > 0 && close(k)).last().map_or(wanted, |k| k + 1)
    }

    /// How many of the first `wanted` pairs are below the tolerance, counted from the lowest.
    pub(super) fn converged(&self, wanted: usize, tolerance: f64) -> usize {
        self.estimate.iter().take(wanted).take_while(|&&e| e <= tolerance).count()
    }

    /// Half width of an interval around λ that holds an eigenvalue: |δθ| ≤ ‖B s‖.
    pub(super) fn uncertainty(&self, k: usize) -> f64 {
        let norm = self.coupling[k].iter().map(|x| x * x).sum::<f64>().sqrt();
        norm / (self.theta[k] * self.theta[k])
    }
}
