//! The halfgap command.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod solve;

/// Simulates flat rigid bodies with straight and circular edges.
#[derive(Debug, Parser)]
#[command(name = "halfgap", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Solves one contact problem from a file and explains the answer.
    Solve(solve::SolveArgs),
}

fn main() -> ExitCode {
    match Cli::parse().command {
        Command::Solve(args) => solve::run(&args),
    }
}
