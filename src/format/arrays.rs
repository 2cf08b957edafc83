//! A reduced model as flat named arrays: what .mat, .npz and JSON exports are written from.

use crate::model::{ReducedModel, StateSpace};
use nalgebra::DMatrix;

/// The content of a named array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Array {
    /// Numbers in a row.
    Row(Vec<f64>),
    /// A matrix.
    Matrix(DMatrix<f64>),
    /// Texts in a row.
    Texts(Vec<String>),
}

/// The arrays of a model under names that are identifiers in every language; SI units, as the fields
/// of [`ReducedModel`] say. Labels, recipe and hashes stay in the HDF5 file.
pub(super) fn arrays(model: &ReducedModel, state_space: Option<&StateSpace>) -> Vec<(&'static str, Array)> {
    use Array::{Matrix, Row, Texts};
    let modes = |f: &dyn Fn(usize) -> f64| Row((0..model.modes.len()).map(f).collect());
    let texts = |words: Vec<&str>| Texts(words.into_iter().map(str::to_owned).collect());
    let body = &model.rigid.body;
    let dof_nodes = model.dofs.iter().map(|d| model.nodes.get(d.node).map_or("", |n| n.name.as_str()));
    let mut all = vec![
        ("name", texts(vec![&model.name])),
        ("number", modes(&|k| f64::from(model.modes[k].number.0))),
        ("omega", modes(&|k| model.modes[k].omega)),
        ("zeta", modes(&|k| model.modes[k].zeta)),
        ("origin", texts(model.modes.iter().map(|m| m.origin.name()).collect())),
        ("shapes", Matrix(model.shapes.clone())),
        ("participation", Matrix(model.participation.clone())),
        ("dof_node", texts(dof_nodes.collect())),
        ("dof_axis", texts(model.dofs.iter().map(|d| d.axis.name()).collect())),
        ("dof_unit", texts(model.dofs.iter().map(|d| d.axis.unit()).collect())),
        ("node_name", texts(model.nodes.iter().map(|n| n.name.as_str()).collect())),
        ("node_role", texts(model.nodes.iter().map(|n| n.role.name()).collect())),
        ("node_position", Matrix(DMatrix::from_fn(model.nodes.len(), 3, |k, d| model.nodes[k].position[d]))),
        ("mass", Row(vec![body.mass])),
        ("centre", Row(body.centre.to_vec())),
        ("inertia", Matrix(DMatrix::from_fn(3, 3, |i, j| body.inertia[(i, j)]))),
        ("rigid_shapes", Matrix(model.rigid.shapes.clone())),
        ("rigid_participation", Matrix(model.rigid.participation.clone())),
    ];
    if let Some(residual) = &model.residual {
        all.extend([
            ("residual_flexibility", Matrix(residual.flexibility.clone())),
            ("residual_omega", Row(residual.omega.clone())),
            ("residual_zeta", Row(residual.zeta.clone())),
            ("residual_shapes", Matrix(residual.shapes.clone())),
            ("residual_participation", Matrix(residual.participation.clone())),
        ]);
    }
    if let Some(s) = state_space {
        all.extend([("A", Matrix(s.a.clone())), ("B", Matrix(s.b.clone())), ("C", Matrix(s.c.clone()))]);
        all.push(("D", Matrix(s.d.clone())));
        all.extend([("inputs", Texts(s.inputs.clone())), ("outputs", Texts(s.outputs.clone()))]);
    }
    all
}
