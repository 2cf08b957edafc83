//! Degrees of freedom: which node, which direction, which row.

use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt;
use thiserror::Error;

/// A node's label in the finite-element file; never an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct NodeId(pub u32);

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Direction of a degree of freedom in the model's Cartesian axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Translation along x, m.
    X,
    /// Translation along y, m.
    Y,
    /// Translation along z, m.
    Z,
    /// Rotation about x, rad.
    Rx,
    /// Rotation about y, rad.
    Ry,
    /// Rotation about z, rad.
    Rz,
}

impl Axis {
    /// All six, translations first.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::Rx, Self::Ry, Self::Rz];

    /// 0 … 5 for x y z rx ry rz.
    pub fn index(self) -> usize {
        self as usize
    }

    /// The direction numbered 1 … 6 in FE programs.
    pub fn from_number(number: u32) -> Option<Self> {
        Self::ALL.get((number as usize).checked_sub(1)?).copied()
    }

    /// "x" … "rz".
    pub fn name(self) -> &'static str {
        ["x", "y", "z", "rx", "ry", "rz"][self.index()]
    }

    /// The direction called "x" … "rz", in any case.
    pub fn parse(text: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|a| a.name().eq_ignore_ascii_case(text))
    }

    /// True for rotations.
    pub fn is_rotation(self) -> bool {
        self.index() >= 3
    }

    /// SI unit of the motion: "m" or "rad".
    pub fn unit(self) -> &'static str {
        if self.is_rotation() { "rad" } else { "m" }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One degree of freedom of an FE model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dof {
    /// The node's label.
    pub node: NodeId,
    /// The direction.
    pub axis: Axis,
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.node, self.axis)
    }
}

/// Row ↔ degree of freedom. A model read from bare matrices has rows without labels.
#[derive(Clone, Debug, PartialEq)]
pub struct DofMap {
    count: usize,
    label: Vec<Dof>,
    row: HashMap<Dof, usize>,
}

/// A label that stands twice in a dof list.
#[derive(Debug, Error, PartialEq)]
#[error(
    "dof {dof} labels both row {first} and row {second}; expected each label once (shells and beams expanded to solids repeat labels: export the expanded mesh, or use solid elements)"
)]
pub struct RepeatedDof {
    /// The repeated label.
    pub dof: Dof,
    /// 1-based row of its first occurrence.
    pub first: usize,
    /// 1-based row of its second occurrence.
    pub second: usize,
}

impl DofMap {
    /// Labels in row order; refuses a repeated one.
    pub fn labelled(label: Vec<Dof>) -> Result<Self, RepeatedDof> {
        let mut row = HashMap::with_capacity(label.len());
        for (k, &dof) in label.iter().enumerate() {
            if let Some(first) = row.insert(dof, k) {
                return Err(RepeatedDof { dof, first: first + 1, second: k + 1 });
            }
        }
        Ok(Self { count: label.len(), label, row })
    }

    /// Rows without labels.
    pub fn unlabelled(count: usize) -> Self {
        Self { count, label: Vec::new(), row: HashMap::new() }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// True when rows carry labels.
    pub fn is_labelled(&self) -> bool {
        self.label.len() == self.count
    }

    /// Labels in row order; empty when there are none.
    pub fn labels(&self) -> &[Dof] {
        &self.label
    }

    /// The row of a degree of freedom.
    pub fn row(&self, node: NodeId, axis: Axis) -> Option<usize> {
        self.row.get(&Dof { node, axis }).copied()
    }

    /// "2852.z", or "row 17" (from 1) without labels.
    pub fn describe(&self, row: usize) -> String {
        self.label.get(row).map_or_else(|| format!("row {}", row + 1), |d| d.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_labels_are_refused_with_both_rows() {
        let d = |n, a| Dof { node: NodeId(n), axis: a };
        let err = DofMap::labelled(vec![d(1, Axis::X), d(1, Axis::Y), d(1, Axis::X)]).expect_err("repeated");
        assert_eq!((err.first, err.second), (1, 3));
    }

    #[test]
    fn axes_are_numbered_as_in_fe_programs() {
        assert_eq!(Axis::from_number(3), Some(Axis::Z));
        assert_eq!(Axis::from_number(0), None);
        assert_eq!(Axis::parse("RX"), Some(Axis::Rx));
    }
}
