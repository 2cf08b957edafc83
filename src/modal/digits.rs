//! How many digits the input carries, and what its rounding does to rigid modes.

use crate::linalg::SymSparse;

/// Entries looked at.
const SAMPLE: usize = 2000;

/// Fewest digits that are taken for a rounded text; values with fewer are exact by design (a
/// spring of 3e6 N/m).
const FEWEST: u32 = 6;
/// All of double precision.
const FULL: u32 = 17;

/// Significant decimal digits the entries need (the longest shortest form that reads back the
/// same): 14 for CalculiX text, 17 for full double precision.
pub(super) fn digits(a: &SymSparse) -> u32 {
    let step = (a.stored() / SAMPLE).max(1);
    let longest = a
        .values()
        .iter()
        .step_by(step)
        .filter(|v| **v != 0.0)
        .map(|v| format!("{v:e}").bytes().take_while(|b| *b != b'e').filter(u8::is_ascii_digit).count() as u32)
        .max();
    longest.filter(|d| *d >= FEWEST).map_or(FULL, |d| if d >= 16 { FULL } else { d })
}

/// Relative rounding error (standard deviation) of an entry given with so many digits: a uniform
/// error of half a unit in the last place, over a leading digit of about 3. Never less than that of
/// 14 digits: a text that was scaled to other units shows 17, and assembling elements loses as much.
pub(super) fn rounding(digits: u32) -> f64 {
    (0.1 * 10f64.powi(1 - digits as i32)).max(1e-14)
}

/// Standard deviation of rᵀδK r when every entry of K carries an independent relative rounding
/// error: how far from zero the ω² of a rigid motion r may lie.
pub(super) fn noise(k: &SymSparse, r: &[f64], relative: f64) -> f64 {
    let mut sum = 0.0;
    for j in 0..k.order() {
        for (i, a) in k.column(j) {
            let twice = if i == j { 1.0 } else { 2.0 };
            sum += (twice * a * r[i] * r[j]).powi(2);
        }
    }
    relative * sum.sqrt()
}
