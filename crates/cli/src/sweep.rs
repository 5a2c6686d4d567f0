//! `halfgap sweep`: runs a scene many times, one of its numbers varied.
//!
//! Runs share nothing, so they go to all cores at once, and each gives the bits that it gives alone.

use crate::args::SweepOptions;
use crate::failure::{End, Failure};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::{output, table};
use halfgap::scene::{Scene, SceneError, SceneSource, VariedScene};
use halfgap::{Outcome, Record, RunPlan, RunResult, World, run};
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// One run of the sweep.
#[derive(Debug, Serialize)]
struct SweepRun {
    value: f64,
    result: RunResult,
    /// Why it stopped early, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip)]
    warnings: Vec<String>,
}

/// All runs, in the order of their values.
#[derive(Debug, Serialize)]
struct Sweep {
    format: &'static str,
    field: String,
    runs: Vec<SweepRun>,
}

pub(crate) fn sweep(options: &SweepOptions) -> Result<End, Failure> {
    let source = SceneSource::read(&options.scene)?;
    let varied = VariedScene::new(source.clone(), &options.vary.field)?;
    // All are read before one runs: a value out of range is found at once.
    let values = options.vary.values();
    let scenes = values.iter().map(|&value| Ok((value, varied.with(value)?)));
    let scenes = scenes.collect::<Result<Vec<_>, SceneError>>()?;
    let title = scenes.first().map_or(String::new(), |(_, scene)| scene.title.clone());
    let progress = Progress::new(!options.quiet && !options.json, &title);
    let runs = run_all(&scenes, &source, options, &progress)?;
    progress.finish();
    let sweep = Sweep { format: "halfgap-sweep-1", field: varied.field().to_string(), runs };
    tell_on_stderr(&sweep, &options.scene);
    if let Some(file) = &options.out {
        std::fs::write(file, csv(&sweep)).map_err(|error| Failure::Write(file.clone(), error))?;
    }
    if options.json {
        let json = serde_json::to_string(&sweep).expect("a sweep is strings and numbers only");
        output::print(&format!("{json}\n"))?;
    } else if !options.quiet {
        output::print(&lines(&sweep))?;
    }
    let stopped = sweep.runs.iter().any(|run| run.result.status != Outcome::Done);
    Ok(if stopped { End::Stopped } else { End::Done })
}

fn run_all(
    scenes: &[(f64, Scene)],
    source: &SceneSource,
    options: &SweepOptions,
    progress: &Progress,
) -> Result<Vec<SweepRun>, Failure> {
    let threads = options.threads.map_or(0, usize::from);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(Failure::Threads)?;
    let done = AtomicUsize::new(0);
    let interrupt = Interrupt::listen();
    let run_one = |(value, scene): &(f64, Scene)| {
        let run = run_scene(*value, scene, &interrupt).map_err(|error| source.locate(error))?;
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.set(count as f64 / scenes.len() as f64);
        Ok(run)
    };
    let runs: Result<Vec<_>, SceneError> = pool.install(|| scenes.par_iter().map(run_one).collect());
    Ok(runs?)
}

fn run_scene(value: f64, scene: &Scene, interrupt: &Interrupt) -> Result<SweepRun, SceneError> {
    let mut world = World::from_scene(scene)?;
    let report = run(&mut world, &RunPlan::of_scene(scene, Record::Ends), &mut |_| interrupt.flow());
    let result = RunResult::new(&world, &report);
    let error = report.error.map(|error| error.to_string());
    Ok(SweepRun { value, result, error, warnings: world.warnings().to_vec() })
}

/// Warnings, each where it comes first, and why runs stopped early, with the value of the run.
fn tell_on_stderr(sweep: &Sweep, scene: &Path) {
    let mut told = BTreeSet::new();
    for SweepRun { value, result, error, warnings } in &sweep.runs {
        let at = format!("{} with {} = {}", scene.display(), sweep.field, table::number(*value));
        for warning in warnings.iter().filter(|warning| told.insert(warning.as_str())) {
            eprintln!("warning: {at}: {warning}");
        }
        for finding in &result.findings {
            eprintln!("warning: {at}: {finding}");
        }
        if let Some(error) = error {
            eprintln!("error: {at}: stopped early at t = {} s: {error}", result.time);
        }
    }
}

/// What a person wants to see of each run.
fn lines(sweep: &Sweep) -> String {
    let heads = ["status", "time [s]", "energy change [J]", "impacts", "steps"];
    let mut text = format!("{:>20}", sweep.field);
    heads.iter().for_each(|head| text.push_str(&format!(" {head:>18}")));
    text.push('\n');
    for SweepRun { value, result, .. } in &sweep.runs {
        let statistics = &result.statistics.world;
        let _ = writeln!(
            text,
            "{:>20} {:>18} {:>18} {:>18.9e} {:>18} {:>18}",
            table::number(*value),
            result.status.name(),
            table::number(result.time),
            result.energy.total - result.energy.start,
            statistics.impacts,
            statistics.steps
        );
    }
    text
}

/// Everything but the wall time, in digits that read back as the same bits: equal sweeps write equal files.
fn csv(sweep: &Sweep) -> String {
    let mut text = format!("{},status,time,energy_start,energy_end,impacts,steps", quoted(&sweep.field));
    let bodies = sweep.runs.first().map_or(&[][..], |run| &run.result.bodies);
    for (name, _) in bodies {
        for quantity in ["x", "y", "angle", "vx", "vy", "w"] {
            let _ = write!(text, ",{}", quoted(&format!("{name}.{quantity}")));
        }
    }
    text.push('\n');
    for SweepRun { value, result, .. } in &sweep.runs {
        let (energy, statistics) = (&result.energy, &result.statistics.world);
        let _ = write!(
            text,
            "{value:?},{},{:?},{:?},{:?},{},{}",
            result.status.name(),
            result.time,
            energy.start,
            energy.total,
            statistics.impacts,
            statistics.steps
        );
        for (_, state) in &result.bodies {
            let (place, speed) = (state.position, state.velocity);
            for number in [place.x, place.y, state.angle, speed.x, speed.y, state.angular_velocity] {
                let _ = write!(text, ",{number:?}");
            }
        }
        text.push('\n');
    }
    text
}

/// A field of CSV, in quotes where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
