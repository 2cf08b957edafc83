//! Sparse symmetric algebra: storage, factorisation, eigen-solution. Knows no structures.

mod basis;
mod block;
mod dense;
mod error;
mod factor;
mod front;
mod graph;
mod lanczos;
mod null_space;
mod ordering;
mod products;
mod propagator;
mod ritz;
mod row_sparse;
mod sparse;
mod substitute;
mod supernodes;
mod symbolic;
mod symmetric;
mod tree;
mod vectorised;

pub use dense::{DenseError, dense_pencil};
pub use error::FactorError;
pub use factor::{Inertia, ShiftedFactor};
pub use lanczos::{EigenPairs, LanczosOptions, LanczosStatus, lanczos};
pub use null_space::{Split, split};
pub use propagator::Propagator;
pub use sparse::{SparseError, SymSparse};
pub use symbolic::Analysis;
