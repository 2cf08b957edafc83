//! A body as modal coordinates: rigid motions first, then elastic modes, unit modal mass each.

use super::error::{SceneError, names};
use crate::model::{Axis, ReducedModel, RigidBody};
use nalgebra::{DMatrix, DVector};

/// What a body is made of.
#[derive(Clone, Debug)]
pub(super) enum Make<'a> {
    /// Mass and inertia at a point; no rotation coordinates where there is no inertia.
    Rigid(RigidBody),
    /// A reduced model; `shapes` has one column per coordinate of the body, one row per kept dof.
    Flexible {
        /// The reduced model.
        model: &'a ReducedModel,
        /// k×c, 1/√kg.
        shapes: DMatrix<f64>,
    },
}

/// A body of the scene with its c coordinates.
#[derive(Clone, Debug)]
pub(super) struct Body<'a> {
    /// Name in the scene.
    pub(super) name: String,
    /// What it is made of.
    pub(super) make: Make<'a>,
    /// Natural frequency per coordinate, rad/s; 0 for rigid motions; c.
    pub(super) omega: Vec<f64>,
    /// Damping ratio per coordinate; c.
    pub(super) zeta: Vec<f64>,
    /// Participation Γ for unit translations, c×3, √kg.
    pub(super) participation: DMatrix<f64>,
    /// First coordinate in the scene's vector.
    pub(super) first: usize,
}

impl<'a> Body<'a> {
    /// A rigid body.
    pub(super) fn rigid(name: &str, body: RigidBody) -> Self {
        let motion = body.motion_at(body.centre);
        let count = motion.ncols();
        Self {
            name: name.into(),
            omega: vec![0.0; count],
            zeta: vec![0.0; count],
            participation: motion.rows(0, 3).transpose() * body.mass,
            make: Make::Rigid(body),
            first: 0,
        }
    }

    /// A reduced model with its rigid motions and the given elastic coordinates: columns of shapes
    /// (k×e), their frequencies, damping ratios and participation (e×3).
    pub(super) fn flexible(
        name: &str,
        model: &'a ReducedModel,
        elastic: &DMatrix<f64>,
        omega: &[f64],
        zeta: &[f64],
        participation: &DMatrix<f64>,
    ) -> Self {
        let rigid = &model.rigid;
        let s = rigid.shapes.ncols();
        let stack = |top: &DMatrix<f64>, bottom: &DMatrix<f64>| {
            DMatrix::from_fn(s + bottom.nrows(), 3, |r, c| if r < s { top[(r, c)] } else { bottom[(r - s, c)] })
        };
        let shapes = DMatrix::from_fn(model.dofs.len(), s + elastic.ncols(), |r, c| {
            if c < s { rigid.shapes[(r, c)] } else { elastic[(r, c - s)] }
        });
        Self {
            name: name.into(),
            omega: std::iter::repeat_n(0.0, s).chain(omega.iter().copied()).collect(),
            zeta: std::iter::repeat_n(0.0, s).chain(zeta.iter().copied()).collect(),
            participation: stack(&rigid.participation, participation),
            make: Make::Flexible { model, shapes },
            first: 0,
        }
    }

    /// Number of coordinates.
    pub(super) fn count(&self) -> usize {
        self.omega.len()
    }

    /// Position of a node of the body, or of its centre of mass without a node.
    pub(super) fn position(&self, node: Option<&str>) -> Result<[f64; 3], SceneError> {
        match (&self.make, node) {
            (Make::Rigid(body), None) => Ok(body.centre),
            (Make::Rigid(_), Some(node)) => Err(SceneError::missing(format!(
                "body \"{}\" is rigid and has no node \"{node}\"; name the body alone",
                self.name
            ))),
            (Make::Flexible { model, .. }, Some(node)) => Ok(model.nodes[self.node(model, node)?].position),
            (Make::Flexible { model, .. }, None) => Err(SceneError::missing(format!(
                "body \"{0}\" is flexible: name one of its nodes, \"{0}:NODE\", with NODE among {1}",
                self.name,
                names(model.nodes.iter().map(|n| n.name.as_str()))
            ))),
        }
    }

    fn node(&self, model: &ReducedModel, node: &str) -> Result<usize, SceneError> {
        model.node(node).ok_or_else(|| {
            SceneError::missing(format!(
                "body \"{}\" has no node \"{node}\"; its reduced model keeps {}",
                self.name,
                names(model.nodes.iter().map(|n| n.name.as_str()))
            ))
        })
    }

    /// Motion in a direction, per unit of each coordinate of the body; c. For a flexible body at a
    /// node; for a rigid one at a point of space that moves with it.
    pub(super) fn motion(&self, node: Option<&str>, point: [f64; 3], axis: Axis) -> Result<DVector<f64>, SceneError> {
        match &self.make {
            Make::Rigid(body) => {
                Ok(DVector::from_iterator(self.count(), body.motion_at(point).row(axis.index()).iter().copied()))
            }
            Make::Flexible { model, shapes } => {
                self.position(node)?;
                let node = node.unwrap_or_default();
                let row = model.row(self.node(model, node)?, axis).ok_or_else(|| {
                    SceneError::missing(format!(
                        "node \"{}:{node}\" has no direction {axis}: a single solid-element node has no rotation; make the joint a node set in model.toml",
                        self.name
                    ))
                })?;
                Ok(DVector::from_iterator(self.count(), shapes.row(row).iter().copied()))
            }
        }
    }
}
