//! ferrom (FE → ROM): from finite-element exports to compact reduced models to drop tests.
//!
//! ```text
//! FE matrices (K, M) ─┐                                            scene.toml
//!                     ├─ format ─▶ FeModel ─ modal ─▶ Modes ─ rank ─▶ Ranking ─▶ Selection
//! FE mode shapes  ────┘                                                             │
//!                                                                       reduce ◀────┘
//!                                                                          │
//!                              reduced/<name>.h5 + .toml summary ◀─────────┴──▶ simulate ─▶ Trajectory ─▶ report
//! ```
//!
//! # The house
//! `model` holds the nouns that stages share; each stage is a folder of functions from nouns to a
//! noun; stages never use each other; `pipeline` and `cli` compose them.
//!
//! # Notation
//! K, M stiffness and mass (n×n); φ, Φ shapes; ω natural frequency, rad/s; ζ damping ratio;
//! σ shift of the eigen-solution; Γ participation; R residual flexibility; q modal coordinate.
//! Symbols in the docs, words in the code. SI units inside, always.
//!
//! # Allowed uses
//! A test holds this table to the code: a module may use what stands on its line, and nothing else.
//!
//! ```text
//! quantity <-
//! linalg   <-
//! model    <- linalg
//! frf      <- model
//! format   <- linalg model
//! modal    <- linalg model
//! rank     <- frf model
//! reduce   <- linalg model
//! simulate <- linalg model quantity
//! report   <- frf model
//! pipeline <- format modal model quantity rank reduce simulate
//! cli      <- format frf modal model pipeline quantity rank reduce report simulate
//! main     <- cli
//! ```

pub mod cli;
pub mod format;
pub mod frf;
pub mod linalg;
pub mod modal;
pub mod model;
pub mod pipeline;
pub mod quantity;
pub mod rank;
pub mod reduce;
pub mod report;
pub mod simulate;
