//! From a recipe (model.toml) to a reduced model: format → modal → rank → reduce; and the check of
//! what came out against what was committed.

mod build;
mod check;
mod error;
mod locate;
mod recipe;
mod scenes;

pub use build::{Analysed, Built, Timing, analyse, build, path_of, tool, write};
pub use check::{Check, Difference, Expected, check, committed};
pub use error::PipelineError;
pub use locate::{model_file, output_file, summary_file};
pub use recipe::{Damping, ModalSettings, NodeSpec, RankSettings, Recipe, ReduceSettings, ReferenceFrequencies};
pub use scenes::{Loaded, load_scene, scene_files};
