//! What a simulation leaves behind: channels over time, extremes, energy, cost.

use serde::Serialize;

/// One measured quantity over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name in the scene.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// What zero means: "start", "static equilibrium", "absolute".
    pub datum: String,
    /// Values at the trajectory's times; empty for a static analysis.
    pub values: Vec<f64>,
    /// Static value from the start configuration, in `unit`; `None` without an equilibrium.
    pub at_rest: Option<f64>,
    /// Turning points, in time order.
    pub extremes: Vec<Extreme>,
    /// Largest and smallest value over the run with their times.
    pub range: [Extreme; 2],
}

/// A turning point of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// s.
    pub t: f64,
    /// In the channel's unit.
    pub value: f64,
}

/// Energy balance over a run, J: initial + work of gravity and applied forces = stored + dissipated.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Energy {
    /// Kinetic and strain energy at the start.
    pub initial: f64,
    /// Work done by gravity and by applied forces, per effect.
    pub input: Vec<(String, f64)>,
    /// Energy at the end: kinetic, strain, springs of effects.
    pub stored: Vec<(String, f64)>,
    /// Dissipated, per effect.
    pub dissipated: Vec<(String, f64)>,
    /// Largest |imbalance| over the run.
    pub error: f64,
    /// `error` divided by the largest of initial energy plus positive work over the run.
    pub relative_error: f64,
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stats {
    /// Fixed steps taken.
    pub steps: u64,
    /// Parts of steps taken to locate touchdown and lift-off.
    pub substeps: u64,
    /// Contact solves.
    pub solves: u64,
    /// Newton iterations in all contact solves.
    pub iterations: u64,
    /// Events located.
    pub events: u64,
    /// Wall time of the run without set-up, s.
    pub wall_s: f64,
    /// Step, s.
    pub step_s: f64,
    /// Simulated time over wall time.
    pub real_time_factor: f64,
}

/// The result of one simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Name of the scene.
    pub scene: String,
    /// s.
    pub time: Vec<f64>,
    /// Measured channels.
    pub channels: Vec<Channel>,
    /// Energy balance; `None` for a static analysis.
    pub energy: Option<Energy>,
    /// Names of the effects that were on.
    pub effects: Vec<String>,
    /// Cost.
    pub stats: Stats,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Trajectory {
    /// A channel by name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|c| c.name == name)
    }
}
