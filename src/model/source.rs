//! Where data came from: path and hash of a file.

use serde::{Deserialize, Serialize};

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// What it gave: "stiffness", "mass", "dofs", "mesh", "modes".
    pub role: String,
    /// Path as the recipe writes it.
    pub path: String,
    /// SHA-256 of the file's bytes (after decompression), hexadecimal.
    pub sha256: String,
}
