//! Sparse symmetric algebra: storage, factorisation, eigen-solution. Knows no structures.

mod sparse;

pub use sparse::{SparseError, SymSparse};
