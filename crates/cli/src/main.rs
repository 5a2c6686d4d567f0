//! The `halfgap` command: runs, varies and checks scene files, and solves contact problems.
//!
//! `args` declares the command line; `source` reads the scene of a command; each subcommand is a module of its own (`run` with `files` and `repeat`, `check`,
//! `sweep` with `vary` and `rows`, `solve`), `failure` makes messages and exit codes, `table` the tables and `numbers`
//! what stands in them, `output` writes to standard output and standard error, `progress` shows the progress bar,
//! `interrupt` handles Ctrl-C and SIGTERM.

#![warn(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "print macros panic where nothing can be written; `output` does not"
)]

mod args;
mod check;
mod failure;
mod files;
mod interrupt;
mod numbers;
mod output;
mod progress;
mod repeat;
mod rows;
mod run;
mod solve;
mod source;
mod sweep;
mod table;
mod vary;

use args::{Args, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let end = match Args::parse().command {
        Command::Run(options) => run::run(&options),
        Command::Check(options) => check::check(&options),
        Command::Sweep(options) => sweep::sweep(&options),
        Command::Solve(options) => solve::run(&options),
    };
    match end {
        Ok(end) => end.into(),
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.exit_code())
        }
    }
}
