//! Everything that can stop the pipeline, with the exit code it means.

use crate::format::FormatError;
use crate::modal::ModalError;
use crate::rank::SelectError;
use crate::reduce::ReduceError;
use crate::simulate::SceneError;
use thiserror::Error;

/// A failure of the pipeline.
#[derive(Debug, Error)]
pub enum PipelineError {
    /// A file that cannot be read, written or understood; recipe and scene faults carry file and line.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The eigen-solution failed.
    #[error("modal analysis: {0}")]
    Modal(#[from] ModalError),
    /// The rule cannot select.
    #[error("selection: {0}")]
    Select(#[from] SelectError),
    /// The reduction failed.
    #[error("reduction: {0}")]
    Reduce(#[from] ReduceError),
    /// The run of a scene failed numerically.
    #[error("{scene}: {error}")]
    Simulate {
        /// Path of the scene file.
        scene: String,
        /// What happened.
        error: SceneError,
    },
    /// What the command line asks for does not exist.
    #[error("{0}")]
    Request(String),
}

impl PipelineError {
    /// Process exit code: 3 input, 4 numerics.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Modal(ModalError::Factor(_) | ModalError::NotConverged { .. }) => 4,
            Self::Reduce(ReduceError::Residual(_)) => 4,
            Self::Simulate { error: SceneError::Numerics(_), .. } => 4,
            _ => 3,
        }
    }
}
