//! CalculiX `*FREQUENCY, STORAGE=YES` (.eig): modes in full double precision.
//!
//! Little endian without record marks: four int32 (cyclic symmetry, Hermitian, iperturb, modes m); m
//! eigenvalues (rad/s)²; K and M as diagonals and off-diagonals; m shapes of n numbers in the order of
//! the .dof file, mass-normalised. n is not stored, which is why the dof list is needed.

use super::error::{Fault, FormatError, Place};
use super::imported::assemble;
use crate::model::{DofMap, Modes, Source};
use nalgebra::DMatrix;
use std::path::Path;

/// Reads the modes; `dofs` is the .dof list of the same model.
pub fn read_eig(path: &Path, dofs: &DofMap) -> Result<(Modes, Source), FormatError> {
    let (bytes, sha256) = super::input::read_all(path)?;
    let modes = parse(&bytes, dofs).map_err(|fault| fault.in_file(path))?;
    Ok((modes, Source { role: "modes".into(), path: path.display().to_string(), sha256 }))
}

fn parse(bytes: &[u8], dofs: &DofMap) -> Result<Modes, Fault> {
    let n = dofs.len();
    let header: Vec<i32> =
        bytes.chunks_exact(4).take(4).map(|c| i32::from_le_bytes([c[0], c[1], c[2], c[3]])).collect();
    let &[cyclic, _, _, count] = header.as_slice() else {
        return Err(Fault::new("the file is shorter than its header").expected("a CalculiX .eig file"));
    };
    let at = |byte: usize, found: String| Fault { place: Place::Byte(byte as u64), ..Fault::new(found) };
    if cyclic != 0 {
        return Err(at(0, format!("cyclic symmetry flag {cyclic}")).expected("0").cure("export the whole part"));
    }
    let m = usize::try_from(count).ok().filter(|&m| m > 0);
    let m = m.ok_or_else(|| at(12, format!("{count} modes")).expected("a positive number"))?;
    // 2n + 2·(off-diagonals) numbers of K and M stand between the eigenvalues and the shapes.
    let least = m.checked_mul(n + 1).and_then(|x| x.checked_add(2 * n)).and_then(|x| x.checked_mul(8));
    let body = bytes.len() - 16;
    if least.is_none_or(|least| body < least || !(body - least).is_multiple_of(16)) {
        return Err(at(bytes.len(), format!("{} bytes do not hold {m} modes of {n} dofs", bytes.len()))
            .expected("the .eig file that belongs to the dof list")
            .cure("take both from one run; the file may be cut short"));
    }
    let double = |bytes: &[u8]| -> Vec<f64> {
        bytes.chunks_exact(8).map(|c| f64::from_le_bytes([c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]])).collect()
    };
    let lambda = double(&bytes[16..16 + 8 * m]);
    if let Some(k) = lambda.iter().position(|l| !l.is_finite()) {
        return Err(at(16 + 8 * k, format!("eigenvalue {} is {}", k + 1, lambda[k])).expected("a finite number"));
    }
    let shapes = double(&bytes[bytes.len() - 8 * m * n..]);
    // √λ keeps its sign, so that negative eigenvalues (rounding of rigid modes) sort first.
    let omega: Vec<f64> = lambda.iter().map(|l| l.abs().sqrt().copysign(*l)).collect();
    assemble(omega, DMatrix::from_vec(n, m, shapes), dofs.clone())
}
