//! Blocks of P vectors stored row by row: n rows of `[f64; P]`.

use super::row_sparse::PIECE;
use super::vectorised::{Kernel, fma, vectorised};
use rayon::prelude::*;

/// n×P.
pub(super) type Block<const P: usize> = Vec<[f64; P]>;
/// P×P, row by row.
pub(super) type Small<const P: usize> = [[f64; P]; P];

/// AᵀB.
pub(super) fn gram<const P: usize>(a: &[[f64; P]], b: &[[f64; P]]) -> Small<P> {
    grams(&[a], b).pop().unwrap_or([[0.0; P]; P])
}

/// A_iᵀB for several blocks A_i in one sweep over B. Pieces are summed in a fixed order.
pub(super) fn grams<const P: usize>(a: &[&[[f64; P]]], b: &[[f64; P]]) -> Vec<Small<P>> {
    let parts: Vec<Vec<Small<P>>> = b
        .par_chunks(PIECE)
        .enumerate()
        .map(|(piece, rows)| {
            let from = piece * PIECE;
            a.iter().map(|block| vectorised(Gram { a: &block[from..from + rows.len()], b: rows })).collect()
        })
        .collect();
    let mut sum = vec![[[0.0; P]; P]; a.len()];
    for part in parts {
        for (s, p) in sum.iter_mut().zip(part) {
            for r in 0..P {
                (0..P).for_each(|q| s[r][q] += p[r][q]);
            }
        }
    }
    sum
}

/// W −= Σ A_i H_i.
pub(super) fn subtract<const P: usize>(w: &mut [[f64; P]], a: &[&[[f64; P]]], h: &[Small<P>]) {
    w.par_chunks_mut(PIECE).enumerate().for_each(|(piece, rows)| {
        let from = piece * PIECE;
        for (block, h) in a.iter().zip(h) {
            let a = &block[from..from + rows.len()];
            vectorised(Subtract { w: &mut *rows, a, h });
        }
    });
}

/// W ← W T.
pub(super) fn transform<const P: usize>(w: &mut [[f64; P]], t: &Small<P>) {
    w.par_chunks_mut(PIECE).for_each(|rows| vectorised(Transform { w: rows, t }));
}

struct Gram<'a, const P: usize> {
    a: &'a [[f64; P]],
    b: &'a [[f64; P]],
}

impl<const P: usize> Kernel for Gram<'_, P> {
    type Output = Small<P>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Small<P> {
        let mut sum = [[0.0; P]; P];
        for (a, b) in self.a.iter().zip(self.b) {
            for r in 0..P {
                for q in 0..P {
                    sum[r][q] = fma::<FMA>(a[r], b[q], sum[r][q]);
                }
            }
        }
        sum
    }
}

struct Subtract<'a, const P: usize> {
    w: &'a mut [[f64; P]],
    a: &'a [[f64; P]],
    h: &'a Small<P>,
}

impl<const P: usize> Kernel for Subtract<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let h = *self.h;
        for (w, a) in self.w.iter_mut().zip(self.a) {
            let mut sum = *w;
            for r in 0..P {
                let factor = -a[r];
                for q in 0..P {
                    sum[q] = fma::<FMA>(factor, h[r][q], sum[q]);
                }
            }
            *w = sum;
        }
    }
}

struct Transform<'a, const P: usize> {
    w: &'a mut [[f64; P]],
    t: &'a Small<P>,
}

impl<const P: usize> Kernel for Transform<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let t = *self.t;
        for w in self.w.iter_mut() {
            let mut sum = [0.0; P];
            for r in 0..P {
                for q in 0..P {
                    sum[q] = fma::<FMA>(w[r], t[r][q], sum[q]);
                }
            }
            *w = sum;
        }
    }
}
