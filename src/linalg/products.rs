//! Products of a symmetric matrix with many vectors, plain and compensated.

use super::SymSparse;
use super::vectorised::{Kernel, fma, vectorised};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Vectors multiplied together; their rows fill a cache line.
const P: usize = 8;

impl SymSparse {
    /// Y = A X, n×p.
    pub fn mul_block(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        self.product::<false>(x)
    }

    /// Y = A X with every entry of Y as if summed in twice the working precision (Ogita, Rump &
    /// Oishi 2005, Dot2): stiffness times a smooth shape loses up to ten digits to cancellation
    /// otherwise.
    pub fn mul_block_compensated(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        self.product::<true>(x)
    }

    fn product<const EXACT: bool>(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        let n = self.order();
        let mut y = DMatrix::zeros(n, x.ncols());
        if n == 0 {
            return y;
        }
        y.as_mut_slice().par_chunks_mut(n * P).zip(x.as_slice().par_chunks(n * P)).for_each(|(y, x)| {
            let columns = x.len() / n;
            let mut rows = vec![[0.0; P]; n];
            for (c, column) in x.chunks_exact(n).enumerate() {
                rows.iter_mut().zip(column).for_each(|(row, &v)| row[c] = v);
            }
            let mut high = vec![[0.0; P]; n];
            if EXACT {
                let mut low = vec![[0.0; P]; n];
                vectorised(Compensated { matrix: self, x: &rows, high: &mut high, low: &mut low });
                for (h, l) in high.iter_mut().zip(&low) {
                    (0..P).for_each(|q| h[q] += l[q]);
                }
            } else {
                vectorised(Plain { matrix: self, x: &rows, y: &mut high });
            }
            for c in 0..columns {
                y[c * n..(c + 1) * n].iter_mut().zip(&high).for_each(|(v, row)| *v = row[c]);
            }
        });
        y
    }
}

struct Plain<'a> {
    matrix: &'a SymSparse,
    x: &'a [[f64; P]],
    y: &'a mut [[f64; P]],
}

impl Kernel for Plain<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for j in 0..self.x.len() {
            let (from, to) = (self.matrix.col_starts()[j], self.matrix.col_starts()[j + 1]);
            let xj = self.x[j];
            let mut sum = [0.0; P];
            for (&i, &a) in self.matrix.rows()[from..to].iter().zip(&self.matrix.values()[from..to]) {
                let xi = self.x[i];
                (0..P).for_each(|q| sum[q] = fma::<FMA>(a, xi[q], sum[q]));
                if i != j {
                    let yi = &mut self.y[i];
                    (0..P).for_each(|q| yi[q] = fma::<FMA>(a, xj[q], yi[q]));
                }
            }
            (0..P).for_each(|q| self.y[j][q] += sum[q]);
        }
    }
}

struct Compensated<'a> {
    matrix: &'a SymSparse,
    x: &'a [[f64; P]],
    high: &'a mut [[f64; P]],
    low: &'a mut [[f64; P]],
}

/// (high, low) += a·x, both the product and the sum without error to second order.
#[inline(always)]
fn accumulate<const FMA: bool>(a: f64, x: f64, high: &mut f64, low: &mut f64) {
    let product = a * x;
    let product_error = if FMA { a.mul_add(x, -product) } else { split_error(a, x, product) };
    let sum = *high + product;
    let part = sum - *high;
    let sum_error = (*high - (sum - part)) + (product - part);
    *high = sum;
    *low += sum_error + product_error;
}

/// a·x − fl(a·x) without a fused multiply–add (Dekker 1971).
#[inline(always)]
fn split_error(a: f64, x: f64, product: f64) -> f64 {
    const FACTOR: f64 = 134_217_729.0;
    let (ca, cx) = (FACTOR * a, FACTOR * x);
    let (ah, xh) = (ca - (ca - a), cx - (cx - x));
    let (al, xl) = (a - ah, x - xh);
    ((ah * xh - product) + ah * xl + al * xh) + al * xl
}

impl Kernel for Compensated<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        for j in 0..self.x.len() {
            let (from, to) = (self.matrix.col_starts()[j], self.matrix.col_starts()[j + 1]);
            let xj = self.x[j];
            let (mut high, mut low) = (self.high[j], self.low[j]);
            for (&i, &a) in self.matrix.rows()[from..to].iter().zip(&self.matrix.values()[from..to]) {
                let xi = self.x[i];
                (0..P).for_each(|q| accumulate::<FMA>(a, xi[q], &mut high[q], &mut low[q]));
                if i != j {
                    let (hi, lo) = (&mut self.high[i], &mut self.low[i]);
                    (0..P).for_each(|q| accumulate::<FMA>(a, xj[q], &mut hi[q], &mut lo[q]));
                }
            }
            self.high[j] = high;
            self.low[j] = low;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compensated_product_keeps_what_cancellation_would_lose() {
        // Row 1: 1e16·1 + 1·1 − 1e16·1 = 1 exactly; plain summation gives 0 or 2.
        let a = SymSparse::from_triplets(3, &[(0, 0, 1e16), (0, 1, 1.0), (0, 2, -1e16)]).expect("valid");
        let y = a.mul_block_compensated(&DMatrix::from_element(3, 1, 1.0));
        assert_eq!(y[(0, 0)], 1.0);
    }

    #[test]
    fn block_product_equals_the_single_one() {
        let a = SymSparse::from_triplets(3, &[(0, 0, 2.0), (0, 2, -1.0), (1, 1, 3.0), (2, 2, 4.0)]).expect("valid");
        let x = DMatrix::from_fn(3, 11, |i, j| (i * 11 + j) as f64);
        let y = a.mul_block(&x);
        for c in 0..11 {
            assert_eq!(y.column(c).as_slice(), a.mul(x.column(c).as_slice()).as_slice());
        }
    }
}
