//! The command line: one verb, one file.

mod check;
mod inspect;
mod list;
mod matrices;
mod modes;
mod output;
mod progress;
mod rank;
mod reduce;
mod run;
mod simulate;

use crate::pipeline::PipelineError;
use clap::{Parser, Subcommand};
use output::Outcome;
use std::process::ExitCode;

/// Exit code of a failed check.
const CHECK_FAILED: u8 = 5;

#[derive(Debug, Parser)]
#[command(
    name = "ferrom",
    version,
    about = "From finite-element export to reduced model to drop test",
    after_help = "Exit codes: 0 ok, 2 usage, 3 input, 4 numerics, 5 a check failed.\n\nExample: ferrom run models/leaf-spring"
)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
    /// Print one JSON object on stdout and nothing else there
    #[arg(long, global = true)]
    json: bool,
    /// Threads for the parallel parts (default: all cores)
    #[arg(long, global = true, value_name = "N")]
    threads: Option<usize>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// The whole pipeline of a project folder: reduce, check, every scene, report
    Run(run::Arguments),
    /// What an export holds, and what looks suspicious
    Inspect(inspect::Arguments),
    /// Modal analysis
    Modes(modes::Arguments),
    /// Rank the modes by a transfer function
    Rank(rank::Arguments),
    /// Write the reduced model
    Reduce(reduce::Arguments),
    /// Compare selection, frequencies and shapes with what is committed or named (for CI)
    Check(check::Arguments),
    /// Run one scene
    Simulate(simulate::Arguments),
    /// Formats, criteria, rules, methods, effects, integrators
    List(list::Arguments),
}

/// Runs the command line; the exit code says how it went.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(threads) = arguments.threads {
        if threads == 0 {
            output::complain("--threads 0: expected at least one thread");
            return ExitCode::from(2);
        }
        // Fails only when the pool exists already, and nothing has used it yet.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    }
    let progress = progress::Terminal::new();
    let result: Result<Outcome, PipelineError> = match &arguments.verb {
        Verb::Run(a) => run::run(a, &progress),
        Verb::Inspect(a) => inspect::run(a, &progress),
        Verb::Modes(a) => modes::run(a, &progress),
        Verb::Rank(a) => rank::run(a, &progress),
        Verb::Reduce(a) => reduce::run(a, &progress),
        Verb::Check(a) => check::run(a, &progress),
        Verb::Simulate(a) => simulate::run(a, &progress),
        Verb::List(a) => list::run(a),
    };
    progress.clear();
    match result {
        Ok(outcome) => outcome.print(arguments.json),
        Err(error) => {
            output::complain(&error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}
