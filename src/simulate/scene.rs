//! The scene as its file gives it: bodies, joints, effects, start, run, channels.

use crate::quantity::{
    Acceleration, Damping, Force, ForcePerAngle, Inertia, Length, Mass, Quantity, Ratio, Speed, Stiffness, Time,
};
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, Deserializer, IntoDeserializer, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use toml::Spanned;

/// One scene file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Scene {
    /// Title.
    pub name: String,
    /// What it is for, in words.
    #[serde(default)]
    pub about: String,
    /// Names of the effects that act.
    pub effects: Vec<Spanned<String>>,
    /// How to run.
    pub run: RunSettings,
    /// Bodies by name.
    pub body: BTreeMap<Spanned<String>, BodySpec>,
    /// Joints by name.
    #[serde(default)]
    pub joint: BTreeMap<Spanned<String>, JointSpec>,
    /// Parameters of effects.
    #[serde(default)]
    pub effect: EffectTables,
    /// Initial condition.
    #[serde(default)]
    pub start: Start,
    /// Measured channels.
    #[serde(default)]
    pub measure: Vec<Measure>,
    /// Published or measured values to compare channels with.
    #[serde(default)]
    pub reference: Vec<Reference>,
}

/// What is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Analysis {
    /// Motion over time.
    #[default]
    Transient,
    /// Equilibrium under each load case.
    Static,
}

/// How flexible bodies are treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// Free-free modes, joints eliminated, exact propagation.
    #[default]
    Modal,
    /// Flexible bodies as rigid ones.
    Rigid,
}

/// `[run]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RunSettings {
    /// Transient or static.
    #[serde(default)]
    pub analysis: Analysis,
    /// Modal or rigid.
    #[serde(default)]
    pub formulation: Formulation,
    /// Step, s.
    pub step: Option<Spanned<Quantity<Time>>>,
    /// End of the run, s.
    pub until: Option<Spanned<Quantity<Time>>>,
}

/// A point: a named node ("leaf:c") or coordinates.
#[derive(Clone, Debug)]
pub enum Place {
    /// "body:node".
    Node(String),
    /// x, y, z.
    Position([Quantity<Length>; 3]),
}

/// `[body.NAME]`: a reduced model, or mass and inertia.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BodySpec {
    /// Reduced model file, relative to the scene file.
    pub model: Option<Spanned<String>>,
    /// Treat the reduced model as a rigid body.
    #[serde(default)]
    pub rigid: bool,
    /// kg.
    pub mass: Option<Spanned<Quantity<Mass>>>,
    /// About x, y, z through the centre of mass, kg·m²; none for a body that does not rotate.
    pub inertia: Option<Spanned<[Quantity<Inertia>; 3]>>,
    /// Centre of mass.
    pub at: Option<Spanned<Place>>,
}

/// `[joint.NAME]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct JointSpec {
    /// Two of: "ground", a body, "body:node".
    pub between: Spanned<[String; 2]>,
    /// Held directions, "x y z ry", or the name of a preset.
    pub holds: Spanned<String>,
    /// Where, when neither end is a named node.
    pub at: Option<Spanned<Place>>,
}

/// `[effect.NAME]` tables.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct EffectTables {
    /// Weight.
    pub gravity: Option<GravityTable>,
    /// Which elastic modes take part.
    pub flexibility: Option<FlexibilityTable>,
    /// Tyres, vertical.
    pub tire_normal: Option<Spanned<TireNormalTable>>,
    /// Tyres, sideways.
    pub tire_lateral: Option<Spanned<TireLateralTable>>,
    /// Given forces.
    pub applied_force: Vec<Spanned<AppliedForceTable>>,
}

/// `[effect.gravity]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GravityTable {
    /// Downward (−z), m/s².
    pub acceleration: Quantity<Acceleration>,
}

/// `[effect.flexibility]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FlexibilityTable {
    /// Elastic modes that take part, "7-17"; all kept ones when absent.
    pub modes: Option<Spanned<String>>,
}

/// `[effect.tire-normal]`, eq. (27).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TireNormalTable {
    /// Bodies or nodes that carry a tyre.
    pub at: Vec<Spanned<String>>,
    /// Hub to contact point, m.
    pub radius: Quantity<Length>,
    /// N/m.
    pub stiffness: Spanned<Quantity<Stiffness>>,
    /// N·s/m.
    pub damping: Spanned<Quantity<Damping>>,
}

/// `[effect.tire-lateral]`, eq. (28).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TireLateralTable {
    /// Cornering stiffness C₁, N/rad.
    pub cornering_stiffness: Spanned<Quantity<ForcePerAngle>>,
    /// Friction coefficient μ.
    pub friction: Spanned<Quantity<Ratio>>,
    /// Regularisation speed v_reg, m/s.
    pub regularization_speed: Spanned<Quantity<Speed>>,
}

/// `[[effect.applied-force]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AppliedForceTable {
    /// "leaf:d:z" or "load:z".
    pub at: String,
    /// Constant value, or peak of the half-sine, N; one per load case in a static analysis.
    pub force: Option<ForceValues>,
    /// Duration of a half-sine pulse, s.
    pub half_sine: Option<Quantity<Time>>,
    /// (time, force) points, straight between them, zero outside.
    pub table: Option<Vec<(Quantity<Time>, Quantity<Force>)>>,
}

/// One force or one per load case.
#[derive(Clone, Debug)]
pub enum ForceValues {
    /// The same in every case.
    One(Quantity<Force>),
    /// One per case.
    Cases(Vec<Quantity<Force>>),
}

// Not serde's untagged: its errors do not say what is wrong with the value.
impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl<'de> Visitor<'de> for Read {
            type Value = Place;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a node such as \"leaf:c\" or three coordinates [x, y, z]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Place, E> {
                Ok(Place::Node(text.to_string()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Place, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(Place::Position)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

impl<'de> Deserialize<'de> for ForceValues {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl<'de> Visitor<'de> for Read {
            type Value = ForceValues;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a force such as \"10 N\", or one per load case [\"10 N\", \"20 N\"]")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<ForceValues, E> {
                Quantity::deserialize(text.into_deserializer()).map(ForceValues::One)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<ForceValues, E> {
                Quantity::deserialize(value.into_deserializer()).map(ForceValues::One)
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<ForceValues, E> {
                self.visit_f64(value as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ForceValues, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(ForceValues::Cases)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

/// `[start]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Start {
    /// Downward speed of everything, m/s.
    pub speed: Option<Quantity<Speed>>,
    /// Height of the tyres above the ground, m: the fall to touchdown is part of the run.
    pub height: Option<Quantity<Length>>,
    /// Forward speed, for the slip angle, m/s.
    pub forward_speed: Option<Quantity<Speed>>,
}

/// What a channel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shown {
    /// m or rad.
    #[default]
    Displacement,
    /// m/s or rad/s.
    Velocity,
    /// m/s² or rad/s².
    Acceleration,
    /// N.
    Force,
}

/// What zero means in a displacement channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Datum {
    /// The start of the run.
    #[default]
    Start,
    /// The static equilibrium.
    Static,
}

/// `[[measure]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Measure {
    /// Name of the channel.
    pub name: Spanned<String>,
    /// "leaf:b:z", "load:z"; for forces "tire-normal:wheel-c".
    pub of: Spanned<String>,
    /// Subtracts a second motion: the spread of two points.
    pub minus: Option<Spanned<String>>,
    /// Displacement, velocity, acceleration or force.
    #[serde(default)]
    pub show: Shown,
    /// Zero of a displacement.
    #[serde(default)]
    pub datum: Datum,
}

/// `[[reference]]`: published values of a channel's extremes (transient) or cases (static).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Reference {
    /// Where the values come from.
    pub name: String,
    /// Channel they belong to.
    pub channel: Spanned<String>,
    /// In order of the channel's extremes or of the load cases, m.
    pub values: Vec<Quantity<Length>>,
    /// What another simulation of the same gave.
    pub other: Option<OtherValues>,
}

/// Values of another simulation beside a reference.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct OtherValues {
    /// Whose they are.
    pub name: String,
    /// In the order of the reference's values, m.
    pub values: Vec<Quantity<Length>>,
}

impl Scene {
    /// True when an effect is listed.
    pub fn has(&self, effect: &str) -> bool {
        self.effects.iter().any(|e| e.get_ref() == effect)
    }

    /// Switches an effect on or off, as `--with` and `--without` do.
    pub fn switch(&mut self, effect: &str, on: bool) {
        self.effects.retain(|e| e.get_ref() != effect);
        if on {
            self.effects.push(Spanned::new(0..0, effect.to_string()));
        }
    }
}
