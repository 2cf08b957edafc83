//! CalculiX `*FREQUENCY, SOLVER=MATRIXSTORAGE`: .sti, .mas (matrices) and .dof (what the rows mean);
//! Abaqus `*MATRIX OUTPUT, FORMAT=COORDINATE` (.mtx) is the same with both triangles.
//!
//! Matrices: one line "row column value" per entry, counted from 1, no header, one triangle with the
//! whole diagonal, zeros included (Abaqus: both triangles). Dof list: line k is `node.direction` of row k, two integers.

use super::error::{Fault, FormatError, Place, quote};
use super::input::Input;
use super::triplets::{Halves, cut_line, each_record};
use crate::linalg::SymSparse;
use crate::model::{Axis, Dof, DofMap, NodeId, Source};
use nom::Parser;
use nom::character::complete::{char, space0, u32 as integer};
use nom::combinator::all_consuming;
use nom::sequence::{delimited, separated_pair};
use std::path::Path;

/// True for lines of two integers and a real number.
pub(super) fn looks_like_matrix(head: &[u8]) -> bool {
    first_line(head).is_some_and(|line| {
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).collect();
        words.len() == 3
            && words[..2].iter().all(|w| w.iter().all(u8::is_ascii_digit))
            && super::number::whole_real(words[2]).is_some()
    })
}

/// True for lines of `node.direction`.
pub(super) fn looks_like_dofs(head: &[u8]) -> bool {
    first_line(head).is_some_and(|line| label(line).is_some())
}

fn first_line(head: &[u8]) -> Option<&[u8]> {
    head.split(|&b| b == b'\n').map(<[u8]>::trim_ascii).find(|line| !line.is_empty())
}

/// Reads the triplets of an open file; the order is the largest index.
pub(super) fn read_matrix(path: &Path, input: Input, tell: &dyn Fn(usize)) -> Result<(SymSparse, String), FormatError> {
    let mut entries = Halves::default();
    let mut line = 0;
    let mut done = 0;
    let hash = input.each_chunk(path, |chunk| {
        done += chunk.len();
        tell(done);
        each_record(chunk, &mut line, |row, col, value, line| entries.push(row, col, value, line))
    })?;
    finish(entries, line).map(|matrix| (matrix, hash)).map_err(|fault| fault.in_file(path))
}

fn finish(entries: Halves, lines: usize) -> Result<SymSparse, Fault> {
    let largest = entries.largest();
    if entries.seen() == 0 {
        return Err(Fault::new("the file is empty")
            .expected("lines of row, column and value")
            .cure("did the export run to its end?"));
    }
    if (entries.upper.diagonals as u64) < u64::from(largest) {
        let (row, col) = entries.last;
        let missing = entries.upper.missing_diagonal(largest).unwrap_or(largest);
        let place = Place::Line(lines);
        let fault = if missing == row.max(col) {
            Fault::new(format!("the file ends at entry ({row}, {col}), before the diagonal of column {missing}"))
                .cure("it was probably cut short: copy or export it again")
        } else {
            Fault::new(format!("the file ends without a diagonal entry for row {missing} of {largest}"))
                .cure("export it again, or write the matrix in MatrixMarket format, which states its size")
        };
        return Err(Fault { place, ..fault }.expected("the whole diagonal, as CalculiX writes it"));
    }
    entries.into_matrix(largest as usize)
}

/// Reads a dof list; a label that stands twice is refused with both lines.
pub fn read_dof_map(path: &Path) -> Result<(DofMap, Source), FormatError> {
    let (text, sha256) = super::input::read_all(path)?;
    let dofs = parse_dofs(&text).map_err(|fault| fault.in_file(path))?;
    Ok((dofs, Source { role: "dofs".into(), path: path.display().to_string(), sha256 }))
}

/// The dof list in a text.
pub(super) fn parse_dofs(text: &[u8]) -> Result<DofMap, Fault> {
    let expected = "node.direction with direction 1 to 6, such as 2868.3";
    let mut labels = Vec::with_capacity(text.len() / 8);
    let mut lines = Vec::with_capacity(text.len() / 8);
    for (k, raw) in text.split_inclusive(|&b| b == b'\n').enumerate() {
        let line = raw.trim_ascii();
        if line.is_empty() {
            continue;
        }
        if !raw.ends_with(b"\n") {
            return Err(cut_line(k + 1, line));
        }
        let (node, direction) =
            label(line).ok_or_else(|| Fault::line(k + 1, format!("found {}", quote(line))).expected(expected))?;
        let axis = Axis::from_number(direction).ok_or_else(|| {
            Fault::line(k + 1, format!("direction {direction} of node {node}"))
                .expected(expected)
                .cure("only mechanical dofs can be read: leave temperatures and pressures out of the export")
        })?;
        labels.push(Dof { node: NodeId(node), axis });
        lines.push(k + 1);
    }
    if labels.is_empty() {
        return Err(Fault::new("the file is empty").expected(expected).cure("did the export run to its end?"));
    }
    DofMap::labelled(labels).map_err(|repeated| {
        let (first, second) = (lines[repeated.first - 1], lines[repeated.second - 1]);
        Fault::line(second, format!("dof {} also stands on line {first}", repeated.dof))
            .expected("each label once")
            .cure("shells and beams expanded to solids repeat labels: use solid elements in the export")
    })
}

/// `2868.3`: two integers, never a decimal number (`2868.1` and `2868.10` differ).
fn label(line: &[u8]) -> Option<(u32, u32)> {
    let text = std::str::from_utf8(line).ok()?;
    let mut parser = all_consuming(delimited(
        space0::<_, nom::error::Error<&str>>,
        separated_pair(integer, char('.'), integer),
        space0,
    ));
    parser.parse(text).ok().map(|(_, pair)| pair)
}
