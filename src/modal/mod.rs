//! FE model to modes: eigen-solution, rigid modes, proof of completeness, damping, survey of an export.

mod damping;
mod digits;
mod error;
mod pairs;
mod report;
mod rigid;
mod shift;
mod solve;
mod survey;
mod trust;

pub use damping::{DAMPING_PRESETS, DampingModel, set_damping};
pub use error::ModalError;
pub use report::{SolveReport, Stage};
pub use solve::{ModalOptions, solve, solve_with_report};
pub use survey::{Survey, survey};
