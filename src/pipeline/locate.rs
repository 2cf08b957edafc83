//! Where things are: the recipe of a model, the reduced files it leads to.

use super::{PipelineError, Recipe};
use std::path::{Component, Path, PathBuf};

/// The model.toml of an argument that names it or its folder.
pub fn model_file(argument: &Path) -> Result<PathBuf, PipelineError> {
    if argument.is_dir() {
        let file = argument.join("model.toml");
        if file.is_file() {
            return Ok(file);
        }
        return Err(PipelineError::Request(format!(
            "{}: the folder holds no model.toml; write one (see README, \"Bring your own model\") or name another folder",
            argument.display()
        )));
    }
    if argument.is_file() {
        return Ok(argument.to_path_buf());
    }
    Err(PipelineError::Request(format!("{}: there is no such file or folder", argument.display())))
}

/// Where the reduced model of a recipe goes: its `[reduce] output`, else `reduced/NAME.h5` beside
/// the folder that holds the model's folder (models/NAME/model.toml → reduced/NAME.h5).
pub fn output_file(model_file: &Path, recipe: &Recipe) -> PathBuf {
    let folder = model_file.parent().unwrap_or(Path::new("."));
    tidy(&match &recipe.reduce.output {
        Some(output) => folder.join(output),
        None => folder.join("../../reduced").join(format!("{}.h5", recipe.name)),
    })
}

/// The same path without "NAME/.." detours, where NAME is no link ("models/leaf/../../reduced" reads
/// badly and means "reduced").
fn tidy(path: &Path) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let plain = matches!(short.components().next_back(), Some(Component::Normal(_)));
        if part == Component::ParentDir && plain && !short.is_symlink() {
            short.pop();
        } else {
            short.push(part);
        }
    }
    short
}

/// The readable summary beside a reduced model.
pub fn summary_file(reduced: &Path) -> PathBuf {
    reduced.with_extension("toml")
}
