//! `ferrom simulate`: one scene.

use super::output::Outcome;
use crate::format::{trajectory_to_csv, trajectory_to_h5, write_atomically};
use crate::model::{Progress, Trajectory};
use crate::pipeline::{Loaded, PipelineError, load_scene};
use crate::quantity::{Kind, Time, parse};
use crate::report::{channels_table, energy_table};
use crate::simulate::{EFFECTS, FORMULATIONS, FlexibilityTable, simulate};
use clap::Args;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use toml::Spanned;

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ferrom simulate models/leaf-spring/drop-3mps.toml\n  ferrom simulate models/leaf-spring/drop-3mps.toml --step \"0.1 ms\" --with residual-flexibility -o drop.csv"
)]
pub(super) struct Arguments {
    /// Scene file
    scene: PathBuf,
    /// Write the channels over time (.h5 or .csv)
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Step instead of the scene's, such as "0.1 ms"
    #[arg(long, value_name = "TIME")]
    step: Option<String>,
    /// End instead of the scene's
    #[arg(long, value_name = "TIME")]
    until: Option<String>,
    /// Formulation instead of the scene's; `ferrom list formulations`
    #[arg(long)]
    formulation: Option<String>,
    /// Elastic modes that take part, such as 7 or 7-13 (default: all kept)
    #[arg(long, value_name = "LIST")]
    modes: Option<String>,
    /// Switch an effect on (repeatable)
    #[arg(long = "with", value_name = "EFFECT")]
    with: Vec<String>,
    /// Switch an effect off (repeatable)
    #[arg(long = "without", value_name = "EFFECT")]
    without: Vec<String>,
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let mut loaded = load_scene(&arguments.scene)?;
    change(&mut loaded, arguments)?;
    let system = loaded.assemble()?;
    let trajectory = simulate(&system, progress).map_err(|e| loaded.located(e))?;
    if let Some(file) = &arguments.output {
        save(&trajectory, file)?;
    }
    let outcome = Outcome::new(trajectory_json(&trajectory), trajectory_text(&trajectory));
    Ok(outcome.warn(trajectory.warnings.clone()))
}

/// Applies the switches of the command line to the scene.
fn change(loaded: &mut Loaded, arguments: &Arguments) -> Result<(), PipelineError> {
    let scene = &mut loaded.scene;
    let time = |option: &str, text: &Option<String>| {
        text.as_ref()
            .map(|t| parse(t, Time::DIMENSION).map_err(|m| PipelineError::Request(format!("--{option}: {m}"))))
            .transpose()
            .map(|t| t.map(|seconds| Spanned::new(0..0, seconds.into())))
    };
    if let Some(step) = time("step", &arguments.step)? {
        scene.run.step = Some(step);
    }
    if let Some(until) = time("until", &arguments.until)? {
        scene.run.until = Some(until);
    }
    if let Some(name) = &arguments.formulation {
        let known = FORMULATIONS.iter().map(|f| f.name).collect::<Vec<_>>().join(", ");
        let found = FORMULATIONS.iter().find(|f| f.name == name).ok_or_else(|| {
            PipelineError::Request(format!("unknown formulation \"{name}\"; the formulations are {known}"))
        })?;
        scene.run.formulation = found.value;
    }
    if let Some(modes) = &arguments.modes {
        scene.effect.flexibility = Some(FlexibilityTable { modes: Some(Spanned::new(0..0, modes.clone())) });
    }
    for (names, on) in [(&arguments.with, true), (&arguments.without, false)] {
        for name in names {
            if !EFFECTS.iter().any(|e| e.name == name) {
                let known = EFFECTS.iter().map(|e| e.name).collect::<Vec<_>>().join(", ");
                return Err(PipelineError::Request(format!("unknown effect \"{name}\"; the effects are {known}")));
            }
            scene.switch(name, on);
        }
    }
    Ok(())
}

fn save(trajectory: &Trajectory, file: &Path) -> Result<(), PipelineError> {
    let bytes = match file.extension().and_then(|e| e.to_str()) {
        Some("csv") => trajectory_to_csv(trajectory).into_bytes(),
        Some("h5") => trajectory_to_h5(trajectory)?,
        _ => return Err(PipelineError::Request(format!("{}: a trajectory is written as .h5 or .csv", file.display()))),
    };
    Ok(write_atomically(file, &bytes)?)
}

/// A trajectory for `--json`: everything but the samples.
pub(super) fn trajectory_json(t: &Trajectory) -> Value {
    let channels: Vec<Value> =
        t.channels.iter().map(|c| json!({ "name": c.name, "unit": c.unit, "datum": c.datum })).collect();
    let by_channel = |value: &dyn Fn(&crate::model::Channel) -> Value| -> Map<String, Value> {
        t.channels.iter().map(|c| (c.name.clone(), value(c))).collect()
    };
    let cases = t.energy.is_none();
    let mut object = json!({
        "scene": t.scene,
        "channels": channels,
        "extremes": by_channel(&|c| json!(c.extremes)),
        "range": by_channel(&|c| json!({ "least": c.range[0], "largest": c.range[1] })),
        "static": by_channel(&|c| if cases { json!(c.values) } else { json!(c.at_rest) }),
        "energy": t.energy,
        "effects": t.effects,
        "stats": t.stats,
        "warnings": t.warnings,
    });
    if let (Some(energy), Some(stated)) = (&t.energy, object.get_mut("energy").and_then(Value::as_object_mut)) {
        for (key, pairs) in [("input", &energy.input), ("stored", &energy.stored), ("dissipated", &energy.dissipated)] {
            let map: Map<String, Value> = pairs.iter().map(|(n, v)| (n.clone(), json!(v))).collect();
            stated.insert(key.into(), Value::Object(map));
        }
    }
    object
}

/// A trajectory in words.
pub(super) fn trajectory_text(t: &Trajectory) -> String {
    let mut text = format!("{}\n  effects: {}\n\n{}", t.scene, t.effects.join(", "), channels_table(t).text());
    if let Some(energy) = &t.energy {
        text += &format!("\n{}", energy_table(energy).text());
        let s = &t.stats;
        text += &format!(
            "\n{} steps of {} ms in {:.2} ms ({:.2} µs a step, {:.0} times real time); {} contact solutions, {} events located\n",
            s.steps,
            s.step_s * 1e3,
            s.wall_s * 1e3,
            s.wall_s / s.steps.max(1) as f64 * 1e6,
            s.real_time_factor,
            s.solves,
            s.events
        );
    }
    text
}
