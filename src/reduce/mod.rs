//! Modes, selection and interface nodes to a reduced model.

mod residual;
mod truncate;

pub use residual::ResidualError;
pub use truncate::{METHODS, Made, Method, ReduceError, method, reduce};
