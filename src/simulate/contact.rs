//! Contact forces at the end of a block, solved implicitly with the compliance of the contact points.

use super::system::Tire;
use nalgebra::DMatrix;

/// Whether a tyre carries load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Regime {
    /// No force.
    Open,
    /// Pressed: the linear law, whatever its sign; a negative force at the end of a block tells that
    /// the tyre lifted off inside it.
    Pressed,
    /// The one-sided law itself; used where a step holds too many events to locate each.
    OneSided,
}

/// Motions of a contact point that the laws read, in this order: normal displacement, normal
/// velocity, lateral velocity.
pub(super) const MOTIONS: usize = 3;

/// Forces per contact point: along the normal row, along the lateral row.
pub(super) const FORCES: usize = 2;

/// Outcome of a solve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved {
    /// Newton iterations.
    pub(super) iterations: u64,
    /// False when the last correction was not yet at rounding.
    pub(super) converged: bool,
}

/// Most Newton iterations; the laws are piecewise smooth and monotone, three or four are usual.
const MOST_ITERATIONS: u64 = 60;

/// After this many full Newton steps the iteration is jumping between two branches of the cap: halve.
const FULL_STEPS: u64 = 12;

/// Solver with its work space.
#[derive(Clone, Debug)]
pub(super) struct ContactSolver {
    motion: Vec<f64>,
    law: Vec<f64>,
    slope: Vec<f64>,
    jacobian: Vec<f64>,
}

impl ContactSolver {
    /// For m tyres.
    pub(super) fn new(tires: usize) -> Self {
        let p = FORCES * tires;
        Self {
            motion: vec![0.0; MOTIONS * tires],
            law: vec![0.0; p],
            slope: vec![0.0; p * MOTIONS * tires],
            jacobian: vec![0.0; p * p],
        }
    }

    /// Forces of the laws for given motions, without feedback.
    pub(super) fn forces(tires: &[Tire], regimes: &[Regime], motion: &[f64], forces: &mut [f64]) {
        for (k, tire) in tires.iter().enumerate() {
            let law = tire_law(tire, regimes[k], &motion[MOTIONS * k..MOTIONS * (k + 1)]);
            forces[FORCES * k] = law.normal;
            forces[FORCES * k + 1] = law.lateral;
        }
    }

    /// Solves f = law(y + Q f) by Newton's method with the exact slopes of the laws; `free` = y
    /// (3m), `response` = Q (3m×2m), `forces` holds the guess and then the solution (2m).
    pub(super) fn solve(
        &mut self,
        tires: &[Tire],
        regimes: &[Regime],
        free: &[f64],
        response: &DMatrix<f64>,
        forces: &mut [f64],
    ) -> Solved {
        let p = forces.len();
        let q = free.len();
        let mut iterations = 0;
        loop {
            iterations += 1;
            for r in 0..q {
                self.motion[r] = free[r] + (0..p).map(|c| response[(r, c)] * forces[c]).sum::<f64>();
            }
            self.slope.fill(0.0);
            for (k, tire) in tires.iter().enumerate() {
                let law = tire_law(tire, regimes[k], &self.motion[MOTIONS * k..MOTIONS * (k + 1)]);
                let (row, col) = (FORCES * k, MOTIONS * k);
                self.law[row] = law.normal;
                self.law[row + 1] = law.lateral;
                self.slope[row * q + col] = law.normal_by_displacement;
                self.slope[row * q + col + 1] = law.normal_by_velocity;
                // The cap moves with the normal force.
                self.slope[(row + 1) * q + col] = law.lateral_by_normal * law.normal_by_displacement;
                self.slope[(row + 1) * q + col + 1] = law.lateral_by_normal * law.normal_by_velocity;
                self.slope[(row + 1) * q + col + 2] = law.lateral_by_velocity;
            }
            let mut largest = 1.0_f64;
            for r in 0..p {
                largest = largest.max(self.law[r].abs());
                self.law[r] -= forces[r];
                for c in 0..p {
                    let fed_back: f64 = (0..q).map(|k| self.slope[r * q + k] * response[(k, c)]).sum();
                    self.jacobian[r * p + c] = f64::from(u8::from(r == c)) - fed_back;
                }
            }
            solve_in_place(&mut self.jacobian, &mut self.law);
            let damping = if iterations <= FULL_STEPS { 1.0 } else { 0.5 };
            let mut correction = 0.0_f64;
            for r in 0..p {
                forces[r] += damping * self.law[r];
                correction = correction.max(self.law[r].abs());
            }
            // Forces carry a dozen roundings of the largest one.
            if correction <= 1e-13 * largest {
                return Solved { iterations, converged: true };
            }
            if iterations == MOST_ITERATIONS || !correction.is_finite() {
                return Solved { iterations, converged: correction <= 1e-6 * largest };
            }
        }
    }
}

struct TireForces {
    normal: f64,
    normal_by_displacement: f64,
    normal_by_velocity: f64,
    lateral: f64,
    lateral_by_velocity: f64,
    lateral_by_normal: f64,
}

fn tire_law(tire: &Tire, regime: Regime, motion: &[f64]) -> TireForces {
    let (penetration, rate) = (-motion[0] - tire.gap, -motion[1]);
    let normal = match regime {
        Regime::Open => 0.0,
        Regime::Pressed => tire.normal.pressed(penetration, rate),
        Regime::OneSided => tire.normal.force(penetration, rate),
    };
    let active = regime == Regime::Pressed || normal > 0.0;
    let (lateral, lateral_by_velocity, lateral_by_normal) =
        if active { tire.lateral.map_or((0.0, 0.0, 0.0), |law| law.force(motion[2], normal)) } else { (0.0, 0.0, 0.0) };
    TireForces {
        normal,
        normal_by_displacement: if active { -tire.normal.stiffness } else { 0.0 },
        normal_by_velocity: if active { -tire.normal.damping } else { 0.0 },
        lateral,
        lateral_by_velocity,
        lateral_by_normal,
    }
}

/// Gaussian elimination with partial pivoting of a small row-major system; the solution replaces
/// the right-hand side.
fn solve_in_place(a: &mut [f64], b: &mut [f64]) {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs())).unwrap_or(k);
        if pivot != k {
            for c in 0..n {
                a.swap(k * n + c, pivot * n + c);
            }
            b.swap(k, pivot);
        }
        for r in k + 1..n {
            let factor = a[r * n + k] / a[k * n + k];
            if factor != 0.0 {
                for c in k..n {
                    a[r * n + c] -= factor * a[k * n + c];
                }
                b[r] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|c| a[k * n + c] * b[c]).sum();
        b[k] = (b[k] - known) / a[k * n + k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::effect::{TireLateral, TireNormal};
    use nalgebra::DVector;

    fn tire() -> Tire {
        Tire {
            name: "w".into(),
            normal_row: DVector::zeros(0),
            lateral_row: DVector::zeros(0),
            gap: 0.0,
            normal: TireNormal { stiffness: 75e6, damping: 175.0 },
            lateral: Some(TireLateral { cornering_stiffness: 9542.6, friction: 0.743, base_speed: 12.6 }),
        }
    }

    #[test]
    fn stiff_tyre_with_sliding_solves_its_equation() {
        // 1 ms on a 1.5 kg wheel: displacement h²/6m, velocity h/2m per newton.
        let response = DMatrix::from_row_slice(3, 2, &[1.1e-7, 0.0, 3.3e-4, 0.0, 0.0, 5e-3]);
        for (z, vz, vy) in [(-1e-3, -3.0, 0.4), (-1e-4, 0.5, 8.0), (-0.02, -3.0, -20.0)] {
            let mut solver = ContactSolver::new(1);
            let mut f = [0.0, 0.0];
            let free = [z, vz, vy];
            let solved = solver.solve(&[tire()], &[Regime::OneSided], &free, &response, &mut f);
            assert!(solved.converged && solved.iterations < 20, "{solved:?}");
            let y: Vec<f64> = (0..3).map(|r| free[r] + response[(r, 0)] * f[0] + response[(r, 1)] * f[1]).collect();
            let mut law = [0.0; 2];
            ContactSolver::forces(&[tire()], &[Regime::OneSided], &y, &mut law);
            // The law amplifies rounding of y (1e-18 m) by K = 75e6.
            for k in 0..2 {
                assert!((law[k] - f[k]).abs() <= 1e-8 * (1.0 + f[k].abs()), "{law:?} {f:?}");
            }
        }
    }
}
