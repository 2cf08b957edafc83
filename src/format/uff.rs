//! Universal files (.unv, .uff): nodes (15, 2411), units (164), program (151) and modes (55).
//!
//! Source: SDRC universal file format documents, University of Cincinnati SDRL. A dataset stands
//! between two lines that hold only −1 in columns 1 to 6; its first line is its number. Numbers stand
//! in fixed columns and abut, so lines are never split on blanks. Other datasets are passed over.

use super::error::{Fault, FormatError, quote};
use super::number::whole_real;
use super::uff55::{TestMode, mode55};
use crate::model::{NodeId, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What a test (or another program) says about a structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TestData {
    /// Positions in m, by dataset 164 (in the file's unit without one, with a warning).
    pub nodes: BTreeMap<NodeId, [f64; 3]>,
    /// Modes in the order of the file.
    pub modes: Vec<TestMode>,
    /// The program that wrote the file; may be empty.
    pub program: String,
    /// Numbers of the datasets that were passed over.
    pub passed: BTreeSet<u32>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// True for a file that begins with the mark and a dataset number.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let mut lines = head.split(|&b| b == b'\n').filter(|l| !l.trim_ascii().is_empty());
    let mark = lines.next().is_some_and(is_mark);
    mark && lines.next().is_some_and(|l| number(l, 0, 6).is_some())
}

/// Reads a universal file.
pub fn read_uff(path: &Path) -> Result<(TestData, Source), FormatError> {
    let (bytes, sha256) = super::input::read_all(path)?;
    let data = parse(&bytes).map_err(|fault| fault.in_file(path))?;
    Ok((data, Source { role: "test".into(), path: path.display().to_string(), sha256 }))
}

/// −1 in columns 1 to 6 and nothing else.
fn is_mark(line: &[u8]) -> bool {
    line.trim_ascii() == b"-1" && line.iter().take(6).any(|&b| b == b'1')
}

/// Lines of one dataset.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    /// Lines read in the file.
    pub line: usize,
}

impl<'a> Lines<'a> {
    /// The next line, whatever it holds.
    pub fn raw(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = self.rest.get(end + 1..).unwrap_or(&[]);
        self.line += 1;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// The next line of the dataset; `None` at its end mark.
    pub fn data(&mut self, what: &str) -> Result<Option<&'a [u8]>, Fault> {
        match self.raw() {
            Some(line) if is_mark(line) => Ok(None),
            Some(line) => Ok(Some(line)),
            None => Err(self.ended(what)),
        }
    }

    /// A line that must be there.
    pub fn must(&mut self, what: &str) -> Result<&'a [u8], Fault> {
        self.data(what)?.ok_or_else(|| Fault::line(self.line, format!("the dataset ends before {what}")))
    }

    pub fn ended(&self, what: &str) -> Fault {
        Fault::line(self.line, format!("the file ends before {what}"))
            .expected("the end mark -1")
            .cure("it was probably cut short: copy or export it again")
    }

    /// What stands on the line read last is wrong.
    pub fn wrong(&self, line: &[u8], expected: &str) -> Fault {
        Fault::line(self.line, format!("found {}", quote(line))).expected(expected)
    }

    /// Whole numbers of ten columns each, over as many lines as it takes.
    pub fn integers(&mut self, count: usize, per_line: usize, what: &str) -> Result<Vec<i64>, Fault> {
        let mut values = Vec::new();
        while values.len() < count {
            let line = self.must(what)?;
            for k in 0..per_line.min(count - values.len()) {
                values.push(number(line, 10 * k, 10 * k + 10).ok_or_else(|| self.wrong(line, what))?);
            }
        }
        Ok(values)
    }

    /// Real numbers of thirteen columns each, six to a line.
    pub fn reals(&mut self, count: usize, what: &str) -> Result<Vec<f64>, Fault> {
        let mut values = Vec::new();
        while values.len() < count {
            let line = self.must(what)?;
            for k in 0..6.min(count - values.len()) {
                values.push(real(line, 13 * k, 13 * k + 13).ok_or_else(|| self.wrong(line, what))?);
            }
        }
        Ok(values)
    }

    /// Passes over a binary body of so many bytes.
    fn skip(&mut self, bytes: usize, what: &str) -> Result<(), Fault> {
        self.rest = self.rest.get(bytes..).ok_or_else(|| self.ended(what))?;
        Ok(())
    }
}

/// A whole number in columns `from..to` (from 0).
pub(super) fn number(line: &[u8], from: usize, to: usize) -> Option<i64> {
    let field = line.get(from..to.min(line.len()))?.trim_ascii();
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// A finite real number in columns `from..to` (from 0).
pub(super) fn real(line: &[u8], from: usize, to: usize) -> Option<f64> {
    whole_real(line.get(from..to.min(line.len()))?).filter(|v| v.is_finite())
}

fn parse(bytes: &[u8]) -> Result<TestData, Fault> {
    let mut lines = Lines { rest: bytes, line: 0 };
    let mut data = TestData::default();
    let mut length = None;
    let mut systems = BTreeSet::new();
    let mut local = BTreeMap::new();
    let mut sets = 0;
    while let Some(line) = lines.raw() {
        if line.trim_ascii().is_empty() {
            continue;
        }
        if !is_mark(line) {
            return Err(lines.wrong(line, "-1 in columns 5 and 6, which begins a dataset"));
        }
        let title = lines.must("the dataset's number")?;
        let kind = number(title, 0, 6).and_then(|n| u32::try_from(n).ok());
        let kind = kind.ok_or_else(|| lines.wrong(title, "a dataset number in columns 1 to 6"))?;
        sets += 1;
        match kind {
            15 => nodes15(&mut lines, &mut data.nodes, &mut local)?,
            2411 => nodes2411(&mut lines, &mut data.nodes, &mut local)?,
            55 => data.modes.push(mode55(&mut lines)?),
            164 => length = Some(units(&mut lines)?),
            151 => {
                data.program = program(&mut lines)?;
            }
            18 | 2420 => {
                systems.insert(kind);
                pass(&mut lines, title, kind)?;
            }
            _ => {
                data.passed.insert(kind);
                pass(&mut lines, title, kind)?;
            }
        }
    }
    if sets == 0 {
        return Err(Fault::new("no dataset").expected("a universal file, which begins with -1 and a dataset number"));
    }
    match length {
        Some(factor) => data.nodes.values_mut().flatten().for_each(|x| *x /= factor),
        None if data.nodes.is_empty() => {}
        None => data.warnings.push("no units (dataset 164): positions are taken as metres".into()),
    }
    if let Some((node, system)) = local.into_iter().next().filter(|_| !systems.is_empty()) {
        data.warnings.push(format!(
            "node {node} moves in coordinate system {system} and the file defines systems of its own (dataset {}): directions are taken as global",
            systems.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
        ));
    }
    Ok(data)
}

/// Passes over a dataset, also a binary one, whose sizes stand in its first line: text lines in
/// columns 20 to 31, bytes behind them in columns 32 to 43.
fn pass(lines: &mut Lines, title: &[u8], kind: u32) -> Result<(), Fault> {
    let what = format!("the end of dataset {kind}");
    if title.get(6).is_some_and(|b| b.eq_ignore_ascii_case(&b'b')) {
        let size = |from, to| number(title, from, to).and_then(|n| usize::try_from(n).ok());
        let (Some(text), Some(bytes)) = (size(19, 31), size(31, 43)) else {
            return Err(lines.wrong(title, "lines in columns 20 to 31, bytes in columns 32 to 43"));
        };
        for _ in 0..text {
            lines.raw().ok_or_else(|| lines.ended(&what))?;
        }
        lines.skip(bytes, &what)?;
    }
    while lines.data(&what)?.is_some() {}
    Ok(())
}

/// Remembers the position of a node and its displacement coordinate system where that is not global.
fn place(
    lines: &Lines,
    nodes: &mut BTreeMap<NodeId, [f64; 3]>,
    local: &mut BTreeMap<NodeId, i64>,
    (label, system): (i64, i64),
    position: [f64; 3],
) -> Result<(), Fault> {
    let id = u32::try_from(label).map(NodeId);
    let id = id.map_err(|_| Fault::line(lines.line, format!("node {label}")).expected("a positive label"))?;
    if nodes.insert(id, position).is_some_and(|old| old != position) {
        return Err(Fault::line(lines.line, format!("node {id} stands twice, at different places"))
            .expected("each label once")
            .cure("parts with labels of their own need one file each"));
    }
    if system > 1 {
        local.insert(id, system);
    }
    Ok(())
}

/// 15: label, two coordinate systems, colour (4I10), x y z (3E13.5), on one line.
fn nodes15(
    lines: &mut Lines,
    nodes: &mut BTreeMap<NodeId, [f64; 3]>,
    local: &mut BTreeMap<NodeId, i64>,
) -> Result<(), Fault> {
    while let Some(line) = lines.data("the end of dataset 15")? {
        let whole = (number(line, 0, 10), number(line, 20, 30));
        let at = (real(line, 40, 53), real(line, 53, 66), real(line, 66, 79));
        let ((Some(label), Some(system)), (Some(x), Some(y), Some(z))) = (whole, at) else {
            return Err(lines.wrong(line, "label, two coordinate systems, colour (10 columns each), x y z (13 each)"));
        };
        place(lines, nodes, local, (label, system), [x, y, z])?;
    }
    Ok(())
}

/// 2411: label, two coordinate systems, colour (4I10); x y z (3D25.16) on a second line.
fn nodes2411(
    lines: &mut Lines,
    nodes: &mut BTreeMap<NodeId, [f64; 3]>,
    local: &mut BTreeMap<NodeId, i64>,
) -> Result<(), Fault> {
    while let Some(line) = lines.data("the end of dataset 2411")? {
        let (Some(label), Some(system)) = (number(line, 0, 10), number(line, 20, 30)) else {
            return Err(lines.wrong(line, "label, two coordinate systems, colour (10 columns each)"));
        };
        let line = lines.must("the position of a node")?;
        let (Some(x), Some(y), Some(z)) = (real(line, 0, 25), real(line, 25, 50), real(line, 50, 75)) else {
            return Err(lines.wrong(line, "x, y and z (25 columns each)"));
        };
        place(lines, nodes, local, (label, system), [x, y, z])?;
    }
    Ok(())
}

/// 164: the factor of length by which the file's numbers are divided to give metres.
fn units(lines: &mut Lines) -> Result<f64, Fault> {
    lines.must("the name of the units")?;
    let line = lines.must("the unit factors")?;
    // The temperature offset on the next line is no length.
    let factor = real(line, 0, 25).filter(|&f| f > 0.0);
    let factor = factor.ok_or_else(|| lines.wrong(line, "a positive factor of length in columns 1 to 25"))?;
    while lines.data("the end of dataset 164")?.is_some() {}
    Ok(factor)
}

/// 151: the program is named on the sixth line.
fn program(lines: &mut Lines) -> Result<String, Fault> {
    let mut name = String::new();
    let mut k = 0;
    while let Some(line) = lines.data("the end of dataset 151")? {
        k += 1;
        if k == 6 {
            name = String::from_utf8_lossy(line.trim_ascii()).into_owned();
        }
    }
    Ok(name)
}
