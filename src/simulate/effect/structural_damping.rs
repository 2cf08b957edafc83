//! Structural damping: 2ζω per elastic coordinate. Dissipates Σ 2ζω q̇².

pub(super) const NAME: &str = "structural-damping";

/// 2ζω per coordinate, 1/s.
pub(in crate::simulate) fn damping_rates(omega: &[f64], zeta: &[f64]) -> Vec<f64> {
    omega.iter().zip(zeta).map(|(w, z)| 2.0 * z * w).collect()
}
