//! `halfgap sweep`: runs a scene many times, with one of its numbers varied.
//!
//! Runs share nothing, so they go to all cores at once, and each gives the same bits as alone. A value from which no
//! world can be built, say because bodies overlap, is reported as a refused run; the other runs are not affected. Each
//! run is written as soon as it is over and those before it are (`rows`).

use crate::args::SweepOptions;
use crate::failure::{End, Failure};
use crate::interrupt::Interrupt;
use crate::numbers::{change, given};
use crate::output;
use crate::progress::{Progress, Shown, Way};
use crate::rows::{QUANTITIES, Rows};
use halfgap::scene::{Scene, SceneError, VariedScene};
use halfgap::{Outcome, Reached, Record, RunPlan, RunResult, World, run};
use rayon::ThreadPoolBuilder;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Status of a value from which no world can be built.
const REFUSED: &str = "refused";

/// One run of the sweep.
#[derive(Debug, Serialize)]
struct SweepRun {
    value: f64,
    /// Result of the run, unless it was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    result: Option<RunResult>,
    /// Message of the error that stopped the run early or refused it.
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
    let source = options.scene.source()?;
    let varied = VariedScene::new(source.clone(), &options.vary.field)?;
    let values = options.vary.values();
    // All scenes are read before the first runs, so that a value out of range is found at once.
    let scenes = values.iter().map(|&value| varied.with(value));
    let kinds = scenes.map(|scene| scene.map(Kind::of)).collect::<Result<BTreeSet<_>, _>>()?;
    let Kind { title, bodies } = kinds.into_iter().next().unwrap_or_default();
    let interrupt = Interrupt::listen();
    let field = varied.field().to_string();
    // The file is made before the runs, which a bad path would lose.
    let rows = options.out.as_ref().map(|path| Rows::create(path, &field, &bodies)).transpose()?;
    let rows = rows.map(Mutex::new);
    let way = Way::Runs { count: values.len() };
    let mut progress = Progress::new(Shown::of(options.quiet, options.json), &title, way);
    let runs = run_all(
        &values,
        options,
        (&progress, &interrupt),
        |value| run_scene(value, &varied, &interrupt),
        |index, run| {
            if let Some(rows) = &rows {
                rows.lock().unwrap_or_else(PoisonError::into_inner).add(index, row(run, bodies.len()));
            }
        },
    )?;
    progress.finish();
    let sweep = Sweep { format: "halfgap-sweep-1", field, runs };
    // A failure to write is reported last, so that the results are not lost with it.
    let written =
        rows.map_or(Ok(()), |rows| rows.into_inner().unwrap_or_else(PoisonError::into_inner).finish());
    tell_on_stderr(&sweep, &options.scene.scene, values.len());
    if options.json {
        let json = serde_json::to_string(&sweep).expect("a sweep is strings and numbers only");
        output::print(&format!("{json}\n"))?;
    } else if !options.quiet {
        output::print(&lines(&sweep))?;
    }
    written?;
    Ok(sweep.end(values.len()))
}

/// What all scenes of a sweep have in common.
#[derive(Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    title: String,
    /// Names of the movable bodies.
    bodies: Vec<String>,
}

impl Kind {
    fn of(scene: Scene) -> Self {
        let movable = scene.bodies.into_iter().filter(|body| !body.fixed);
        Self { title: scene.title, bodies: movable.map(|body| body.name).collect() }
    }
}

/// Runs all values, except those left after an interruption, and tells of each run as soon as it is over. Values are
/// taken up in their order, so that of the first ones all are over soon.
fn run_all(
    values: &[f64],
    options: &SweepOptions,
    (progress, interrupt): (&Progress, &Interrupt),
    run_one: impl Fn(f64) -> SweepRun + Sync,
    is_over: impl Fn(usize, &SweepRun) + Sync,
) -> Result<Vec<SweepRun>, Failure> {
    // 0 stands for one thread for each core; more threads than runs would only wait.
    let threads = options.threads.map_or(0, |threads| threads.get().min(values.len()));
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().map_err(Failure::Threads)?;
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let of_threads = pool.broadcast(|_| {
        let mut runs = Vec::new();
        while interrupt.flow().is_continue() {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(&value) = values.get(index) else { break };
            let run = run_one(value);
            is_over(index, &run);
            runs.push((index, run));
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            let fraction = count as f64 / values.len() as f64;
            progress.set(&Reached { fraction, ..Reached::default() });
        }
        runs
    });
    let mut runs: Vec<_> = of_threads.into_iter().flatten().collect();
    runs.sort_unstable_by_key(|&(index, _)| index);
    Ok(runs.into_iter().map(|(_, run)| run).collect())
}

fn run_scene(value: f64, varied: &VariedScene, interrupt: &Interrupt) -> SweepRun {
    let outcome = || -> Result<SweepRun, SceneError> {
        let scene = varied.with(value)?;
        let mut world = World::from_scene(&scene)?;
        let report = run(&mut world, &RunPlan::of_scene(&scene, Record::Ends), &mut |_| interrupt.flow());
        let result = Some(RunResult::new(&world, &report));
        let error = report.error.map(|error| error.to_string());
        Ok(SweepRun { value, result, error, warnings: world.warnings().to_vec() })
    };
    outcome().unwrap_or_else(|error| SweepRun {
        value,
        result: None,
        error: Some(error.to_string()),
        warnings: Vec::new(),
    })
}

impl Sweep {
    /// Returns the end of a sweep of `values` values.
    fn end(&self, values: usize) -> End {
        let is_done = |run: &SweepRun| run.status() == Outcome::Done.name();
        if self.runs.iter().any(|run| run.result.is_none()) {
            End::BadInput
        } else if self.runs.len() == values && self.runs.iter().all(is_done) {
            End::Done
        } else {
            End::Stopped
        }
    }
}

impl SweepRun {
    fn status(&self) -> &'static str {
        self.result.as_ref().map_or(REFUSED, |result| result.status.name())
    }
}

/// Writes to standard error: each warning at the first run that has it, findings and errors with the value of their
/// run, and the number of runs made before an interruption.
fn tell_on_stderr(sweep: &Sweep, scene: &Path, values: usize) {
    let mut told = BTreeSet::new();
    for SweepRun { value, result, error, warnings } in &sweep.runs {
        let at = format!("{} with {} = {}", scene.display(), sweep.field, given(*value));
        for warning in warnings.iter().filter(|warning| told.insert(warning.as_str())) {
            output::tell(&format!("warning: {at}: {warning}"));
        }
        for finding in result.iter().flat_map(|result| &result.findings) {
            output::tell(&format!("warning: {at}: {finding}"));
        }
        match (result, error) {
            (Some(_), Some(error)) => output::tell(&format!("error: {at}: stopped early: {error}")),
            (None, Some(error)) => output::tell(&format!("error: {at}: {error}")),
            (_, None) => {}
        }
    }
    let broken_off = |run: &&SweepRun| run.status() == Outcome::Interrupted.name();
    let whole = sweep.runs.len() - sweep.runs.iter().filter(broken_off).count();
    if whole < values {
        output::tell(&format!("error: interrupted: {whole} of {values} runs were made"));
    }
}

/// Returns the table: a line for each run.
fn lines(sweep: &Sweep) -> String {
    let heads = ["status", "time [s]", "energy change [J]", "impacts", "steps"];
    let mut text = format!("{:>20}", sweep.field);
    heads.iter().for_each(|head| text.push_str(&format!(" {head:>18}")));
    text.push('\n');
    for run in &sweep.runs {
        let _ = write!(text, "{:>20} {:>18}", given(run.value), run.status());
        if let Some(result) = &run.result {
            let statistics = &result.statistics.world;
            let _ = write!(
                text,
                " {:>18} {:>18} {:>18} {:>18}",
                given(result.time),
                change(result.energy.total - result.energy.start, result.scales.energy),
                statistics.impacts,
                statistics.steps
            );
        }
        text.push('\n');
    }
    text
}

/// Returns the row of a run, in digits that read back as the same bits and without wall times: equal sweeps write equal
/// files. A refused run has its value and status only; its other fields are empty.
fn row(run: &SweepRun, bodies: usize) -> String {
    let mut text = format!("{:?},{}", run.value, run.status());
    match &run.result {
        Some(result) => write_result(&mut text, result),
        None => text.push_str(&",".repeat(5 + QUANTITIES.len() * bodies)),
    }
    text.push('\n');
    text
}

fn write_result(text: &mut String, result: &RunResult) {
    let (energy, statistics) = (&result.energy, &result.statistics.world);
    let (impacts, steps) = (statistics.impacts, statistics.steps);
    let _ = write!(text, ",{:?},{:?},{:?},{impacts},{steps}", result.time, energy.start, energy.total);
    for (_, state) in &result.bodies {
        let (place, speed) = (state.position, state.velocity);
        for number in [place.x, place.y, state.angle, speed.x, speed.y, state.angular_velocity] {
            let _ = write!(text, ",{number:?}");
        }
    }
}
