//! The readable summary beside a reduced model: reduced/NAME.toml, made to be read in a diff.
//!
//! Numbers carry as many digits as mean something: frequencies 11 (compared at 1e-9), damping 9,
//! scores 4; a score below 1e-9 of the largest is rounding noise and written as 0.

use super::error::FormatError;
use super::input::sha256;
use super::toml_file::parse_toml;
use crate::model::{ModeNo, NodeId, Origin, ReducedModel, Role, Source};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::Path;

/// What a summary says; see the fields of [`ReducedModel`] for meanings and units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Summary {
    /// Name of the model.
    pub name: String,
    /// "ferrom 0.1.0".
    pub tool: String,
    /// Degrees of freedom of the full model.
    pub full_dofs: usize,
    /// Degrees of freedom kept.
    pub kept_dofs: usize,
    /// Residual vectors kept; 0 without residual flexibility.
    pub residual_vectors: usize,
    /// SHA-256 of the recipe's text.
    pub recipe_sha256: String,
    /// The kept modes and why.
    pub selection: SummarySelection,
    /// Mass, centre, inertia.
    pub rigid: SummaryRigid,
    /// Kept modes, ascending.
    #[serde(default)]
    pub modes: Vec<SummaryMode>,
    /// Scores of all ranked modes, kept or not.
    #[serde(default)]
    pub scores: Vec<SummaryScore>,
    /// Kept nodes.
    #[serde(default)]
    pub nodes: Vec<SummaryNode>,
    /// Files it was made from.
    #[serde(default)]
    pub sources: Vec<Source>,
}

/// The selection in a summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SummarySelection {
    /// "7-17".
    pub modes: String,
    /// The rule in words.
    pub reason: String,
    /// What the rule does not protect against.
    pub warnings: Vec<String>,
    /// "peak-gain".
    pub criterion: String,
    /// "d:z".
    pub input: String,
    /// "d:z".
    pub output: String,
    /// Unit of the scores.
    pub unit: String,
}

/// Mass properties in a summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SummaryRigid {
    /// Rigid modes.
    pub modes: usize,
    /// kg.
    pub mass: f64,
    /// m.
    pub centre: [f64; 3],
    /// xx yy zz xy xz yz about the centre, kg·m².
    pub inertia: [f64; 6],
}

/// A kept mode in a summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SummaryMode {
    /// Number in the full analysis.
    pub number: ModeNo,
    /// rad/s.
    pub omega: f64,
    /// Hz.
    pub hz: f64,
    /// Damping ratio.
    pub zeta: f64,
    /// Where it came from.
    pub origin: Origin,
}

/// A score in a summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SummaryScore {
    /// The mode.
    pub mode: ModeNo,
    /// In the criterion's unit.
    pub score: f64,
    /// Relative to the largest.
    pub relative: f64,
    /// Whether it was kept.
    pub kept: bool,
}

/// A kept node in a summary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SummaryNode {
    /// Name in the recipe.
    pub name: String,
    /// Joint or measured.
    pub role: Role,
    /// m.
    pub position: [f64; 3],
    /// FE labels: "2852" or "2841-2868".
    pub labels: String,
    /// Kept directions: "x y z rx ry rz".
    pub axes: String,
}

/// Reads a summary.
pub fn read_summary(path: &Path) -> Result<Summary, FormatError> {
    parse_toml(path).map(|(summary, _)| summary)
}

/// The summary of a reduced model; the same model gives the same text.
pub fn summary_to_text(model: &ReducedModel) -> String {
    let mut text = format!(
        "# What `ferrom reduce` chose for {}. Written by the program; `ferrom check` compares with it.\n",
        model.name.replace(['\n', '\r'], " ")
    );
    let out = &mut text;
    line(out, "name", &quoted(&model.name));
    line(out, "tool", &quoted(&model.tool));
    line(out, "full-dofs", &model.full_dofs.to_string());
    line(out, "kept-dofs", &model.dofs.len().to_string());
    line(out, "residual-vectors", &model.residual.as_ref().map_or(0, |r| r.omega.len()).to_string());
    line(out, "recipe-sha256", &quoted(&sha256(model.recipe.as_bytes())));

    out.push('\n');
    line(out, "selection.modes", &quoted(&model.selection.ranges()));
    line(out, "selection.reason", &quoted(&model.selection.reason));
    let warnings: Vec<String> = model.selection.warnings.iter().map(|w| quoted(w)).collect();
    line(out, "selection.warnings", &format!("[{}]", warnings.join(", ")));
    line(out, "selection.criterion", &quoted(&model.ranking.criterion));
    line(out, "selection.input", &quoted(&model.ranking.input));
    line(out, "selection.output", &quoted(&model.ranking.output));
    line(out, "selection.unit", &quoted(&model.ranking.unit));

    let body = &model.rigid.body;
    let i = &body.inertia;
    let inertia = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
    *out += "\n# kg, m, kg*m2 (xx yy zz xy xz yz about the centre)\n";
    line(out, "rigid.modes", &model.rigid.shapes.ncols().to_string());
    line(out, "rigid.mass", &digits(body.mass, 9));
    line(out, "rigid.centre", &list(&rounded(&body.centre)));
    line(out, "rigid.inertia", &list(&rounded(&inertia)));

    table(
        out,
        "modes",
        " # rad/s, Hz",
        model.modes.iter().map(|m| {
            let hz = m.omega / std::f64::consts::TAU;
            format!(
                "number = {}, omega = {}, hz = {}, zeta = {}, origin = \"{}\"",
                m.number,
                digits(m.omega, 11),
                digits(hz, 7),
                digits(m.zeta, 9),
                m.origin.name()
            )
        }),
    );
    table(
        out,
        "scores",
        " # of all ranked modes",
        model.ranking.scores.iter().map(|s| {
            let noise = s.relative.abs() < 1e-9;
            let (score, relative) = if noise { (0.0, 0.0) } else { (s.score, s.relative) };
            let kept = model.selection.modes.contains(&s.mode);
            format!(
                "mode = {}, score = {}, relative = {}, kept = {kept}",
                s.mode,
                digits(score, 4),
                digits(relative, 4)
            )
        }),
    );
    table(
        out,
        "nodes",
        " # m",
        model.nodes.iter().enumerate().map(|(k, n)| {
            let axes: Vec<&str> = model.dofs.iter().filter(|d| d.node == k).map(|d| d.axis.name()).collect();
            format!(
                "name = {}, role = \"{}\", position = {}, labels = \"{}\", axes = \"{}\"",
                quoted(&n.name),
                n.role.name(),
                list(&rounded(&n.position)),
                label_ranges(&n.labels),
                axes.join(" ")
            )
        }),
    );
    table(
        out,
        "sources",
        "",
        model
            .sources
            .iter()
            .map(|s| format!("role = {}, path = {}, sha256 = {}", quoted(&s.role), quoted(&s.path), quoted(&s.sha256))),
    );
    text
}

fn line(out: &mut String, key: &str, value: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{key} = {value}");
}

/// An array of inline tables, one per line, so that a diff shows what changed.
fn table(out: &mut String, key: &str, note: &str, rows: impl Iterator<Item = String>) {
    let _ = writeln!(out, "\n{key} = [{note}");
    for row in rows {
        let _ = writeln!(out, "  {{ {row} }},");
    }
    *out += "]\n";
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn list(values: &[String]) -> String {
    format!("[{}]", values.join(", "))
}

/// Components of one vector, none finer than 1e-9 of the largest: the rest is rounding noise.
fn rounded(values: &[f64]) -> Vec<String> {
    let largest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    values.iter().map(|&v| if v.abs() < 1e-9 * largest { "0.0".to_owned() } else { digits(v, 9) }).collect()
}

/// A number with so many significant digits, as TOML writes it.
fn digits(value: f64, significant: usize) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            "nan".into()
        } else if value > 0.0 {
            "inf".into()
        } else {
            "-inf".into()
        };
    }
    let scientific = format!("{value:.*e}", significant - 1);
    let short: f64 = scientific.parse().unwrap_or(value);
    if short == 0.0 || (1e-4..1e7).contains(&short.abs()) { format!("{short:?}") } else { format!("{short:e}") }
}

/// "2841-2868" or "12, 14-16".
pub(super) fn label_ranges(labels: &[NodeId]) -> String {
    let mut sorted: Vec<u32> = labels.iter().map(|l| l.0).collect();
    sorted.sort_unstable();
    let runs = sorted.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let text: Vec<String> = runs
        .map(|run| if run.len() == 1 { run[0].to_string() } else { format!("{}-{}", run[0], run[run.len() - 1]) })
        .collect();
    text.join(", ")
}
