//! Progress on stderr when it is a terminal; silent otherwise.

use crate::model::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Where the end is known.
const BAR: &str = "{spinner} {msg:20} {bar:40} {pos}/{len}  {elapsed}";

/// Where it is not.
const COUNT: &str = "{spinner} {msg:20} {pos}  {elapsed}";

/// A line on the terminal that says what is being done.
#[derive(Debug)]
pub(super) struct Terminal {
    bar: Option<ProgressBar>,
}

impl Terminal {
    pub(super) fn new() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self { bar: None };
        }
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template(COUNT) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Self { bar: Some(bar) }
    }

    /// Removes the line.
    pub(super) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Terminal {
    fn report(&self, stage: &str, done: usize, total: usize) {
        if let Some(bar) = &self.bar {
            let known = total > 0;
            if bar.message() != stage || known != (bar.length() > Some(0)) {
                if let Ok(style) = ProgressStyle::with_template(if known { BAR } else { COUNT }) {
                    bar.set_style(style);
                }
                bar.set_message(stage.to_string());
            }
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        }
    }
}
