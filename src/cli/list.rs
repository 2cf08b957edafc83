//! `ferrom list`: everything that goes by a name, from the tables themselves.

use super::output::Outcome;
use crate::format::FORMATS;
use crate::modal::DAMPING_PRESETS;
use crate::pipeline::PipelineError;
use crate::rank::{CRITERIA, RULES};
use crate::reduce::METHODS;
use crate::report::{Cell, Column, Table};
use crate::simulate::{EFFECTS, FORMULATIONS, INTEGRATORS, PRESETS};
use clap::Args;
use serde_json::{Map, Value, json};

#[derive(Debug, Args)]
#[command(after_help = "Example: ferrom list effects")]
pub(super) struct Arguments {
    /// One table only: formats, criteria, rules, methods, damping, effects, joints, formulations, integrators
    table: Option<String>,
}

type Rows = Vec<(String, String)>;

fn tables() -> Vec<(&'static str, Rows)> {
    let rows = |pairs: &mut dyn Iterator<Item = (&str, &str)>| -> Rows {
        pairs.map(|(n, h)| (n.to_string(), h.to_string())).collect()
    };
    vec![
        ("formats", rows(&mut FORMATS.iter().map(|f| (f.name, f.help)))),
        ("criteria", rows(&mut CRITERIA.iter().map(|c| (c.name, c.help)))),
        ("rules", rows(&mut RULES.iter().copied())),
        ("methods", rows(&mut METHODS.iter().map(|m| (m.name, m.help)))),
        ("damping", rows(&mut DAMPING_PRESETS.iter().map(|p| (p.0, p.2)))),
        ("effects", rows(&mut EFFECTS.iter().map(|e| (e.name, e.help)))),
        ("joints", rows(&mut PRESETS.iter().map(|p| (p.name, p.help)))),
        ("formulations", rows(&mut FORMULATIONS.iter().map(|f| (f.name, f.help)))),
        (
            "integrators",
            INTEGRATORS.iter().map(|i| (i.name.to_string(), format!("order {}: {}", i.order, i.help))).collect(),
        ),
    ]
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, PipelineError> {
    let mut all = tables();
    if let Some(wanted) = &arguments.table {
        let known = all.iter().map(|t| t.0).collect::<Vec<_>>().join(", ");
        all.retain(|t| t.0 == wanted);
        if all.is_empty() {
            return Err(PipelineError::Request(format!("there is no table \"{wanted}\"; the tables are {known}")));
        }
    }
    let mut object = Map::new();
    let mut text = String::new();
    for (name, rows) in all {
        let mut table = Table::new(name, vec![Column::text("name"), Column::text("what")]);
        table.rows = rows.iter().map(|(n, h)| vec![Cell(n.clone()), Cell(h.clone())]).collect();
        text += &table.text();
        text.push('\n');
        let listed: Vec<Value> = rows.into_iter().map(|(name, help)| json!({ "name": name, "help": help })).collect();
        object.insert(name.into(), Value::Array(listed));
    }
    Ok(Outcome::new(Value::Object(object), text))
}
