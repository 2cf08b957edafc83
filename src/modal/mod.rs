//! FE model to modes: eigen-solution, rigid modes, proof of completeness.

mod digits;
mod error;
mod pairs;
mod report;
mod rigid;
mod shift;
mod solve;
mod trust;

pub use error::ModalError;
pub use report::{SolveReport, Stage};
pub use solve::{ModalOptions, solve, solve_with_report};
