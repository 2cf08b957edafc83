//! What a modal analysis cost.

use serde::Serialize;
use std::time::Instant;

/// One stage of the analysis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stage {
    /// "ordering", "factorisation", "lanczos", "refinement", "completeness".
    pub name: &'static str,
    /// Wall time, s.
    pub wall_s: f64,
    /// Bytes of the largest data the stage made.
    pub bytes: usize,
    /// What was chosen or counted, in words.
    pub note: String,
}

/// Time and memory of a modal analysis by stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SolveReport {
    /// Stages in the order they ran.
    pub stages: Vec<Stage>,
    /// Significant decimal digits the entries of K carry (17: full double precision).
    pub digits: u32,
}

impl SolveReport {
    pub(super) fn add(&mut self, name: &'static str, since: Instant, bytes: usize, note: String) {
        self.stages.push(Stage { name, wall_s: since.elapsed().as_secs_f64(), bytes, note });
    }
}
