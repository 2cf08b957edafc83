//! Interface nodes: the joints and measured points of a body, one FE node or the average of a set.

use super::{Axis, FeModel, Modes, NodeId};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What an interface node is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// Forces act and joints attach here; residual flexibility is kept.
    Joint,
    /// Motion is only read here.
    Measured,
}

impl Role {
    /// "joint" or "measured".
    pub fn name(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Measured => "measured",
        }
    }
}

/// A point of the body whose motion is a weighted sum of FE degrees of freedom.
#[derive(Clone, Debug)]
pub struct InterfaceNode {
    /// Name in the recipe: "d".
    pub name: String,
    /// Joint or measured.
    pub role: Role,
    /// FE nodes it averages (one for a plain node).
    pub labels: Vec<NodeId>,
    /// Mean position, m.
    pub position: [f64; 3],
    /// Per direction the weights: motion = Σ weight·u\[row\].
    pub axes: Vec<(Axis, Vec<(usize, f64)>)>,
}

/// Why an interface node cannot be built.
#[derive(Debug, Error, PartialEq)]
pub enum InterfaceError {
    /// The label is not in the mesh.
    #[error("node {0} is not in the mesh; name a node of the mesh file")]
    NoNode(NodeId),
    /// The node carries no degree of freedom.
    #[error(
        "node {0} has no degree of freedom in the matrices (constrained, or not part of the export); choose a free node"
    )]
    NoDof(NodeId),
    /// A node of a set lacks a translation.
    #[error("node {node} of the set has no dof {axis} (constrained?); an average needs x, y and z of every node")]
    Incomplete {
        /// The node.
        node: NodeId,
        /// The missing direction.
        axis: Axis,
    },
    /// A set without nodes.
    #[error("the node set is empty")]
    EmptySet,
}

impl InterfaceNode {
    /// One FE node with whatever degrees of freedom it has.
    pub fn single(fe: &FeModel, name: &str, role: Role, node: NodeId) -> Result<Self, InterfaceError> {
        let position = *fe.nodes.get(&node).ok_or(InterfaceError::NoNode(node))?;
        let axes: Vec<_> =
            Axis::ALL.into_iter().filter_map(|a| fe.dofs.row(node, a).map(|row| (a, vec![(row, 1.0)]))).collect();
        if axes.is_empty() {
            return Err(InterfaceError::NoDof(node));
        }
        Ok(Self { name: name.into(), role, labels: vec![node], position, axes })
    }

    /// Average of a node set with unit weights: translation ū = Σu_i/N; rotation by least squares,
    /// θ = J⁻¹ Σ r_i × (u_i − ū) with r_i from the mean position and J = Σ(|r_i|² I − r_i r_iᵀ)
    /// (the motion an RBE3 element with unit weights gives its reference node). A set whose nodes
    /// lie on a line has no rotation about that line, a single node none at all: those directions
    /// are left out.
    pub fn average(fe: &FeModel, name: &str, role: Role, nodes: &[NodeId]) -> Result<Self, InterfaceError> {
        if nodes.is_empty() {
            return Err(InterfaceError::EmptySet);
        }
        let mut arms = Vec::with_capacity(nodes.len());
        let mut rows = Vec::with_capacity(nodes.len());
        for &node in nodes {
            let p = fe.nodes.get(&node).ok_or(InterfaceError::NoNode(node))?;
            arms.push(Vector3::from(*p));
            let mut of_node = [0usize; 3];
            for axis in [Axis::X, Axis::Y, Axis::Z] {
                of_node[axis.index()] = fe.dofs.row(node, axis).ok_or(InterfaceError::Incomplete { node, axis })?;
            }
            rows.push(of_node);
        }
        let share = 1.0 / nodes.len() as f64;
        let centre: Vector3<f64> = arms.iter().sum::<Vector3<f64>>() * share;
        arms.iter_mut().for_each(|r| *r -= centre);
        let second: Matrix3<f64> =
            arms.iter().map(|r| Matrix3::identity() * r.norm_squared() - r * r.transpose()).sum();
        let mut axes = Vec::with_capacity(6);
        for d in 0..3 {
            axes.push((Axis::ALL[d], rows.iter().map(|r| (r[d], share)).collect::<Vec<_>>()));
        }
        let eigen = second.symmetric_eigen();
        let largest = eigen.eigenvalues.amax();
        // Rounding of node coordinates leaves a line of nodes with a moment of ~1e-12 of the largest.
        let has_rotation = largest > 0.0 && eigen.eigenvalues.min() > 1e-10 * largest;
        if has_rotation {
            let inverse = eigen.eigenvectors
                * Matrix3::from_diagonal(&eigen.eigenvalues.map(|e| 1.0 / e))
                * eigen.eigenvectors.transpose();
            for d in 0..3 {
                // Σ r × ū vanishes because Σ r = 0, so the mean need not be subtracted.
                let mut weights = Vec::with_capacity(3 * nodes.len());
                for (r, row) in arms.iter().zip(&rows) {
                    // θ_d = inverse_d · (r × u): the coefficient of u_c is (inverse_d × r)_c.
                    let w = Vector3::from(inverse.row(d).transpose()).cross(r);
                    for c in 0..3 {
                        if w[c] != 0.0 {
                            weights.push((row[c], w[c]));
                        }
                    }
                }
                axes.push((Axis::ALL[3 + d], weights));
            }
        }
        Ok(Self { name: name.into(), role, labels: nodes.to_vec(), position: centre.into(), axes })
    }

    /// Weights of a direction, if the node has it.
    pub fn weights(&self, axis: Axis) -> Option<&[(usize, f64)]> {
        self.axes.iter().find(|a| a.0 == axis).map(|a| a.1.as_slice())
    }

    /// The modal row φ of a direction: its motion per unit of each modal coordinate; m, 1/√kg.
    pub fn modal_row(&self, axis: Axis, modes: &Modes) -> Option<Vec<f64>> {
        let weights = self.weights(axis)?;
        Some((0..modes.len()).map(|c| weights.iter().map(|&(row, w)| w * modes.shapes[(row, c)]).sum()).collect())
    }
}
