//! CalculiX printed output (.dat): the eigenvalue table of `*FREQUENCY`, seven digits.

use super::error::{Fault, FormatError, quote};
use super::number::whole_real;
use crate::model::{ModeNo, Source};
use std::path::Path;

/// One line of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DatMode {
    /// Number in the file.
    pub number: ModeNo,
    /// ω², (rad/s)²; negative for an unstable mode, or a rigid one within rounding.
    pub lambda: f64,
    /// rad/s; 0 where λ is negative.
    pub omega: f64,
}

const TITLE: &str = "EIGENVALUEOUTPUT";
const NEXT: &str = "PARTICIPATION";

/// Titles are printed with blanks between the letters.
fn squeezed(line: &[u8]) -> String {
    String::from_utf8_lossy(line).chars().filter(|c| !c.is_whitespace()).collect()
}

/// True for a file whose head has the title of the table.
pub(super) fn looks_like(head: &[u8]) -> bool {
    head.split(|&b| b == b'\n').take(200).any(|line| squeezed(line) == TITLE)
}

/// Reads the last eigenvalue table of a .dat file.
pub fn read_dat(path: &Path) -> Result<(Vec<DatMode>, Source), FormatError> {
    let (bytes, sha256) = super::input::read_all(path)?;
    let modes = parse(&bytes).map_err(|fault| fault.in_file(path))?;
    Ok((modes, Source { role: "modes".into(), path: path.display().to_string(), sha256 }))
}

fn parse(bytes: &[u8]) -> Result<Vec<DatMode>, Fault> {
    let mut modes: Vec<DatMode> = Vec::new();
    let mut inside = false;
    let mut titles = false;
    for (k, raw) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
        let line = raw.trim_ascii();
        let title = squeezed(line);
        if title == TITLE {
            (inside, titles) = (true, true);
            modes.clear();
            continue;
        }
        inside &= !title.starts_with(NEXT);
        if !inside || !line.first().is_some_and(u8::is_ascii_digit) {
            continue;
        }
        if !raw.ends_with(b"\n") {
            return Err(super::triplets::cut_line(k + 1, line));
        }
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).collect();
        let number = std::str::from_utf8(words[0]).ok().and_then(|w| w.parse::<u32>().ok());
        let values: Option<Vec<f64>> = words[1..].iter().map(|w| whole_real(w).filter(|v| v.is_finite())).collect();
        let (Some(number), Some(&[lambda, omega, _, _])) = (number, values.as_deref()) else {
            return Err(Fault::line(k + 1, format!("found {}", quote(line)))
                .expected("mode, eigenvalue, rad/time, cycles/time, imaginary part"));
        };
        if number as usize != modes.len() + 1 {
            return Err(Fault::line(k + 1, format!("mode {number} after mode {}", modes.len()))
                .expected(format!("mode {}", modes.len() + 1)));
        }
        modes.push(DatMode { number: ModeNo(number), lambda, omega });
    }
    if modes.is_empty() {
        let found = if titles { "an eigenvalue table without modes" } else { "no eigenvalue table" };
        return Err(Fault::new(found)
            .expected("E I G E N V A L U E   O U T P U T and its modes")
            .cure("name the .dat file of a *FREQUENCY step"));
    }
    Ok(modes)
}
