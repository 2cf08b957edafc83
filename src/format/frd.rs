//! CalculiX results (.frd), ascii and binary: nodes and the mode shapes of `*FREQUENCY`.
//!
//! Source: G. Dhondt, K. Wittig, "CalculiX GraphiX user's manual", result format. Fields stand in
//! fixed columns and abut, so lines are never split on blanks. Headers are text in both variants;
//! binary records (little endian) follow their header at once. CalculiX modes are mass-normalised.
//! The ascii variant carries six digits: good for shapes, never for recomputing stiffness.

use super::error::{Fault, FormatError, Place, quote};
use super::imported::{ImportedModes, assemble};
use super::number::whole_real;
use crate::model::{Axis, Dof, DofMap, NodeId, Source};
use nalgebra::DMatrix;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// True for a file that begins with the card `    1C`.
pub(super) fn looks_like(head: &[u8]) -> bool {
    head.starts_with(b"    1C")
}

/// Reads the nodes and mode shapes of a .frd file.
pub fn read_frd(path: &Path) -> Result<(ImportedModes, Source), FormatError> {
    let (bytes, sha256) = super::input::read_all(path)?;
    let modes = parse(&bytes).map_err(|fault| fault.in_file(path))?;
    Ok((modes, Source { role: "modes".into(), path: path.display().to_string(), sha256 }))
}

/// How the records of a block are written: the digit in column 75 of its header.
#[derive(Clone, Copy, PartialEq)]
enum Coding {
    /// Text, node numbers of so many columns.
    Text(usize),
    /// Single precision.
    Single,
    /// Double precision.
    Double,
}

/// A node number and its three numbers.
type Triple = (u32, [f64; 3]);

struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Lines read; binary blocks count as none.
    line: usize,
    binary: bool,
}

impl<'a> Cursor<'a> {
    /// The next line of text, without its end.
    fn line(&mut self) -> Option<&'a [u8]> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += end + 1;
        self.line += 1;
        Some(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    /// A fault on the line read last; behind a binary block lines mean nothing, bytes do.
    fn fault(&self, found: impl Into<String>) -> Fault {
        let place = if self.binary { Place::Byte(self.at as u64) } else { Place::Line(self.line) };
        Fault { place, ..Fault::new(found) }
    }

    fn ended(&self, what: &str) -> Fault {
        self.fault(format!("the file ends inside {what}")).cure("it was probably cut short: copy or export it again")
    }

    /// A binary record of so many bytes.
    fn record(&mut self, size: usize, what: &str) -> Result<&'a [u8], Fault> {
        self.binary = true;
        let record = self.bytes.get(self.at..self.at + size).ok_or_else(|| self.ended(what))?;
        self.at += size;
        Ok(record)
    }
}

fn parse(bytes: &[u8]) -> Result<ImportedModes, Fault> {
    let mut cursor = Cursor { bytes, at: 0, line: 0, binary: false };
    if !looks_like(bytes) {
        return Err(Fault::line(1, format!("found {}", quote(&bytes[..bytes.len().min(40)])))
            .expected("a CalculiX .frd file, which begins with 1C"));
    }
    let mut nodes = BTreeMap::new();
    let mut omega = Vec::new();
    let mut shapes: Vec<Vec<Triple>> = Vec::new();
    let mut complete = false;
    while let Some(line) = cursor.line() {
        if line.starts_with(b"    2C") {
            let coding = coding(&cursor, line)?;
            let count = count(&cursor, line)?;
            let records = triples(&mut cursor, count, coding, "the nodes")?;
            nodes.extend(records.into_iter().map(|(id, position)| (NodeId(id), position)));
        } else if line.starts_with(b"    3C") {
            skip_elements(&mut cursor, line)?;
        } else if line.starts_with(b"  100C") {
            let modal = line.windows(5).any(|w| w == b"MODAL");
            if let Some(shape) = result(&mut cursor, line, modal)? {
                let hertz = columns(line, 12, 24).and_then(whole_real).filter(|f| f.is_finite());
                let hertz = hertz.ok_or_else(|| cursor.fault("no frequency in columns 13 to 24"))?;
                omega.push(hertz * std::f64::consts::TAU);
                shapes.push(shape);
            }
        } else if line.trim_ascii() == b"9999" {
            complete = true;
            break;
        }
    }
    if !complete {
        return Err(cursor.ended("the results, before the end mark 9999"));
    }
    let Some(first) = shapes.first() else {
        return Err(Fault::new("no mode shapes")
            .expected("DISP blocks of a *FREQUENCY analysis")
            .cure("add *NODE FILE with U to the frequency step"));
    };
    let labels =
        first.iter().flat_map(|&(id, _)| [Axis::X, Axis::Y, Axis::Z].map(|axis| Dof { node: NodeId(id), axis }));
    let dofs = DofMap::labelled(labels.collect()).map_err(|e| Fault::new(e.to_string()))?;
    let row: HashMap<u32, usize> = first.iter().enumerate().map(|(k, &(id, _))| (id, k)).collect();
    let mut matrix = DMatrix::zeros(3 * first.len(), shapes.len());
    for (m, shape) in shapes.iter().enumerate() {
        for &(id, values) in shape {
            let k = row.get(&id).filter(|_| shape.len() == first.len()).ok_or_else(|| {
                Fault::new(format!("mode {} is given at other nodes than mode 1 (node {id})", m + 1))
                    .expected("every mode at the same nodes")
            })?;
            (0..3).for_each(|d| matrix[(3 * k + d, m)] = values[d]);
        }
    }
    Ok(ImportedModes { modes: assemble(omega, matrix, dofs)?, nodes })
}

fn columns(line: &[u8], from: usize, to: usize) -> Option<&[u8]> {
    line.get(from..to.min(line.len())).map(<[u8]>::trim_ascii)
}

fn integer(text: &[u8]) -> Option<u32> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// Records in a block: columns 25 to 36 of its header.
fn count(cursor: &Cursor, header: &[u8]) -> Result<usize, Fault> {
    let found = columns(header, 24, 36).and_then(integer);
    found.map(|n| n as usize).ok_or_else(|| cursor.fault("no number of records in columns 25 to 36"))
}

fn coding(cursor: &Cursor, header: &[u8]) -> Result<Coding, Fault> {
    match columns(header, 73, 75).unwrap_or(b"") {
        b"0" => Ok(Coding::Text(5)),
        b"1" => Ok(Coding::Text(10)),
        b"2" => Ok(Coding::Single),
        b"3" => Ok(Coding::Double),
        other => Err(cursor.fault(format!("coding {} in column 75", quote(other))).expected("0, 1, 2 or 3")),
    }
}

/// Records of a node number and three numbers.
fn triples(cursor: &mut Cursor, count: usize, coding: Coding, what: &str) -> Result<Vec<Triple>, Fault> {
    // A record takes 16 bytes at least: the header's count is not believed beyond the file's size.
    let mut records = Vec::with_capacity(count.min(cursor.bytes.len() / 16));
    let size = match coding {
        Coding::Text(width) => {
            while let Some(line) = cursor.line() {
                if line.starts_with(b" -3") {
                    if records.len() != count {
                        return Err(cursor.fault(format!("{} records", records.len())).expected(count.to_string()));
                    }
                    return Ok(records);
                }
                let field = |k: usize| columns(line, 3 + width + 12 * k, 15 + width + 12 * k).and_then(whole_real);
                let id = columns(line, 3, 3 + width).and_then(integer).filter(|_| line.starts_with(b" -1"));
                let (Some(id), Some(x), Some(y), Some(z)) = (id, field(0), field(1), field(2)) else {
                    return Err(cursor
                        .fault(format!("found {}", quote(line)))
                        .expected(format!("-1, a node number ({width} columns) and three numbers (12 columns each)")));
                };
                records.push((id, [x, y, z]));
            }
            return Err(cursor.ended(what));
        }
        Coding::Single => 4,
        Coding::Double => 8,
    };
    for _ in 0..count {
        let record = cursor.record(4 + 3 * size, what)?;
        let value = |k: usize| {
            let bytes = &record[4 + size * k..4 + size * (k + 1)];
            match *bytes {
                [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
                [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
                _ => f64::NAN,
            }
        };
        let id = u32::from_le_bytes([record[0], record[1], record[2], record[3]]);
        records.push((id, [value(0), value(1), value(2)]));
    }
    Ok(records)
}

fn skip_elements(cursor: &mut Cursor, header: &[u8]) -> Result<(), Fault> {
    if let Coding::Text(_) = coding(cursor, header)? {
        return skip_text(cursor, "the elements");
    }
    // Nodes of the element types 1 … 12 (he8 pe6 te4 he20 pe15 te10 tr3 tr6 qu4 qu8 be2 be3).
    const NODES: [usize; 12] = [8, 6, 4, 20, 15, 10, 3, 6, 4, 8, 2, 3];
    for _ in 0..count(cursor, header)? {
        let record = cursor.record(16, "the elements")?;
        let kind = u32::from_le_bytes([record[4], record[5], record[6], record[7]]) as usize;
        let nodes = kind.checked_sub(1).and_then(|k| NODES.get(k));
        let nodes = nodes.ok_or_else(|| cursor.fault(format!("element type {kind}")).expected("1 to 12"))?;
        cursor.record(4 * nodes, "the elements")?;
    }
    Ok(())
}

fn skip_text(cursor: &mut Cursor, what: &str) -> Result<(), Fault> {
    while let Some(line) = cursor.line() {
        if line.starts_with(b" -3") {
            return Ok(());
        }
    }
    Err(cursor.ended(what))
}

/// A result block; its values when they are the displacements of a mode.
fn result(cursor: &mut Cursor, header: &[u8], modal: bool) -> Result<Option<Vec<Triple>>, Fault> {
    let (coding, count) = (coding(cursor, header)?, count(cursor, header)?);
    let title = cursor.line().filter(|l| l.starts_with(b" -4")).ok_or_else(|| cursor.ended("a result block"))?;
    let displacement = columns(title, 5, 13) == Some(b"DISP");
    let listed = columns(title, 13, 18).and_then(integer).ok_or_else(|| cursor.fault("no number of components"))?;
    let mut stored = 0;
    for _ in 0..listed {
        let line = cursor.line().filter(|l| l.starts_with(b" -5")).ok_or_else(|| cursor.ended("a result block"))?;
        // A component marked 1 in columns 34 to 38 is derived and not stored (ALL).
        stored += usize::from(columns(line, 33, 38) != Some(b"1"));
    }
    if modal && displacement {
        if stored != 3 {
            return Err(cursor.fault(format!("{stored} displacement components")).expected("3"));
        }
        return triples(cursor, count, coding, "a mode shape").map(Some);
    }
    let size = match coding {
        Coding::Text(_) => return skip_text(cursor, "a result block").map(|()| None),
        Coding::Single => 4,
        Coding::Double => 8,
    };
    let total = count.checked_mul(4 + stored * size).ok_or_else(|| cursor.ended("a result block"))?;
    cursor.record(total, "a result block").map(|_| None)
}
