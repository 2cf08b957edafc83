//! `ferrom modes`: modal analysis of a model or of bare matrices.

use super::output::Outcome;
use crate::format::{FeFiles, FileUnits, read_fe_model};
use crate::modal::{ModalOptions, solve};
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
    /// Stiffness matrix (instead of a model)
    #[arg(long, requires = "mass", value_name = "FILE")]
    stiffness: Option<PathBuf>,
    /// Mass matrix
    #[arg(long, requires = "stiffness", value_name = "FILE")]
    mass: Option<PathBuf>,
    /// Dof list of the matrices
    #[arg(long, requires = "stiffness", value_name = "FILE")]
    dofs: Option<PathBuf>,
    /// Mesh with node positions
    #[arg(long, requires = "dofs", value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Shift of the eigen-solution, (rad/s)², negative (default: found automatically)
    #[arg(long, value_name = "SIGMA", allow_hyphen_values = true)]
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

/// "complete: …" in words.
pub(super) fn completeness_words(modes: &Modes) -> String {
    let c = &modes.complete;
    if c.proved {
        format!("No mode below {:.6} rad/s is missing: inertia counts {} (Sturm).", c.below, c.count)
    } else {
        format!("Not proved that no mode below {:.6} rad/s is missing.", c.below)
    }
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let (modes, mass) = match (&arguments.model, &arguments.stiffness, &arguments.mass) {
        (Some(model), _, _) => {
            let analysed = analyse(&model_file(model)?, arguments.count, progress)?;
            (analysed.modes, RigidBody::of(&analysed.fe).map(|b| b.mass))
        }
        (None, Some(stiffness), Some(mass)) => {
            let files = FeFiles {
                name: "matrices".into(),
                stiffness: stiffness.clone(),
                mass: mass.clone(),
                dofs: arguments.dofs.clone(),
                mesh: arguments.mesh.clone(),
                units: FileUnits::default(),
            };
            let fe = read_fe_model(&files, progress)?;
            let options = ModalOptions { count: arguments.count.unwrap_or(50), shift: arguments.shift };
            (solve(&fe, &options, progress)?, RigidBody::of(&fe).map(|b| b.mass))
        }
        _ => return Err(PipelineError::Request("name a model, or --stiffness and --mass".into())),
    };
    let table = modes_table(&modes, &[], mass);
    let text = format!("{}\n{}\n", table.text(), completeness_words(&modes));
    Ok(Outcome::new(modes_json(&modes), text).warn(modes.warnings.iter().cloned()))
}
