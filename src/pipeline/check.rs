//! The check: what came out now against what was committed or named.

use super::PipelineError;
use crate::format::read_reduced;
use crate::model::{ModeNo, ReducedModel, Selection};
use nalgebra::DMatrix;
use std::path::Path;

/// What is expected.
#[derive(Clone, Debug)]
pub struct Expected {
    /// Modes that must be selected; `None` takes those of `model`.
    pub modes: Option<Vec<ModeNo>>,
    /// A reduced model to compare frequencies and shapes with.
    pub model: Option<ReducedModel>,
    /// Where the expectation comes from, in words.
    pub origin: String,
    /// Largest relative difference of a frequency.
    pub frequency_tolerance: f64,
    /// Least MAC.
    pub least_mac: f64,
}

/// One compared quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// "selection", "mode 7 frequency", "mode 7 MAC".
    pub what: String,
    /// Expected value in words.
    pub expected: String,
    /// Found value in words.
    pub found: String,
    /// How far, and how far it may be.
    pub change: String,
}

/// Outcome of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// True without differences.
    pub ok: bool,
    /// Expected modes.
    pub expected: Vec<ModeNo>,
    /// Found modes.
    pub found: Vec<ModeNo>,
    /// Where the expectation came from.
    pub origin: String,
    /// What differs beyond tolerance.
    pub differences: Vec<Difference>,
    /// Things to know that are no failure, such as a changed source file.
    pub notes: Vec<String>,
    /// Largest relative frequency difference over common modes; `None` without a model to compare.
    pub worst_frequency: Option<f64>,
    /// Least MAC over common modes.
    pub worst_mac: Option<f64>,
}

/// The committed reduced model, if the file is there.
pub fn committed(output: &Path) -> Result<Option<ReducedModel>, PipelineError> {
    if output.is_file() { Ok(Some(read_reduced(output)?)) } else { Ok(None) }
}

/// Compares a model with what is expected of it.
pub fn check(found: &ReducedModel, expected: &Expected) -> Check {
    let numbers = |m: &ReducedModel| m.modes.iter().map(|k| k.number).collect::<Vec<_>>();
    let have = numbers(found);
    let want = expected.modes.clone().or_else(|| expected.model.as_ref().map(numbers)).unwrap_or_else(|| have.clone());
    let mut differences = Vec::new();
    let mut notes = Vec::new();
    if want != have {
        let listed = |modes: Vec<ModeNo>| Selection { modes, reason: String::new(), warnings: Vec::new() }.ranges();
        let missing: Vec<ModeNo> = want.iter().copied().filter(|m| !have.contains(m)).collect();
        let added: Vec<ModeNo> = have.iter().copied().filter(|m| !want.contains(m)).collect();
        let mut change = Vec::new();
        if !missing.is_empty() {
            change.push(format!("no longer kept: {}", listed(missing)));
        }
        if !added.is_empty() {
            let scores: Vec<String> = added
                .iter()
                .filter_map(|m| found.ranking.scores.iter().find(|s| s.mode == *m))
                .map(|s| format!("{} scores {:.2e}", s.mode, s.relative))
                .collect();
            change.push(format!("kept beyond it: {} ({})", listed(added), scores.join(", ")));
        }
        differences.push(Difference {
            what: "selection".into(),
            expected: listed(want.clone()),
            found: listed(have.clone()),
            change: change.join("; "),
        });
    }
    let (mut worst_frequency, mut worst_mac) = (None, None);
    if let Some(model) = &expected.model {
        let common: Vec<ModeNo> = numbers(model).into_iter().filter(|m| have.contains(m)).collect();
        let (mut worst_df, mut least) = (0.0_f64, 1.0_f64);
        for number in &common {
            let column = |m: &ReducedModel| m.modes.iter().position(|k| k.number == *number).unwrap_or(0);
            let (old, new) = (&model.modes[column(model)], &found.modes[column(found)]);
            let df = (new.omega - old.omega) / old.omega;
            worst_df = worst_df.max(df.abs());
            if df.abs() > expected.frequency_tolerance {
                differences.push(Difference {
                    what: format!("mode {number} frequency"),
                    expected: format!("{:.6} rad/s", old.omega),
                    found: format!("{:.6} rad/s", new.omega),
                    change: format!("{df:+.2e}, allowed ±{:.0e}", expected.frequency_tolerance),
                });
            }
        }
        match common_rows(model, found) {
            Err(why) => notes.push(why),
            Ok((old_rows, new_rows)) => {
                for number in &common {
                    let mac = subspace_mac(model, &old_rows, found, &new_rows, *number);
                    least = least.min(mac);
                    if mac < expected.least_mac {
                        differences.push(Difference {
                            what: format!("mode {number} MAC"),
                            expected: format!("≥ {}", expected.least_mac),
                            found: format!("{mac:.6}"),
                            change: "the shape at the kept nodes changed".into(),
                        });
                    }
                }
                worst_mac = Some(least);
            }
        }
        worst_frequency = Some(worst_df);
        for source in &model.sources {
            match found.sources.iter().find(|s| s.role == source.role) {
                Some(now) if now.sha256 == source.sha256 => {}
                Some(now) => notes
                    .push(format!("{} file {} is not the one it was made from (SHA-256 differs)", now.role, now.path)),
                None => notes.push(format!("{} file {} is no longer used", source.role, source.path)),
            }
        }
        if model.recipe != found.recipe {
            notes.push("the recipe (model.toml) has changed since".into());
        }
    }
    Check {
        ok: differences.is_empty(),
        expected: want,
        found: have,
        origin: expected.origin.clone(),
        differences,
        notes,
        worst_frequency,
        worst_mac,
    }
}

/// Rows of the translations both models keep, by node name and direction.
fn common_rows(a: &ReducedModel, b: &ReducedModel) -> Result<(Vec<usize>, Vec<usize>), String> {
    let (mut in_a, mut in_b) = (Vec::new(), Vec::new());
    for (row, dof) in a.dofs.iter().enumerate().filter(|d| !d.1.axis.is_rotation()) {
        if let Some(other) = b.node(&a.nodes[dof.node].name).and_then(|n| b.row(n, dof.axis)) {
            in_a.push(row);
            in_b.push(other);
        }
    }
    if in_a.is_empty() { Err("no common node to compare shapes at".into()) } else { Ok((in_a, in_b)) }
}

/// Modes closer than this (relative) are a repeated root, whose shapes are arbitrary within it.
const CLUSTER: f64 = 1e-4;

/// MAC of a new shape with the span of the old shapes of the same (possibly repeated) root: the
/// squared cosine of the angle between them. For a single root this is the usual MAC
/// |φᵀψ|²/(φᵀφ·ψᵀψ) (Allemang and Brown 1982).
fn subspace_mac(old: &ReducedModel, old_rows: &[usize], new: &ReducedModel, new_rows: &[usize], number: ModeNo) -> f64 {
    let Some(column) = new.modes.iter().position(|k| k.number == number) else { return 0.0 };
    let omega = new.modes[column].omega;
    let cluster: Vec<usize> = (0..old.modes.len())
        .filter(|&c| old.modes[c].number == number || (old.modes[c].omega - omega).abs() <= CLUSTER * omega)
        .collect();
    let psi = DMatrix::from_fn(new_rows.len(), 1, |r, _| new.shapes[(new_rows[r], column)]);
    let phi = DMatrix::from_fn(old_rows.len(), cluster.len(), |r, c| old.shapes[(old_rows[r], cluster[c])]);
    let size = psi.norm_squared();
    if size == 0.0 || phi.norm() == 0.0 {
        return f64::from(u8::from(size == 0.0 && phi.norm() == 0.0));
    }
    let q = phi.qr().q();
    (q.transpose() * psi).norm_squared() / size
}
