//! The M-orthonormal basis of the Lanczos iteration: one block step, restart, Ritz vectors.

use super::block::{Block, Small, gram, grams, subtract, transform};
use super::factor::ShiftedFactor;
use super::ritz::{Projected, Ritz};
use super::row_sparse::RowSparse;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Directions whose M-norm is below this share of the operator's norm are rounding, not new.
const DEAD: f64 = 1e-14;
/// Loss of orthogonality, relative to the vector, above which a second sweep is made: what is
/// left after the three-term recurrence is normally 1e-13.
const SECOND_SWEEP: f64 = 1e-12;

/// What one block step found.
pub(super) struct Step<const P: usize> {
    /// Index of the block it started from.
    pub(super) index: usize,
    /// QᵀM (K − σM)⁻¹ M Q.
    pub(super) diagonal: Small<P>,
    /// B with W = Q₊ B.
    pub(super) next: Small<P>,
    /// Directions of Q₊ that are not rounding.
    pub(super) rank: usize,
    q: Block<P>,
    mq: Block<P>,
}

/// V = [Q₀ Q₁ …], VᵀMV = I, in the row order of the factor.
pub(super) struct Basis<'a, const P: usize> {
    factor: &'a ShiftedFactor,
    mass: &'a RowSparse,
    blocks: Vec<Block<P>>,
    /// M times the last block.
    mq: Block<P>,
    /// ‖(K − σM)⁻¹M‖ seen so far.
    norm: f64,
    seed: u64,
}

impl<'a, const P: usize> Basis<'a, P> {
    /// A pseudo-random block, passed through the operator once so that it lies in its range.
    pub(super) fn start(factor: &'a ShiftedFactor, mass: &'a RowSparse) -> Self {
        let mut basis = Self { factor, mass, blocks: Vec::new(), mq: Vec::new(), norm: 0.0, seed: 1 };
        let (w, mw) = basis.random();
        let (q, mq, _, _) = basis.orthonormal(w, mw, 0.0);
        basis.blocks.push(q);
        basis.mq = mq;
        basis
    }

    pub(super) fn blocks(&self) -> usize {
        self.blocks.len()
    }

    pub(super) fn vectors(&self) -> usize {
        self.blocks.len() * P
    }

    fn views(&self) -> Vec<&[[f64; P]]> {
        self.blocks.iter().map(|b| b.as_slice()).collect()
    }

    /// W = (K − σM)⁻¹ M Q less its part in V, and its M-orthonormal factors.
    pub(super) fn step(&mut self, projected: &Projected) -> Step<P> {
        let index = self.blocks.len() - 1;
        let mut w = self.mq.clone();
        self.factor.solve_block(&mut w);
        let diagonal = gram(&self.mq, &w);
        for r in 0..P {
            self.norm = self.norm.max(diagonal[r][r].abs());
        }
        // Three-term recurrence; after a restart every kept block is coupled.
        let mut coupled: Vec<&[[f64; P]]> = Vec::new();
        let mut factors = Vec::new();
        for i in 0..index {
            let t = projected.block::<P>(i, index);
            if t.iter().flatten().any(|&x| x != 0.0) {
                coupled.push(&self.blocks[i]);
                factors.push(t);
            }
        }
        coupled.push(&self.blocks[index]);
        factors.push(diagonal);
        subtract(&mut w, &coupled, &factors);
        let mut mw = vec![[0.0; P]; w.len()];
        self.mass.mul(&w, &mut mw);
        self.sweep(&mut w, &mut mw);
        let (q, mq, next, rank) = self.orthonormal(w, mw, self.norm);
        Step { index, diagonal, next, rank, q, mq }
    }

    /// W −= V VᵀMW until nothing is left to remove.
    fn sweep(&self, w: &mut Block<P>, mw: &mut Block<P>) {
        let views = self.views();
        // Twice is enough (Kahan); the third sweep is only reached when W lies in V altogether.
        for _ in 0..3 {
            let h = grams(&views, mw);
            subtract(w, &views, &h);
            let size = gram(w, mw);
            let worst = (0..P).fold(0.0f64, |worst, q| {
                let length = size[q][q].abs().sqrt().max(DEAD * self.norm);
                let part = h.iter().map(|h| (0..P).map(|r| h[r][q] * h[r][q]).sum::<f64>()).sum::<f64>().sqrt();
                if length > 0.0 { worst.max(part / length) } else { worst }
            });
            // M W must follow W even for the smallest change: the next solve magnifies what is left of
            // the lowest modes by the ratio of the largest θ to the present ones.
            self.mass.mul(w, mw);
            if worst <= SECOND_SWEEP {
                return;
            }
        }
    }

    /// W = Q B with QᵀMQ = I, by the eigenvectors of WᵀMW (twice, which makes it orthonormal to
    /// rounding: Yamamoto et al. 2015). Directions below the noise are replaced by random ones
    /// with zero rows in B, so that multiple eigenvalues beyond the block size are still found; by
    /// zero vectors when the space is exhausted.
    fn orthonormal(&mut self, mut w: Block<P>, mut mw: Block<P>, norm: f64) -> (Block<P>, Block<P>, Small<P>, usize) {
        let floor = (DEAD * norm).powi(2);
        let (to_q, mut b, rank, condition) = whiten(&gram(&w, &mw), floor);
        transform(&mut w, &to_q);
        transform(&mut mw, &to_q);
        // Small directions were magnified together with their rounding.
        if condition > 1e6 || rank < P {
            self.mass.mul(&w, &mut mw);
            if !self.blocks.is_empty() {
                self.sweep(&mut w, &mut mw);
            }
        }
        let mut alive = rank;
        if rank < P && rank + self.vectors() < w.len() && !self.blocks.is_empty() {
            alive += self.refill(&mut w, &mut mw, rank);
        }
        let (again, b2, _, _) = whiten(&gram(&w, &mw), 0.25);
        transform(&mut w, &again);
        transform(&mut mw, &again);
        for row in rank..P {
            b[row] = [0.0; P];
        }
        b = product(&b2, &b);
        (w, mw, b, alive)
    }

    /// Puts random directions, M-orthogonal to V and to the first `rank` columns, in the others.
    fn refill(&mut self, w: &mut Block<P>, mw: &mut Block<P>, rank: usize) -> usize {
        let (mut fresh, mut mfresh) = self.random();
        let before = gram(&fresh, &mfresh);
        let scale = (0..P).fold(0.0f64, |s, q| s.max(before[q][q]));
        for _ in 0..2 {
            self.sweep(&mut fresh, &mut mfresh);
            let h = gram(w, &mfresh);
            subtract(&mut fresh, &[w.as_slice()], &[h]);
            self.mass.mul(&fresh, &mut mfresh);
        }
        // What is left of a random block inside an exhausted space is rounding of its length.
        let (to_q, _, found, _) = whiten(&gram(&fresh, &mfresh), (1e-10f64).powi(2) * scale);
        transform(&mut fresh, &to_q);
        self.mass.mul(&fresh, mfresh.as_mut());
        let used = found.min(P - rank);
        for (row, new) in w.iter_mut().zip(&fresh) {
            row[rank..rank + used].copy_from_slice(&new[..used]);
        }
        for (row, new) in mw.iter_mut().zip(&mfresh) {
            row[rank..rank + used].copy_from_slice(&new[..used]);
        }
        used
    }

    /// (K − σM)⁻¹ M times a pseudo-random block (splitmix64), and M times that.
    fn random(&mut self) -> (Block<P>, Block<P>) {
        let n = self.factor.analysis().order();
        let mut raw = vec![[0.0; P]; n];
        for x in raw.iter_mut().flatten() {
            self.seed = self.seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.seed;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            *x = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        }
        let mut w = vec![[0.0; P]; n];
        self.mass.mul(&raw, &mut w);
        self.factor.solve_block(&mut w);
        self.mass.mul(&w, &mut raw);
        (w, raw)
    }

    /// Appends the step's new block.
    pub(super) fn advance(&mut self, step: Step<P>) {
        self.blocks.push(step.q);
        self.mq = step.mq;
    }

    /// V ← V S for the first `keep` Ritz vectors.
    pub(super) fn restart(&mut self, ritz: &Ritz, keep: usize) {
        let n = self.mq.len();
        let mut kept: Vec<Block<P>> = vec![vec![[0.0; P]; n]; keep / P];
        for (b, block) in kept.iter_mut().enumerate() {
            let coefficients: Vec<Small<P>> = (0..self.blocks.len())
                .map(|i| {
                    std::array::from_fn(|r| {
                        std::array::from_fn(|q| {
                            let k = b * P + q;
                            if k < ritz.column.len() { -ritz.vectors[(i * P + r, ritz.column[k])] } else { 0.0 }
                        })
                    })
                })
                .collect();
            subtract(block, &self.views(), &coefficients);
        }
        self.blocks = kept;
    }

    /// Vs + Q₊ B s/θ of the first `count` pairs, n×count, in the row order of the matrices.
    pub(super) fn vectors_of(&self, ritz: &Ritz, count: usize, step: &Step<P>) -> DMatrix<f64> {
        let n = self.mq.len();
        let mut out = DMatrix::zeros(n, count);
        let mut views = self.views();
        views.push(&step.q);
        let inverse = &self.factor.analysis().inverse;
        for begin in (0..count).step_by(P) {
            let columns = P.min(count - begin);
            let entry = |i: usize, r: usize, k: usize| match views.len() - 1 - i {
                0 => ritz.coupling[k][r] / ritz.theta[k],
                _ => ritz.vectors[(i * P + r, ritz.column[k])],
            };
            let coefficients: Vec<Small<P>> = (0..views.len())
                .map(|i| {
                    std::array::from_fn(|r| {
                        std::array::from_fn(|q| if q < columns { -entry(i, r, begin + q) } else { 0.0 })
                    })
                })
                .collect();
            let mut block = vec![[0.0; P]; n];
            subtract(&mut block, &views, &coefficients);
            let target = &mut out.as_mut_slice()[begin * n..(begin + columns) * n];
            target.par_chunks_mut(n).enumerate().for_each(|(q, column)| {
                column.iter_mut().zip(inverse).for_each(|(x, &p)| *x = block[p as usize][q]);
            });
        }
        out
    }
}

/// T and B with G = BᵀB and TᵀGT = I on the directions above `floor`, largest first: the columns
/// of T below it are zero. Also their number and the condition of the rest.
fn whiten<const P: usize>(g: &Small<P>, floor: f64) -> (Small<P>, Small<P>, usize, f64) {
    let eigen = DMatrix::from_fn(P, P, |r, c| 0.5 * (g[r][c] + g[c][r])).symmetric_eigen();
    let mut order: Vec<usize> = (0..P).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let mut to_q = [[0.0; P]; P];
    let mut b = [[0.0; P]; P];
    let mut rank = 0;
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for (k, &e) in order.iter().enumerate() {
        let d = eigen.eigenvalues[e];
        if d > floor && d > 0.0 {
            rank += 1;
            least = least.min(d);
            most = most.max(d);
            for r in 0..P {
                to_q[r][k] = eigen.eigenvectors[(r, e)] / d.sqrt();
                b[k][r] = eigen.eigenvectors[(r, e)] * d.sqrt();
            }
        }
    }
    (to_q, b, rank, most / least)
}

fn product<const P: usize>(a: &Small<P>, b: &Small<P>) -> Small<P> {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..P).map(|k| a[r][k] * b[k][c]).sum()))
}
