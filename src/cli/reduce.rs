//! `ferrom reduce`: the reduced model and its summary.

use super::output::Outcome;
use crate::model::{Progress, Selection};
use crate::pipeline::{PipelineError, analyse, build, model_file, summary_file, write};
use crate::rank::Rule;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "Example: ferrom reduce models/leaf-spring -o reduced/leaf-spring.h5")]
pub(super) struct Arguments {
    /// model.toml or its folder
    model: PathBuf,
    /// Reduced model file (default: the recipe's output, reduced/NAME.h5)
    #[arg(short, long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Keep these modes instead of the recipe's selection, such as 7-17
    #[arg(long, value_name = "LIST")]
    modes: Option<String>,
    /// Also write A, B, C, D of the paper's eq. (10)
    #[arg(long)]
    state_space: bool,
}

/// "Kept modes 7-17: reason".
pub(super) fn selection_text(selection: &Selection) -> String {
    format!("Kept modes {}: {}.\n", selection.ranges(), selection.reason)
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let rule = arguments.modes.as_ref().map(|modes| Rule::List { modes: modes.clone() });
    let analysed = analyse(&model_file(&arguments.model)?, None, progress)?;
    let built = build(analysed, rule.as_ref(), progress)?;
    let output = arguments.output.clone().unwrap_or_else(|| built.output.clone());
    let state_space = arguments.state_space || built.analysed.recipe.reduce.state_space;
    let bytes = write(&built.reduced, &output, state_space)?;
    let model = &built.reduced;
    let json = json!({
        "selected": built.selection.modes,
        "reason": built.selection.reason,
        "kept_dofs": model.dofs.len(),
        "full_dofs": model.full_dofs,
        "residual_vectors": model.residual.as_ref().map_or(0, |r| r.omega.len()),
        "bytes": bytes,
        "file": output.display().to_string(),
        "summary": summary_file(&output).display().to_string(),
        "warnings": built.selection.warnings,
    });
    let text = format!(
        "{}{} modes at {} dofs of {} nodes{}, from {} dofs: {} ({:.1} kB)\n",
        selection_text(&built.selection),
        model.modes.len(),
        model.dofs.len(),
        model.nodes.len(),
        model.residual.as_ref().map_or_else(String::new, |r| format!(", {} residual vectors", r.omega.len())),
        model.full_dofs,
        output.display(),
        bytes as f64 / 1e3
    );
    let warnings = built.selection.warnings.clone().into_iter().chain(built.analysed.modes.warnings.clone());
    Ok(Outcome::new(json, text).warn(warnings))
}
