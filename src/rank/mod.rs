//! Modes to ranking to selection: how much each mode matters for a transfer path, and which are kept.

mod criteria;
mod select;

pub use criteria::{CRITERIA, Criterion, Path, PathEnd, criterion, rank};
pub use select::{RULES, Rule, SelectError, select};
