//! Why a scene cannot be simulated, and where in the scene file the cause stands.

use std::ops::Range;
use thiserror::Error;

/// A fault of the scene or of the run.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SceneError {
    /// The scene says something that cannot be built.
    #[error("{message}")]
    Scene {
        /// Bytes of the scene file that say it; `None` when something is missing.
        span: Option<Range<usize>>,
        /// What was found, what was expected, the cure.
        message: String,
    },
    /// The numbers went wrong while running.
    #[error("{0}")]
    Numerics(String),
}

impl SceneError {
    /// A fault at a place of the scene file.
    pub(super) fn at(span: Range<usize>, message: impl Into<String>) -> Self {
        Self::Scene { span: Some(span), message: message.into() }
    }

    /// A fault without a place.
    pub(super) fn missing(message: impl Into<String>) -> Self {
        Self::Scene { span: None, message: message.into() }
    }
}

/// `"a", "b" and "c"`, for messages that say what exists.
pub(super) fn names<'a>(all: impl IntoIterator<Item = &'a str>) -> String {
    all.into_iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}
