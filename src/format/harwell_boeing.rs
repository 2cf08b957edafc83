//! Harwell-Boeing (.rsa, .rua) and Rutherford-Boeing (.rb) matrices, ANSYS HBMAT among them: real or
//! integer, assembled; symmetric, or unsymmetric when the values are symmetric.
//!
//! Source: I. Duff, R. Grimes, J. Lewis, "Users' guide for the Harwell-Boeing sparse matrix
//! collection", 1992; "The Rutherford-Boeing sparse matrix collection", 1997. Column pointers, rows
//! and values stand in the fixed columns that the header's Fortran formats give.

use super::error::{Fault, FormatError, Place, quote};
use super::input::Input;
use super::number::whole_real;
use super::triplets::Halves;
use crate::linalg::SymSparse;
use nom::Parser;
use nom::branch::alt;
use nom::character::complete::{char, one_of, space0, u32 as integer};
use nom::combinator::opt;
use nom::sequence::{delimited, preceded, terminated};
use std::path::Path;

type Text<'a> = nom::error::Error<&'a str>;

/// True for a file whose third line begins with a matrix type and whose fourth is a format.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let lines: Vec<&[u8]> = head.split(|&b| b == b'\n').take(4).collect();
    let &[_, _, kind, formats] = lines.as_slice() else { return false };
    let known = |k: usize, letters: &[u8]| kind.get(k).is_some_and(|b| letters.contains(&b.to_ascii_uppercase()));
    known(0, b"RCPIQX") && known(1, b"SUHZR") && known(2, b"AE") && formats.starts_with(b"(")
}

/// Reads an open file.
pub(super) fn read_matrix(path: &Path, input: Input, tell: &dyn Fn(usize)) -> Result<(SymSparse, String), FormatError> {
    let (bytes, hash) = input.all(path)?;
    let matrix = parse(&bytes).map_err(|fault| fault.in_file(path))?;
    tell(bytes.len());
    Ok((matrix, hash))
}

struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self, what: &str) -> Result<&'a [u8], Fault> {
        let rest = &self.bytes[self.at..];
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
            return Err(Fault::line(self.line + 1, format!("the file ends inside {what}"))
                .cure("it was probably cut short: copy or export it again"));
        };
        self.at += end + 1;
        self.line += 1;
        Ok(rest[..end].strip_suffix(b"\r").unwrap_or(&rest[..end]))
    }

    fn fault(&self, found: String) -> Fault {
        Fault::line(self.line, found)
    }
}

fn parse(bytes: &[u8]) -> Result<SymSparse, Fault> {
    let mut lines = Lines { bytes, at: 0, line: 0 };
    lines.next("the header")?;
    let counts = lines.next("the header")?;
    // The fifth count, of right-hand side lines, exists in Harwell-Boeing only.
    let right_hand_sides = field(counts, 56, 70).and_then(whole).unwrap_or(0);
    let line = lines.next("the header")?;
    let kind = String::from_utf8_lossy(&line[..3.min(line.len())]).to_ascii_uppercase();
    let refuse = |cure: &str| {
        Err(Fault::line(3, format!("matrix type {kind}"))
            .expected("RSA or RUA (real, symmetric or not, assembled)")
            .cure(cure))
    };
    let letters: Vec<char> = kind.chars().collect();
    let symmetric = match letters.as_slice() {
        ['R' | 'I', 'S', 'A'] => true,
        ['R' | 'I', 'U', 'A'] => false,
        ['P', ..] => return refuse("the file has no values: export them too"),
        ['C', ..] => return refuse("structural damping makes a matrix complex: export without it"),
        [_, 'R', _] => return refuse("a stiffness or mass matrix is square"),
        [_, 'Z', _] => return refuse("a stiffness or mass matrix is symmetric: is this a gyroscopic matrix?"),
        [.., 'E'] => return refuse("export the assembled matrix"),
        _ => return refuse("check the third line"),
    };
    let size = |k: usize| {
        let from = 14 * k;
        field(line, from, from + 14).and_then(whole).ok_or_else(|| {
            Fault::line(3, format!("found {}", quote(line))).expected("type, rows, columns, entries (14 columns each)")
        })
    };
    let (rows, cols, entries) = (size(1)?, size(2)?, size(3)?);
    if rows != cols || rows == 0 || rows > u64::from(u32::MAX) {
        return Err(Fault::line(3, format!("{rows} rows and {cols} columns")).expected("a square matrix"));
    }
    // A column pointer and a row number take a character at least.
    if rows.saturating_add(entries) > bytes.len() as u64 {
        return Err(Fault::line(3, format!("{rows} rows and {entries} entries in a file of {} bytes", bytes.len()))
            .expected("sizes the file can hold")
            .cure("it was probably cut short: copy or export it again"));
    }
    let (order, entries) = (rows as usize, entries as usize);
    let line = lines.next("the header")?;
    let format = |from: usize, to: usize| {
        let text = field(line, from, to).unwrap_or(b"");
        Layout::parse(text).ok_or_else(|| {
            Fault::line(4, format!("format {}", quote(text))).expected("a Fortran format such as (16I5) or (1P,5D16.9)")
        })
    };
    let (pointers, indices, values) = (format(0, 16)?, format(16, 32)?, format(32, 52)?);
    if right_hand_sides > 0 {
        lines.next("the header")?;
    }
    let start = integers(&mut lines, pointers, order + 1, "the column pointers")?;
    let ascending = start.windows(2).all(|w| w[0] <= w[1]) && start[0] == 1 && start[order] == entries as u64 + 1;
    if !ascending {
        return Err(lines
            .fault(format!("column pointers from {} to {}", start[0], start[order]))
            .expected(format!("ascending from 1 to {}", entries + 1)));
    }
    let rows = integers(&mut lines, indices, entries, "the row numbers")?;
    let mut halves = Halves::default();
    let mut column = 0;
    let mut k = 0;
    fields(&mut lines, values, entries, "the values", |text, line| {
        while start[column + 1] <= k as u64 + 1 {
            column += 1;
        }
        let (row, col) = (rows[k], column as u32 + 1);
        let row = u32::try_from(row).ok().filter(|&r| r > 0 && r as usize <= order);
        let row = row.ok_or_else(|| {
            Fault::line(line, format!("entry {} lies in row {}", k + 1, rows[k])).expected(format!("rows 1 to {order}"))
        })?;
        let value = values.value(text).ok_or_else(|| {
            Fault::line(line, format!("found {}", quote(text))).expected("a finite number with a decimal point")
        })?;
        k += 1;
        if symmetric { halves.upper.push(row, col, value, line) } else { halves.push(row, col, value, line) }
    })?;
    let matrix = if symmetric { halves.upper.into_matrix(order) } else { halves.into_symmetrised(order) };
    // Entries stand in three blocks: no line holds one.
    matrix.map_err(
        |fault| if matches!(fault.place, Place::Entry(..)) { Fault { place: Place::File, ..fault } } else { fault },
    )
}

fn field(line: &[u8], from: usize, to: usize) -> Option<&[u8]> {
    line.get(from..to.min(line.len())).map(<[u8]>::trim_ascii)
}

fn whole(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// A Fortran format of equal fields: `(16I5)`, `(4E20.12)`, `(1P,5D16.9)`, `(I14)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layout {
    per_line: usize,
    width: usize,
    /// The letter, in capitals.
    letter: char,
}

impl Layout {
    fn parse(text: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(text).ok()?;
        let number = || terminated(integer::<_, Text>, space0);
        let scale =
            terminated((opt(alt((char('-'), char('+')))), number(), one_of("pP"), space0), opt((char(','), space0)));
        let letter = terminated(one_of("iIeEdDfFgG"), space0);
        let decimals = preceded(char('.'), (number(), opt((one_of("eE"), number()))));
        let body = (opt(scale), opt(number()), letter, number(), opt(decimals));
        let (_, (scale, repeat, letter, width, _)) =
            delimited((char('('), space0), body, char(')')).parse(text).ok()?;
        let letter = letter.to_ascii_uppercase();
        // A scale moves the point of F fields on input; of no known file.
        if scale.is_some() && letter == 'F' {
            return None;
        }
        let layout = Self { per_line: repeat.unwrap_or(1) as usize, width: width as usize, letter };
        (1..=1000).contains(&layout.per_line).then_some(layout).filter(|l| (1..=100).contains(&l.width))
    }

    /// A value; blanks inside ("1.000000000E 00") count for nothing. Without a decimal point Fortran
    /// would place one by the format: such a field is refused rather than guessed, unless it is an integer's.
    fn value(self, text: &[u8]) -> Option<f64> {
        let tight: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
        whole_real(&tight).filter(|v| v.is_finite() && (self.letter == 'I' || tight.contains(&b'.')))
    }
}

/// Hands on so many fields of fixed width with their line.
fn fields<'a>(
    lines: &mut Lines<'a>,
    layout: Layout,
    count: usize,
    what: &str,
    mut take: impl FnMut(&'a [u8], usize) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let mut done = 0;
    while done < count {
        let line = lines.next(what)?;
        for k in 0..layout.per_line.min(count - done) {
            let text = field(line, layout.width * k, layout.width * (k + 1)).filter(|t| !t.is_empty());
            let text = text.ok_or_else(|| {
                lines.fault(format!("{k} fields of {what}")).expected(layout.per_line.min(count - done).to_string())
            })?;
            take(text, lines.line)?;
        }
        done += layout.per_line.min(count - done);
    }
    Ok(())
}

fn integers(lines: &mut Lines, layout: Layout, count: usize, what: &str) -> Result<Vec<u64>, Fault> {
    let mut values = Vec::with_capacity(count);
    fields(lines, layout, count, what, |text, line| {
        let value = whole(text);
        values.push(value.ok_or_else(|| Fault::line(line, format!("found {}", quote(text))).expected(what))?);
        Ok(())
    })?;
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fortran_formats_are_understood() {
        let cases: [(&str, usize, usize); 8] = [
            ("(16I5)", 16, 5),
            ("(1P,5D16.9)", 5, 16),
            ("(1P5D16.8)", 5, 16),
            ("(4E20.12)", 4, 20),
            ("(I14)", 1, 14),
            ("(d25.15)", 1, 25),
            ("( 1P , 3 E 26.16E3 )", 3, 26),
            ("(3D21.15)", 3, 21),
        ];
        for (text, per_line, width) in cases {
            let layout = Layout::parse(text.as_bytes()).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((layout.per_line, layout.width), (per_line, width), "{text}");
        }
        for text in ["", "16I5", "(16X5)", "(0I5)", "(5I0)", "(1P,4F20.12)", "(99999999999I5)"] {
            assert_eq!(Layout::parse(text.as_bytes()), None, "{text}");
        }
    }
}
