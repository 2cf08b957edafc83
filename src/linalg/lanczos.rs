//! Shift-invert block Lanczos with thick restart.

use super::SymSparse;
use super::basis::{Basis, Step};
use super::factor::ShiftedFactor;
use super::ritz::{Projected, Ritz};
use super::row_sparse::RowSparse;
use nalgebra::DMatrix;

/// Vectors worked on together: eight doubles fill a cache line and an AVX-512 register, and eight
/// right-hand sides cost about as much to solve as two single ones.
const P: usize = 8;

/// Residual of the inverted problem that is enough to see an eigenvalue: its square is the error.
const SEEN: f64 = 1e-3;

/// What is asked of the iteration.
#[derive(Clone, Copy, Debug)]
pub struct LanczosOptions {
    /// Eigenvalues wanted, counted from the lowest above σ.
    pub wanted: usize,
    /// Eigenvalues after those that need only be seen (to 10⁻³ of the inverted problem), so that
    /// the gap above the wanted ones is known; they are returned when they have converged too.
    pub seen: usize,
    /// Basis vectors held at most; rounded to whole blocks, and never less than `wanted` and four blocks.
    pub basis: usize,
    /// ‖residual‖ / θ at which a Ritz pair of the inverted problem counts as converged.
    pub tolerance: f64,
    /// Restarts after which it gives up.
    pub restarts: usize,
}

/// Where the iteration stands.
#[derive(Clone, Copy, Debug)]
pub struct LanczosStatus<'a> {
    /// Block steps done.
    pub steps: usize,
    /// Pairs converged of those wanted.
    pub converged: usize,
    /// Ritz values λ, ascending; upper bounds in exact arithmetic. Empty between checks.
    pub lambda: &'a [f64],
    /// Half width of an interval around each that holds an eigenvalue.
    pub uncertainty: &'a [f64],
}

/// Eigenpairs of K φ = λ M φ next above σ.
#[derive(Clone, Debug)]
pub struct EigenPairs {
    /// λ, ascending.
    pub lambda: Vec<f64>,
    /// M-orthonormal vectors, n×m, rows in the order of K.
    pub vectors: DMatrix<f64>,
    /// Estimated ‖Kφ − λMφ‖ / ‖Kφ‖ of each pair.
    pub estimate: Vec<f64>,
    /// The first Ritz value not returned and its uncertainty; `None` when the space is exhausted.
    pub next: Option<(f64, f64)>,
    /// True when every wanted pair met the tolerance.
    pub converged: bool,
    /// Solves with the factor, counted in single vectors.
    pub solves: usize,
    /// Thick restarts.
    pub restarts: usize,
    /// Largest number of basis vectors held.
    pub basis: usize,
    /// Bytes held at the peak besides the factor.
    pub bytes: usize,
}

/// The eigenvalues λ of K φ = λ M φ next above σ, as θ = 1/(λ − σ) of (K − σM)⁻¹ M, by block
/// Lanczos with full reorthogonalisation in the M inner product (Grimes, Lewis & Simon 1994) and
/// thick restart (Wu & Simon 2000). M may be singular: the start vector and every restart vector
/// pass through the operator, and the returned vectors are Vs + Q B s/θ, which is one more
/// application of it (Ericsson & Ruhe 1980; Nour-Omid, Parlett, Ericsson & Jensen 1987).
///
/// Deterministic: the start block is a fixed pseudo-random sequence. `watch` sees every step and
/// stops the iteration by returning false (`None` is returned then).
pub fn lanczos(
    factor: &ShiftedFactor,
    mass: &SymSparse,
    options: LanczosOptions,
    watch: &mut dyn FnMut(LanczosStatus<'_>) -> bool,
) -> Option<EigenPairs> {
    let mass = RowSparse::permuted(mass, &factor.analysis().inverse);
    let n = factor.analysis().order();
    // Twice the wanted number needs a restart only seldom; four blocks more let the kept ones grow.
    let blocks = options.basis.max(options.wanted + 4 * P).div_ceil(P);
    let mut basis = Basis::<P>::start(factor, &mass);
    let mut projected = Projected::new();
    let (mut steps, mut restarts) = (0, 0);
    let mut largest = 0;
    loop {
        let step = basis.step(&projected);
        steps += 1;
        projected.close(&step);
        largest = largest.max(basis.vectors());
        let exhausted = step.rank == 0;
        let dims = projected.order();
        let full = basis.blocks() >= blocks;
        let mut pairs = None;
        if exhausted || full || dims >= options.wanted || steps == 3 || steps == 5 {
            let ritz = projected.ritz(factor.shift(), &step);
            let wanted = ritz.whole(options.wanted, options.seen);
            let good = ritz.converged(wanted, options.tolerance);
            let seen = ritz.converged(options.wanted + options.seen, SEEN.max(options.tolerance));
            let uncertainty: Vec<f64> = (0..ritz.lambda.len()).map(|k| ritz.uncertainty(k)).collect();
            let go_on =
                watch(LanczosStatus { steps, converged: good, lambda: &ritz.lambda, uncertainty: &uncertainty });
            if !go_on {
                return None;
            }
            if exhausted || (good >= wanted && seen >= (options.wanted + options.seen).min(ritz.lambda.len())) {
                pairs = Some((ritz, true));
            } else if full && restarts == options.restarts {
                pairs = Some((ritz, false));
            } else if full {
                restarts += 1;
                // A third of the room above the wanted ones keeps what has been learnt of the next.
                let keep = (options.wanted + (blocks * P - options.wanted) / 3).min((blocks - 2) * P) / P * P;
                basis.restart(&ritz, keep);
                projected = Projected::restarted::<P>(&ritz, keep);
                basis.advance(step);
                continue;
            }
        } else if !watch(LanczosStatus { steps, converged: 0, lambda: &[], uncertainty: &[] }) {
            return None;
        }
        if let Some((ritz, converged)) = pairs {
            return Some(finish(
                &basis,
                &ritz,
                &step,
                &options,
                Tally { n, steps, restarts, largest, converged },
                &mass,
            ));
        }
        projected.couple(&step);
        basis.advance(step);
    }
}

struct Tally {
    n: usize,
    steps: usize,
    restarts: usize,
    largest: usize,
    converged: bool,
}

fn finish(
    basis: &Basis<'_, P>,
    ritz: &Ritz,
    step: &Step<P>,
    options: &LanczosOptions,
    tally: Tally,
    mass: &RowSparse,
) -> EigenPairs {
    let seen = ritz.converged(options.wanted + options.seen, options.tolerance);
    let count = options.wanted.max(seen).min(ritz.lambda.len());
    let vectors = basis.vectors_of(ritz, count, step);
    EigenPairs {
        lambda: ritz.lambda[..count].to_vec(),
        vectors,
        estimate: ritz.estimate[..count].to_vec(),
        next: ritz.lambda.get(count).map(|&l| (l, ritz.uncertainty(count))),
        converged: tally.converged,
        solves: (tally.steps + 1) * P,
        restarts: tally.restarts,
        basis: tally.largest,
        bytes: (tally.largest + 6 * P) * tally.n * 8 + mass.bytes(),
    }
}
