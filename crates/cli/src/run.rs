//! `halfgap run`: runs a scene, reports its final state, and writes its recording.

use crate::args::RunOptions;
use crate::failure::{End, Failure};
use crate::interrupt::Interrupt;
use crate::progress::{Progress, Shown, Way};
use crate::repeat::Repeats;
use crate::{files, output, table};
use halfgap::{Outcome, Probe, Reached, Record, RunPlan, RunResult, World, estimate_error, run as run_world};
use std::num::NonZeroUsize;
use std::path::Path;

pub(crate) fn run(options: &RunOptions) -> Result<End, Failure> {
    let source = options.scene.source()?;
    let mut scene = source.parse()?;
    if let Some(tolerance) = options.tolerance {
        scene.set_tolerance(tolerance, "--tolerance")?;
    }
    if let Some(duration) = options.duration {
        scene.set_duration(duration, "--duration")?;
    }
    let everything = options.out.is_some() || options.estimate_error;
    if everything {
        scene.check_recording().map_err(|error| source.locate(error))?;
    }
    let mut world = World::from_scene(&scene).map_err(|error| source.locate(error))?;
    for warning in world.warnings() {
        output::tell(&format!("warning: {}: {warning}", options.scene.scene.display()));
    }
    let probes = Probe::of_scene(&scene, &world).map_err(|error| source.locate(error))?;
    let interrupt = Interrupt::listen();
    if let Some(folder) = &options.out {
        files::prepare(folder)?;
    }
    let record = if everything { Record::Everything } else { Record::Ends };
    let plan = RunPlan::of_scene(&scene, record);
    let way = Way::Run { end: scene.run.end_time() };
    let mut progress = Progress::new(Shown::of(options.quiet, options.json), &scene.title, way);
    let mut follow = |reached: &Reached| {
        progress.set(reached);
        interrupt.flow()
    };
    let report = run_world(&mut world, &plan, &mut follow);
    let mut result = RunResult::new(&world, &report);
    let repeats = match options.repeat {
        Some(count) if result.status != Outcome::Interrupted => {
            let again = || -> Result<RunResult, Failure> {
                let mut world = World::from_scene(&scene).map_err(|error| source.locate(error))?;
                let report = run_world(&mut world, &plan, &mut follow);
                Ok(RunResult::new(&world, &report))
            };
            Some(Repeats::make(&mut result, count, again)?)
        }
        _ => None,
    };
    if options.estimate_error && result.status != Outcome::Interrupted {
        let estimate = estimate_error(&scene, &plan, &world, &report, &mut follow);
        result.error_estimate = Some(estimate.map_err(|error| source.locate(error))?);
    }
    progress.finish();
    // A failure to write is reported last, so that the results are not lost with it.
    let written = options.out.as_ref().map_or(Ok(()), |folder| {
        files::write_all(folder, &world, &report.recording, &result, (&probes, options.pictures))
    });
    let problem =
        options.out.as_ref().map_or(Ok(false), |folder| files::write_problem(folder, report.error.as_ref()));
    let printed = match (options.json, options.quiet) {
        (true, _) => output::print(&format!("{}\n", result.to_json())),
        (false, false) => {
            output::print(&table::of_result(&result, repeats.as_ref().map_or(1, |made| made.count)))
        }
        (false, true) => output::print(&table::of_estimate(&result)),
    };
    for finding in &report.findings {
        output::tell(&format!("warning: {}: {finding}", options.scene.scene.display()));
    }
    if let Some(error) = &report.error {
        output::tell(&format!("error: {}: stopped early: {error}", options.scene.scene.display()));
    }
    if let (Ok(true), Some(folder)) = (&problem, &options.out) {
        let path = folder.join(files::PROBLEM);
        output::tell(&format!(
            "note: `halfgap solve {}` explains the contact problem that has no answer",
            path.display()
        ));
    }
    let repeated = repeats
        .zip(options.repeat)
        .map_or(End::Done, |(made, wanted)| tell_repeats(&made, wanted, &options.scene.scene));
    written?;
    problem?;
    printed?;
    Ok(if report.error.is_none() { repeated } else { End::Stopped })
}

/// Tells of repetitions that were not made or that differ, and returns the end of the command for them.
fn tell_repeats(made: &Repeats, wanted: NonZeroUsize, scene: &Path) -> End {
    let scene = scene.display();
    if let Some(number) = made.differs {
        output::tell(&format!(
            "error: {scene}: run {number} of {wanted} differs from the first in its result"
        ));
        return End::CheckFailed;
    }
    if made.count < wanted.get() {
        output::tell(&format!("error: {scene}: interrupted: {} of {wanted} runs were made", made.count));
        return End::Stopped;
    }
    End::Done
}
