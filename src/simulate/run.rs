//! A system to a trajectory.

use super::integrate::Exact;
use super::record::{Recorder, at_rest};
use super::scene::Analysis;
use super::statics::equilibrium;
use super::system::System;
use super::watch::Watch;
use super::{Formulation, SceneError};
use crate::model::{Channel, Extreme, Progress, Stats, Trajectory};
use std::time::Instant;

/// A formulation's name and one line.
#[derive(Clone, Copy, Debug)]
pub struct FormulationInfo {
    /// Name in a scene.
    pub name: &'static str,
    /// Its value.
    pub value: Formulation,
    /// One line.
    pub help: &'static str,
}

/// All formulations.
pub const FORMULATIONS: &[FormulationInfo] = &[
    FormulationInfo {
        name: "modal",
        value: Formulation::Modal,
        help: "free-free modes about a frame that moves but does not turn, joints eliminated, exact propagation",
    },
    FormulationInfo { name: "rigid", value: Formulation::Rigid, help: "flexible bodies as rigid ones" },
];

/// Runs the scene's analysis.
pub fn simulate(system: &System, progress: &dyn Progress) -> Result<Trajectory, SceneError> {
    match system.analysis {
        Analysis::Static => statics(system),
        Analysis::Transient => transient(system, progress),
    }
}

fn transient(system: &System, progress: &dyn Progress) -> Result<Trajectory, SceneError> {
    // The last step may end after `until` by less than one rounding of the quotient.
    let steps = (system.until / system.step - 1e-9).ceil().max(1.0) as u64;
    let mut warnings = system.warnings.clone();
    let given: Vec<f64> = system.applied.iter().map(|_| 0.0).collect();
    let rest = equilibrium(system, &given);
    if let (Err(why), false) = (&rest, system.tires.is_empty()) {
        warnings.push(format!("no static equilibrium: {why}; displacements are measured from the start"));
    }
    let mut recorder = Recorder::new(system, steps as usize + 1);
    let mut watch = Watch::new(system);
    let begun = Instant::now();
    let mut exact = Exact::new(system);
    recorder.take(&exact.now);
    for k in 0..steps {
        exact.advance(k);
        watch.look(system, &exact.now).map_err(SceneError::Numerics)?;
        recorder.take(&exact.now);
        if k % 8192 == 8191 {
            progress.report("simulate", k as usize + 1, steps as usize);
        }
    }
    let wall_s = begun.elapsed().as_secs_f64();
    let energy = exact.balance.close(system, &exact.now);
    Watch::judge(&energy).map_err(SceneError::Numerics)?;
    let counts = exact.counts;
    warnings.extend(watch.warnings(system, &counts, &energy));
    let (time, channels) = recorder.close(rest.as_ref().ok());
    Ok(Trajectory {
        scene: system.name.clone(),
        time,
        channels,
        energy: Some(energy),
        effects: system.effects.clone(),
        stats: Stats {
            steps: counts.steps,
            substeps: counts.substeps,
            solves: counts.solves,
            iterations: counts.iterations,
            events: counts.events,
            wall_s,
            step_s: system.step,
            real_time_factor: steps as f64 * system.step / wall_s.max(f64::MIN_POSITIVE),
        },
        warnings,
    })
}

/// One equilibrium per load case; the trajectory's "times" are the case numbers from 1.
fn statics(system: &System) -> Result<Trajectory, SceneError> {
    let begun = Instant::now();
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); system.channels.len()];
    for case in 0..system.cases {
        let given: Vec<f64> = system.applied.iter().map(|(law, _)| law.in_case(case)).collect();
        let rest = equilibrium(system, &given)
            .map_err(|why| SceneError::Numerics(format!("load case {}: no static equilibrium: {why}", case + 1)))?;
        for (values, channel) in values.iter_mut().zip(&system.channels) {
            values.push(match &channel.reading {
                super::system::Reading::AppliedForce(k) => given[*k],
                _ => at_rest(system, channel, &rest),
            });
        }
    }
    let wall_s = begun.elapsed().as_secs_f64();
    let time: Vec<f64> = (1..=system.cases).map(|c| c as f64).collect();
    let channels = system
        .channels
        .iter()
        .zip(values)
        .map(|(spec, values)| {
            let at = |value: Option<f64>| Extreme { t: 0.0, value: value.unwrap_or(0.0) };
            Channel {
                name: spec.name.clone(),
                unit: spec.unit.clone(),
                datum: "start".into(),
                at_rest: values.last().copied(),
                extremes: Vec::new(),
                range: [at(values.iter().copied().reduce(f64::min)), at(values.iter().copied().reduce(f64::max))],
                values,
            }
        })
        .collect();
    Ok(Trajectory {
        scene: system.name.clone(),
        time,
        channels,
        energy: None,
        effects: system.effects.clone(),
        stats: Stats { steps: 0, solves: system.cases as u64, wall_s, ..Stats::default() },
        warnings: system.warnings.clone(),
    })
}
