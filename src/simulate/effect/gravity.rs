//! Gravity: f = −g Γ_z, constant. Potential energy g Γ_z · w.

use nalgebra::DVector;

pub(super) const NAME: &str = "gravity";

/// Generalised weight of coordinates whose participation along z is Γ_z (√kg), for an acceleration
/// g (m/s²) along −z.
pub(in crate::simulate) fn weight(participation_z: &DVector<f64>, acceleration: f64) -> DVector<f64> {
    participation_z * -acceleration
}
