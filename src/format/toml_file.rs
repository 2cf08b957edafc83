//! TOML files (recipes, scenes, summaries) with errors that carry file and line, and the nearest
//! known key for an unknown one.

use super::error::{Fault, FormatError};
use super::input::read_all;
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::path::Path;

/// Reads a TOML file into `T`; also returns its text, so that later errors about a
/// `toml::Spanned` value can be placed by [`toml_error_at`].
pub fn parse_toml<T: DeserializeOwned>(path: &Path) -> Result<(T, String), FormatError> {
    let (bytes, _) = read_all(path)?;
    let text = String::from_utf8(bytes).map_err(|e| {
        let good = e.utf8_error().valid_up_to();
        let line = 1 + e.as_bytes()[..good].iter().filter(|&&b| b == b'\n').count();
        Fault::line(line, "bytes that are no UTF-8 text").expected("a TOML file").cure("save it as UTF-8").in_file(path)
    })?;
    match toml::from_str(&text) {
        Ok(value) => Ok((value, text)),
        Err(error) => {
            let mut fault = explain(error.message());
            if let Some(span) = error.span() {
                fault.place = super::error::Place::Line(line_at(&text, span.start));
            }
            Err(fault.in_file(path))
        }
    }
}

/// An error about the part of a TOML file at a span (of bytes).
pub fn toml_error_at(path: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> FormatError {
    Fault::line(line_at(text, span.start), message).in_file(path)
}

/// The line (from 1) of a byte of a text.
fn line_at(text: &str, byte: usize) -> usize {
    1 + text.as_bytes()[..byte.min(text.len())].iter().filter(|&&b| b == b'\n').count()
}

/// The nearest of some known names, if one is near enough to be meant.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = found.to_lowercase();
    let likeness = |name: &str| strsim::jaro_winkler(&lower, &name.to_lowercase());
    // Below 0.7 the suggestion is more often wrong than right ("mass" ~ "modes" is 0.58).
    known.into_iter().map(|n| (likeness(n), n)).filter(|c| c.0 >= 0.7).max_by(|a, b| a.0.total_cmp(&b.0)).map(|c| c.1)
}

/// serde's message with the nearest key or variant where it lists the known ones.
fn explain(message: &str) -> Fault {
    let mut lines = message.lines();
    let first = lines.next().unwrap_or(message);
    let (found, expected) = first.split_once(", expected ").unwrap_or((first, ""));
    let unknown = found.strip_prefix("unknown field `").or_else(|| found.strip_prefix("unknown variant `"));
    let rest: Vec<&str> = lines.map(str::trim).filter(|l| !l.is_empty()).collect();
    let said = found.replacen("unknown field", "unknown key", 1).replacen("missing field", "missing key", 1);
    let mut fault = Fault::new(if rest.is_empty() { said } else { format!("{said}: {}", rest.join(", ")) });
    fault = fault.expected(expected);
    if let Some(unknown) = unknown {
        let known = expected.split('`').skip(1).step_by(2);
        if let Some(name) = nearest(unknown.trim_end_matches('`'), known) {
            fault = fault.cure(format!("did you mean `{name}`?"));
        }
    }
    fault
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_key_gets_the_nearest_known_one() {
        let fault = explain("unknown field `stifness`, expected one of `stiffness`, `mass`, `dofs`");
        assert_eq!(fault.found, "unknown key `stifness`");
        assert_eq!(fault.cure, "did you mean `stiffness`?");
        let far = explain("unknown field `colour`, expected `mass` or `dofs`");
        assert_eq!(far.cure, "");
    }
}
