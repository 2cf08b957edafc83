//! State-space form of a reduced body, eq. (5)–(10) of Xue et al. 2014.

use super::ReducedModel;
use nalgebra::DMatrix;

/// ẋ = A x + B u, y = C x + D u with x = [q; q̇] of the kept elastic modes, u the forces at p kept
/// degrees of freedom and y their displacements, velocities and accelerations at q of them.
#[derive(Clone, Debug)]
pub struct StateSpace {
    /// 2r×2r: [0 I; −Ω −2Γ] with Ω = diag(ω²), Γ = diag(ζω).
    pub a: DMatrix<f64>,
    /// 2r×p: [0; Σ], Σ = Φᵀ at the inputs.
    pub b: DMatrix<f64>,
    /// 3q×2r: rows of displacement, velocity, acceleration.
    pub c: DMatrix<f64>,
    /// 3q×p: [0; 0; ΘΣ].
    pub d: DMatrix<f64>,
    /// Names of the inputs with unit: "d:z N".
    pub inputs: Vec<String>,
    /// Names of the outputs with unit: "d:z m", then "m/s", then "m/s2".
    pub outputs: Vec<String>,
}

impl StateSpace {
    /// Forces at the rows `inputs`, motions at the rows `outputs` of the reduced model's shapes.
    pub fn new(model: &ReducedModel, inputs: &[usize], outputs: &[usize]) -> Self {
        let r = model.modes.len();
        let (p, q) = (inputs.len(), outputs.len());
        let mut a = DMatrix::zeros(2 * r, 2 * r);
        let mut b = DMatrix::zeros(2 * r, p);
        let mut c = DMatrix::zeros(3 * q, 2 * r);
        let mut d = DMatrix::zeros(3 * q, p);
        for (i, mode) in model.modes.iter().enumerate() {
            let (stiffness, damping) = (mode.omega * mode.omega, 2.0 * mode.zeta * mode.omega);
            a[(i, r + i)] = 1.0;
            a[(r + i, i)] = -stiffness;
            a[(r + i, r + i)] = -damping;
            for (k, &row) in inputs.iter().enumerate() {
                b[(r + i, k)] = model.shapes[(row, i)];
            }
            for (k, &row) in outputs.iter().enumerate() {
                let theta = model.shapes[(row, i)];
                c[(k, i)] = theta;
                c[(q + k, r + i)] = theta;
                c[(2 * q + k, i)] = -theta * stiffness;
                c[(2 * q + k, r + i)] = -theta * damping;
                for (l, &source) in inputs.iter().enumerate() {
                    d[(2 * q + k, l)] += theta * model.shapes[(source, i)];
                }
            }
        }
        let force = |row: &usize| {
            let unit = if model.dofs[*row].axis.is_rotation() { "N*m" } else { "N" };
            format!("{} {unit}", model.dof_name(*row))
        };
        let motion = |suffix: &'static str| {
            move |row: &usize| format!("{} {}{suffix}", model.dof_name(*row), model.dofs[*row].axis.unit())
        };
        let outputs_named =
            ["", "/s", "/s2"].into_iter().flat_map(|s| outputs.iter().map(motion(s)).collect::<Vec<_>>()).collect();
        Self { a, b, c, d, inputs: inputs.iter().map(force).collect(), outputs: outputs_named }
    }
}
