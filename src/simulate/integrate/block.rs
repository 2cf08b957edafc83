//! The exact propagators of a step and of its halves, quarters, … down to the locating resolution.

use crate::linalg::Propagator;
use crate::simulate::contact::{FORCES, MOTIONS};
use crate::simulate::system::System;
use nalgebra::{DMatrix, DVector};

/// Touchdown and lift-off are located to the step divided by 2 to this power. At 1 ms that is 15 ns,
/// 46 nm of fall at 3 m/s: far below the discretisation of the contact force.
pub(super) const DEPTH: u32 = 16;

/// Propagation over one block of time; state x = [S w; ẇ], 2n.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Length, s.
    pub(super) h: f64,
    /// E, G₀, G₁ for the inputs (two forces per tyre, then the given forces).
    pub(super) step: Propagator,
    /// Contribution of the weight.
    pub(super) weight: DVector<f64>,
    /// Q: motions of the contact points at the end per contact force at the end, 3m×2m.
    pub(super) response: DMatrix<f64>,
}

/// Blocks of halving length, made when first needed.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    gravity: DMatrix<f64>,
    /// Motions of the contact points from the state, 3m×2n.
    pub(super) observe: DMatrix<f64>,
    /// S, 1/s; n.
    pub(super) scale: DVector<f64>,
    step: f64,
    made: Vec<Option<Block>>,
}

impl Blocks {
    /// For a system with its step.
    pub(super) fn new(system: &System) -> Self {
        let n = system.stiffness.len();
        let tires = system.tires.len();
        let inputs = FORCES * tires + system.applied.len();
        // Scaled by its own frequency (or the step rate, if higher), each coordinate's block of A·h
        // has entries of its phase over the step and not of its square.
        let scale = system.stiffness.map(|l| l.sqrt().max(1.0 / system.step));
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        for k in 0..n {
            a[(k, n + k)] = scale[k];
            a[(n + k, k)] = -system.stiffness[k] / scale[k];
        }
        a.view_mut((n, n), (n, n)).copy_from(&(-&system.damping));
        let mut b = DMatrix::zeros(2 * n, inputs);
        let mut observe = DMatrix::zeros(MOTIONS * tires, 2 * n);
        for (k, tire) in system.tires.iter().enumerate() {
            b.view_mut((n, FORCES * k), (n, 1)).copy_from(&tire.normal_row);
            b.view_mut((n, FORCES * k + 1), (n, 1)).copy_from(&tire.lateral_row);
            for c in 0..n {
                observe[(MOTIONS * k, c)] = tire.normal_row[c] / scale[c];
                observe[(MOTIONS * k + 1, n + c)] = tire.normal_row[c];
                observe[(MOTIONS * k + 2, n + c)] = tire.lateral_row[c];
            }
        }
        for (k, (_, row)) in system.applied.iter().enumerate() {
            b.view_mut((n, FORCES * tires + k), (n, 1)).copy_from(row);
        }
        let mut gravity = DMatrix::zeros(2 * n, 1);
        gravity.view_mut((n, 0), (n, 1)).copy_from(&system.gravity);
        Self { a, b, gravity, observe, scale, step: system.step, made: vec![None; DEPTH as usize + 1] }
    }

    /// The block of length step / 2^level.
    pub(super) fn level(&mut self, level: u32) -> &Block {
        let slot = &mut self.made[level as usize];
        slot.get_or_insert_with(|| {
            let h = self.step / f64::from(1u32 << level);
            let inputs = self.b.ncols();
            let all = DMatrix::from_fn(self.b.nrows(), inputs + 1, |r, c| {
                if c < inputs { self.b[(r, c)] } else { self.gravity[(r, 0)] }
            });
            let mut step = Propagator::first_order_hold(&self.a, &all, h);
            let weight = step.start.column(inputs) + step.end.column(inputs);
            step.start = step.start.columns(0, inputs).into_owned();
            step.end = step.end.columns(0, inputs).into_owned();
            let contact = self.observe.nrows() / MOTIONS * FORCES;
            let response = &self.observe * step.end.columns(0, contact);
            Block { h, step, weight, response }
        })
    }
}
