//! All integration tests, one binary.

mod architecture;
mod cli;
mod contracts;
mod formats;
mod hard;
mod leaf;
mod paper;
mod reduced;
mod support;
mod textbook;
