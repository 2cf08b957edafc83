//! The finite-element model: matrices, degrees of freedom, nodes and sets. SI units inside.

use super::{DofMap, NodeId, Source};
use crate::linalg::SymSparse;
use std::collections::BTreeMap;

/// K, M and what their rows mean; n degrees of freedom.
#[derive(Clone, Debug)]
pub struct FeModel {
    /// Name of the model.
    pub name: String,
    /// Position of each node, m; empty when no mesh was given.
    pub nodes: BTreeMap<NodeId, [f64; 3]>,
    /// Row ↔ node and direction; n rows.
    pub dofs: DofMap,
    /// K, n×n, N/m (N·m/rad for rotations).
    pub stiffness: SymSparse,
    /// M, n×n, kg (kg·m² for rotations).
    pub mass: SymSparse,
    /// Named node sets of the mesh, labels ascending.
    pub node_sets: BTreeMap<String, Vec<NodeId>>,
    /// Files this came from.
    pub sources: Vec<Source>,
}
