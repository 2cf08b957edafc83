//! Channels over time: values at the steps, static values, turning points.

use super::contact::FORCES;
use super::integrate::Sample;
use super::scene::{Datum, Shown};
use super::statics::Equilibrium;
use super::system::{ChannelSpec, Reading, System};
use crate::model::{Channel, Extreme};

/// A turning point counts when the signal comes back from it by this share of the channel's range:
/// ripples of high modes on a large motion are not extremes of the motion.
const PROMINENCE: f64 = 5e-3;

/// Collects samples.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    system: &'a System,
    pub(super) time: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(system: &'a System, samples: usize) -> Self {
        Self {
            system,
            time: Vec::with_capacity(samples),
            values: vec![Vec::with_capacity(samples); system.channels.len()],
        }
    }

    /// Adds the values of a step.
    pub(super) fn take(&mut self, now: &Sample) {
        self.time.push(now.t);
        for (values, channel) in self.values.iter_mut().zip(&self.system.channels) {
            values.push(reading(self.system, channel, now));
        }
    }

    /// Channels with datum, static value and extremes.
    pub(super) fn close(self, rest: Option<&Equilibrium>) -> (Vec<f64>, Vec<Channel>) {
        let Self { system, time, values } = self;
        let channels = system
            .channels
            .iter()
            .zip(values)
            .map(|(spec, mut values)| {
                let at_rest = rest.map(|e| at_rest(system, spec, e));
                let datum = match (spec.shown, spec.datum, at_rest) {
                    (Shown::Displacement, Datum::Static, Some(zero)) => {
                        values.iter_mut().for_each(|v| *v -= zero);
                        "static equilibrium"
                    }
                    (Shown::Displacement, _, _) => "start",
                    _ => "absolute",
                };
                let smooth = matches!(spec.reading, Reading::Motion(_)) && spec.shown != Shown::Acceleration;
                Channel {
                    name: spec.name.clone(),
                    unit: spec.unit.clone(),
                    datum: datum.into(),
                    at_rest,
                    extremes: extremes(&time, &values, smooth),
                    range: range(&time, &values, smooth),
                    values,
                }
            })
            .collect();
        (time, channels)
    }
}

fn reading(system: &System, channel: &ChannelSpec, now: &Sample) -> f64 {
    let given = FORCES * system.tires.len();
    match &channel.reading {
        Reading::Motion(row) => match channel.shown {
            Shown::Displacement | Shown::Force => row.dot(&now.position),
            Shown::Velocity => row.dot(&now.velocity),
            Shown::Acceleration => row.dot(&now.acceleration),
        },
        Reading::NormalForce(k) => now.forces[FORCES * k],
        Reading::LateralForce(k) => now.forces[FORCES * k + 1],
        Reading::AppliedForce(k) => now.forces[given + k],
    }
}

/// Value of a channel at an equilibrium.
pub(super) fn at_rest(system: &System, channel: &ChannelSpec, rest: &Equilibrium) -> f64 {
    match &channel.reading {
        Reading::Motion(row) if channel.shown == Shown::Displacement => row.dot(&rest.position),
        Reading::NormalForce(k) => rest.normal[*k].max(0.0),
        Reading::AppliedForce(k) => system.applied[*k].0.in_case(0),
        _ => 0.0,
    }
}

/// Vertex of the parabola through three neighbouring samples.
fn vertex(time: &[f64], values: &[f64], k: usize) -> Extreme {
    if k == 0 || k + 1 >= values.len() {
        return Extreme { t: time[k], value: values[k] };
    }
    let (a, b, c) = (values[k - 1], values[k], values[k + 1]);
    let bend = a - 2.0 * b + c;
    if bend == 0.0 {
        return Extreme { t: time[k], value: b };
    }
    let shift = (0.5 * (a - c) / bend).clamp(-1.0, 1.0);
    Extreme { t: time[k] + shift * (time[k + 1] - time[k]), value: b - 0.25 * (a - c) * shift }
}

fn refine(time: &[f64], values: &[f64], k: usize, smooth: bool) -> Extreme {
    if smooth { vertex(time, values, k) } else { Extreme { t: time[k], value: values[k] } }
}

fn range(time: &[f64], values: &[f64], smooth: bool) -> [Extreme; 2] {
    let of = |better: fn(f64, f64) -> bool| {
        let k = (1..values.len()).fold(0, |best, k| if better(values[k], values[best]) { k } else { best });
        refine(time, values, k, smooth)
    };
    if values.is_empty() {
        return [Extreme { t: 0.0, value: 0.0 }; 2];
    }
    [of(|a, b| a < b), of(|a, b| a > b)]
}

/// Alternating turning points with the stated prominence, in time order. `smooth` channels (motions)
/// get the vertex of a parabola through the samples, third order in the step; forces, which jump,
/// the sample itself. The first and last sample are no turning points.
fn extremes(time: &[f64], values: &[f64], smooth: bool) -> Vec<Extreme> {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |r, &v| (r.0.min(v), r.1.max(v)));
    let prominence = PROMINENCE * (high - low);
    let mut found = Vec::new();
    if values.is_empty() || prominence <= 0.0 {
        return found;
    }
    // +1 while looking for a maximum, −1 for a minimum, 0 before the first clear move.
    let (mut looking, mut best, mut highest, mut lowest) = (0.0, 0usize, 0usize, 0usize);
    for k in 1..values.len() {
        if looking == 0.0 {
            if values[k] > values[highest] {
                highest = k;
            }
            if values[k] < values[lowest] {
                lowest = k;
            }
            if values[k] - values[lowest] >= prominence {
                push(&mut found, time, values, lowest, smooth);
                (looking, best) = (1.0, k);
            } else if values[highest] - values[k] >= prominence {
                push(&mut found, time, values, highest, smooth);
                (looking, best) = (-1.0, k);
            }
        } else if looking * (values[k] - values[best]) > 0.0 {
            best = k;
        } else if looking * (values[best] - values[k]) >= prominence {
            push(&mut found, time, values, best, smooth);
            (looking, best) = (-looking, k);
        }
    }
    found
}

fn push(found: &mut Vec<Extreme>, time: &[f64], values: &[f64], k: usize, smooth: bool) {
    if k > 0 {
        found.push(refine(time, values, k, smooth));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damped_cosine_gives_its_turning_points() {
        // y = e^{−at} cos(bt): turning points where tan(bt) = −a/b, one every π/b.
        let (a, b, h) = (2.0_f64, 12.0_f64, 1e-3);
        let time: Vec<f64> = (0..1500).map(|k| k as f64 * h).collect();
        let values: Vec<f64> = time.iter().map(|t| (-a * t).exp() * (b * t).cos()).collect();
        let found = extremes(&time, &values, true);
        let first = (std::f64::consts::PI - (a / b).atan()) / b;
        assert!(found.len() >= 5);
        for (k, e) in found.iter().enumerate() {
            let t = first + k as f64 * std::f64::consts::PI / b;
            // Parabola through samples: error of the value h³·y‴/15, of the time h²·y‴/y″.
            assert!((e.t - t).abs() < 1e-5, "{k}: {} {t}", e.t);
            assert!((e.value - (-a * t).exp() * (b * t).cos()).abs() < 1e-8);
        }
    }

    #[test]
    fn ripples_and_constants_are_no_extremes() {
        let time: Vec<f64> = (0..1000).map(|k| k as f64 * 1e-3).collect();
        let ripple: Vec<f64> = time.iter().map(|t| t + 1e-3 * (500.0 * t).sin()).collect();
        assert!(extremes(&time, &ripple, true).is_empty());
        assert!(extremes(&time, &vec![1.0; 1000], true).is_empty());
        assert!(extremes(&[], &[], true).is_empty());
    }
}
