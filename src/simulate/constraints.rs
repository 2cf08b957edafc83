//! Joints as constraint rows, and the modes of the jointed system.

use super::assembly::Assembly;
use super::bodies::{find, place, resolve};
use super::error::SceneError;
use super::joint::held;
use crate::linalg::split;
use crate::model::Axis;
use nalgebra::{DMatrix, DVector};

/// Directions whose elastic part is below this share are motions of the mechanism as a whole.
const NO_ELASTIC_PART: f64 = 1e-9;

/// One row over the scene coordinates per held direction: motion of the first end less the second.
pub(super) fn constraints(assembly: &Assembly) -> Result<DMatrix<f64>, SceneError> {
    let total = assembly.basis.nrows();
    let mut rows: Vec<DVector<f64>> = Vec::new();
    for (name, joint) in &assembly.scene.joint {
        let between = &joint.between;
        let at_ends = |e: SceneError| place(e, between.span());
        let ends: Vec<Option<(usize, Option<&str>)>> = between
            .get_ref()
            .iter()
            .map(|end| if end == "ground" { Ok(None) } else { find(end, &assembly.bodies).map(Some) })
            .collect::<Result<_, _>>()
            .map_err(at_ends)?;
        if ends[0].is_none() && ends[1].is_none() {
            return Err(SceneError::at(
                between.span(),
                format!("joint \"{}\" joins the ground to itself", name.get_ref()),
            ));
        }
        if between.get_ref()[0] == between.get_ref()[1] {
            return Err(SceneError::at(
                between.span(),
                format!("joint \"{}\" joins \"{}\" to itself", name.get_ref(), between.get_ref()[0]),
            ));
        }
        let point = match &joint.at {
            Some(at) => resolve(at.get_ref(), &assembly.bodies).map_err(|e| place(e, at.span()))?,
            None => {
                let named = ends.iter().flatten().find(|e| e.1.is_some()).or(ends.iter().flatten().next());
                match named {
                    Some(&(body, node)) => assembly.bodies[body].position(node).map_err(at_ends)?,
                    None => [0.0; 3],
                }
            }
        };
        for axis in held(joint.holds.get_ref()).map_err(|m| SceneError::at(joint.holds.span(), m))? {
            let mut row = DVector::zeros(total);
            for (end, sign) in ends.iter().zip([1.0, -1.0]) {
                if let Some((body, node)) = *end {
                    let motion = assembly.bodies[body].motion(node, point, axis).map_err(at_ends)?;
                    if axis.is_rotation() && motion.iter().all(|m| *m == 0.0) && !guided(assembly, body, axis) {
                        return Err(SceneError::at(
                            joint.holds.span(),
                            format!(
                                "joint \"{}\" holds {axis} to \"{1}\", which has no inertia and so would hold it still; give \"{1}\" inertia, or guide its {axis} by a joint to the ground",
                                name.get_ref(),
                                assembly.bodies[body].name
                            ),
                        ));
                    }
                    let first = assembly.bodies[body].first;
                    for (k, value) in motion.iter().enumerate() {
                        row[first + k] += sign * value;
                    }
                }
            }
            rows.push(row);
        }
    }
    Ok(DMatrix::from_fn(rows.len(), total, |r, c| rows[r][c]))
}

/// True when a joint between the body and the ground holds the rotation: then the body rightly does
/// not turn.
fn guided(assembly: &Assembly, body: usize, axis: Axis) -> bool {
    assembly.scene.joint.values().any(|joint| {
        let ends = joint.between.get_ref();
        let of_body = |end: &str| find(end, &assembly.bodies).is_ok_and(|(b, _)| b == body);
        let grounded = (ends[0] == "ground" && of_body(&ends[1])) || (ends[1] == "ground" && of_body(&ends[0]));
        grounded && held(joint.holds.get_ref()).is_ok_and(|axes| axes.contains(&axis))
    })
}

/// Basis (N×n) and λ (n) of the jointed coordinates: mechanism motions with λ exactly 0 first, then
/// the modes of the jointed system. λ are squared singular values of diag(ω) Z, so that low
/// frequencies keep their digits beside very high ones.
pub(super) fn jointed_modes(null: &DMatrix<f64>, omega: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let elastic: Vec<usize> = (0..omega.len()).filter(|&k| omega[k] > 0.0).collect();
    let parts = split(&null.select_rows(&elastic), NO_ELASTIC_PART);
    let free = null * &parts.null;
    let moving = null * &parts.range;
    let count = moving.ncols();
    let mut stiffness = DVector::zeros(free.ncols() + count);
    let mut basis = DMatrix::zeros(null.nrows(), free.ncols() + count);
    basis.columns_mut(0, free.ncols()).copy_from(&free);
    if count > 0 {
        let weighted = DMatrix::from_fn(elastic.len(), count, |r, c| omega[elastic[r]] * moving[(elastic[r], c)]);
        let svd = weighted.svd(false, true);
        let vectors = svd.v_t.map(|v| v.transpose()).unwrap_or_else(|| DMatrix::identity(count, count));
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b]));
        for (c, &k) in order.iter().enumerate() {
            stiffness[free.ncols() + c] = svd.singular_values[k].powi(2);
            basis.set_column(free.ncols() + c, &(&moving * vectors.column(k)));
        }
    }
    (basis, stiffness)
}
