//! MatrixMarket coordinate files (.mtx): real or integer; symmetric, or general when the values are.
//!
//! Source of the format: R. Boisvert, R. Pozo, K. Remington, "The Matrix Market exchange formats",
//! NISTIR 5935, 1996. Blank lines between entries are accepted, as many files have them.

use super::error::{Fault, FormatError, Place, quote};
use super::input::Input;
use super::triplets::{Halves, each_record};
use crate::linalg::SymSparse;
use nom::Parser;
use nom::bytes::complete::tag_no_case;
use nom::character::complete::{alpha1, space0, space1, u64 as integer};
use nom::combinator::all_consuming;
use nom::sequence::{preceded, terminated};
use std::fmt::Write;
use std::path::Path;

type Text<'a> = nom::error::Error<&'a str>;

/// Stored entries can be fewer than rows (a mass on a few nodes), but a header that claims this many
/// rows per entry is not believed, so that it cannot make the reader allocate at will.
const ROWS_PER_ENTRY: u64 = 1000;

/// True for a file that begins with the banner.
pub(super) fn looks_like(head: &[u8]) -> bool {
    head.get(..14).is_some_and(|banner| banner.eq_ignore_ascii_case(b"%%MatrixMarket"))
}

#[derive(Clone, Copy, PartialEq)]
enum Symmetry {
    Symmetric,
    General,
}

#[derive(Clone, Copy)]
struct Header {
    symmetry: Symmetry,
    order: u64,
    count: u64,
    /// Its size line.
    line: usize,
}

/// Reads an open file.
pub(super) fn read_matrix(path: &Path, input: Input, tell: &dyn Fn(usize)) -> Result<(SymSparse, String), FormatError> {
    let size = input.size;
    let mut reader = Reader { header: None, symmetry: None, line: 0, halves: Halves::default() };
    let mut done = 0;
    let hash = input.each_chunk(path, |chunk| {
        done += chunk.len();
        tell(done);
        reader.take(chunk, size)
    })?;
    reader.finish().map(|matrix| (matrix, hash)).map_err(|fault| fault.in_file(path))
}

struct Reader {
    symmetry: Option<Symmetry>,
    header: Option<Header>,
    /// Lines read.
    line: usize,
    /// Of a symmetric file, whose triangle may be either, only `upper` is used.
    halves: Halves,
}

impl Reader {
    fn take(&mut self, mut chunk: &[u8], size: u64) -> Result<(), Fault> {
        while self.header.is_none() {
            if chunk.is_empty() {
                return Ok(());
            }
            let end = chunk.iter().position(|&b| b == b'\n').map_or(chunk.len(), |k| k + 1);
            self.line += 1;
            self.header_line(chunk[..end].trim_ascii(), size)?;
            chunk = &chunk[end..];
        }
        let Some(header) = &self.header else { return Ok(()) };
        let halves = &mut self.halves;
        each_record(chunk, &mut self.line, |row, col, value, line| {
            if u64::from(row.max(col)) > header.order {
                return Err(Fault::line(line, format!("entry ({row}, {col}) lies outside the matrix"))
                    .expected(format!("indices up to {} as line {} declares", header.order, header.line)));
            }
            if halves.seen() == header.count {
                return Err(Fault::line(line, format!("one more entry than the {} declared", header.count))
                    .expected("the end of the file")
                    .cure(format!("correct the count on line {}", header.line)));
            }
            match header.symmetry {
                Symmetry::General => halves.push(row, col, value, line),
                Symmetry::Symmetric => halves.upper.push(row, col, value, line),
            }
        })
    }

    fn header_line(&mut self, line: &[u8], size: u64) -> Result<(), Fault> {
        let at = self.line;
        let text = String::from_utf8_lossy(line);
        let Some(symmetry) = self.symmetry else {
            self.symmetry = Some(banner(&text).map_err(|fault| Fault { place: Place::Line(at), ..fault })?);
            return Ok(());
        };
        if line.is_empty() || line.starts_with(b"%") {
            return Ok(());
        }
        let mut sizes = (integer::<_, Text>, preceded(space1, integer), preceded(space1, integer));
        let (rows, cols, count) = all_consuming(|t| sizes.parse(t))
            .parse(&text)
            .map(|(_, sizes)| sizes)
            .map_err(|_| Fault::line(at, format!("found {}", quote(line))).expected("rows, columns and entries"))?;
        let wrong = |found: String| Fault::line(at, found);
        if rows != cols || rows == 0 {
            return Err(wrong(format!("{rows} rows and {cols} columns")).expected("a square matrix"));
        }
        if rows > u64::from(u32::MAX) {
            return Err(wrong(format!("{rows} rows")).expected(format!("at most {}", u32::MAX)));
        }
        let most = u128::from(rows) * u128::from(rows);
        if u128::from(count) > most {
            return Err(
                wrong(format!("{count} entries in a matrix of order {rows}")).expected(format!("at most {most}"))
            );
        }
        // An entry takes 6 characters ("1 1 1\n"), so the file bounds what is worth reserving.
        let room = count.min(size / 6) as usize;
        self.halves.upper.reserve(if symmetry == Symmetry::General { room / 2 } else { room });
        self.header = Some(Header { symmetry, order: rows, count, line: at });
        Ok(())
    }

    fn finish(self) -> Result<SymSparse, Fault> {
        if self.symmetry.is_none() {
            return Err(Fault::new("the file is empty").expected("a MatrixMarket file"));
        }
        let Some(header) = self.header else {
            return Err(Fault::line(self.line, "the file ends before its size line")
                .expected("rows, columns and entries")
                .cure("it was probably cut short: copy or export it again"));
        };
        let seen = self.halves.seen();
        if seen < header.count {
            return Err(Fault::line(self.line, format!("the file ends after {seen} entries"))
                .expected(format!("{} as line {} declares", header.count, header.line))
                .cure("it was probably cut short: copy or export it again"));
        }
        if header.order > ROWS_PER_ENTRY * (seen + ROWS_PER_ENTRY) {
            return Err(Fault::line(header.line, format!("{} rows but only {seen} entries", header.order))
                .expected("the matrix of an FE model")
                .cure("check the size line"));
        }
        let order = header.order as usize;
        match header.symmetry {
            Symmetry::Symmetric => self.halves.upper.into_matrix(order),
            Symmetry::General => self.halves.into_symmetrised(order),
        }
    }
}

/// The lower triangle as a MatrixMarket file; every number reads back to the same bits.
pub fn symmetric_to_matrix_market(matrix: &SymSparse) -> String {
    // A column of the stored upper triangle is a row of the lower one: rows ascending is as good an order.
    let mut text =
        format!("%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {1}\n", matrix.order(), matrix.stored());
    for j in 0..matrix.order() {
        for (i, value) in matrix.column(j) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{} {} {value:e}", j + 1, i + 1);
        }
    }
    text
}

/// The first line: what the file says it holds.
fn banner(line: &str) -> Result<Symmetry, Fault> {
    let word = |text| preceded(space1::<_, Text>, alpha1).parse(text);
    let mut words = terminated(
        (
            preceded(tag_no_case("%%MatrixMarket"), word),
            word,
            word,
            preceded(space1, nom::bytes::complete::take_while1(|c: char| c.is_alphabetic() || c == '-')),
        ),
        space0,
    );
    let expected = "\"%%MatrixMarket matrix coordinate real symmetric\"";
    let (_, (object, format, field, symmetry)) = all_consuming(|t| words.parse(t))
        .parse(line)
        .map_err(|_| Fault::new(format!("found {}", quote(line.as_bytes()))).expected(expected))?;
    let lower = |word: &str| word.to_ascii_lowercase();
    let refuse = |word: &str, cure: &str| {
        Err(Fault::new(format!("a MatrixMarket file that says `{word}`")).expected(expected).cure(cure))
    };
    if lower(object) != "matrix" {
        return refuse(object, "check the first line");
    }
    match lower(format).as_str() {
        "coordinate" => {}
        "array" => return refuse(format, "write the matrix in sparse (coordinate) form"),
        _ => return refuse(format, "check the first line"),
    }
    match lower(field).as_str() {
        "real" | "integer" | "double" => {}
        "complex" => return refuse(field, "structural damping makes a matrix complex: export without it"),
        "pattern" => return refuse(field, "the file has no values: export them too"),
        _ => return refuse(field, "check the first line"),
    }
    match lower(symmetry).as_str() {
        "symmetric" => Ok(Symmetry::Symmetric),
        "general" => Ok(Symmetry::General),
        "skew-symmetric" => refuse(symmetry, "a stiffness or mass matrix is symmetric: is this a gyroscopic matrix?"),
        _ => refuse(symmetry, "check the first line"),
    }
}
