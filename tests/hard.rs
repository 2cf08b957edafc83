//! Hard eigenproblems give the right number or one clear error.
