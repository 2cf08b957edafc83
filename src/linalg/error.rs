//! Why a factorisation cannot be made.

use thiserror::Error;

/// Why K − σM has no usable factorisation.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FactorError {
    /// K and M differ in size.
    #[error(
        "the stiffness matrix has order {stiffness}, the mass matrix {mass}; both must belong to the same degrees of freedom"
    )]
    OrderMismatch {
        /// Order of K.
        stiffness: usize,
        /// Order of M.
        mass: usize,
    },
    /// No rows.
    #[error("the matrices have order 0")]
    Empty,
    /// σ is NaN or infinite.
    #[error("the shift {shift} is not a finite number")]
    BadShift {
        /// σ.
        shift: f64,
    },
    /// A pivot ≤ 0 where K − σM should be positive definite.
    #[error("K − σM is not positive definite (row {})", .row + 1)]
    NotDefinite {
        /// 0-based row.
        row: usize,
    },
    /// A pivot is zero or not finite.
    #[error(
        "K − σM is singular at row {}: the shift is an eigenvalue, or K and M share a null vector there (a degree of freedom without stiffness and mass)",
        .row + 1
    )]
    Singular {
        /// 0-based row.
        row: usize,
    },
}

impl FactorError {
    /// The same error with its row renamed.
    pub(super) fn at(self, rename: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::NotDefinite { row } => Self::NotDefinite { row: rename(row) },
            Self::Singular { row } => Self::Singular { row: rename(row) },
            other => other,
        }
    }
}
