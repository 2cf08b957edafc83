//! `ferrom check`: the CI gate.

use super::CHECK_FAILED;
use super::output::Outcome;
use crate::format::read_reduced;
use crate::model::{Progress, Selection};
use crate::pipeline::{Check, Expected, PipelineError, analyse, build, check, committed, model_file};
use crate::report::{Cell, Column, Table};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ferrom check models/leaf-spring                  against the committed reduced model\n  ferrom check models/leaf-spring --modes 7-17     against named modes as well\n  ferrom check reduced/leaf-spring.h5 --modes 7-17 without remaking it"
)]
pub(super) struct Arguments {
    /// A reduced model (.h5), or a model.toml or its folder: then it is remade first
    model: PathBuf,
    /// Modes that must be selected, such as 7-17
    #[arg(long, value_name = "LIST")]
    modes: Option<String>,
    /// Reduced model to compare with (default: the committed one)
    #[arg(long, value_name = "FILE.h5")]
    against: Option<PathBuf>,
    /// Largest relative difference of a frequency
    #[arg(long, default_value_t = 1e-6, value_name = "R")]
    frequency_tolerance: f64,
    /// Least MAC between old and new shapes at the kept nodes
    #[arg(long, default_value_t = 0.999, value_name = "MAC")]
    least_mac: f64,
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let modes = arguments.modes.as_deref().map(Selection::parse_ranges).transpose().map_err(PipelineError::Request)?;
    let is_reduced = arguments.model.extension().is_some_and(|e| e == "h5");
    let against = arguments.against.as_ref().map(|f| read_reduced(f)).transpose()?;
    let (found, model, origin) = if is_reduced {
        let origin = arguments.against.as_ref().map(|f| f.display().to_string());
        (read_reduced(&arguments.model)?, against, origin)
    } else {
        let built = build(analyse(&model_file(&arguments.model)?, None, progress)?, None, progress)?;
        match (against, &arguments.against) {
            (Some(model), Some(file)) => (built.reduced, Some(model), Some(file.display().to_string())),
            _ => {
                let model = committed(&built.output)?;
                let origin = model.is_some().then(|| built.output.display().to_string());
                (built.reduced, model, origin)
            }
        }
    };
    if modes.is_none() && model.is_none() {
        return Err(PipelineError::Request(format!(
            "{}: nothing to compare with; name --modes 7-17, --against FILE.h5, or commit a reduced model (`ferrom reduce`)",
            arguments.model.display()
        )));
    }
    let named = arguments.modes.as_ref().map(|m| format!("--modes {m}"));
    let expected = Expected {
        modes,
        model,
        origin: [named, origin].into_iter().flatten().collect::<Vec<_>>().join(" and "),
        frequency_tolerance: arguments.frequency_tolerance,
        least_mac: arguments.least_mac,
    };
    let outcome = check(&found, &expected);
    let code = if outcome.ok { 0 } else { CHECK_FAILED };
    Ok(Outcome { json: check_json(&outcome), text: check_text(&outcome), warnings: outcome.notes.clone(), code })
}

/// A check for `--json`.
pub(super) fn check_json(check: &Check) -> Value {
    let differences: Vec<Value> = check
        .differences
        .iter()
        .map(|d| json!({ "what": d.what, "expected": d.expected, "found": d.found, "change": d.change }))
        .collect();
    json!({
        "ok": check.ok,
        "expected": check.expected,
        "found": check.found,
        "against": check.origin,
        "differences": differences,
        "worst_frequency": check.worst_frequency,
        "worst_mac": check.worst_mac,
        "notes": check.notes,
    })
}

/// A check in words: one line when all is well, a table of what changed when not.
pub(super) fn check_text(check: &Check) -> String {
    let range = |modes: &[crate::model::ModeNo]| {
        Selection { modes: modes.to_vec(), reason: String::new(), warnings: Vec::new() }.ranges()
    };
    if check.ok {
        let mut text = format!("Check ok against {}: modes {}", check.origin, range(&check.found));
        if let (Some(df), Some(mac)) = (check.worst_frequency, check.worst_mac) {
            text += &format!(", frequencies within {df:.1e}, MAC ≥ {mac:.6}");
        }
        return text + "\n";
    }
    let columns = ["what", "expected", "found", "change"].map(Column::text).to_vec();
    let mut table = Table::new(&format!("Check FAILED against {}", check.origin), columns);
    table.rows = check
        .differences
        .iter()
        .map(|d| [&d.what, &d.expected, &d.found, &d.change].map(|t| Cell(t.clone())).to_vec())
        .collect();
    table.text()
}
