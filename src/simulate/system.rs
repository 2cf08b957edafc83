//! The assembled system: constant after assembly.

use super::effect::{AppliedForce, TireLateral, TireNormal};
use super::scene::{Analysis, Datum, Shown};
use nalgebra::{DMatrix, DVector};

/// A tyre: laws and the rows of its contact point.
#[derive(Clone, Debug)]
pub(super) struct Tire {
    /// "wheel-c".
    pub(super) name: String,
    /// Vertical motion of the contact point per coordinate; n.
    pub(super) normal_row: DVector<f64>,
    /// Sideways motion of the contact point per coordinate; n.
    pub(super) lateral_row: DVector<f64>,
    /// Distance to the ground in the start configuration, m.
    pub(super) gap: f64,
    /// Eq. (27).
    pub(super) normal: TireNormal,
    /// Eq. (28); `None` when the effect is off.
    pub(super) lateral: Option<TireLateral>,
}

/// What a channel reads.
#[derive(Clone, Debug)]
pub(super) enum Reading {
    /// A motion: row per coordinate.
    Motion(DVector<f64>),
    /// Normal force of a tyre.
    NormalForce(usize),
    /// Lateral force of a tyre.
    LateralForce(usize),
    /// A given force.
    AppliedForce(usize),
}

/// A channel to record.
#[derive(Clone, Debug)]
pub(super) struct ChannelSpec {
    /// Name.
    pub(super) name: String,
    /// SI unit.
    pub(super) unit: String,
    /// What it reads.
    pub(super) reading: Reading,
    /// Displacement, velocity, acceleration or force.
    pub(super) shown: Shown,
    /// Zero.
    pub(super) datum: Datum,
}

/// Elastic deflection of a flexible body's nodes, for the small-deflection watch.
#[derive(Clone, Debug)]
pub(super) struct Deflection {
    /// Name of the body.
    pub(super) body: String,
    /// Largest distance between its kept nodes, m.
    pub(super) length: f64,
    /// Elastic displacement (x y z per node) per coordinate, 3·nodes×n.
    pub(super) rows: DMatrix<f64>,
}

/// ẅ + C ẇ + diag(λ) w = gravity + rows·forces, in n coordinates that satisfy every joint.
#[derive(Clone, Debug)]
pub struct System {
    /// Name of the scene.
    pub(super) name: String,
    /// Transient or static.
    pub(super) analysis: Analysis,
    /// Names of the effects that are on, in table order.
    pub(super) effects: Vec<String>,
    /// λ = ω² of the jointed, undamped system, (rad/s)²; exactly 0 for free motions; n.
    pub(super) stiffness: DVector<f64>,
    /// C, 1/s; n×n.
    pub(super) damping: DMatrix<f64>,
    /// Generalised weight; n.
    pub(super) gravity: DVector<f64>,
    /// Tyres.
    pub(super) tires: Vec<Tire>,
    /// Given forces: law and row.
    pub(super) applied: Vec<(AppliedForce, DVector<f64>)>,
    /// ẇ at the start; n.
    pub(super) start_velocity: DVector<f64>,
    /// Channels.
    pub(super) channels: Vec<ChannelSpec>,
    /// Flexible bodies to watch.
    pub(super) deflections: Vec<Deflection>,
    /// Step, s; 0 for a static analysis.
    pub(super) step: f64,
    /// End, s.
    pub(super) until: f64,
    /// Load cases of a static analysis.
    pub(super) cases: usize,
    /// Notes from assembly.
    pub(super) warnings: Vec<String>,
}

impl System {
    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.stiffness.len()
    }

    /// Natural frequencies of the jointed system without contact, rad/s, ascending.
    pub fn frequencies(&self) -> Vec<f64> {
        self.stiffness.iter().map(|l| l.sqrt()).collect()
    }
}
