//! The command line.

use crate::solve::SolveArgs;
use crate::source::SceneArgs;
use crate::vary::Vary;
use clap::{Parser, Subcommand};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Exact, fast 2D rigid-body mechanics.
///
/// Exit codes: 0 done; 1 a check failed; 2 the input is wrong; 3 the simulation stopped early, with the recording up to
/// then written.
#[derive(Debug, Parser)]
#[command(name = "halfgap", version)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scene, report its final state, and record it if asked to.
    Run(RunOptions),
    /// Run scenes that have expected states, and compare.
    Check(CheckOptions),
    /// Run a scene many times, with one of its numbers varied, on all cores.
    Sweep(SweepOptions),
    /// Solve one contact problem from a file and explain the answer.
    Solve(SolveArgs),
}

#[derive(Debug, clap::Args)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Write the recording (CSV and JSON) and pictures (SVG) to this folder, also when Ctrl-C stops the run.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also write N pictures, evenly spaced in time, to that folder.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "out")]
    pub(crate) pictures: usize,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Relative accuracy, instead of the scene's.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,
    /// Duration in seconds, instead of the scene's.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,
    /// Run the scene N times: the wall time told is the least of them, beside the median (of an even number the mean of
    /// the two in the middle). All must give the same bits, else the exit code is 1. Recorded is the first.
    #[arg(long, value_name = "N")]
    pub(crate) repeat: Option<NonZeroUsize>,
    /// Run the scene again at a tighter tolerance, and print the differences.
    #[arg(long)]
    pub(crate) estimate_error: bool,
    /// Print no progress bar and no table, only the error estimate if asked for.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct CheckOptions {
    /// The scenes, .toml or .json files, or - for standard input.
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Print a JSON array instead of lines.
    #[arg(long)]
    pub(crate) json: bool,
    /// Relative accuracy, instead of the scenes'.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,
}

#[derive(Debug, clap::Args)]
pub(crate) struct SweepOptions {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The number to vary and its values: N of them from A to B, ends included, evenly spaced, or with equal ratios if
    /// /log follows. FIELD is the path of a number in the scene, such as body.ball.elasticity, body[0].position[1],
    /// run.tolerance, or let.r for what `[let]` names.
    #[arg(long, value_name = "FIELD=A..B/N[/log]", allow_hyphen_values = true)]
    pub(crate) vary: Vary,
    /// Write the table, with the final states, to this CSV file.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object with all results instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of runs at a time; by default one for each core.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Print no progress bar and no table.
    #[arg(long)]
    pub(crate) quiet: bool,
}
