//! Flexibility: u = Θ q, q̈ + 2ζω q̇ + ω² q = Θᵀ f (eq. (7) of Xue et al. 2014). Strain energy ½ Σ ω² q².

use crate::model::{ReducedModel, Selection};
use nalgebra::DMatrix;

pub(super) const NAME: &str = "flexibility";

/// Elastic coordinates of a body; e of them at k kept dofs.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct Coordinates {
    /// k×e, 1/√kg.
    pub(in crate::simulate) shapes: DMatrix<f64>,
    /// rad/s; e.
    pub(in crate::simulate) omega: Vec<f64>,
    /// Damping ratios; e.
    pub(in crate::simulate) zeta: Vec<f64>,
    /// Participation, e×3, √kg.
    pub(in crate::simulate) participation: DMatrix<f64>,
}

/// The kept modes of a reduced model, or those of them that `modes` ("7-13") names.
pub(in crate::simulate) fn elastic_coordinates(
    model: &ReducedModel,
    modes: Option<&str>,
) -> Result<Coordinates, String> {
    let columns: Vec<usize> = match modes {
        None => (0..model.modes.len()).collect(),
        Some(list) => {
            let asked = Selection::parse_ranges(list)?;
            asked
                .iter()
                .map(|number| {
                    model.modes.iter().position(|m| m.number == *number).ok_or_else(|| {
                        format!(
                            "mode {number} is not kept in \"{}\", which holds {}",
                            model.name,
                            model.selection.ranges()
                        )
                    })
                })
                .collect::<Result<_, _>>()?
        }
    };
    Ok(Coordinates {
        shapes: model.shapes.select_columns(&columns),
        omega: columns.iter().map(|&c| model.modes[c].omega).collect(),
        zeta: columns.iter().map(|&c| model.modes[c].zeta).collect(),
        participation: model.participation.select_rows(&columns),
    })
}
