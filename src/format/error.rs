//! What is wrong with a file: where, what was found, what was expected, the cure.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A byte offset, counted from 0 (binary files).
    Byte(u64),
    /// A matrix entry (row, column), counted from 1, whose line is not known.
    Entry(u32, u32),
}

/// What is wrong inside a file whose path the parser does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where.
    pub place: Place,
    /// What stands there.
    pub found: String,
    /// What should stand there; may be empty.
    pub expected: String,
    /// What to do about it; may be empty.
    pub cure: String,
}

impl Fault {
    /// Something wrong with the file as a whole.
    pub fn new(found: impl Into<String>) -> Self {
        Self { place: Place::File, found: found.into(), expected: String::new(), cure: String::new() }
    }

    /// Something wrong on a line (from 1).
    pub fn line(line: usize, found: impl Into<String>) -> Self {
        Self { place: Place::Line(line), ..Self::new(found) }
    }

    /// Adds what was expected.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = expected.into();
        self
    }

    /// Adds what to do.
    #[must_use]
    pub fn cure(mut self, cure: impl Into<String>) -> Self {
        self.cure = cure.into();
        self
    }

    /// The same with the file it is about.
    pub fn in_file(self, path: &Path) -> FormatError {
        FormatError::Content { path: path.to_path_buf(), fault: Box::new(self) }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Place::File => write!(f, " ")?,
            Place::Line(line) => write!(f, "{line}: ")?,
            Place::Byte(byte) => write!(f, " byte {byte}: ")?,
            Place::Entry(row, col) => write!(f, " entry ({row}, {col}): ")?,
        }
        f.write_str(&self.found)?;
        if !self.expected.is_empty() {
            write!(f, "; expected {}", self.expected)?;
        }
        if !self.cure.is_empty() {
            write!(f, "; {}", self.cure)?;
        }
        Ok(())
    }
}

/// Why a file cannot be read or written. Every text is "path:line: found; expected …; cure".
#[derive(Debug, Error)]
pub enum FormatError {
    /// The operating system refused.
    #[error("{}: cannot be {action}: {source}; {cure}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// "read" or "written".
        action: &'static str,
        /// What to do.
        cure: &'static str,
        /// The system's reason.
        source: io::Error,
    },
    /// The content is not what it should be.
    #[error("{}:{fault}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where and what.
        fault: Box<Fault>,
    },
}

impl FormatError {
    pub(super) fn reading(path: &Path, source: io::Error) -> Self {
        let cure = match source.kind() {
            io::ErrorKind::NotFound => "check the path (paths in a model.toml or scene are relative to that file)",
            io::ErrorKind::PermissionDenied => "check who may read it",
            _ => "check that it is a readable file",
        };
        Self::Io { path: path.to_path_buf(), action: "read", cure, source }
    }

    pub(super) fn writing(path: &Path, source: io::Error) -> Self {
        let cure = "check the folder, its permissions and the free space";
        Self::Io { path: path.to_path_buf(), action: "written", cure, source }
    }

    /// The line (from 1) the error is about, where there is one.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::Content { fault, .. } => match fault.place {
                Place::Line(line) => Some(line),
                _ => None,
            },
            Self::Io { .. } => None,
        }
    }

    /// The file the error is about.
    pub fn path(&self) -> &Path {
        match self {
            Self::Io { path, .. } | Self::Content { path, .. } => path,
        }
    }
}

/// The start of a line or word, fit to be quoted in a message.
pub(super) fn quote(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes.trim_ascii());
    let mut short: String = text.chars().take(40).map(|c| if c.is_control() { '·' } else { c }).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    format!("`{short}`")
}
