//! Energy accounts: what came in, what is stored, what each effect dissipated, and the imbalance.
//!
//! Dissipation comes from the laws themselves, integrated by the corrected trapezoid
//! ∫g ≈ h/2 (g₀ + g₁) + h²/12 (g₀' − g₁') (fourth order; Davis and Rabinowitz, Methods of Numerical
//! Integration, 2nd ed., sec. 2.9), so the imbalance shows what the discretisation of the contact
//! forces costs.

use super::contact::{FORCES, Regime};
use super::integrate::Sample;
use super::system::System;
use crate::model::Energy;
use nalgebra::DVector;

/// A rate (W) and its derivative (W/s).
type Rate = (f64, f64);

/// Accounts of a run.
#[derive(Clone, Debug)]
pub(super) struct Balance {
    initial: f64,
    applied: f64,
    damping: f64,
    normal: f64,
    lateral: f64,
    gravity: f64,
    highest_input: f64,
    worst: f64,
    rates: Rates,
    work: DVector<f64>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Rates {
    applied: Rate,
    damping: Rate,
    normal: Rate,
    lateral: Rate,
}

impl Balance {
    pub(super) fn new(system: &System) -> Self {
        Self {
            initial: 0.0,
            applied: 0.0,
            damping: 0.0,
            normal: 0.0,
            lateral: 0.0,
            gravity: 0.0,
            highest_input: 0.0,
            worst: 0.0,
            rates: Rates::default(),
            work: DVector::zeros(system.stiffness.len()),
        }
    }

    /// Opens the accounts.
    pub(super) fn start(&mut self, system: &System, now: &Sample) {
        self.initial = stored(system, now).iter().sum();
        self.highest_input = self.initial;
        self.rates = self.rates_at(system, None, now);
    }

    /// After a jump of the forces: rates begin anew.
    pub(super) fn restart(&mut self, system: &System, now: &Sample) {
        self.rates = self.rates_at(system, None, now);
    }

    /// Adds a block of length h that ended in `now`.
    pub(super) fn add(&mut self, system: &System, regimes: &[Regime], h: f64, now: &Sample) {
        let end = self.rates_at(system, Some(regimes), now);
        let begin = self.rates;
        let integral = |a: Rate, b: Rate| 0.5 * h * (a.0 + b.0) + h * h / 12.0 * (a.1 - b.1);
        self.applied += integral(begin.applied, end.applied);
        self.damping += integral(begin.damping, end.damping);
        self.normal += integral(begin.normal, end.normal);
        self.lateral += integral(begin.lateral, end.lateral);
        self.gravity = system.gravity.dot(&now.position);
        self.rates = end;
        let input = self.initial + self.gravity + self.applied;
        self.highest_input = self.highest_input.max(input);
        let imbalance = stored(system, now).iter().sum::<f64>() + self.damping + self.normal + self.lateral - input;
        self.worst = self.worst.max(imbalance.abs());
    }

    fn rates_at(&mut self, system: &System, regimes: Option<&[Regime]>, now: &Sample) -> Rates {
        let forces = &now.forces;
        let mut rates = Rates::default();
        self.work.gemv(1.0, &system.damping, &now.velocity, 0.0);
        rates.damping = (self.work.dot(&now.velocity), 2.0 * self.work.dot(&now.acceleration));
        for (k, tire) in system.tires.iter().enumerate() {
            let penetration = -tire.normal_row.dot(&now.position) - tire.gap;
            let rate = -tire.normal_row.dot(&now.velocity);
            let rate_change = -tire.normal_row.dot(&now.acceleration);
            let (normal, lateral) = (forces[FORCES * k], forces[FORCES * k + 1]);
            let pressed = regimes.map_or(normal > 0.0, |r| r[k] == Regime::Pressed || normal > 0.0);
            let law = tire.normal;
            if pressed {
                rates.normal.0 += law.damping * rate * rate;
                rates.normal.1 += 2.0 * law.damping * rate * rate_change;
            } else if penetration > 0.0 {
                // Off the ground, the tyre relaxes and its spring energy goes into its own damper.
                rates.normal.0 -= law.stiffness * penetration * rate;
                rates.normal.1 -= law.stiffness * (rate * rate + penetration * rate_change);
            }
            if let Some(slip) = tire.lateral.filter(|_| pressed) {
                let sideways = tire.lateral_row.dot(&now.velocity);
                let sideways_change = tire.lateral_row.dot(&now.acceleration);
                let (_, by_speed, by_normal) = slip.force(sideways, normal);
                let normal_change = law.stiffness * rate + law.damping * rate_change;
                let lateral_change = by_speed * sideways_change + by_normal * normal_change;
                rates.lateral.0 -= lateral * sideways;
                rates.lateral.1 -= lateral_change * sideways + lateral * sideways_change;
            }
        }
        let first = FORCES * system.tires.len();
        for (k, (law, row)) in system.applied.iter().enumerate() {
            let (speed, change) = (row.dot(&now.velocity), row.dot(&now.acceleration));
            let slope = law.slope(now.t);
            rates.applied.0 += forces[first + k] * speed;
            rates.applied.1 += slope * speed + forces[first + k] * change;
        }
        rates
    }

    /// The accounts as the result states them.
    pub(super) fn close(&self, system: &System, now: &Sample) -> Energy {
        let on = |name: &str| system.effects.iter().any(|e| e == name);
        let listed = |pairs: &[(&str, f64)]| -> Vec<(String, f64)> {
            pairs.iter().filter(|p| on(p.0)).map(|p| (p.0.to_string(), p.1)).collect()
        };
        let [kinetic, strain, springs] = stored(system, now);
        let mut all = vec![("kinetic".to_string(), kinetic), ("strain".to_string(), strain)];
        if on("tire-normal") {
            all.push(("tire-normal".to_string(), springs));
        }
        Energy {
            initial: self.initial,
            input: listed(&[("gravity", self.gravity), ("applied-force", self.applied)]),
            stored: all,
            dissipated: listed(&[
                ("structural-damping", self.damping),
                ("tire-normal", self.normal),
                ("tire-lateral", self.lateral),
            ]),
            error: self.worst,
            relative_error: if self.highest_input > 0.0 { self.worst / self.highest_input } else { 0.0 },
        }
    }
}

/// Kinetic energy, strain energy, energy of the tyre springs, J.
fn stored(system: &System, now: &Sample) -> [f64; 3] {
    let kinetic = 0.5 * now.velocity.norm_squared();
    let strain = 0.5 * system.stiffness.iter().zip(now.position.iter()).map(|(l, w)| l * w * w).sum::<f64>();
    let springs = system.tires.iter().map(|t| t.normal.stored(-t.normal_row.dot(&now.position) - t.gap)).sum::<f64>();
    [kinetic, strain, springs]
}
