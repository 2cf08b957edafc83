//! Receptance of a set of modes: displacement at one degree of freedom per force at another.

use crate::model::Modes;
use std::ops::{Add, Mul};

/// A complex number a + jb; all the arithmetic the receptance needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// 1/(a + jb).
    pub fn inverse_of(re: f64, im: f64) -> Self {
        let square = re * re + im * im;
        Self { re: re / square, im: -im / square }
    }

    /// Magnitude.
    pub fn magnitude(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// Phase, rad, in (−π, π].
    pub fn phase(self) -> f64 {
        self.im.atan2(self.re)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

/// H(ω) = Σ φ_o φ_i / (ω_k² − ω² + 2jζ_k ω_k ω) over the given columns (Ewins, Modal Testing,
/// 2nd ed., sec. 2.4; eq. (12) of Xue et al. 2014 summed over modes), m/N.
///
/// `output` and `input` are modal rows (one entry per mode, 1/√kg), `omega` in rad/s. Rigid modes
/// (ω_k = 0) give their inertia term −φ_o φ_i/ω².
pub fn receptance(
    modes: &Modes,
    output: &[f64],
    input: &[f64],
    columns: impl IntoIterator<Item = usize>,
    omega: f64,
) -> Complex {
    let mut sum = Complex::default();
    for c in columns {
        let gain = output[c] * input[c];
        if gain != 0.0 {
            sum = sum + modal_term(modes.omega[c], modes.zeta[c], omega) * gain;
        }
    }
    sum
}

/// 1/(ω_k² − ω² + 2jζ_k ω_k ω): the receptance of one mode with unit shapes.
pub fn modal_term(natural: f64, zeta: f64, omega: f64) -> Complex {
    Complex::inverse_of(natural * natural - omega * omega, 2.0 * zeta * natural * omega)
}

/// `count` frequencies from `first` to `last`, rad/s, evenly spaced on a logarithmic scale, with
/// every frequency of `peaks` inside that range added, so that no resonance falls between points.
pub fn frequency_grid(first: f64, last: f64, count: usize, peaks: &[f64]) -> Vec<f64> {
    let ratio = (last / first).ln() / (count.max(2) - 1) as f64;
    let mut grid: Vec<f64> = (0..count).map(|k| first * (ratio * k as f64).exp()).collect();
    grid.extend(peaks.iter().copied().filter(|&w| w >= first && w <= last));
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_mode_peaks_at_its_closed_form() {
        // |H| of one mode is largest at ω√(1−2ζ²), where it is 1/(2ζω²√(1−ζ²)).
        let (natural, zeta) = (107.0_f64, 0.03_f64);
        let at = natural * (1.0 - 2.0 * zeta * zeta).sqrt();
        let peak = modal_term(natural, zeta, at).magnitude();
        let closed = 1.0 / (2.0 * zeta * natural * natural * (1.0 - zeta * zeta).sqrt());
        assert!((peak / closed - 1.0).abs() < 1e-14);
        for shift in [0.999, 1.001] {
            assert!(modal_term(natural, zeta, at * shift).magnitude() < peak);
        }
        assert!((modal_term(natural, zeta, 0.0).re * natural * natural - 1.0).abs() < 1e-15);
    }
}
