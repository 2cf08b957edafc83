//! Modes read from another program's results, put into the form of `model::Modes`.

use super::error::Fault;
use crate::model::{Completeness, DofMap, Modes, NodeId, Origin};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Modes and the nodes that stand in the same file.
#[derive(Clone, Debug)]
pub struct ImportedModes {
    /// The modes. Damping, participation and residuals are NaN: such files do not hold them.
    pub modes: Modes,
    /// Node positions in the file's unit of length; empty when the file has none.
    pub nodes: BTreeMap<NodeId, [f64; 3]>,
}

/// A free body's rigid modes come out at rounding noise. On the reference leaf the highest is 3e-4 of
/// the first elastic frequency; 1e-2 keeps a distance to both sides.
const RIGID_BELOW: f64 = 1e-2;

/// How many of the first modes are rigid: those at ω ≤ 0, and up to six that lie below 1 % of the next.
/// `omega` ascending, rad/s.
fn rigid_count(omega: &[f64]) -> usize {
    let zero = omega.iter().take_while(|&&w| w <= 0.0).count();
    let gap = (1..omega.len().min(7)).rev().find(|&r| omega[r - 1] < RIGID_BELOW * omega[r]);
    gap.unwrap_or(0).max(zero)
}

/// Sets rigid frequencies to 0, makes the largest component of each shape positive, and says what is
/// not known. `omega` in rad/s ascending (≤ 0 where the file has no positive eigenvalue), shapes n×m.
pub(super) fn assemble(mut omega: Vec<f64>, mut shapes: DMatrix<f64>, dofs: DofMap) -> Result<Modes, Fault> {
    let count = omega.len();
    if count == 0 {
        return Err(Fault::new("no modes").expected("the results of a frequency analysis"));
    }
    if let Some(k) = (1..count).find(|&k| omega[k].is_nan() || omega[k] < omega[k - 1]) {
        return Err(Fault::new(format!("mode {} at {} rad/s follows {} rad/s", k + 1, omega[k], omega[k - 1]))
            .expected("frequencies in ascending order"));
    }
    if let Some(bad) = shapes.iter().position(|v| !v.is_finite()) {
        let (row, mode) = (bad % shapes.nrows(), bad / shapes.nrows() + 1);
        return Err(Fault::new(format!("mode {mode} is not a number at {}", dofs.describe(row))));
    }
    let rigid = rigid_count(&omega);
    let highest = omega[..rigid].last().copied().unwrap_or(0.0);
    omega[..rigid].fill(0.0);
    for mut shape in shapes.column_iter_mut() {
        if !shape.is_empty() && shape[shape.iamax()] < 0.0 {
            shape.neg_mut();
        }
    }
    let mut warnings = Vec::new();
    if highest > 0.0 {
        warnings.push(format!("modes 1-{rigid} (up to {highest:.3e} rad/s in the file) are taken as rigid"));
    }
    let below = omega[count - 1];
    Ok(Modes {
        zeta: vec![f64::NAN; count],
        participation: DMatrix::from_element(count, 3, f64::NAN),
        origin: (0..count).map(|k| if k < rigid { Origin::Rigid } else { Origin::Imported }).collect(),
        residual: vec![f64::NAN; count],
        orthogonality: f64::NAN,
        shift: 0.0,
        complete: Completeness { proved: false, count, below },
        omega,
        shapes,
        dofs,
        rigid,
        warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::rigid_count;

    #[test]
    fn rigid_modes_are_told_by_the_gap_above_them() {
        assert_eq!(rigid_count(&[0.0, 0.0, 1e-2, 3e-2, 107.0, 332.0]), 4);
        assert_eq!(rigid_count(&[0.0; 3]), 3);
        assert_eq!(rigid_count(&[10.0, 20.0]), 0);
        assert_eq!(rigid_count(&[10.0, 20.0, 1e4]), 2);
        assert_eq!(rigid_count(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 1e6]), 0);
    }
}
