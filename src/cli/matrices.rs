//! Bare matrices on the command line, instead of a model.

use crate::format::{FeFiles, FileUnits};
use clap::Args;
use std::path::PathBuf;

/// `--stiffness K --mass M [--dofs FILE [--mesh FILE]]`.
#[derive(Debug, Args)]
pub(super) struct Matrices {
    /// Stiffness matrix (instead of a model), in SI units
    #[arg(long, requires = "mass", value_name = "FILE")]
    stiffness: Option<PathBuf>,
    /// Mass matrix
    #[arg(long, requires = "stiffness", value_name = "FILE")]
    mass: Option<PathBuf>,
    /// Dof list of the matrices
    #[arg(long, requires = "stiffness", value_name = "FILE")]
    dofs: Option<PathBuf>,
    /// Mesh with node positions
    #[arg(long, requires = "dofs", value_name = "FILE")]
    mesh: Option<PathBuf>,
}

impl Matrices {
    /// The files, when they were given.
    pub(super) fn files(&self) -> Option<FeFiles> {
        Some(FeFiles {
            name: "matrices".into(),
            stiffness: self.stiffness.clone()?,
            mass: self.mass.clone()?,
            dofs: self.dofs.clone(),
            mesh: self.mesh.clone(),
            units: FileUnits::default(),
        })
    }
}
