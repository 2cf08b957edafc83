//! Hard eigenproblems give the right number or one clear error.

mod closed_forms;
mod exports;
mod input_errors;
mod pencils;
mod read;
