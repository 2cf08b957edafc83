//! Rank-revealing null spaces of small dense matrices.

use nalgebra::DMatrix;

/// Orthonormal bases of the row space and of the null space of a matrix.
#[derive(Clone, Debug)]
pub struct Split {
    /// n×r: spans the rows.
    pub range: DMatrix<f64>,
    /// n×(n − r): Z with A Z = 0.
    pub null: DMatrix<f64>,
}

/// Splits the n coordinates of a c×n matrix by QR with column pivoting of its transpose (Golub and
/// Van Loan, Matrix Computations, 4th ed., sec. 5.4.2). Rows are scaled to unit length first; a row
/// whose part outside the span of the others is below `tolerance` counts as dependent.
pub fn split(rows: &DMatrix<f64>, tolerance: f64) -> Split {
    let n = rows.ncols();
    let lengths: Vec<f64> = rows.row_iter().map(|r| r.norm()).collect();
    let used: Vec<usize> = (0..rows.nrows()).filter(|&k| lengths[k] > 0.0).collect();
    let width = used.len().max(n);
    // Zero columns beside the rows make Q square, so that it completes the basis.
    let padded = DMatrix::from_fn(n, width, |r, c| used.get(c).map_or(0.0, |&k| rows[(k, r)] / lengths[k]));
    let (q, r, _) = padded.col_piv_qr().unpack();
    let rank = (0..n.min(width)).take_while(|&k| r[(k, k)].abs() > tolerance).count();
    Split { range: q.columns(0, rank).into_owned(), null: q.columns(rank, n - rank).into_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dmatrix;

    #[test]
    fn dependent_rows_do_not_count_twice() {
        let a = dmatrix![1.0, 0.0, 0.0, 1.0; 0.0, 2.0, 0.0, 0.0; 1.0, 2.0, 1e-12, 1.0; 0.0, 0.0, 0.0, 0.0];
        let s = split(&a, 1e-9);
        assert_eq!((s.range.ncols(), s.null.ncols()), (2, 2));
        // The dropped row leaves its 1e-12; everything else is rounding.
        assert!((&a * &s.null).amax() < 2e-12);
        let q = DMatrix::from_columns(&[s.range.column(0), s.range.column(1), s.null.column(0), s.null.column(1)]);
        assert!((q.transpose() * &q - DMatrix::identity(4, 4)).amax() < 1e-15);
    }

    #[test]
    fn no_rows_leave_everything_free() {
        assert_eq!(split(&DMatrix::zeros(0, 3), 1e-9).null.ncols(), 3);
        assert_eq!(split(&DMatrix::zeros(2, 3), 1e-9).null.ncols(), 3);
    }
}
