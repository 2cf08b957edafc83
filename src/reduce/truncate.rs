//! Modal truncation at the interface nodes, with or without residual flexibility.

use super::residual::{ResidualError, residual};
use crate::model::{
    FeModel, InterfaceNode, KeptDof, KeptMode, KeptNode, Modes, Ranking, ReducedModel, Residual, RigidBody, RigidPart,
    Selection,
};
use nalgebra::{DMatrix, Matrix3};
use thiserror::Error;

/// A way to reduce, by name.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Name in recipes.
    pub name: &'static str,
    /// One line of help.
    pub help: &'static str,
    /// Whether residual vectors at the joints are added.
    pub residual: bool,
}

/// All methods.
pub const METHODS: &[Method] = &[
    Method { name: "truncation", help: "the kept modes only (the paper's)", residual: false },
    Method {
        name: "truncation-residual",
        help: "the kept modes, and at every joint the static flexibility of all the others, computed or not",
        residual: true,
    },
];

/// The method of a name.
pub fn method(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|m| m.name == name)
}

/// What a reduced model is made from and what its provenance says.
#[derive(Clone, Debug)]
pub struct Made<'a> {
    /// The FE model; without one (mode shapes only) there is no residual flexibility.
    pub fe: Option<&'a FeModel>,
    /// All computed modes, damping set.
    pub modes: &'a Modes,
    /// The ranking the selection was made from.
    pub ranking: &'a Ranking,
    /// The kept modes.
    pub selection: &'a Selection,
    /// Kept nodes, joints and measured.
    pub nodes: &'a [InterfaceNode],
    /// Name of the model.
    pub name: &'a str,
    /// Text of the recipe.
    pub recipe: &'a str,
    /// "ferrom 0.1.0".
    pub tool: &'a str,
}

/// Why a model cannot be reduced.
#[derive(Debug, Error)]
pub enum ReduceError {
    /// Nothing to attach to.
    #[error("the recipe names no joint and no measured node; add [joint.NAME] or [measured.NAME]")]
    NoNodes,
    /// Residual flexibility needs K.
    #[error(
        "residual flexibility needs the stiffness matrix, and only mode shapes were given; use method = \"truncation\""
    )]
    NoMatrices,
    /// The static solution failed.
    #[error(transparent)]
    Residual(#[from] ResidualError),
}

/// Keeps the selected modes at the interface nodes: Θ = TΦ with T the weights of the interface
/// nodes (eq. (9) of Xue et al. 2014), and the rigid part beside them.
pub fn reduce(method: &Method, made: &Made) -> Result<ReducedModel, ReduceError> {
    if made.nodes.is_empty() {
        return Err(ReduceError::NoNodes);
    }
    let modes = made.modes;
    let mut dofs = Vec::new();
    let mut rows: Vec<&[(usize, f64)]> = Vec::new();
    for (node, interface) in made.nodes.iter().enumerate() {
        for (axis, weights) in &interface.axes {
            dofs.push(KeptDof { node, axis: *axis });
            rows.push(weights);
        }
    }
    let at_rows = |columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |k, c| {
            rows[k].iter().map(|&(row, w)| w * modes.shapes[(row, columns[c])]).sum()
        })
    };
    let kept: Vec<usize> = made.selection.modes.iter().map(|m| m.column()).collect();
    let rigid: Vec<usize> = (0..modes.rigid).collect();
    let participation =
        |columns: &[usize]| DMatrix::from_fn(columns.len(), 3, |c, d| modes.participation[(columns[c], d)]);
    let residual = match (method.residual, made.fe) {
        (false, _) => None,
        (true, None) => return Err(ReduceError::NoMatrices),
        (true, Some(fe)) => Some(with_damping(residual(fe, modes, &kept, made.nodes, &rows)?, modes, &kept)),
    };
    let body = made.fe.and_then(RigidBody::of).unwrap_or(RigidBody {
        // Without matrices, M and positions the mass is what the rigid modes carry: Γ² summed.
        mass: (0..3)
            .map(|d| rigid.iter().map(|&c| modes.participation[(c, d)].powi(2)).sum::<f64>())
            .fold(0.0, f64::max),
        centre: [0.0; 3],
        inertia: Matrix3::zeros(),
    });
    Ok(ReducedModel {
        name: made.name.into(),
        modes: made
            .selection
            .modes
            .iter()
            .map(|&number| KeptMode {
                number,
                omega: modes.omega[number.column()],
                zeta: modes.zeta[number.column()],
                origin: modes.origin[number.column()],
            })
            .collect(),
        shapes: at_rows(&kept),
        participation: participation(&kept),
        dofs,
        nodes: made
            .nodes
            .iter()
            .map(|n| KeptNode { name: n.name.clone(), role: n.role, position: n.position, labels: n.labels.clone() })
            .collect(),
        rigid: RigidPart { body, shapes: at_rows(&rigid), participation: participation(&rigid) },
        residual,
        ranking: made.ranking.clone(),
        selection: made.selection.clone(),
        full_dofs: modes.dofs.len(),
        sources: made.fe.map_or_else(Vec::new, |fe| fe.sources.clone()),
        recipe: made.recipe.into(),
        tool: made.tool.into(),
    })
}

/// Residual vectors stand for modes above the kept ones: they get the damping ratio of the highest
/// kept mode (of the last computed one when none is kept).
fn with_damping(mut residual: Residual, modes: &Modes, kept: &[usize]) -> Residual {
    let zeta = kept.last().or(modes.len().checked_sub(1).as_ref()).map_or(0.0, |&c| modes.zeta[c]);
    residual.zeta = vec![zeta; residual.omega.len()];
    residual
}
