//! Symmetric sparse matrices, upper triangle in compressed columns.

use thiserror::Error;

/// A symmetric n×n matrix; only the upper triangle (row ≤ column) is stored, column by column,
/// rows ascending, no duplicates, no stored zeros off the diagonal.
#[derive(Clone, Debug, PartialEq)]
pub struct SymSparse {
    order: usize,
    /// Column j holds the entries `col_start[j]..col_start[j + 1]`; n + 1 long.
    col_start: Vec<usize>,
    row: Vec<usize>,
    value: Vec<f64>,
}

/// Why entries do not make a symmetric matrix.
#[derive(Debug, Error, PartialEq)]
pub enum SparseError {
    /// An index outside the matrix.
    #[error("entry ({row}, {col}) lies outside a matrix of order {order}")]
    Outside {
        /// 1-based row.
        row: usize,
        /// 1-based column.
        col: usize,
        /// Order of the matrix.
        order: usize,
    },
    /// A value that is not a number or infinite.
    #[error("entry ({row}, {col}) is {value}, not a finite number")]
    NotFinite {
        /// 1-based row.
        row: usize,
        /// 1-based column.
        col: usize,
        /// What was found.
        value: f64,
    },
}

impl SymSparse {
    /// Collects (row, column, value) entries, 0-based, of one triangle (either, or a mixture: an
    /// entry below the diagonal is taken as its mirror image). Entries at the same place add up;
    /// off-diagonal zeros are dropped.
    pub fn from_triplets(order: usize, entries: &[(usize, usize, f64)]) -> Result<Self, SparseError> {
        Self::gather(order, entries.iter().copied())
    }

    /// The same from indices of half the size: the form in which large files are read.
    pub fn from_compact(order: usize, entries: &[(u32, u32, f64)]) -> Result<Self, SparseError> {
        Self::gather(order, entries.iter().map(|&(i, j, value)| (i as usize, j as usize, value)))
    }

    /// Counts the columns, drops each entry into its column, then orders every column in place.
    fn gather(order: usize, entries: impl Iterator<Item = (usize, usize, f64)> + Clone) -> Result<Self, SparseError> {
        let mut start = vec![0usize; order + 1];
        for (i, j, value) in entries.clone() {
            if i >= order || j >= order {
                return Err(SparseError::Outside { row: i + 1, col: j + 1, order });
            }
            if !value.is_finite() {
                return Err(SparseError::NotFinite { row: i + 1, col: j + 1, value });
            }
            start[i.max(j) + 1] += usize::from(value != 0.0 || i == j);
        }
        for j in 0..order {
            start[j + 1] += start[j];
        }
        let mut next = start.clone();
        let mut row = vec![0usize; start[order]];
        let mut value = vec![0.0f64; start[order]];
        for (i, j, v) in entries.filter(|&(i, j, v)| v != 0.0 || i == j) {
            let place = &mut next[i.max(j)];
            (row[*place], value[*place]) = (i.min(j), v);
            *place += 1;
        }
        let mut filled = 0;
        let mut col_start = Vec::with_capacity(order + 1);
        col_start.push(0);
        let mut column: Vec<(usize, f64)> = Vec::new();
        for j in 0..order {
            let (first, end) = (start[j], start[j + 1]);
            if !row[first..end].is_sorted() {
                column.clear();
                column.extend(row[first..end].iter().copied().zip(value[first..end].iter().copied()));
                column.sort_by_key(|e| e.0);
                for (k, &(i, v)) in column.iter().enumerate() {
                    (row[first + k], value[first + k]) = (i, v);
                }
            }
            let begin = filled;
            for k in first..end {
                if filled > begin && row[filled - 1] == row[k] {
                    value[filled - 1] += value[k];
                } else {
                    (row[filled], value[filled]) = (row[k], value[k]);
                    filled += 1;
                }
            }
            col_start.push(filled);
        }
        row.truncate(filled);
        value.truncate(filled);
        Ok(Self { order, col_start, row, value })
    }

    /// The identity of order n.
    pub fn identity(order: usize) -> Self {
        Self { order, col_start: (0..=order).collect(), row: (0..order).collect(), value: vec![1.0; order] }
    }

    /// Number of rows.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Entries stored (upper triangle with diagonal).
    pub fn stored(&self) -> usize {
        self.value.len()
    }

    /// Entries of the full symmetric matrix.
    pub fn nonzeros(&self) -> usize {
        let diagonal = (0..self.order).filter(|&j| self.column(j).any(|(i, _)| i == j)).count();
        2 * self.stored() - diagonal
    }

    /// Start of each column in `rows` and `values`; n + 1 long.
    pub fn col_starts(&self) -> &[usize] {
        &self.col_start
    }

    /// Row of each stored entry.
    pub fn rows(&self) -> &[usize] {
        &self.row
    }

    /// Value of each stored entry.
    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// The stored entries (row, value) of a column.
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.col_start[j]..self.col_start[j + 1]).map(|k| (self.row[k], self.value[k]))
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.order).map(|j| self.column(j).filter(|e| e.0 == j).map(|e| e.1).sum()).collect()
    }

    /// Sum of the diagonal.
    pub fn trace(&self) -> f64 {
        self.diagonal().iter().sum()
    }

    /// The same matrix times a factor.
    pub fn scaled(mut self, factor: f64) -> Self {
        for v in &mut self.value {
            *v *= factor;
        }
        self
    }

    /// The same pattern with every stored entry replaced by f(row, column, value), row ≤ column.
    pub fn map_entries(mut self, f: impl Fn(usize, usize, f64) -> f64) -> Self {
        for j in 0..self.order {
            for k in self.col_start[j]..self.col_start[j + 1] {
                self.value[k] = f(self.row[k], j, self.value[k]);
            }
        }
        self
    }

    /// y = A x.
    pub fn mul(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.order];
        self.mul_add(x, &mut y);
        y
    }

    /// y += A x.
    pub fn mul_add(&self, x: &[f64], y: &mut [f64]) {
        for j in 0..self.order {
            let xj = x[j];
            let mut sum = 0.0;
            for k in self.col_start[j]..self.col_start[j + 1] {
                let (i, a) = (self.row[k], self.value[k]);
                if i == j {
                    sum += a * xj;
                } else {
                    sum += a * x[i];
                    y[i] += a * xj;
                }
            }
            y[j] += sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_either_triangle_make_the_same_matrix() {
        let upper = SymSparse::from_triplets(3, &[(0, 0, 2.0), (0, 2, -1.0), (1, 1, 3.0), (2, 2, 4.0)]);
        let lower = SymSparse::from_triplets(3, &[(2, 2, 4.0), (2, 0, -1.0), (1, 1, 3.0), (0, 0, 2.0)]);
        assert_eq!(upper, lower);
        let a = upper.expect("valid");
        assert_eq!(a.mul(&[1.0, 2.0, 3.0]), vec![-1.0, 6.0, 11.0]);
        assert_eq!((a.stored(), a.nonzeros(), a.trace()), (4, 5, 9.0));
    }

    #[test]
    fn nan_and_outside_entries_are_named() {
        let nan = SymSparse::from_triplets(2, &[(0, 1, f64::NAN)]).expect_err("NaN");
        assert!(matches!(nan, SparseError::NotFinite { row: 1, col: 2, .. }));
        let out = SymSparse::from_triplets(2, &[(0, 2, 1.0)]).expect_err("outside");
        assert_eq!(out, SparseError::Outside { row: 1, col: 3, order: 2 });
    }
}
