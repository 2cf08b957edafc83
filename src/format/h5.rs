//! HDF5 in memory: building groups, and reading them back with every shape checked.

use super::error::Fault;
use hdf5_pure::{AttrValue, DType, File, FileBuilder, FinishedGroup};
use nalgebra::DMatrix;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A group being built.
pub(super) struct Tree {
    group: hdf5_pure::GroupBuilder,
    /// The first text that could not be stored.
    fault: Option<Fault>,
}

/// What the library refused to write.
pub(super) fn refused(error: impl std::fmt::Display) -> Fault {
    Fault::new(format!("HDF5 cannot hold this: {error}"))
}

impl Tree {
    pub fn new(file: &mut FileBuilder, name: &str) -> Self {
        Self { group: file.create_group(name), fault: None }
    }

    pub fn finish(self) -> Result<FinishedGroup, Fault> {
        self.fault.map_or_else(|| Ok(self.group.finish()), Err)
    }

    /// A text attribute of the group.
    pub fn note(&mut self, name: &str, text: &str) {
        self.group.set_attr(name, AttrValue::String(text.into()));
    }

    /// Real numbers of a shape, row by row, with their unit.
    pub fn reals(&mut self, name: &str, values: &[f64], shape: &[usize], unit: &str) {
        let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
        let data = self.group.create_dataset(name).with_f64_data(values).with_shape(&shape);
        if !unit.is_empty() {
            data.set_attr("unit", AttrValue::String(unit.into()));
        }
    }

    /// A matrix, row by row as HDF5 has it.
    pub fn matrix(&mut self, name: &str, matrix: &DMatrix<f64>, unit: &str) {
        self.reals(name, &row_major(matrix), &[matrix.nrows(), matrix.ncols()], unit);
    }

    /// Whole numbers in a row.
    pub fn integers(&mut self, name: &str, values: &[u32]) {
        self.group.create_dataset(name).with_u32_data(values);
    }

    /// Texts in a row, each padded with zeros to the longest: a list of its own heap would take 4 kB.
    pub fn texts<S: AsRef<str>>(&mut self, name: &str, values: &[S]) {
        let values: Vec<&str> = values.iter().map(AsRef::as_ref).collect();
        if let Err(error) = self.group.create_dataset(name).with_strings(&values) {
            self.fault = Some(refused(format!("/{name}: {error}")));
        }
    }
}

/// Row by row.
pub(super) fn row_major(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// An HDF5 file to read from.
pub(super) struct Reader {
    file: File,
    /// Elements a dataset of this file can hold at most: deflate packs at most 1032 to 1.
    most: u64,
}

impl Reader {
    pub fn open(bytes: Vec<u8>) -> Result<Self, Fault> {
        let size = bytes.len() as u64;
        let file = guarded("the file", || File::from_bytes(bytes).map_err(|e| e.to_string()))
            .map_err(|f| f.expected("an HDF5 file").cure("it was probably cut short or is another format"))?;
        Ok(Self { file, most: size.saturating_mul(1032) })
    }

    /// A text attribute of the root.
    pub fn root_note(&self, name: &str) -> Result<String, Fault> {
        let attributes = guarded("the root attributes", || self.file.root().attrs().map_err(|e| e.to_string()))?;
        match attributes.get(name) {
            Some(AttrValue::String(text) | AttrValue::AsciiString(text)) => Ok(text.clone()),
            _ => Err(missing(&format!("attribute {name}"))),
        }
    }

    pub fn has(&self, path: &str) -> bool {
        guarded(path, || self.file.dataset(path).map(|_| ()).map_err(|e| e.to_string())).is_ok()
    }

    fn dataset(&self, path: &str) -> Result<(hdf5_pure::Dataset, Vec<u64>), Fault> {
        let data = guarded(path, || self.file.dataset(path).map_err(|e| e.to_string()))
            .map_err(|_| missing(&format!("dataset /{path}")))?;
        let shape = guarded(path, || data.shape().map_err(|e| e.to_string()))?;
        let count = shape.iter().try_fold(1u64, |n, &d| n.checked_mul(d));
        if count.is_none_or(|n| n > self.most) {
            return Err(Fault::new(format!("dataset /{path} claims the shape {shape:?}"))
                .expected("no more than the file can hold")
                .cure("the file is damaged: remake it"));
        }
        Ok((data, shape))
    }

    /// Real numbers of exactly this shape.
    pub fn reals(&self, path: &str, shape: &[usize]) -> Result<Vec<f64>, Fault> {
        let (data, found) = self.dataset(path)?;
        let same = found.len() == shape.len() && found.iter().zip(shape).all(|(&f, &s)| f == s as u64);
        if !same {
            return Err(Fault::new(format!("dataset /{path} has the shape {found:?}"))
                .expected(format!("{shape:?}"))
                .cure("the file is damaged or was edited: remake it"));
        }
        typed(path, &data, |t| matches!(t, DType::F64), "real numbers of 64 bits")?;
        let values = guarded(path, || data.read_f64().map_err(|e| e.to_string()))?;
        sized(path, values, shape.iter().product())
    }

    /// A matrix of exactly this shape.
    pub fn matrix(&self, path: &str, rows: usize, cols: usize) -> Result<DMatrix<f64>, Fault> {
        Ok(DMatrix::from_row_slice(rows, cols, &self.reals(path, &[rows, cols])?))
    }

    /// Columns of a matrix with this many rows.
    pub fn columns(&self, path: &str, rows: usize) -> Result<usize, Fault> {
        match self.dataset(path)?.1.as_slice() {
            &[found, cols] if found == rows as u64 => Ok(cols as usize),
            shape => Err(Fault::new(format!("dataset /{path} has the shape {shape:?}"))
                .expected(format!("{rows} rows"))
                .cure("the file is damaged or was edited: remake it")),
        }
    }

    /// Whole numbers in a row; of this count where one is asked for.
    pub fn integers(&self, path: &str, count: Option<usize>) -> Result<Vec<u32>, Fault> {
        let (data, found) = self.row(path, count)?;
        typed(path, &data, |t| matches!(t, DType::U32), "whole numbers of 32 bits")?;
        let values = guarded(path, || data.read_u32().map_err(|e| e.to_string()))?;
        sized(path, values, found)
    }

    /// Texts in a row; of this count where one is asked for.
    pub fn texts(&self, path: &str, count: Option<usize>) -> Result<Vec<String>, Fault> {
        let (data, found) = self.row(path, count)?;
        let values = guarded(path, || data.read_string().map_err(|e| e.to_string()))?;
        sized(path, values, found)
    }

    /// One text.
    pub fn text(&self, path: &str) -> Result<String, Fault> {
        self.texts(path, Some(1))?.pop().ok_or_else(|| missing(path))
    }

    fn row(&self, path: &str, count: Option<usize>) -> Result<(hdf5_pure::Dataset, usize), Fault> {
        let (data, shape) = self.dataset(path)?;
        match (shape.as_slice(), count) {
            (&[n], None) => Ok((data, n as usize)),
            (&[n], Some(wanted)) if n == wanted as u64 => Ok((data, wanted)),
            _ => Err(Fault::new(format!("dataset /{path} has the shape {shape:?}"))
                .expected(count.map_or("one row".to_owned(), |n| format!("[{n}]")))
                .cure("the file is damaged or was edited: remake it")),
        }
    }
}

fn missing(path: &str) -> Fault {
    Fault::new(format!("no {path}"))
        .expected("a reduced model written by ferrom")
        .cure("remake it with `ferrom reduce`")
}

fn typed(path: &str, data: &hdf5_pure::Dataset, fits: impl Fn(&DType) -> bool, expected: &str) -> Result<(), Fault> {
    let found = guarded(path, || data.dtype().map_err(|e| e.to_string()))?;
    if fits(&found) {
        return Ok(());
    }
    Err(Fault::new(format!("dataset /{path} holds {found:?}"))
        .expected(expected)
        .cure("remake it with `ferrom reduce`"))
}

fn sized<T>(path: &str, values: Vec<T>, count: usize) -> Result<Vec<T>, Fault> {
    if values.len() == count {
        return Ok(values);
    }
    Err(Fault::new(format!("dataset /{path} holds {} values", values.len()))
        .expected(count.to_string())
        .cure("the file is damaged: remake it"))
}

/// Runs the HDF5 library; what it refuses, and should it ever panic on a damaged file, becomes a fault.
fn guarded<T>(what: &str, read: impl FnOnce() -> Result<T, String>) -> Result<T, Fault> {
    let outcome = catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| Err("the data are damaged".into()));
    outcome.map_err(|reason| Fault::new(format!("{what} cannot be read as HDF5: {reason}")))
}
