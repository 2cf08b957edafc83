//! Lines of "row column value": the inner loop of .sti, .mas and MatrixMarket files.

use super::error::{Fault, Place, quote};
use super::number::{digits, real, skip_blanks};
use crate::linalg::{SparseError, SymSparse};

/// What a line of a triplet file must look like.
const RECORD: &str = "a row number, a column number (both from 1) and a value";

/// Hands on every "row column value" line of a chunk of whole lines; blank lines are passed over.
/// `line` counts the lines before the chunk and is carried forward.
#[inline]
pub(super) fn each_record(
    chunk: &[u8],
    line: &mut usize,
    mut take: impl FnMut(u32, u32, f64, usize) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let mut at = 0;
    while at < chunk.len() {
        let begin = at;
        let number = *line + 1;
        let record = record(chunk, at);
        let Some((row, col, value, end)) = record else {
            let stop = chunk[begin..].iter().position(|&b| b == b'\n').map_or(chunk.len(), |k| begin + k);
            if chunk[begin..stop].trim_ascii().is_empty() {
                at = stop + 1;
                *line = number;
                continue;
            }
            if stop == chunk.len() {
                return Err(cut_line(number, &chunk[begin..stop]));
            }
            return Err(Fault::line(number, format!("found {}", quote(&chunk[begin..stop]))).expected(RECORD));
        };
        if row == 0 || col == 0 {
            return Err(Fault::line(number, format!("entry ({row}, {col}) has index 0"))
                .expected("rows and columns counted from 1")
                .cure("add 1 to every index, or export in MatrixMarket format"));
        }
        let (Ok(row), Ok(col)) = (u32::try_from(row), u32::try_from(col)) else {
            return Err(Fault::line(number, format!("entry ({row}, {col}) lies beyond the largest possible matrix"))
                .expected(format!("indices up to {}", u32::MAX)));
        };
        if !value.is_finite() {
            return Err(Fault::line(number, format!("entry ({row}, {col}) is {value}"))
                .expected("a finite number")
                .cure("look for zero or missing material data at this dof and export again"));
        }
        take(row, col, value, number)?;
        at = end;
        *line = number;
    }
    Ok(())
}

/// One complete line: row, column, value, index behind its line end.
#[inline(always)]
fn record(chunk: &[u8], at: usize) -> Option<(u64, u64, f64, usize)> {
    let (row, at) = digits(chunk, skip_blanks(chunk, at))?;
    let blank = skip_blanks(chunk, at);
    let (col, end) = digits(chunk, blank)?;
    let next = skip_blanks(chunk, end);
    if blank == at || next == end {
        return None;
    }
    let (value, at) = real(chunk, next)?;
    let mut at = skip_blanks(chunk, at);
    if chunk.get(at) == Some(&b'\r') {
        at += 1;
    }
    (chunk.get(at) == Some(&b'\n')).then_some((row, col, value, at + 1))
}

/// A last line without its line end: what a cut file looks like.
pub(super) fn cut_line(number: usize, text: &[u8]) -> Fault {
    Fault::line(number, format!("the file ends in the middle of a line: {}", quote(text)))
        .expected("a line end after the last line")
        .cure("it was probably cut short: copy or export it again (add a line end if it is complete)")
}

/// A full matrix is taken as symmetric when its triangles agree to this share of the larger of the
/// two entries (programs print 10 to 17 digits) …
const ENTRY_TOLERANCE: f64 = 1e-9;
/// … or to this share of the largest entry of the matrix (rounding of sums of large terms).
const MATRIX_TOLERANCE: f64 = 1e-13;

/// Collects a matrix of which one triangle is given, or both.
#[derive(Default)]
pub(super) struct Halves {
    /// With the diagonal.
    pub upper: Triangle,
    /// Without it.
    pub lower: Triangle,
    /// The last entry seen, from 1.
    pub last: (u32, u32),
}

impl Halves {
    /// Adds an entry, indices from 1.
    #[inline(always)]
    pub fn push(&mut self, row: u32, col: u32, value: f64, line: usize) -> Result<(), Fault> {
        self.last = (row, col);
        if row > col { self.lower.push(row, col, value, line) } else { self.upper.push(row, col, value, line) }
    }

    /// Entries seen, zeros included.
    pub fn seen(&self) -> u64 {
        self.upper.seen + self.lower.seen
    }

    /// Largest index seen, from 1.
    pub fn largest(&self) -> u32 {
        self.upper.largest.max(self.lower.largest)
    }

    /// The matrix of a file that may give one triangle only: then that one counts.
    pub fn into_matrix(mut self, order: usize) -> Result<SymSparse, Fault> {
        if self.lower.seen == 0 || self.upper.seen == self.upper.diagonals as u64 {
            self.upper.entries.append(&mut self.lower.entries);
            return self.upper.into_matrix(order);
        }
        self.into_symmetrised(order)
    }

    /// The mean of both triangles of a full matrix, which must agree.
    pub fn into_symmetrised(self, order: usize) -> Result<SymSparse, Fault> {
        let upper = self.upper.into_matrix(order)?;
        let lower = self.lower.into_matrix(order)?;
        let largest = upper.values().iter().chain(lower.values()).fold(0.0f64, |m, v| m.max(v.abs()));
        let mut mean = Vec::with_capacity(upper.stored());
        for j in 0..order {
            let (mut above, mut below) = (upper.column(j).peekable(), lower.column(j).peekable());
            while let Some(i) = above.peek().map(|e| e.0).into_iter().chain(below.peek().map(|e| e.0)).min() {
                let a = above.next_if(|e| e.0 == i).map_or(0.0, |e| e.1);
                let b = if i == j { a } else { below.next_if(|e| e.0 == i).map_or(0.0, |e| e.1) };
                let (row, col) = (i as u32 + 1, j as u32 + 1);
                let allowed = (ENTRY_TOLERANCE * a.abs().max(b.abs())).max(MATRIX_TOLERANCE * largest);
                if (a - b).abs() > allowed {
                    return Err(Fault {
                        place: Place::Entry(row, col),
                        ..Fault::new(format!(
                            "the matrix is not symmetric: ({row}, {col}) is {a:e}, ({col}, {row}) is {b:e}"
                        ))
                    }
                    .expected("one triangle, or both with the same values")
                    .cure("gyroscopic, follower-force and friction terms cannot be used: export without them"));
                }
                mean.push((i as u32, j as u32, if a == b { a } else { 0.5 * (a + b) }));
            }
        }
        SymSparse::from_compact(order, &mean).map_err(|e| sparse_fault(&e))
    }
}

/// Collects the entries of one triangle of a symmetric matrix; off-diagonal zeros are dropped.
#[derive(Default)]
pub(super) struct Triangle {
    /// Row, column from 0.
    entries: Vec<(u32, u32, f64)>,
    /// Largest index seen, from 1.
    pub largest: u32,
    /// Diagonal entries seen.
    pub diagonals: usize,
    /// Entries seen, zeros included.
    pub seen: u64,
    first_upper: Option<(u32, u32, usize)>,
    first_lower: Option<(u32, u32, usize)>,
    last: (u32, u32),
}

impl Triangle {
    /// Room for this many entries.
    pub fn reserve(&mut self, count: usize) {
        self.entries.reserve(count);
    }

    /// Adds an entry, indices from 1; refuses one in the other triangle, or twice in a row the same.
    #[inline(always)]
    pub fn push(&mut self, row: u32, col: u32, value: f64, line: usize) -> Result<(), Fault> {
        self.seen += 1;
        self.largest = self.largest.max(row).max(col);
        if row == col {
            self.diagonals += 1;
        } else {
            let (mine, other) = if row < col {
                (&mut self.first_upper, &self.first_lower)
            } else {
                (&mut self.first_lower, &self.first_upper)
            };
            if mine.is_none() {
                *mine = Some((row, col, line));
                if let Some((r, c, l)) = other {
                    return Err(Fault::line(
                        line,
                        format!(
                            "entry ({row}, {col}) and entry ({r}, {c}) on line {l} lie on both sides of the diagonal"
                        ),
                    )
                    .expected("one triangle of a symmetric matrix")
                    .cure("export one triangle, or a full matrix as MatrixMarket \"general\""));
                }
            }
        }
        if self.last == (row, col) {
            return Err(twice(Place::Line(line), row, col));
        }
        self.last = (row, col);
        if value != 0.0 || row == col {
            self.entries.push((row - 1, col - 1, value));
        }
        Ok(())
    }

    /// The smallest index from 1 to `largest` without a diagonal entry.
    pub fn missing_diagonal(&self, largest: u32) -> Option<u32> {
        let mut found: Vec<u32> = self.entries.iter().filter(|e| e.0 == e.1).map(|e| e.0 + 1).collect();
        found.sort_unstable();
        found.dedup();
        if found.len() as u64 == u64::from(largest) {
            return None;
        }
        Some(found.iter().zip(1..).find(|&(&d, k)| d != k).map_or(found.len() as u32 + 1, |(_, k)| k))
    }

    /// The matrix; refuses repeated entries.
    pub fn into_matrix(self, order: usize) -> Result<SymSparse, Fault> {
        let pushed = self.entries.len();
        let matrix = SymSparse::from_compact(order, &self.entries).map_err(|e| sparse_fault(&e))?;
        if matrix.stored() < pushed {
            let mut places: Vec<(u32, u32)> = self.entries.iter().map(|e| (e.0.max(e.1), e.0.min(e.1))).collect();
            places.sort_unstable();
            let (col, row) = places.windows(2).find(|w| w[0] == w[1]).map_or((0, 0), |w| w[0]);
            return Err(twice(Place::Entry(row + 1, col + 1), row + 1, col + 1));
        }
        Ok(matrix)
    }
}

fn twice(place: Place, row: u32, col: u32) -> Fault {
    Fault { place, ..Fault::new(format!("entry ({row}, {col}) stands twice")) }
        .expected("each entry once")
        .cure("was the file appended to an older one? export it again")
}

/// The same complaint about a matrix, told of a file.
pub(super) fn sparse_fault(error: &SparseError) -> Fault {
    Fault::new(error.to_string())
}
