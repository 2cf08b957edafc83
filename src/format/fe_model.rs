//! A finite-element model from its files: matrices, dof list, mesh, in SI units.

use super::error::{Fault, FormatError, Place};
use super::input::Input;
use super::{calculix, harwell_boeing, inp, matrix_market};
use crate::linalg::SymSparse;
use crate::model::{DofMap, FeModel, Progress, Source};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The files a model is made of.
#[derive(Clone, Debug)]
pub struct FeFiles {
    /// Name of the model.
    pub name: String,
    /// K: .sti or MatrixMarket.
    pub stiffness: PathBuf,
    /// M: .mas or MatrixMarket.
    pub mass: PathBuf,
    /// What the rows mean; rows stay without labels when there is none.
    pub dofs: Option<PathBuf>,
    /// Node positions and sets.
    pub mesh: Option<PathBuf>,
    /// Units the files are written in.
    pub units: FileUnits,
}

/// SI size of the files' units: metres, kilograms, seconds per unit. For millimetre, tonne, second:
/// 1e-3, 1e3, 1. Rotations are in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileUnits {
    /// m.
    pub length: f64,
    /// kg.
    pub mass: f64,
    /// s.
    pub time: f64,
}

impl Default for FileUnits {
    fn default() -> Self {
        Self { length: 1.0, mass: 1.0, time: 1.0 }
    }
}

/// Reads a symmetric matrix: .sti or .mas triplets, or MatrixMarket (real or integer; symmetric, or
/// general when its values are), or Harwell-Boeing; plain or .gz, told by content. `role` goes into the source.
pub fn read_symmetric(path: &Path, role: &str) -> Result<(SymSparse, Source), FormatError> {
    read_matrix(path, role, &|_| {})
}

/// The same, telling the bytes read so far.
fn read_matrix(path: &Path, role: &str, tell: &dyn Fn(usize)) -> Result<(SymSparse, Source), FormatError> {
    let input = Input::open(path)?;
    let head = input.head();
    let read = if matrix_market::looks_like(head) {
        matrix_market::read_matrix(path, input, tell)
    } else if harwell_boeing::looks_like(head) {
        harwell_boeing::read_matrix(path, input, tell)
    } else if head.trim_ascii().is_empty() {
        return Err(Fault::new("the file is empty")
            .expected("a matrix")
            .cure("did the export run to its end?")
            .in_file(path));
    } else if head.iter().take(4096).any(|&b| b == 0) {
        return Err(Fault::new("this is a binary file")
            .expected("a .sti, .mas or MatrixMarket text file")
            .cure("see `ferrom list` for what can be read")
            .in_file(path));
    } else {
        calculix::read_matrix(path, input, tell)
    };
    let (matrix, sha256) = read.map_err(|error| with_line(path, error))?;
    Ok((matrix, Source { role: role.into(), path: path.display().to_string(), sha256 }))
}

/// Finds the line of an entry that was found wrong only when the matrix was put together.
fn with_line(path: &Path, error: FormatError) -> FormatError {
    let FormatError::Content { fault, .. } = &error else { return error };
    let Place::Entry(row, col) = fault.place else { return error };
    let Ok((text, _)) = super::input::read_all(path) else { return error };
    let mut places = text.split(|&b| b == b'\n').enumerate().filter(|(_, line)| {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        let mut index = || words.next().and_then(|w| std::str::from_utf8(w).ok()?.parse::<u32>().ok());
        let (a, b) = (index(), index());
        (a, b) == (Some(row), Some(col)) || (a, b) == (Some(col), Some(row))
    });
    let first = places.next();
    // The second place is the one to complain about; the size line of MatrixMarket never is.
    match places.next().or(first) {
        Some((k, _)) => Fault { place: Place::Line(k + 1), ..(**fault).clone() }.in_file(path),
        None => error,
    }
}

/// Reads all files of a model and checks that they belong together: the matrices and the dof list
/// have the same order, and every dof sits on a node of the mesh. K and M are read side by side.
pub fn read_fe_model(files: &FeFiles, progress: &dyn Progress) -> Result<FeModel, FormatError> {
    let matrix = |path: &Path, role: &str| {
        let stage = format!("read {role}");
        let size = std::fs::metadata(path).map_or(0, |m| m.len() as usize);
        let packed = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
        let total = if packed { 0 } else { size };
        read_matrix(path, role, &|done| progress.report(&stage, done, total))
    };
    let (stiffness, mass) = rayon::join(|| matrix(&files.stiffness, "stiffness"), || matrix(&files.mass, "mass"));
    let ((stiffness, k_source), (mass, m_source)) = (stiffness?, mass?);
    let order = stiffness.order();
    if mass.order() != order {
        return Err(orders(&files.mass, "mass matrix", mass.order(), &files.stiffness, "stiffness matrix", order));
    }
    let mut sources = vec![k_source, m_source];
    let mut dofs = DofMap::unlabelled(order);
    if let Some(path) = &files.dofs {
        let (list, source) = calculix::read_dof_map(path)?;
        if list.len() != order {
            return Err(orders(path, "dof list", list.len(), &files.stiffness, "stiffness matrix", order));
        }
        dofs = list;
        sources.push(source);
    }
    let (mut nodes, mut node_sets) = (BTreeMap::new(), BTreeMap::new());
    if let Some(path) = &files.mesh {
        let (mesh, source) = inp::read_mesh(path)?;
        if let Some(row) = dofs.labels().iter().position(|dof| !mesh.nodes.contains_key(&dof.node)) {
            let owner = files.dofs.as_deref().unwrap_or(path);
            return Err(Fault::new(format!(
                "dof {} of row {} sits on no node of the mesh",
                dofs.describe(row),
                row + 1
            ))
            .expected(format!("a node of {}", path.display()))
            .cure("use the mesh the matrices were exported from")
            .in_file(owner));
        }
        (nodes, node_sets) = (mesh.nodes, mesh.node_sets);
        sources.push(source);
    }
    let FileUnits { length, mass: heavy, time } = files.units;
    if length != 1.0 {
        nodes.values_mut().flatten().for_each(|x| *x *= length);
    }
    let stiffness = in_si(stiffness, &dofs, heavy / (time * time), length);
    let mass = in_si(mass, &dofs, heavy, length);
    Ok(FeModel { name: files.name.clone(), nodes, dofs, stiffness, mass, node_sets, sources })
}

fn orders(path: &Path, what: &str, found: usize, other: &Path, other_what: &str, expected: usize) -> FormatError {
    Fault::new(format!("the {what} has {found} rows"))
        .expected(format!("{expected}, as the {other_what} {} has", other.display()))
        .cure("take all files from one export; one of them may be cut short")
        .in_file(path)
}

/// Times `factor`, and once `length` for each rotation an entry couples: with u in m and θ in rad,
/// a translation row holds force per m and a rotation row moment, one length more on either side.
fn in_si(matrix: SymSparse, dofs: &DofMap, factor: f64, length: f64) -> SymSparse {
    let turns: Vec<bool> = dofs.labels().iter().map(|dof| dof.axis.is_rotation()).collect();
    if length == 1.0 || !turns.contains(&true) {
        return if factor == 1.0 { matrix } else { matrix.scaled(factor) };
    }
    let arm = |row: usize| if turns[row] { length } else { 1.0 };
    matrix.map_entries(|i, j, value| value * factor * arm(i) * arm(j))
}
