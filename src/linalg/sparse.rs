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
        let mut count = vec![0usize; order + 1];
        for &(i, j, value) in entries {
            if i >= order || j >= order {
                return Err(SparseError::Outside { row: i + 1, col: j + 1, order });
            }
            if !value.is_finite() {
                return Err(SparseError::NotFinite { row: i + 1, col: j + 1, value });
            }
            count[i.max(j) + 1] += 1;
        }
        for j in 0..order {
            count[j + 1] += count[j];
        }
        let mut next = count.clone();
        let mut bucket = vec![(0usize, 0.0f64); entries.len()];
        for &(i, j, value) in entries {
            let col = i.max(j);
            bucket[next[col]] = (i.min(j), value);
            next[col] += 1;
        }
        let mut matrix = Self {
            order,
            col_start: Vec::with_capacity(order + 1),
            row: Vec::with_capacity(entries.len()),
            value: Vec::with_capacity(entries.len()),
        };
        matrix.col_start.push(0);
        for j in 0..order {
            let column = &mut bucket[count[j]..count[j + 1]];
            if !column.is_sorted_by_key(|e| e.0) {
                column.sort_by_key(|e| e.0);
            }
            let begin = matrix.row.len();
            for &(i, value) in column.iter() {
                if matrix.row.len() > begin && matrix.row.last() == Some(&i) {
                    if let Some(last) = matrix.value.last_mut() {
                        *last += value;
                    }
                } else if value != 0.0 || i == j {
                    matrix.row.push(i);
                    matrix.value.push(value);
                }
            }
            matrix.col_start.push(matrix.row.len());
        }
        Ok(matrix)
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
