//! All integration tests, one binary.

mod architecture;
mod formats;
mod hard;
