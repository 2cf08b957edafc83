//! Results over time: CSV for spreadsheets, HDF5 for everything else.

use super::error::{Fault, FormatError};
use super::h5::{Tree, refused};
use crate::model::Trajectory;
use hdf5_pure::{AttrValue, FileBuilder};
use std::path::Path;

/// One column of time and one per channel, `name [unit]` in the first line; every number reads back
/// to the same bits. A static analysis has one line, its time empty, with the values at rest.
pub fn trajectory_to_csv(t: &Trajectory) -> String {
    let mut text = String::from("time [s]");
    for channel in &t.channels {
        text.push(',');
        text += &cell(&format!("{} [{}]", channel.name, channel.unit));
    }
    text.push('\n');
    for (k, time) in t.time.iter().enumerate() {
        text += &format!("{time:?}");
        for channel in &t.channels {
            text += &channel.values.get(k).map_or(",".into(), |v| format!(",{v:?}"));
        }
        text.push('\n');
    }
    if t.time.is_empty() {
        for channel in &t.channels {
            text += &channel.at_rest.map_or(",".into(), |v| format!(",{v:?}"));
        }
        text.push('\n');
    }
    text
}

fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// `/time`, `/values` (times × channels), `/channels`, `/extremes`, `/energy`, `/stats`. Wall times
/// are left out, so that the same run gives the same bytes.
pub fn trajectory_to_h5(t: &Trajectory) -> Result<Vec<u8>, FormatError> {
    build(t).map_err(|fault| fault.in_file(Path::new(&format!("{}.h5", t.scene))))
}

fn build(t: &Trajectory) -> Result<Vec<u8>, Fault> {
    let mut file = FileBuilder::new();
    file.set_attr("format", AttrValue::String("ferrom trajectory 1".into()));
    file.set_attr("scene", AttrValue::String(t.scene.clone()));
    let (steps, count) = (t.time.len(), t.channels.len());
    file.create_dataset("time").with_f64_data(&t.time).set_attr("unit", AttrValue::String("s".into()));
    let at = |k: usize, c: usize| t.channels[c].values.get(k).copied().unwrap_or(f64::NAN);
    let values: Vec<f64> = (0..steps).flat_map(|k| (0..count).map(move |c| at(k, c))).collect();
    let data = file.create_dataset("values").with_f64_data(&values).with_shape(&[steps as u64, count as u64]);
    if !values.is_empty() {
        // One channel is read in one go; 4096 steps of it are 32 kB.
        data.with_chunks(&[steps.min(4096) as u64, 1]).with_shuffle().with_deflate(6);
    }

    let mut channels = Tree::new(&mut file, "channels");
    channels.texts("name", &t.channels.iter().map(|c| &c.name).collect::<Vec<_>>());
    channels.texts("unit", &t.channels.iter().map(|c| &c.unit).collect::<Vec<_>>());
    channels.texts("datum", &t.channels.iter().map(|c| &c.datum).collect::<Vec<_>>());
    let at_rest: Vec<f64> = t.channels.iter().map(|c| c.at_rest.unwrap_or(f64::NAN)).collect();
    channels.reals("at_rest", &at_rest, &[count], "");
    let range: Vec<f64> = t.channels.iter().flat_map(|c| c.range).flat_map(|e| [e.t, e.value]).collect();
    channels.reals("range", &range, &[count, 2, 2], "");
    channels.note(
        "about",
        "range[c] = [[time, value] of the smallest, [time, value] of the largest]; at_rest is NaN without equilibrium",
    );
    file.add_group(channels.finish()?);

    let mut extremes = Tree::new(&mut file, "extremes");
    let all = || t.channels.iter().enumerate().flat_map(|(c, channel)| channel.extremes.iter().map(move |e| (c, e)));
    extremes.integers("channel", &all().map(|(c, _)| c as u32).collect::<Vec<_>>());
    let (times, heights): (Vec<f64>, Vec<f64>) = all().map(|(_, e)| (e.t, e.value)).unzip();
    extremes.reals("t", &times, &[times.len()], "s");
    extremes.reals("value", &heights, &[heights.len()], "");
    file.add_group(extremes.finish()?);

    if let Some(e) = &t.energy {
        let mut energy = Tree::new(&mut file, "energy");
        energy.reals("initial", &[e.initial], &[1], "J");
        for (kind, parts) in [("input", &e.input), ("stored", &e.stored), ("dissipated", &e.dissipated)] {
            energy.texts(&format!("{kind}_names"), &parts.iter().map(|p| &p.0).collect::<Vec<_>>());
            let joules: Vec<f64> = parts.iter().map(|p| p.1).collect();
            energy.reals(kind, &joules, &[joules.len()], "J");
        }
        energy.reals("error", &[e.error], &[1], "J");
        energy.reals("relative_error", &[e.relative_error], &[1], "1");
        file.add_group(energy.finish()?);
    }
    let mut stats = Tree::new(&mut file, "stats");
    let counts = [t.stats.steps, t.stats.substeps, t.stats.solves, t.stats.iterations, t.stats.events];
    for (name, count) in ["steps", "substeps", "solves", "iterations", "events"].into_iter().zip(counts) {
        stats.reals(name, &[count as f64], &[1], "1");
    }
    stats.reals("step", &[t.stats.step_s], &[1], "s");
    stats.texts("effects", &t.effects);
    stats.texts("warnings", &t.warnings);
    file.add_group(stats.finish()?);
    file.finish().map_err(refused)
}
