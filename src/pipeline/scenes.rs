//! Scenes: the files of a project, and loading one with the reduced models it names.

use super::PipelineError;
use crate::format::{FormatError, parse_toml, read_reduced, toml_error_at};
use crate::model::ReducedModel;
use crate::simulate::{Scene, SceneError, System, assemble};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene with its models.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// Path of the scene file.
    pub file: PathBuf,
    /// The scene.
    pub scene: Scene,
    /// Its text.
    pub text: String,
    /// Reduced model per flexible body.
    pub models: BTreeMap<String, ReducedModel>,
}

/// Every .toml beside a model.toml but itself, by name.
pub fn scene_files(model_file: &Path) -> Result<Vec<PathBuf>, PipelineError> {
    let folder = model_file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder)
        .map_err(|e| PipelineError::Request(format!("{}: cannot be listed: {e}", folder.display())))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|e| e.ok().map(|e| e.path()))
        .filter(|p| p.extension().is_some_and(|e| e == "toml") && p.file_name() != model_file.file_name())
        .collect();
    files.sort();
    Ok(files)
}

/// Reads a scene and the reduced models of its bodies.
pub fn load_scene(file: &Path) -> Result<Loaded, PipelineError> {
    let (scene, text): (Scene, String) = parse_toml(file)?;
    let folder = file.parent().unwrap_or(Path::new("."));
    let mut models = BTreeMap::new();
    for (name, body) in &scene.body {
        if let Some(model) = &body.model {
            let path = folder.join(model.get_ref());
            let read = read_reduced(&path).map_err(|error| match error {
                FormatError::Io { .. } => toml_error_at(
                    file,
                    &text,
                    model.span(),
                    format!("{error} (a reduced model is made by `ferrom reduce MODEL`)"),
                ),
                other => other,
            })?;
            models.insert(name.get_ref().clone(), read);
        }
    }
    Ok(Loaded { file: file.to_path_buf(), scene, text, models })
}

impl Loaded {
    /// The system of the scene.
    pub fn assemble(&self) -> Result<System, PipelineError> {
        assemble(&self.scene, &self.models).map_err(|error| self.located(error))
    }

    /// A scene error with file and line.
    pub fn located(&self, error: SceneError) -> PipelineError {
        match error {
            SceneError::Scene { span: Some(span), message } if !span.is_empty() => {
                toml_error_at(&self.file, &self.text, span, message).into()
            }
            SceneError::Scene { message, .. } => PipelineError::Request(format!("{}: {message}", self.file.display())),
            error => PipelineError::Simulate { scene: self.file.display().to_string(), error },
        }
    }
}
