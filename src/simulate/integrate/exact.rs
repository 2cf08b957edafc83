//! The `exact-modal` integrator: ẅ + Cẇ + Λw = weight + rows·f over a step by matrix exponential,
//! f linear over the step (first-order hold) with its end value solved from the contact laws.
//! Second order; the linear part is exact at any step. Where a tyre touches down or lifts off inside
//! a step, the step is split there, by halving, to step/2^16.

use super::block::{Blocks, DEPTH};
use crate::simulate::contact::{ContactSolver, FORCES, MOTIONS, Regime};
use crate::simulate::energy::Balance;
use crate::simulate::system::System;
use nalgebra::DVector;

/// Events located within one step; beyond, the rest of the step uses the one-sided law unlocated
/// (chatter: more than 32 contacts in one step are below its resolution).
const MOST_EVENTS: u32 = 32;

/// State and forces at the end of a step.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct Sample {
    /// s.
    pub(in crate::simulate) t: f64,
    /// w; n.
    pub(in crate::simulate) position: DVector<f64>,
    /// ẇ; n.
    pub(in crate::simulate) velocity: DVector<f64>,
    /// ẅ; n.
    pub(in crate::simulate) acceleration: DVector<f64>,
    /// Two forces per tyre, then the given forces; N.
    pub(in crate::simulate) forces: Vec<f64>,
}

/// Counts of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::simulate) struct Counts {
    pub(in crate::simulate) steps: u64,
    pub(in crate::simulate) substeps: u64,
    pub(in crate::simulate) solves: u64,
    pub(in crate::simulate) iterations: u64,
    pub(in crate::simulate) events: u64,
    pub(in crate::simulate) unconverged: u64,
    pub(in crate::simulate) unlocated: u64,
}

/// The integrator and its state.
#[derive(Debug)]
pub(in crate::simulate) struct Exact<'a> {
    system: &'a System,
    blocks: Blocks,
    solver: ContactSolver,
    regimes: Vec<Regime>,
    state: DVector<f64>,
    /// State at the end of the block being tried.
    trial: DVector<f64>,
    forces: Vec<f64>,
    trial_forces: Vec<f64>,
    motion: DVector<f64>,
    /// Counts so far.
    pub(in crate::simulate) counts: Counts,
    /// Energy accounts so far.
    pub(in crate::simulate) balance: Balance,
    /// State and forces at the end of the last step.
    pub(in crate::simulate) now: Sample,
}

impl<'a> Exact<'a> {
    /// At rest position, with the start velocity.
    pub(in crate::simulate) fn new(system: &'a System) -> Self {
        let n = system.stiffness.len();
        let tires = system.tires.len();
        let blocks = Blocks::new(system);
        let mut state = DVector::zeros(2 * n);
        state.rows_mut(n, n).copy_from(&system.start_velocity);
        let inputs = FORCES * tires + system.applied.len();
        let mut exact = Self {
            system,
            solver: ContactSolver::new(tires),
            regimes: vec![Regime::Open; tires],
            trial: state.clone(),
            forces: vec![0.0; inputs],
            trial_forces: vec![0.0; inputs],
            motion: DVector::zeros(MOTIONS * tires),
            counts: Counts::default(),
            balance: Balance::new(system),
            now: Sample {
                t: 0.0,
                position: DVector::zeros(n),
                velocity: system.start_velocity.clone(),
                acceleration: DVector::zeros(n),
                forces: vec![0.0; inputs],
            },
            blocks,
            state,
        };
        for (k, (law, _)) in system.applied.iter().enumerate() {
            exact.forces[FORCES * tires + k] = law.at(0.0);
        }
        exact.motion.copy_from(&(&exact.blocks.observe * &exact.state));
        for k in 0..tires {
            exact.regimes[k] = exact.touching(k);
        }
        exact.contact_forces_now();
        exact.publish(0.0);
        exact.balance.start(system, &exact.now);
        exact
    }

    /// Pressed when the law pushes at the motions in `motion`.
    fn touching(&self, k: usize) -> Regime {
        let tire = &self.system.tires[k];
        let (displacement, velocity) = (self.motion[MOTIONS * k], self.motion[MOTIONS * k + 1]);
        if tire.normal.force(-displacement - tire.gap, -velocity) > 0.0 { Regime::Pressed } else { Regime::Open }
    }

    /// Sets the contact forces of `forces` from the laws at the motions in `motion`.
    fn contact_forces_now(&mut self) {
        let contact = FORCES * self.system.tires.len();
        ContactSolver::forces(&self.system.tires, &self.regimes, self.motion.as_slice(), &mut self.forces[..contact]);
    }

    /// One step; `k` is its number, so that time carries no accumulated rounding.
    pub(in crate::simulate) fn advance(&mut self, k: u64) {
        let whole = 1u32 << DEPTH;
        let begin = k as f64 * self.system.step;
        let (mut tick, mut cap, mut events) = (0u32, whole, 0u32);
        while tick < whole {
            let aligned = if tick == 0 { whole } else { 1 << tick.trailing_zeros() };
            let mut size = aligned.min(cap);
            let time = |tick: u32| begin + self.system.step * f64::from(tick) / f64::from(whole);
            let mut end = time(tick + size);
            let mut changes = self.try_block(DEPTH - size.trailing_zeros(), end);
            while changes && size > 1 {
                size /= 2;
                cap = size;
                end = time(tick + size);
                changes = self.try_block(DEPTH - size.trailing_zeros(), end);
            }
            if size < whole {
                self.counts.substeps += 1;
            }
            tick += size;
            if changes {
                self.release(end);
            }
            self.accept(DEPTH - size.trailing_zeros(), end);
            if changes {
                events += 1;
                cap = whole;
                self.press(end);
                if events == MOST_EVENTS {
                    self.counts.unlocated += 1;
                    self.regimes.fill(Regime::OneSided);
                    self.contact_forces_now();
                }
            }
        }
        for regime in 0..self.regimes.len() {
            if self.regimes[regime] == Regime::OneSided {
                self.regimes[regime] = self.touching(regime);
            }
        }
        self.counts.steps += 1;
        self.counts.events += u64::from(events);
    }

    /// Propagates over a block into `trial`; true when a tyre touches down or lifts off in it.
    fn try_block(&mut self, level: u32, end: f64) -> bool {
        let contact = FORCES * self.system.tires.len();
        let block = self.blocks.level(level);
        self.trial_forces[..contact].copy_from_slice(&self.forces[..contact]);
        for (k, (law, _)) in self.system.applied.iter().enumerate() {
            self.trial_forces[contact + k] = law.at(end);
        }
        self.trial.copy_from(&block.weight);
        self.trial.gemv(1.0, &block.step.transition, &self.state, 1.0);
        for (c, &f) in self.forces.iter().enumerate() {
            if f != 0.0 {
                self.trial.axpy(f, &block.step.start.column(c), 1.0);
            }
        }
        for c in contact..self.trial_forces.len() {
            self.trial.axpy(self.trial_forces[c], &block.step.end.column(c), 1.0);
        }
        if contact == 0 {
            return false;
        }
        self.motion.gemv(1.0, &self.blocks.observe, &self.trial, 0.0);
        if self.regimes.iter().all(|&r| r == Regime::Open) {
            self.trial_forces[..contact].fill(0.0);
        } else {
            let block = self.blocks.level(level);
            let solved = self.solver.solve(
                &self.system.tires,
                &self.regimes,
                self.motion.as_slice(),
                &block.response,
                &mut self.trial_forces[..contact],
            );
            self.counts.solves += 1;
            self.counts.iterations += solved.iterations;
            self.counts.unconverged += u64::from(!solved.converged);
            for c in 0..contact {
                let f = self.trial_forces[c];
                self.trial.axpy(f, &block.step.end.column(c), 1.0);
                self.motion.axpy(f, &block.response.column(c), 1.0);
            }
        }
        (0..self.regimes.len()).any(|k| self.changes(k))
    }

    /// True when the trial's end contradicts the regime of a tyre.
    fn changes(&self, k: usize) -> bool {
        match self.regimes[k] {
            Regime::Open => self.touching(k) == Regime::Pressed,
            Regime::Pressed => self.trial_forces[FORCES * k] < 0.0,
            Regime::OneSided => false,
        }
    }

    /// Lift-off in the smallest block: no force at its end for those tyres.
    fn release(&mut self, end: f64) {
        let lifted: Vec<usize> =
            (0..self.regimes.len()).filter(|&k| self.regimes[k] == Regime::Pressed && self.changes(k)).collect();
        if !lifted.is_empty() {
            for k in lifted {
                self.regimes[k] = Regime::Open;
            }
            self.try_block(DEPTH, end);
        }
    }

    /// Touchdown at the end of the smallest block: the force jumps to what the law says.
    fn press(&mut self, end: f64) {
        for k in 0..self.regimes.len() {
            if self.regimes[k] == Regime::Open && self.touching(k) == Regime::Pressed {
                self.regimes[k] = Regime::Pressed;
            }
        }
        self.contact_forces_now();
        self.publish(end);
        self.balance.restart(self.system, &self.now);
    }

    fn accept(&mut self, level: u32, end: f64) {
        std::mem::swap(&mut self.state, &mut self.trial);
        std::mem::swap(&mut self.forces, &mut self.trial_forces);
        self.publish(end);
        let h = self.blocks.level(level).h;
        self.balance.add(self.system, &self.regimes, h, &self.now);
    }

    /// Brings `now` up to the state: w, ẇ, ẅ = weight + rows·f − Cẇ − Λw.
    fn publish(&mut self, t: f64) {
        let n = self.system.stiffness.len();
        let now = &mut self.now;
        now.t = t;
        for k in 0..n {
            now.position[k] = self.state[k] / self.blocks.scale[k];
            now.velocity[k] = self.state[n + k];
        }
        now.forces.copy_from_slice(&self.forces);
        now.acceleration.copy_from(&self.system.gravity);
        now.acceleration.gemv(-1.0, &self.system.damping, &now.velocity, 1.0);
        for k in 0..n {
            now.acceleration[k] -= self.system.stiffness[k] * now.position[k];
        }
        for (k, tire) in self.system.tires.iter().enumerate() {
            now.acceleration.axpy(self.forces[FORCES * k], &tire.normal_row, 1.0);
            now.acceleration.axpy(self.forces[FORCES * k + 1], &tire.lateral_row, 1.0);
        }
        let contact = FORCES * self.system.tires.len();
        for (k, (_, row)) in self.system.applied.iter().enumerate() {
            now.acceleration.axpy(self.forces[contact + k], row, 1.0);
        }
    }
}
