//! What is watched while a scene runs: numbers that leave the model's validity.

use super::integrate::{Counts, Sample};
use super::system::System;
use crate::model::Energy;
use nalgebra::DVector;
use std::f64::consts::PI;

/// Deflection above this share of a body's size is no longer small (linear strain, fixed directions
/// of the joints).
const SMALL_DEFLECTION: f64 = 0.1;

/// Steps per contact period that a specialist expects.
const STEPS_PER_PERIOD: f64 = 10.0;

/// Energy appearing from nowhere above this share of the input is reported.
const ENERGY_SHARE: f64 = 1e-2;

/// Above this share the result is refused: half of the energy is made up.
const NONSENSE: f64 = 0.5;

/// Watches a run.
#[derive(Debug)]
pub(super) struct Watch {
    /// Largest elastic displacement of one kept node relative to another, per body, with its time.
    deflection: Vec<(f64, f64)>,
    displacement: Vec<DVector<f64>>,
}

impl Watch {
    pub(super) fn new(system: &System) -> Self {
        Self {
            deflection: vec![(0.0, 0.0); system.deflections.len()],
            displacement: system.deflections.iter().map(|d| DVector::zeros(d.rows.nrows())).collect(),
        }
    }

    /// Looks at a step; an error when the state is not a number.
    pub(super) fn look(&mut self, system: &System, now: &Sample) -> Result<(), String> {
        let norm = now.position.norm_squared() + now.velocity.norm_squared();
        if !norm.is_finite() {
            return Err(format!("the state is no longer a number at t = {:.6} s; shorten the step", now.t));
        }
        for (k, body) in system.deflections.iter().enumerate() {
            let u = &mut self.displacement[k];
            u.gemv(1.0, &body.rows, &now.position, 0.0);
            let first = [u[0], u[1], u[2]];
            for node in 1..u.len() / 3 {
                let away = (0..3).map(|d| (u[3 * node + d] - first[d]).powi(2)).sum::<f64>().sqrt();
                if away > self.deflection[k].0 {
                    self.deflection[k] = (away, now.t);
                }
            }
        }
        Ok(())
    }

    /// An error when energy came from nowhere: no number of the run means anything then.
    pub(super) fn judge(energy: &Energy) -> Result<(), String> {
        if energy.relative_error <= NONSENSE {
            return Ok(());
        }
        Err(format!(
            "the energy balance is off by {:.1e} of the energy put in, so the result means nothing; shorten the step, or look for stiffness or damping of the wrong size",
            energy.relative_error
        ))
    }

    /// What to tell at the end.
    pub(super) fn warnings(&self, system: &System, counts: &Counts, energy: &Energy) -> Vec<String> {
        let mut told = Vec::new();
        for (body, (largest, at)) in system.deflections.iter().zip(&self.deflection) {
            if *largest > SMALL_DEFLECTION * body.length {
                told.push(format!(
                    "deflection of {} reaches {:.0} mm at {at:.3} s, {:.0} % of its {:.2} m: beyond small deflection (10 %), linear stiffness is an extrapolation there",
                    body.body,
                    largest * 1e3,
                    100.0 * largest / body.length,
                    body.length
                ));
            }
        }
        for tire in &system.tires {
            let mobility = tire.normal_row.norm_squared();
            if mobility > 0.0 && tire.normal.stiffness > 0.0 {
                let period = 2.0 * PI / (tire.normal.stiffness * mobility).sqrt();
                if system.step > period / STEPS_PER_PERIOD {
                    told.push(format!(
                        "step {:.3} ms is above a tenth of the contact period of {} ({:.3} ms): its force is coarse",
                        system.step * 1e3,
                        tire.name,
                        period * 1e3
                    ));
                }
            }
        }
        if counts.unconverged > 0 {
            told.push(format!("{} contact solutions did not settle to 1e-6 of the force", counts.unconverged));
        }
        if counts.unlocated > 0 {
            told.push(format!("{} steps held more contacts than can be located (chatter)", counts.unlocated));
        }
        if energy.relative_error > ENERGY_SHARE {
            told.push(format!(
                "energy balance is off by {:.1e} of the input: the step is too long",
                energy.relative_error
            ));
        }
        told
    }
}
