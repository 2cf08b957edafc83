//! A scene half assembled: its bodies, and how their coordinates map to those of the jointed system.

use super::bodies::find;
use super::body::Body;
use super::error::SceneError;
use super::scene::Scene;
use crate::model::Axis;
use nalgebra::{DMatrix, DVector};

/// Bodies, and how coordinates of the scene's vector map to those of the jointed system.
pub(super) struct Assembly<'a> {
    pub(super) scene: &'a Scene,
    pub(super) bodies: Vec<Body<'a>>,
    /// N×n: scene coordinates per jointed coordinate.
    pub(super) basis: DMatrix<f64>,
}

impl Assembly<'_> {
    /// A row over one body's coordinates as a row over the jointed coordinates.
    pub(super) fn jointed(&self, body: usize, row: &DVector<f64>) -> DVector<f64> {
        let body = &self.bodies[body];
        self.basis.rows(body.first, body.count()).transpose() * row
    }

    /// Participation of all scene coordinates along an axis.
    pub(super) fn participation(&self, axis: usize) -> DVector<f64> {
        DVector::from_iterator(
            self.basis.nrows(),
            self.bodies.iter().flat_map(|b| b.participation.column(axis).iter().copied().collect::<Vec<_>>()),
        )
    }

    /// Row over the jointed coordinates of "leaf:b:z" or "load:z", and its direction.
    pub(super) fn motion_row(&self, text: &str) -> Result<(DVector<f64>, Axis), SceneError> {
        let (place, axis) = text.rsplit_once(':').and_then(|(p, a)| Some((p, Axis::parse(a)?))).ok_or_else(|| {
            SceneError::missing(format!(
                "found \"{text}\", expected \"body:node:direction\" or \"body:direction\", such as \"leaf:b:z\""
            ))
        })?;
        let (body, node) = find(place, &self.bodies)?;
        let point = self.bodies[body].position(node)?;
        let row = self.bodies[body].motion(node, point, axis)?;
        Ok((self.jointed(body, &row), axis))
    }
}
