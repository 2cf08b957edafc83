//! What a verb prints: text for people or one JSON object, and the exit code.

use serde_json::Value;
use std::io::Write;
use std::process::ExitCode;

/// The result of a verb.
#[derive(Debug)]
pub(super) struct Outcome {
    /// For `--json`.
    pub(super) json: Value,
    /// For people.
    pub(super) text: String,
    /// Warnings, on stderr in either case.
    pub(super) warnings: Vec<String>,
    /// 0, or 5 when a check failed.
    pub(super) code: u8,
}

impl Outcome {
    /// Success.
    pub(super) fn new(json: Value, text: String) -> Self {
        Self { json, text, warnings: Vec::new(), code: 0 }
    }

    /// Adds warnings.
    pub(super) fn warn(mut self, warnings: impl IntoIterator<Item = String>) -> Self {
        self.warnings.extend(warnings);
        self
    }

    /// Prints and gives the exit code. A closed pipe (`| head`) is no error.
    pub(super) fn print(self, json: bool) -> ExitCode {
        let text = if json { format!("{:#}\n", self.json) } else { self.text };
        let mut out = std::io::stdout().lock();
        let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        for warning in &self.warnings {
            note("warning", warning);
        }
        match written {
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                complain(&format!("cannot write to stdout: {error}"));
                ExitCode::from(3)
            }
            _ => ExitCode::from(self.code),
        }
    }
}

/// One line on stderr: "kind: message". A closed stderr is nobody's concern.
fn note(kind: &str, message: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{kind}: {message}");
}

/// An error on stderr.
pub(super) fn complain(message: &str) {
    note("error", message);
}
