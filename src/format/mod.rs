//! Reads and writes files: one file per format, one row per format in [`FORMATS`].
//!
//! Readers take a path, tell the format by content (never by suffix), unpack .gz on the way, and
//! return nouns of `model` with the SHA-256 of what they read. Errors say file, line, what was
//! found, what was expected and what to do. Writers return bytes or text; only
//! [`write_atomically`] touches the disk.

mod arrays;
mod atomic;
mod calculix;
mod dat;
mod eig;
mod error;
mod fe_model;
mod frd;
mod h5;
mod harwell_boeing;
mod imported;
mod inp;
mod input;
mod json;
mod mat5;
mod matrix_market;
mod npz;
mod number;
mod reduced_h5;
mod summary;
mod toml_file;
mod trajectory;
mod triplets;
mod uff;
mod uff55;

pub use atomic::write_atomically;
pub use calculix::read_dof_map;
pub use dat::{DatMode, read_dat};
pub use eig::read_eig;
pub use error::{Fault, FormatError, Place};
pub use fe_model::{FeFiles, FileUnits, read_fe_model, read_symmetric};
pub use frd::read_frd;
pub use imported::ImportedModes;
pub use inp::{Mesh, read_mesh};
pub use json::reduced_to_json;
pub use mat5::reduced_to_mat5;
pub use matrix_market::symmetric_to_matrix_market;
pub use npz::reduced_to_npz;
pub use reduced_h5::{read_reduced, reduced_to_bytes};
pub use summary::{
    Summary, SummaryMode, SummaryNode, SummaryRigid, SummaryScore, SummarySelection, read_summary, summary_to_text,
};
pub use toml_file::{nearest, parse_toml, toml_error_at};
pub use trajectory::{trajectory_to_csv, trajectory_to_h5};
pub use uff::{TestData, read_uff};
pub use uff55::{TestMode, uff55_to_text};

use std::path::Path;

/// What a file can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// A stiffness or mass matrix.
    Matrix,
    /// What the rows of a matrix mean.
    Dofs,
    /// Nodes and node sets.
    Mesh,
    /// Natural frequencies, mostly with shapes.
    Modes,
    /// Modes and positions of a test.
    Test,
    /// A reduced model.
    ReducedModel,
    /// The readable summary of a reduced model.
    Summary,
    /// Results over time.
    Trajectory,
}

impl Holds {
    /// "matrix", "dof list", …
    pub fn name(self) -> &'static str {
        match self {
            Self::Matrix => "matrix",
            Self::Dofs => "dof list",
            Self::Mesh => "mesh",
            Self::Modes => "modes",
            Self::Test => "test",
            Self::ReducedModel => "reduced model",
            Self::Summary => "summary",
            Self::Trajectory => "trajectory",
        }
    }
}

/// A file format.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// Name on the command line and in tables.
    pub name: &'static str,
    /// What such a file holds.
    pub holds: Holds,
    /// Usual endings of file names, without the dot; only a habit, never trusted.
    pub suffixes: &'static [&'static str],
    /// One line of help.
    pub help: &'static str,
    /// Whether it is read.
    pub reads: bool,
    /// Whether it is written.
    pub writes: bool,
    /// Whether the beginning of a file (after unpacking) looks like it.
    pub detect: fn(&[u8]) -> bool,
}

/// All formats, in the order in which detection tries them.
pub const FORMATS: &[Format] = &[
    Format {
        name: "matrix-market",
        holds: Holds::Matrix,
        suffixes: &["mtx"],
        help: "MatrixMarket coordinate, real or integer, symmetric or general with symmetric values",
        reads: true,
        writes: true,
        detect: matrix_market::looks_like,
    },
    Format {
        name: "reduced",
        holds: Holds::ReducedModel,
        suffixes: &["h5"],
        help: "ferrom's reduced model, HDF5, for h5py and MATLAB",
        reads: true,
        writes: true,
        detect: |head| is_hdf5(head) && contains(head, b"ferrom reduced model"),
    },
    Format {
        name: "mat",
        holds: Holds::ReducedModel,
        suffixes: &["mat"],
        help: "reduced model as MATLAB variables (version 5)",
        reads: false,
        writes: true,
        detect: |head| head.starts_with(b"MATLAB 5.0 MAT-file"),
    },
    Format {
        name: "npz",
        holds: Holds::ReducedModel,
        suffixes: &["npz"],
        help: "reduced model as NumPy arrays",
        reads: false,
        writes: true,
        detect: |head| head.starts_with(b"PK\x03\x04") && contains(head, b".npy"),
    },
    Format {
        name: "json",
        holds: Holds::ReducedModel,
        suffixes: &["json"],
        help: "reduced model as one JSON object",
        reads: false,
        writes: true,
        detect: |head| head.trim_ascii_start().starts_with(b"{") && contains(head, b"\"omega\""),
    },
    Format {
        name: "trajectory",
        holds: Holds::Trajectory,
        suffixes: &["h5"],
        help: "results over time, HDF5",
        reads: false,
        writes: true,
        detect: |head| is_hdf5(head) && contains(head, b"ferrom trajectory"),
    },
    Format {
        name: "csv",
        holds: Holds::Trajectory,
        suffixes: &["csv"],
        help: "results over time, one column per channel",
        reads: false,
        writes: true,
        detect: |head| head.starts_with(b"time [s]"),
    },
    Format {
        name: "harwell-boeing",
        holds: Holds::Matrix,
        suffixes: &["rsa", "rua", "rb", "hb"],
        help: "Harwell-Boeing, Rutherford-Boeing, ANSYS HBMAT: real, assembled, symmetric or with symmetric values",
        reads: true,
        writes: false,
        detect: harwell_boeing::looks_like,
    },
    Format {
        name: "triplets",
        holds: Holds::Matrix,
        suffixes: &["sti", "mas", "mtx"],
        help: "row, column, value: CalculiX SOLVER=MATRIXSTORAGE, Abaqus *MATRIX OUTPUT, FORMAT=COORDINATE",
        reads: true,
        writes: false,
        detect: calculix::looks_like_matrix,
    },
    Format {
        name: "calculix-dofs",
        holds: Holds::Dofs,
        suffixes: &["dof"],
        help: "CalculiX dof list: node.direction per matrix row",
        reads: true,
        writes: false,
        detect: calculix::looks_like_dofs,
    },
    Format {
        name: "inp",
        holds: Holds::Mesh,
        suffixes: &["inp", "mesh", "msh"],
        help: "Abaqus / CalculiX deck: *NODE, *NSET, *INCLUDE",
        reads: true,
        writes: false,
        detect: inp::looks_like,
    },
    Format {
        name: "frd",
        holds: Holds::Modes,
        suffixes: &["frd"],
        help: "CalculiX results, ascii or binary: nodes and mode shapes",
        reads: true,
        writes: false,
        detect: frd::looks_like,
    },
    Format {
        name: "eig",
        holds: Holds::Modes,
        suffixes: &["eig"],
        help: "CalculiX *FREQUENCY, STORAGE=YES: modes in double precision (needs the dof list; nothing in it to detect)",
        reads: true,
        writes: false,
        detect: |_| false,
    },
    Format {
        name: "dat",
        holds: Holds::Modes,
        suffixes: &["dat"],
        help: "CalculiX printed output: the eigenvalue table, without shapes",
        reads: true,
        writes: false,
        detect: dat::looks_like,
    },
    Format {
        name: "uff",
        holds: Holds::Test,
        suffixes: &["unv", "uff"],
        help: "universal file: nodes 15, 2411; units 164; modes 55, real and complex",
        reads: true,
        writes: true,
        detect: uff::looks_like,
    },
    Format {
        name: "summary",
        holds: Holds::Summary,
        suffixes: &["toml"],
        help: "readable summary of a reduced model, for diffs and checks",
        reads: true,
        writes: true,
        detect: |head| contains(head, b"recipe-sha256 ="),
    },
];

/// The format of a file, told by its content; `None` when no reader knows it.
pub fn detect(path: &Path) -> Result<Option<&'static Format>, FormatError> {
    let input = input::Input::open(path)?;
    Ok(FORMATS.iter().find(|format| (format.detect)(input.head())))
}

fn is_hdf5(head: &[u8]) -> bool {
    head.starts_with(b"\x89HDF\r\n\x1a\n")
}

fn contains(head: &[u8], mark: &[u8]) -> bool {
    head.windows(mark.len()).any(|window| window == mark)
}
