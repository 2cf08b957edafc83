//! `ferrom rank`: scores of the modes for a transfer path, the selection, and the receptance.

use super::output::Outcome;
use super::reduce::selection_text;
use crate::format::write_atomically;
use crate::frf::{frequency_grid, receptance};
use crate::model::{Modes, Progress, Ranking, Selection};
use crate::pipeline::{PipelineError, analyse, model_file, path_of};
use crate::rank::{CRITERIA, Path as TransferPath, Rule, criterion, rank, select};
use crate::report::{Path as PlotPath, Receptance, ranking_table, receptance_plot};
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Example: ferrom rank models/leaf-spring --input d:z --output d:z --criterion peak-gain --frf zz.csv --plot zz.svg"
)]
pub(super) struct Arguments {
    /// model.toml or its folder
    model: PathBuf,
    /// Where the force acts (default: the recipe's)
    #[arg(long, value_name = "NODE:DIRECTION")]
    input: Option<String>,
    /// Where the displacement is taken (default: the recipe's)
    #[arg(long, value_name = "NODE:DIRECTION")]
    output: Option<String>,
    /// Criterion (default: the recipe's); `ferrom list criteria`
    #[arg(long)]
    criterion: Option<String>,
    /// Modes to compute, rigid ones included
    #[arg(short = 'n', long = "count", value_name = "N")]
    count: Option<usize>,
    /// Relative score threshold of the recipe's rule, instead of the recipe's
    #[arg(long, value_name = "R")]
    threshold: Option<f64>,
    /// Write the receptance of all modes (complex, magnitude, phase) as CSV
    #[arg(long, value_name = "FILE.csv")]
    frf: Option<PathBuf>,
    /// Write the receptance plot, modes marked (.svg or .png)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Frequencies of CSV and plot
    #[arg(long, default_value_t = 2000, value_name = "N")]
    points: usize,
}

/// Ranking and selection for `--json`.
pub(super) fn ranking_json(ranking: &Ranking, selection: &Selection) -> Value {
    json!({
        "criterion": ranking.criterion,
        "input": ranking.input,
        "output": ranking.output,
        "unit": ranking.unit,
        "scores": ranking.scores,
        "selected": selection.modes,
        "reason": selection.reason,
        "warnings": selection.warnings,
    })
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let analysed = analyse(&model_file(&arguments.model)?, arguments.count, progress)?;
    let recipe = &analysed.recipe;
    let from_recipe = arguments.input.is_none() && arguments.output.is_none();
    let end = |given: &Option<String>, recipe: &str| {
        path_of(&analysed, given.as_deref().unwrap_or(recipe)).map_err(PipelineError::Request)
    };
    let mut paths = vec![TransferPath {
        input: end(&arguments.input, recipe.rank.input.get_ref())?,
        output: end(&arguments.output, recipe.rank.output.get_ref())?,
    }];
    if from_recipe {
        for [input, output] in &recipe.rank.also {
            paths.push(TransferPath { input: end(&None, input.get_ref())?, output: end(&None, output.get_ref())? });
        }
    }
    let name = arguments.criterion.as_deref().unwrap_or(recipe.rank.criterion.get_ref());
    let criterion = criterion(name).ok_or_else(|| {
        let known = CRITERIA.iter().map(|c| c.name).collect::<Vec<_>>().join(", ");
        PipelineError::Request(format!("unknown criterion \"{name}\"; the criteria are {known}"))
    })?;
    let rule = match (&recipe.select, arguments.threshold) {
        (Rule::EachAbove { .. }, Some(threshold)) => Rule::EachAbove { threshold },
        (_, Some(threshold)) => Rule::LastAbove { threshold },
        (rule, None) => rule.clone(),
    };
    let ranking = rank(&analysed.modes, criterion, &paths);
    if let Some(score) = ranking.scores.iter().find(|s| !s.score.is_finite()) {
        return Err(PipelineError::Request(format!(
            "{name} of mode {} is not finite: its damping ratio is {}; use --criterion static-gain, or state damping",
            score.mode,
            analysed.modes.zeta[score.mode.column()]
        )));
    }
    let selection = select(&analysed.modes, &ranking, &rule)?;
    if let Some(file) = &arguments.frf {
        write_atomically(file, frf_csv(&analysed.modes, &paths[0], arguments.points).as_bytes())?;
    }
    if let Some(file) = &arguments.plot {
        let picture = receptance_plot(&picture_of(&recipe.name, &analysed.modes, &selection, &paths, arguments.points))
            .map_err(|e| PipelineError::Request(format!("{}: {e}", file.display())))?;
        let bytes = match file.extension().and_then(|e| e.to_str()) {
            Some("svg") => picture.svg.into_bytes(),
            Some("png") => picture.png,
            _ => return Err(PipelineError::Request(format!("{}: a plot is written as .svg or .png", file.display()))),
        };
        write_atomically(file, &bytes)?;
    }
    let text = format!("{}\n{}", ranking_table(&ranking, &selection).text(), selection_text(&selection));
    let warnings = selection.warnings.clone().into_iter().chain(analysed.modes.warnings.clone());
    Ok(Outcome::new(ranking_json(&ranking, &selection), text).warn(warnings))
}

/// The receptance picture of transfer paths.
pub(super) fn picture_of(
    name: &str,
    modes: &Modes,
    selection: &Selection,
    paths: &[TransferPath],
    points: usize,
) -> Receptance {
    let label = |p: &TransferPath| {
        let axis = |e: &crate::rank::PathEnd| e.axis.name().to_uppercase();
        format!("{}-{}", axis(&p.input), axis(&p.output))
    };
    let curves: Vec<PlotPath> = paths
        .iter()
        .map(|p| PlotPath { label: label(p), output: p.output.row.clone(), input: p.input.row.clone() })
        .collect();
    let unit = if paths[0].input.axis.is_rotation() { "m/(N·m)" } else { "m/N" };
    let title = format!("{name}: receptance for a force at {}", paths[0].input.name);
    Receptance::of(&title, unit, modes, selection, &curves, points)
}

fn frf_csv(modes: &Modes, path: &TransferPath, points: usize) -> String {
    let elastic = &modes.omega[modes.rigid..];
    let (first, last) = (elastic.first().copied().unwrap_or(1.0), elastic.last().copied().unwrap_or(10.0));
    let mut csv = String::from("omega_rad_s,freq_hz,real_m_per_N,imag_m_per_N,magnitude_m_per_N,phase_deg\n");
    for omega in frequency_grid(0.3 * first, 1.2 * last, points, elastic) {
        let h = receptance(modes, &path.output.row, &path.input.row, 0..modes.len(), omega);
        let hz = omega / (2.0 * std::f64::consts::PI);
        let _ =
            writeln!(csv, "{omega:e},{hz:e},{:e},{:e},{:e},{:.6}", h.re, h.im, h.magnitude(), h.phase().to_degrees());
    }
    csv
}
