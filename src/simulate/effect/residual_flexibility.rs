//! Residual flexibility: the residual vectors as extra coordinates. They carry the exact static
//! flexibility at the joints of every mode not kept; exact propagation makes their high frequencies
//! harmless at any step.

use super::Coordinates;
use crate::model::ReducedModel;
use nalgebra::DMatrix;

pub(super) const NAME: &str = "residual-flexibility";

/// Appends the residual vectors of the model to the elastic coordinates.
pub(in crate::simulate) fn add_residual_vectors(model: &ReducedModel, to: &mut Coordinates) -> Result<(), String> {
    let residual = model.residual.as_ref().ok_or_else(|| {
        format!(
            "\"{}\" was reduced without residual flexibility; set [reduce] method = \"truncation-residual\" in its model.toml, or take the effect off",
            model.name
        )
    })?;
    let kept = to.omega.len();
    let added = residual.omega.len();
    to.shapes = DMatrix::from_fn(to.shapes.nrows(), kept + added, |r, c| {
        if c < kept { to.shapes[(r, c)] } else { residual.shapes[(r, c - kept)] }
    });
    to.participation = DMatrix::from_fn(kept + added, 3, |r, c| {
        if r < kept { to.participation[(r, c)] } else { residual.participation[(r - kept, c)] }
    });
    to.omega.extend(&residual.omega);
    to.zeta.extend(&residual.zeta);
    Ok(())
}
