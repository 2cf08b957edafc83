//! MATLAB .mat, version 5: a reduced model as named variables, for `load` and `scipy.io.loadmat`.
//!
//! Source: MathWorks, "MAT-File Format", level 5: little-endian elements of a tag (type, bytes) and
//! data padded to 8 bytes; matrices column by column.

use super::arrays::{Array, arrays};
use super::error::{Fault, FormatError};
use crate::model::{ReducedModel, StateSpace};
use nalgebra::DMatrix;
use std::path::Path;

const INT8: u32 = 1;
const UTF16: u32 = 17;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;

/// The file's bytes. Rows of numbers become 1×n, lists of texts char matrices padded with blanks. No
/// time stamp: the same model gives the same bytes.
pub fn reduced_to_mat5(model: &ReducedModel, state_space: Option<&StateSpace>) -> Result<Vec<u8>, FormatError> {
    // 116 bytes of text, 8 of nothing, version 1, and "MI" as a little-endian number.
    let mut file = format!("{:<116}", "MATLAB 5.0 MAT-file, reduced model written by ferrom").into_bytes();
    file.extend([0; 8]);
    file.extend([0x00, 0x01, b'I', b'M']);
    for (name, array) in arrays(model, state_space) {
        let variable = match array {
            Array::Row(values) => numbers(name, &DMatrix::from_row_slice(1, values.len(), &values)),
            Array::Matrix(matrix) => numbers(name, &matrix),
            Array::Texts(texts) => characters(name, &texts),
        };
        element(&mut file, MATRIX, &variable);
        if u32::try_from(variable.len()).is_err() {
            return Err(Fault::new(format!("{name} takes {} bytes", variable.len()))
                .expected("less than 4 GB per variable")
                .cure("export to HDF5")
                .in_file(Path::new(&format!("{}.mat", model.name))));
        }
    }
    Ok(file)
}

fn element(out: &mut Vec<u8>, kind: u32, data: &[u8]) {
    out.extend(kind.to_le_bytes());
    out.extend((data.len() as u32).to_le_bytes());
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
}

/// Class, size and name of a variable.
fn head(name: &str, class: u32, rows: usize, cols: usize) -> Vec<u8> {
    let mut out = Vec::new();
    element(&mut out, UINT32, &[class.to_le_bytes(), [0; 4]].concat());
    element(&mut out, INT32, &[(rows as i32).to_le_bytes(), (cols as i32).to_le_bytes()].concat());
    element(&mut out, INT8, name.as_bytes());
    out
}

fn numbers(name: &str, matrix: &DMatrix<f64>) -> Vec<u8> {
    let mut out = head(name, DOUBLE_CLASS, matrix.nrows(), matrix.ncols());
    let data: Vec<u8> = matrix.iter().flat_map(|v| v.to_le_bytes()).collect();
    element(&mut out, DOUBLE, &data);
    out
}

fn characters(name: &str, texts: &[String]) -> Vec<u8> {
    let rows: Vec<Vec<u16>> = texts.iter().map(|t| t.encode_utf16().collect()).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    let mut out = head(name, CHAR_CLASS, rows.len(), width);
    let blank = u16::from(b' ');
    let letters = (0..width).flat_map(|c| rows.iter().map(move |row| row.get(c).copied().unwrap_or(blank)));
    element(&mut out, UTF16, &letters.flat_map(u16::to_le_bytes).collect::<Vec<u8>>());
    out
}
