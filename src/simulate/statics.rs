//! Static equilibrium: λ w = weight + given forces + Σ normal_row·N(τ), tyres one-sided.

use super::effect::TireNormal;
use super::system::System;
use nalgebra::{DMatrix, DVector};

/// An equilibrium: w, and the normal force of each tyre.
#[derive(Clone, Debug)]
pub(super) struct Equilibrium {
    pub(super) position: DVector<f64>,
    pub(super) normal: Vec<f64>,
}

/// A motion with less than this share of the largest stiffness has none (a mechanism).
const NO_STIFFNESS: f64 = 1e-13;

/// A diagonal below this share of the largest is rounding: stiffnesses of one system span 1e9.
const ROUNDING: f64 = 1e-16;

/// The equilibrium under the weight and given forces (one value per applied force), side forces of
/// the tyres zero. `None` in words when something falls or slides without end.
///
/// The tyre law is piecewise linear: the loaded set is found by repeated linear solutions, dropping
/// tyres that would pull and adding those that penetrate.
pub(super) fn equilibrium(system: &System, given: &[f64]) -> Result<Equilibrium, String> {
    let n = system.stiffness.len();
    let mut load = system.gravity.clone();
    for ((_, row), &force) in system.applied.iter().zip(given) {
        load.axpy(force, row, 1.0);
    }
    let mut loaded = vec![true; system.tires.len()];
    for _ in 0..=2 * system.tires.len() {
        let mut stiffness = DMatrix::from_diagonal(&system.stiffness);
        let mut force = load.clone();
        for (tire, _) in system.tires.iter().zip(&loaded).filter(|t| *t.1) {
            stiffness.ger(tire.normal.stiffness, &tire.normal_row, &tire.normal_row, 1.0);
            force.axpy(-tire.normal.stiffness * tire.gap, &tire.normal_row, 1.0);
        }
        let position = supported(&stiffness, &force, n)?;
        let normal: Vec<f64> = system
            .tires
            .iter()
            .map(|t| {
                let TireNormal { stiffness, .. } = t.normal;
                stiffness * (-t.normal_row.dot(&position) - t.gap)
            })
            .collect();
        let next: Vec<bool> = normal.iter().map(|&f| f > 0.0).collect();
        if next == loaded {
            return Ok(Equilibrium { position, normal });
        }
        loaded = next;
    }
    Err("the set of loaded tyres does not settle".into())
}

/// Solves where there is stiffness; refuses a load where there is none.
fn supported(stiffness: &DMatrix<f64>, force: &DVector<f64>, n: usize) -> Result<DVector<f64>, String> {
    // Scaling by the diagonal keeps soft directions apart from free ones; a free one (a spinning
    // wheel) has rounding there, which must not be scaled up to a stiffness.
    let floor = (ROUNDING * stiffness.diagonal().amax()).max(f64::MIN_POSITIVE);
    let scale = stiffness.diagonal().map(|d| d.max(floor).sqrt().recip());
    let scaled = DMatrix::from_fn(n, n, |r, c| stiffness[(r, c)] * scale[r] * scale[c]);
    let eigen = scaled.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let right = force.component_mul(&scale);
    let mut solution = DVector::zeros(n);
    for k in 0..n {
        let direction = eigen.eigenvectors.column(k);
        let part = direction.dot(&right);
        if eigen.eigenvalues[k] > NO_STIFFNESS * largest {
            solution.axpy(part / eigen.eigenvalues[k], &direction, 1.0);
        } else if part.abs() > 1e-9 * right.norm() {
            return Err("nothing carries the load: a loaded direction has no stiffness".into());
        }
    }
    Ok(solution.component_mul(&scale))
}
