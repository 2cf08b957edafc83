//! Sparse symmetric algebra: storage, factorisation, eigen-solution. Knows no structures.

mod null_space;
mod propagator;
mod basis;
mod block;
mod error;
mod factor;
mod front;
mod graph;
mod lanczos;
mod ordering;
mod ritz;
mod row_sparse;
mod sparse;
mod substitute;
mod supernodes;
mod symbolic;
mod tree;
mod vectorised;

pub use null_space::{Split, split};
pub use propagator::Propagator;
pub use error::FactorError;
pub use factor::{Inertia, ShiftedFactor};
pub use lanczos::{EigenPairs, LanczosOptions, LanczosStatus, lanczos};
pub use sparse::{SparseError, SymSparse};
pub use symbolic::Analysis;
