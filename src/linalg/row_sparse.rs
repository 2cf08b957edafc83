//! A symmetric matrix stored by full rows, for products with blocks of vectors.

use super::SymSparse;
use super::vectorised::{Kernel, fma, vectorised};
use rayon::prelude::*;

/// Rows per piece of parallel work; fixed, so that results do not depend on the thread count.
pub(super) const PIECE: usize = 2048;

/// Both triangles of P A Pᵀ, row by row; products need no scatter and split over rows.
pub(super) struct RowSparse {
    start: Vec<usize>,
    col: Vec<u32>,
    value: Vec<f64>,
}

impl RowSparse {
    /// `position` sends an old row to its new place. Explicit zeros are dropped.
    pub(super) fn permuted(a: &SymSparse, position: &[u32]) -> Self {
        let n = a.order();
        let mut start = vec![0usize; n + 1];
        for j in 0..n {
            for (i, v) in a.column(j) {
                if v != 0.0 {
                    start[position[i] as usize + 1] += 1;
                    if i != j {
                        start[position[j] as usize + 1] += 1;
                    }
                }
            }
        }
        for i in 0..n {
            start[i + 1] += start[i];
        }
        let mut at = start.clone();
        let mut col = vec![0u32; start[n]];
        let mut value = vec![0.0; start[n]];
        let mut put = |r: u32, c: u32, v: f64| {
            let slot = &mut at[r as usize];
            col[*slot] = c;
            value[*slot] = v;
            *slot += 1;
        };
        for j in 0..n {
            for (i, v) in a.column(j) {
                if v != 0.0 {
                    put(position[i], position[j], v);
                    if i != j {
                        put(position[j], position[i], v);
                    }
                }
            }
        }
        Self { start, col, value }
    }

    /// Y = A X.
    pub(super) fn mul<const P: usize>(&self, x: &[[f64; P]], y: &mut [[f64; P]]) {
        y.par_chunks_mut(PIECE).enumerate().for_each(|(piece, rows)| {
            vectorised(Product { matrix: self, x, rows, first: piece * PIECE });
        });
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.start.len() * 8 + self.value.len() * 12
    }
}

struct Product<'a, const P: usize> {
    matrix: &'a RowSparse,
    x: &'a [[f64; P]],
    rows: &'a mut [[f64; P]],
    first: usize,
}

impl<const P: usize> Kernel for Product<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            let (from, to) = (self.matrix.start[self.first + i], self.matrix.start[self.first + i + 1]);
            let mut sum = [0.0; P];
            for (&c, &a) in self.matrix.col[from..to].iter().zip(&self.matrix.value[from..to]) {
                let x = &self.x[c as usize];
                (0..P).for_each(|q| sum[q] = fma::<FMA>(a, x[q], sum[q]));
            }
            *row = sum;
        }
    }
}
