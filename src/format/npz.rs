//! NumPy .npz: a reduced model as named arrays, for `numpy.load`.
//!
//! Source: NumPy, "numpy.lib.format", version 1.0, in an uncompressed zip archive (PKWARE APPNOTE 2.0).

use super::arrays::{Array, arrays};
use super::error::{Fault, FormatError};
use super::h5::row_major;
use crate::model::{ReducedModel, StateSpace};
use flate2::Crc;
use std::path::Path;

/// 1 January 1980, the first day a zip archive knows: the same model gives the same bytes.
const DATE: u16 = 0x21;

/// The file's bytes.
pub fn reduced_to_npz(model: &ReducedModel, state_space: Option<&StateSpace>) -> Result<Vec<u8>, FormatError> {
    let mut file = Vec::new();
    let mut directory = Vec::new();
    let members = arrays(model, state_space);
    let count = members.len() as u16;
    for (name, array) in members {
        let data = npy(&array);
        let (offset, size) = (file.len(), data.len());
        let (Ok(offset), Ok(size)) = (u32::try_from(offset), u32::try_from(size)) else {
            return Err(Fault::new("the model takes more than 4 GB")
                .expected("a model that fits a zip archive")
                .cure("export to HDF5")
                .in_file(Path::new(&format!("{}.npz", model.name))));
        };
        let name = format!("{name}.npy");
        let mut crc = Crc::new();
        crc.update(&data);
        // Version 2.0, no flags, stored, time 0, date, checksum, sizes, length of the name, no extra.
        let mut common = Vec::new();
        common.extend([20u16, 0, 0, 0, DATE].iter().flat_map(|v| v.to_le_bytes()));
        common.extend([crc.sum(), size, size].iter().flat_map(|v| v.to_le_bytes()));
        common.extend([name.len() as u16, 0].iter().flat_map(|v| v.to_le_bytes()));
        file.extend(b"PK\x03\x04");
        file.extend(&common);
        file.extend(name.as_bytes());
        file.extend(&data);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, size) = (file.len() as u32, directory.len() as u32);
    file.extend(directory);
    file.extend(b"PK\x05\x06\x00\x00\x00\x00");
    file.extend([count, count].iter().flat_map(|v| v.to_le_bytes()));
    file.extend([size, start].iter().flat_map(|v| v.to_le_bytes()));
    file.extend([0; 2]);
    Ok(file)
}

/// One array: magic, version 1.0, a header padded to a multiple of 64 bytes, data row by row.
fn npy(array: &Array) -> Vec<u8> {
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let (kind, shape, data) = match array {
        Array::Row(values) => ("<f8".to_owned(), format!("({},)", values.len()), doubles(values)),
        Array::Matrix(m) => ("<f8".to_owned(), format!("({}, {})", m.nrows(), m.ncols()), doubles(&row_major(m))),
        Array::Texts(texts) => {
            let width = texts.iter().map(|t| t.chars().count()).max().unwrap_or(0).max(1);
            let padded = texts.iter().flat_map(|t| t.chars().chain(std::iter::repeat('\0')).take(width));
            let data = padded.flat_map(|c| u32::from(c).to_le_bytes()).collect();
            (format!("<U{width}"), format!("({},)", texts.len()), data)
        }
    };
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header = format!("{header:<width$}\n", width = length - 1);
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((length as u16).to_le_bytes());
    out.extend(header.as_bytes());
    out.extend(data);
    out
}
