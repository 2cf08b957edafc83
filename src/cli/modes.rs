//! `ferrom modes`: modal analysis of a model or of bare matrices.

use super::matrices::Matrices;
use super::output::Outcome;
use crate::format::read_fe_model;
use crate::modal::{ModalOptions, SolveReport, solve_with_report};
use crate::model::{Modes, Progress, RigidBody};
use crate::pipeline::{PipelineError, analyse, model_file};
use crate::report::modes_table;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ferrom modes models/leaf-spring -n 56\n  ferrom modes --stiffness K.mtx --mass M.mtx --json"
)]
pub(super) struct Arguments {
    /// model.toml or its folder
    #[arg(required_unless_present = "stiffness", conflicts_with = "stiffness")]
    model: Option<PathBuf>,
    /// How many modes, rigid ones included
    #[arg(short = 'n', long = "count", value_name = "N")]
    count: Option<usize>,
    #[command(flatten)]
    matrices: Matrices,
    /// Shift of the eigen-solution, (rad/s)², negative (default: found automatically)
    #[arg(long, value_name = "SIGMA", allow_hyphen_values = true, requires = "stiffness", conflicts_with = "model")]
    shift: Option<f64>,
}

/// Modes for `--json`.
pub(super) fn modes_json(modes: &Modes) -> Value {
    let listed: Vec<Value> = (0..modes.len())
        .map(|k| {
            let finite = |v: f64| if v.is_finite() { json!(v) } else { Value::Null };
            json!({
                "number": k + 1,
                "omega": modes.omega[k],
                "hz": modes.omega[k] / (2.0 * std::f64::consts::PI),
                "zeta": finite(modes.zeta[k]),
                "residual": finite(modes.residual[k]),
                "origin": modes.origin[k].name(),
            })
        })
        .collect();
    json!({
        "dofs": modes.dofs.len(),
        "rigid": modes.rigid,
        "modes": listed,
        "complete": modes.complete,
        "orthogonality": modes.orthogonality,
        "shift": modes.shift,
        "warnings": modes.warnings,
    })
}

/// "Time: ordering 0.02 s, …".
fn stages_words(report: &SolveReport) -> String {
    let stages: Vec<String> = report.stages.iter().map(|s| format!("{} {:.2} s", s.name, s.wall_s)).collect();
    format!("Time: {}.", stages.join(", "))
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let (modes, report, mass) = match (&arguments.model, arguments.matrices.files()) {
        (Some(model), _) => {
            let analysed = analyse(&model_file(model)?, arguments.count, progress)?;
            (analysed.modes, analysed.solve_report, RigidBody::of(&analysed.fe).map(|b| b.mass))
        }
        (None, Some(files)) => {
            let fe = read_fe_model(&files, progress)?;
            let options = ModalOptions { count: arguments.count.unwrap_or(50), shift: arguments.shift };
            let (modes, report) = solve_with_report(&fe, &options, progress)?;
            (modes, report, RigidBody::of(&fe).map(|b| b.mass))
        }
        (None, None) => return Err(PipelineError::Request("name a model, or --stiffness and --mass".into())),
    };
    let table = modes_table(&modes, &[], mass);
    let text = format!("{}\n{}\n", table.text(), stages_words(&report));
    let mut json = modes_json(&modes);
    json["stages"] = json!(report.stages);
    json["digits"] = json!(report.digits);
    Ok(Outcome::new(json, text).warn(modes.warnings.iter().cloned()))
}
