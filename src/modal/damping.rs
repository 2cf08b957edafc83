//! Damping ratios of modes by the usual models.

use crate::model::Modes;
use std::f64::consts::PI;

/// A damping model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DampingModel {
    /// The same ratio for every elastic mode.
    Ratio(f64),
    /// Rayleigh damping C = αM + βK: ζ = (α/ω + βω)/2 (Bathe, Finite Element Procedures, sec. 9.3.3).
    Rayleigh {
        /// 1/s.
        alpha: f64,
        /// s.
        beta: f64,
    },
    /// 1 % below 100 Hz, 10 % from there to 1 kHz, critical above: the default of Adams/Flex.
    Adams,
}

/// Names and one line of each preset.
pub const DAMPING_PRESETS: &[(&str, DampingModel, &str)] =
    &[("adams", DampingModel::Adams, "1 % below 100 Hz, 10 % below 1 kHz, critical above")];

impl DampingModel {
    /// ζ of a mode of frequency ω, rad/s.
    pub fn ratio(self, omega: f64) -> f64 {
        match self {
            Self::Ratio(zeta) => zeta,
            Self::Rayleigh { alpha, beta } => 0.5 * (alpha / omega + beta * omega),
            Self::Adams => match omega / (2.0 * PI) {
                hz if hz < 100.0 => 0.01,
                hz if hz < 1000.0 => 0.1,
                _ => 1.0,
            },
        }
    }
}

/// Sets ζ of every elastic mode; rigid modes get 0.
pub fn set_damping(modes: &mut Modes, model: DampingModel) {
    for k in 0..modes.len() {
        modes.zeta[k] = if k < modes.rigid { 0.0 } else { model.ratio(modes.omega[k]) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_by_model() {
        assert_eq!(DampingModel::Ratio(0.03).ratio(100.0), 0.03);
        let hz = |f: f64| DampingModel::Adams.ratio(2.0 * PI * f);
        assert_eq!((hz(99.0), hz(101.0), hz(1001.0)), (0.01, 0.1, 1.0));
        // Smallest at ω = √(α/β), where ζ = √(αβ).
        let model = DampingModel::Rayleigh { alpha: 4.0, beta: 1e-4 };
        assert!((model.ratio(200.0) - 0.02).abs() < 1e-16 && model.ratio(190.0) > 0.02 && model.ratio(210.0) > 0.02);
    }
}
