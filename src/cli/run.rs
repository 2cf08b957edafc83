//! `ferrom run`: the whole pipeline of a project folder.

use super::CHECK_FAILED;
use super::check::{check_json, check_text};
use super::modes::modes_json;
use super::output::Outcome;
use super::rank::{picture_of, ranking_json};
use super::reduce::selection_text;
use super::simulate::{trajectory_json, trajectory_text};
use crate::format::{trajectory_to_csv, write_atomically};
use crate::model::{Channel, Progress, RigidBody, Trajectory};
use crate::pipeline::{
    Built, Check, Expected, Loaded, PipelineError, analyse, build, check, committed, load_scene, model_file,
    scene_files, summary_file, write,
};
use crate::rank::Rule;
use crate::report::plot::{Picture, PlotError};
use crate::report::{
    Compared, Figure, Page, Reference as Overlay, Section, Table, channels_table, comparison_table, energy_table,
    history_plot, modes_table, ranking_plot, ranking_table, receptance_plot,
};
use crate::simulate::simulate;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, Args)]
#[command(after_help = "Example: ferrom run models/leaf-spring")]
pub(super) struct Arguments {
    /// Project folder (or its model.toml); every other .toml in it is a scene
    project: PathBuf,
    /// Folder of the report (default: report/ in the project folder)
    #[arg(long, value_name = "FOLDER")]
    report: Option<PathBuf>,
}

/// A scene that was run.
struct Ran {
    /// "drop-3mps".
    stem: String,
    loaded: Loaded,
    trajectory: Trajectory,
    comparisons: Vec<Table>,
    pictures: Vec<(String, Picture)>,
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let begun = Instant::now();
    let file = model_file(&arguments.project)?;
    let folder = file.parent().unwrap_or(Path::new(".")).to_path_buf();
    let report = arguments.report.clone().unwrap_or_else(|| folder.join("report"));
    let built = build(analyse(&file, None, progress)?, None, progress)?;
    let (checked, bytes, written) = keep(&built)?;
    let mut scenes = Vec::new();
    for scene in scene_files(&file)? {
        scenes.push(run_scene(&scene, progress)?);
    }
    let tables = model_tables(&built);
    let plotting = |e: PlotError| PipelineError::Request(format!("{}: {e}", report.display()));
    let mut pictures = Vec::new();
    if !built.ranking.scores.is_empty() {
        let name = &built.analysed.recipe.name;
        let receptance = picture_of(name, &built.analysed.modes, &built.selection, &built.drawn, 3000);
        pictures.push(("receptance".to_string(), receptance_plot(&receptance).map_err(plotting)?));
        let threshold = match built.analysed.recipe.select {
            Rule::LastAbove { threshold } | Rule::EachAbove { threshold } => Some(threshold),
            _ => None,
        };
        if built.ranking.scores.iter().any(|s| s.score > 0.0) {
            let title = format!("{name}: scores of the modes");
            let picture = ranking_plot(&title, &built.ranking, &built.selection, threshold).map_err(plotting)?;
            pictures.push(("ranking".to_string(), picture));
        }
    }
    progress.report("write report", 0, 0);
    let mut text = String::new();
    for table in &tables {
        text += &format!("{}\n", table.text());
    }
    text += &selection_text(&built.selection);
    text += &written;
    text += &check_text(&checked);
    for scene in &scenes {
        text += &format!("\n{}", trajectory_text(&scene.trajectory));
        for table in &scene.comparisons {
            text += &format!("\n{}", table.text());
        }
    }
    let files = write_report(&report, &built, &checked, &tables, &pictures, &scenes)?;
    let wall = begun.elapsed().as_secs_f64();
    let stages: Vec<String> = built.analysed.timings.iter().map(|t| format!("{} {:.2} s", t.stage, t.wall_s)).collect();
    text += &format!("\nReport: {}\nTime: {}; everything {wall:.2} s\n", files[0], stages.join(", "));
    let mut warnings: Vec<String> = built.analysed.modes.warnings.clone();
    warnings.extend(built.selection.warnings.iter().cloned());
    warnings.extend(checked.notes.iter().cloned());
    for scene in &scenes {
        warnings.extend(scene.trajectory.warnings.iter().map(|w| format!("{}: {w}", scene.stem)));
    }
    let timings: Vec<Value> =
        built.analysed.timings.iter().map(|t| json!({ "stage": t.stage, "wall_s": t.wall_s })).collect();
    let scenes_json: serde_json::Map<String, Value> =
        scenes.iter().map(|s| (s.stem.clone(), trajectory_json(&s.trajectory))).collect();
    let json = json!({
        "reduced": {
            "file": built.output.display().to_string(),
            "bytes": bytes,
            "selected": built.selection.modes,
            "kept_dofs": built.reduced.dofs.len(),
            "full_dofs": built.reduced.full_dofs,
            "ranking": ranking_json(&built.ranking, &built.selection),
            "analysis": modes_json(&built.analysed.modes),
        },
        "check": check_json(&checked),
        "scenes": scenes_json,
        "report": { "folder": report.display().to_string(), "files": files },
        "timings": timings,
        "wall_s": wall,
    });
    let code = if checked.ok { 0 } else { CHECK_FAILED };
    Ok(Outcome { json, text, warnings, code })
}

/// Compares with the committed model and writes where that is right: nothing is there, or the recipe
/// or a source file has changed. With the same recipe and sources a committed model that agrees is
/// left alone to the bit, and one that does not agree is a failed check and is left alone too.
fn keep(built: &Built) -> Result<(Check, u64, String), PipelineError> {
    let output = &built.output;
    let state_space = built.analysed.recipe.reduce.state_space;
    let shown = output.display();
    let old = committed(output)?;
    let same_input = old.as_ref().is_some_and(|m| {
        m.recipe == built.reduced.recipe && m.sources == built.reduced.sources && summary_file(output).is_file()
    });
    let since = old.as_ref().filter(|_| !same_input).map(|m| {
        let before = Expected {
            modes: None,
            model: Some(m.clone()),
            origin: shown.to_string(),
            frequency_tolerance: 1e-6,
            least_mac: 0.999,
        };
        check(&built.reduced, &before)
    });
    let expected = Expected {
        modes: None,
        model: if same_input { old } else { None },
        origin: if same_input { shown.to_string() } else { "itself (newly written)".into() },
        frequency_tolerance: 1e-6,
        least_mac: 0.999,
    };
    let mut outcome = check(&built.reduced, &expected);
    for change in since.iter().flat_map(|c| &c.differences) {
        outcome.notes.push(format!(
            "{} was {} and is {} since recipe or sources changed ({})",
            change.what, change.expected, change.found, change.change
        ));
    }
    if same_input {
        let bytes = std::fs::metadata(output).map_or(0, |m| m.len());
        let state = if outcome.ok { "is up to date" } else { "is kept as it was" };
        return Ok((outcome, bytes, format!("Reduced model {shown} ({:.1} kB) {state}.\n", bytes as f64 / 1e3)));
    }
    let bytes = write(&built.reduced, output, state_space)?;
    Ok((outcome, bytes, format!("Reduced model written: {shown} ({:.1} kB).\n", bytes as f64 / 1e3)))
}

fn run_scene(file: &Path, progress: &dyn Progress) -> Result<Ran, PipelineError> {
    let loaded = load_scene(file)?;
    let system = loaded.assemble()?;
    let trajectory = simulate(&system, progress).map_err(|e| loaded.located(e))?;
    let stem = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let comparisons = comparisons(&loaded, &trajectory);
    let mut pictures = Vec::new();
    if trajectory.energy.is_some() {
        for (k, channel) in trajectory.channels.iter().enumerate() {
            let mut overlays = Vec::new();
            for reference in loaded.scene.reference.iter().filter(|r| r.channel.get_ref() == &channel.name) {
                let si = |values: &[crate::quantity::Quantity<crate::quantity::Length>]| -> Vec<f64> {
                    values.iter().map(|v| v.si).collect()
                };
                let ours = &channel.extremes;
                overlays.push(Overlay::at_turning_points(&reference.name, &si(&reference.values), ours));
                if let Some(other) = &reference.other {
                    overlays.push(Overlay::at_turning_points(&other.name, &si(&other.values), ours));
                }
            }
            // One picture for the first channel and for every one with a reference.
            if k == 0 || !overlays.is_empty() {
                let picture = history_plot(&trajectory.scene, &trajectory, channel, &overlays)
                    .map_err(|e| PipelineError::Request(format!("{}: {e}", file.display())))?;
                pictures.push((format!("{stem}-{}", slug(&channel.name)), picture));
            }
        }
    }
    Ok(Ran { stem, loaded, trajectory, comparisons, pictures })
}

/// A channel's name as part of a file name.
fn slug(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect()
}

/// One table per reference of the scene: extremes of a transient, cases of a static analysis.
fn comparisons(loaded: &Loaded, trajectory: &Trajectory) -> Vec<Table> {
    loaded
        .scene
        .reference
        .iter()
        .filter_map(|reference| {
            let channel: &Channel = trajectory.channel(reference.channel.get_ref())?;
            let transient = trajectory.energy.is_some();
            let ours: Vec<f64> =
                if transient { channel.extremes.iter().map(|e| e.value).collect() } else { channel.values.clone() };
            let rows: Vec<Compared> = reference
                .values
                .iter()
                .enumerate()
                .map(|(k, value)| Compared {
                    name: format!("{} {}", if transient { "extreme" } else { "case" }, k + 1),
                    unit: "mm".into(),
                    ours: ours.get(k).map_or(f64::NAN, |v| v * 1e3),
                    reference: value.si * 1e3,
                    other: reference.other.as_ref().and_then(|o| o.values.get(k)).map(|v| v.si * 1e3),
                })
                .collect();
            let other = reference.other.as_ref().map_or("", |o| o.name.as_str());
            let title = format!("{}: {} beside {}", trajectory.scene, channel.name, reference.name);
            Some(comparison_table(&title, &reference.name, other, &rows))
        })
        .collect()
}

fn model_tables(built: &Built) -> Vec<Table> {
    let modes = &built.analysed.modes;
    let mass = RigidBody::of(&built.analysed.fe).map(|b| b.mass);
    let mut tables =
        vec![modes_table(modes, &built.selection.modes, mass), ranking_table(&built.ranking, &built.selection)];
    for reference in &built.analysed.recipe.reference {
        let rows: Vec<Compared> = reference
            .omega
            .iter()
            .map(|(number, value)| Compared {
                name: format!("mode {number}"),
                unit: "rad/s".into(),
                ours: modes.omega.get((*number as usize).wrapping_sub(1)).copied().unwrap_or(f64::NAN),
                reference: value.si,
                other: None,
            })
            .collect();
        tables.push(comparison_table(&format!("Frequencies beside {}", reference.name), &reference.name, "", &rows));
    }
    tables
}

/// Writes pictures, channels and the page; returns the paths, the page first.
fn write_report(
    folder: &Path,
    built: &Built,
    checked: &Check,
    tables: &[Table],
    pictures: &[(String, Picture)],
    scenes: &[Ran],
) -> Result<Vec<String>, PipelineError> {
    let mut files = Vec::new();
    let mut save = |name: String, bytes: &[u8]| -> Result<(), PipelineError> {
        let path = folder.join(name);
        write_atomically(&path, bytes)?;
        files.push(path.display().to_string());
        Ok(())
    };
    let recipe = &built.analysed.recipe;
    let figures = |pictures: &[(String, Picture)]| -> Vec<Figure> {
        pictures.iter().map(|(name, picture)| Figure::new(picture, &name.replace('-', " "))).collect()
    };
    let mut sections = vec![Section {
        heading: "Modes and selection".into(),
        paragraphs: vec![selection_text(&built.selection), check_text(checked)],
        tables: tables.to_vec(),
        pictures: figures(pictures),
    }];
    for scene in scenes {
        let mut shown = scene.comparisons.clone();
        shown.push(channels_table(&scene.trajectory));
        if let Some(energy) = &scene.trajectory.energy {
            shown.push(energy_table(energy));
        }
        let mut paragraphs = vec![format!("Effects: {}.", scene.trajectory.effects.join(", "))];
        if !scene.loaded.scene.about.is_empty() {
            paragraphs.insert(0, scene.loaded.scene.about.clone());
        }
        paragraphs.extend(scene.trajectory.warnings.iter().map(|w| format!("Note: {w}.")));
        sections.push(Section {
            heading: scene.trajectory.scene.clone(),
            paragraphs,
            tables: shown,
            pictures: figures(&scene.pictures),
        });
    }
    let page = Page {
        title: recipe.name.clone(),
        lead: vec![recipe.about.clone()],
        sections,
        sources: built.reduced.sources.clone(),
        tool: built.reduced.tool.clone(),
    };
    save("index.html".into(), page.html().as_bytes())?;
    for (name, picture) in pictures.iter().chain(scenes.iter().flat_map(|s| &s.pictures)) {
        save(format!("{name}.svg"), picture.svg.as_bytes())?;
        save(format!("{name}.png"), &picture.png)?;
    }
    for scene in scenes {
        save(format!("{}.csv", scene.stem), trajectory_to_csv(&scene.trajectory).as_bytes())?;
    }
    Ok(files)
}
