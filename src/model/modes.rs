//! Natural modes: frequencies, damping, shapes, and how far they can be trusted.

use super::DofMap;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A mode's number: counts from 1, rigid modes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ModeNo(pub u32);

impl ModeNo {
    /// Column of the shape matrix.
    pub fn column(self) -> usize {
        self.0 as usize - 1
    }

    /// The mode in a column of the shape matrix.
    pub fn from_column(column: usize) -> Self {
        Self(column as u32 + 1)
    }
}

impl fmt::Display for ModeNo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Where a mode came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// Rigid-body motion built from node positions.
    Rigid,
    /// Computed here from K and M.
    Computed,
    /// Read from another program's result file.
    Imported,
    /// Measured on a rig.
    Measured,
}

impl Origin {
    /// "rigid", "computed", "imported", "measured".
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Computed => "computed",
            Self::Imported => "imported",
            Self::Measured => "measured",
        }
    }
}

/// What is known about modes that may have been missed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Completeness {
    /// True when the inertia of K − μM (Sturm count) equals the number of modes returned below μ.
    pub proved: bool,
    /// Eigenvalues below `below`, by inertia when it could be counted, else by the solver.
    pub count: usize,
    /// √μ, rad/s: all modes below this are in the set when `proved`.
    pub below: f64,
}

/// The modes of K φ = ω² M φ; m modes of n degrees of freedom.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Natural frequencies, rad/s, ascending; rigid ones exactly 0; m.
    pub omega: Vec<f64>,
    /// Damping ratios, m; NaN until damping has been stated.
    pub zeta: Vec<f64>,
    /// Φ, n×m, 1/√kg, ΦᵀMΦ = I, largest component of each column positive.
    pub shapes: DMatrix<f64>,
    /// M Φ_r summed over rigid translations, m×3, √kg: participation Γ = Φᵀ M r for unit
    /// translations r along x, y, z. Γ² is the modal effective mass.
    pub participation: DMatrix<f64>,
    /// Row ↔ node and direction; n.
    pub dofs: DofMap,
    /// Origin per mode; m.
    pub origin: Vec<Origin>,
    /// How many of the first modes are rigid (ω = 0).
    pub rigid: usize,
    /// ‖Kφ − ω²Mφ‖ / ‖Kφ‖ per elastic mode; ‖Kφ‖ / (ω₁² ‖Mφ‖) with ω₁ the first elastic frequency for a
    /// rigid one; NaN for modes not computed here; m.
    pub residual: Vec<f64>,
    /// max |ΦᵀMΦ − I|.
    pub orthogonality: f64,
    /// The shift σ that was used, (rad/s)²; 0 when the modes were not computed here.
    pub shift: f64,
    /// Whether a mode may have been missed.
    pub complete: Completeness,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Modes {
    /// Number of modes m, rigid ones included.
    pub fn len(&self) -> usize {
        self.omega.len()
    }

    /// True without modes.
    pub fn is_empty(&self) -> bool {
        self.omega.is_empty()
    }

    /// Numbers of the elastic modes, ascending.
    pub fn elastic(&self) -> impl Iterator<Item = ModeNo> + '_ {
        (self.rigid..self.len()).map(ModeNo::from_column)
    }
}
