//! The reduced model: the kept modes at the kept degrees of freedom, and what was left out.

use super::{Axis, ModeNo, NodeId, Origin, Ranking, RigidBody, Role, Selection, Source};
use nalgebra::DMatrix;

/// A kept elastic mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeptMode {
    /// Number in the full analysis, rigid modes first.
    pub number: ModeNo,
    /// rad/s.
    pub omega: f64,
    /// Damping ratio.
    pub zeta: f64,
    /// Computed, imported or measured.
    pub origin: Origin,
}

/// A kept node: one FE node or the average of several.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptNode {
    /// Name in the recipe: "d".
    pub name: String,
    /// Joint or measured.
    pub role: Role,
    /// Position, m.
    pub position: [f64; 3],
    /// FE labels averaged.
    pub labels: Vec<NodeId>,
}

/// A kept degree of freedom: a row of the shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptDof {
    /// Index into `nodes`.
    pub node: usize,
    /// Direction in the model's axes.
    pub axis: Axis,
}

/// The free motion of the body as a whole; s rigid modes (6 for a free body in space, 0 for a
/// clamped one).
#[derive(Clone, Debug, PartialEq)]
pub struct RigidPart {
    /// Mass, centre, inertia.
    pub body: RigidBody,
    /// Rigid shapes at the kept degrees of freedom, k×s, 1/√kg.
    pub shapes: DMatrix<f64>,
    /// Γ of each rigid mode for unit translations x y z, s×3, √kg.
    pub participation: DMatrix<f64>,
}

/// Everything the kept modes leave out, statically exact at the joints: residual vectors, which
/// are the part of the body's static (inertia-relief) response to a unit force at each joint
/// degree of freedom that the kept modes lack, mass-orthonormalised. t vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// R, k×k, m/N: static flexibility less Σ_kept φφᵀ/ω², equal to S diag(1/ω²) Sᵀ with the two
    /// fields below. Exact in the columns (and rows) of joint nodes, which carry forces; between two
    /// measured nodes it is the part the residual vectors span.
    pub flexibility: DMatrix<f64>,
    /// Frequencies of the residual vectors, rad/s; t.
    pub omega: Vec<f64>,
    /// Damping ratio used for each residual vector; t.
    pub zeta: Vec<f64>,
    /// S, their shapes at the kept degrees of freedom, k×t, 1/√kg.
    pub shapes: DMatrix<f64>,
    /// Γ of each residual vector for unit translations, t×3, √kg (0 for a free body).
    pub participation: DMatrix<f64>,
}

/// A body reduced to r elastic modes at k degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedModel {
    /// Name of the model.
    pub name: String,
    /// Kept elastic modes, ascending; r.
    pub modes: Vec<KeptMode>,
    /// Θ, their shapes at the kept degrees of freedom, k×r, 1/√kg.
    pub shapes: DMatrix<f64>,
    /// Γ of each kept mode for unit translations x y z, r×3, √kg.
    pub participation: DMatrix<f64>,
    /// Rows of the shapes; k.
    pub dofs: Vec<KeptDof>,
    /// Kept nodes.
    pub nodes: Vec<KeptNode>,
    /// Rigid motion.
    pub rigid: RigidPart,
    /// What the kept modes leave out; `None` when the recipe asks for none.
    pub residual: Option<Residual>,
    /// Scores the selection was made from.
    pub ranking: Ranking,
    /// The kept modes and the reason.
    pub selection: Selection,
    /// Degrees of freedom of the full model.
    pub full_dofs: usize,
    /// Files it was made from.
    pub sources: Vec<Source>,
    /// The recipe (model.toml) it was made by, as text.
    pub recipe: String,
    /// "ferrom 0.1.0".
    pub tool: String,
}

impl ReducedModel {
    /// The node of a name.
    pub fn node(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|n| n.name == name)
    }

    /// The row of the shapes for a node and direction.
    pub fn row(&self, node: usize, axis: Axis) -> Option<usize> {
        self.dofs.iter().position(|d| d.node == node && d.axis == axis)
    }

    /// "d:z" for a row of the shapes.
    pub fn dof_name(&self, row: usize) -> String {
        let dof = self.dofs[row];
        format!("{}:{}", self.nodes[dof.node].name, dof.axis)
    }
}
