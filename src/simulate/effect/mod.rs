//! The effects a scene may call for: one law, one file; this table.

mod applied_force;
mod flexibility;
mod gravity;
mod residual_flexibility;
mod structural_damping;
mod tire_lateral;
mod tire_normal;

pub(super) use applied_force::AppliedForce;
pub(super) use flexibility::Coordinates;
pub(super) use flexibility::elastic_coordinates;
pub(super) use gravity::weight;
pub(super) use residual_flexibility::add_residual_vectors;
pub(super) use structural_damping::damping_rates;
pub(super) use tire_lateral::TireLateral;
pub(super) use tire_normal::TireNormal;

/// Name and one line of an effect.
#[derive(Clone, Copy, Debug)]
pub struct EffectInfo {
    /// Name in a scene's `effects`.
    pub name: &'static str,
    /// What it adds.
    pub help: &'static str,
}

/// All effects, in the order in which results list them.
pub const EFFECTS: &[EffectInfo] = &[
    EffectInfo { name: gravity::NAME, help: "weight of every body, constant, along -z" },
    EffectInfo { name: flexibility::NAME, help: "elastic modes of the flexible bodies" },
    EffectInfo { name: residual_flexibility::NAME, help: "static flexibility at the joints of all modes not kept" },
    EffectInfo { name: structural_damping::NAME, help: "modal damping of the elastic modes" },
    EffectInfo { name: tire_normal::NAME, help: "tyre spring and damper, eq. (27), never pulling" },
    EffectInfo { name: tire_lateral::NAME, help: "tyre side force by slip angle, eq. (28), capped by friction" },
    EffectInfo { name: applied_force::NAME, help: "given forces: constant, half-sine or table" },
];
