//! Why a model has no modes.

use crate::linalg::FactorError;
use thiserror::Error;

/// Why modal analysis cannot give a trustworthy answer.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ModalError {
    /// No rows.
    #[error("the model has no degrees of freedom")]
    Empty,
    /// K, M and the dof list differ in length.
    #[error(
        "the stiffness matrix has order {stiffness}, the mass matrix {mass}, the dof list {dofs} rows; all three must be equal"
    )]
    OrderMismatch {
        /// Order of K.
        stiffness: usize,
        /// Order of M.
        mass: usize,
        /// Rows of the dof list.
        dofs: usize,
    },
    /// A row with negative mass on the diagonal, or M indefinite.
    #[error(
        "the mass matrix is not positive semidefinite (at dof {dof}); check that stiffness and mass files are not exchanged"
    )]
    IndefiniteMass {
        /// Where it was noticed.
        dof: String,
    },
    /// Rigid translations carry no kinetic energy.
    #[error(
        "the mass matrix gives rigid translations no mass, as a stiffness matrix would: the stiffness and mass files look exchanged"
    )]
    Exchanged,
    /// M = 0.
    #[error("the mass matrix is zero; natural frequencies need mass")]
    NoMass,
    /// A row without stiffness and mass, or a null vector common to both.
    #[error(
        "stiffness and mass are both zero along a motion of dof {dof}: remove the degree of freedom or give it stiffness or mass"
    )]
    CommonNull {
        /// Where it was noticed.
        dof: String,
    },
    /// Eigenvalues below zero by more than rounding.
    #[error(
        "the stiffness matrix is not positive semidefinite: {count} eigenvalue(s) ω² below {below:e} (rad/s)²; the structure is unstable (preload, buckling) or the file is damaged"
    )]
    NegativeStiffness {
        /// How many.
        count: usize,
        /// σ, (rad/s)².
        below: f64,
    },
    /// A shift that is not a negative number.
    #[error(
        "shift {0} (rad/s)² is not usable; give a negative number of the size of the first elastic ω², or leave it out"
    )]
    BadShift(f64),
    /// No modes asked for.
    #[error("no modes were asked for; give a count of at least 1")]
    NoneAsked,
    /// The factorisation failed.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The iteration did not converge.
    #[error("only {converged} of {wanted} modes converged")]
    NotConverged {
        /// Converged modes.
        converged: usize,
        /// Modes asked for.
        wanted: usize,
    },
}
