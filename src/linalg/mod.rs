//! Sparse symmetric algebra: storage, factorisation, eigen-solution. Knows no structures.

mod null_space;
mod propagator;
mod sparse;

pub use null_space::{Split, split};
pub use propagator::Propagator;
pub use sparse::{SparseError, SymSparse};
