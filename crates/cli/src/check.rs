//! `halfgap check`: runs scenes with expected states and compares.

use crate::args::CheckOptions;
use crate::failure::{End, Failure, describe};
use crate::numbers::size;
use crate::{output, source};
use halfgap::scene::{FieldPath, SceneError};
use halfgap::{CheckReport, World, check as check_world};
use serde::Serialize;
use std::path::Path;

/// The report on one file.
#[derive(Debug, Serialize)]
struct FileReport {
    #[serde(flatten)]
    report: CheckReport,
    file: String,
    #[serde(skip)]
    usable: bool,
}

pub(crate) fn check(options: &CheckOptions) -> Result<End, Failure> {
    let mut reports = Vec::new();
    for scene in &options.scenes {
        let report = match check_file(scene, options.tolerance) {
            Ok(report) => FileReport { report, file: scene.display().to_string(), usable: true },
            Err(error) => {
                output::tell(&describe(&error));
                unusable(scene, &error)
            }
        };
        if !options.json {
            output::print(&lines(&report))?;
        }
        reports.push(report);
    }
    if options.json {
        let json = serde_json::to_string(&reports).expect("reports are strings, flags and numbers only");
        output::print(&format!("{json}\n"))?;
    }
    Ok(match () {
        () if reports.iter().any(|report| !report.usable) => End::BadInput,
        () if reports.iter().any(|report| !report.report.ok) => End::CheckFailed,
        () => End::Done,
    })
}

fn check_file(path: &Path, tolerance: Option<f64>) -> Result<CheckReport, SceneError> {
    let source = source::read(path, None)?;
    let mut scene = source.parse()?;
    if scene.expected.is_empty() {
        let nothing = "missing field `expected`: there is nothing to check";
        return Err(source.locate(SceneError::new(FieldPath::top(), nothing)));
    }
    if let Some(tolerance) = tolerance {
        scene.set_tolerance(tolerance, "--tolerance")?;
    }
    let mut world = World::from_scene(&scene).map_err(|error| source.locate(error))?;
    for warning in world.warnings() {
        output::tell(&format!("warning: {}: {warning}", path.display()));
    }
    let report = check_world(&mut world, &scene);
    for finding in &report.findings {
        output::tell(&format!("warning: {}: {finding}", path.display()));
    }
    Ok(report)
}

fn unusable(path: &Path, error: &SceneError) -> FileReport {
    let file = path.display().to_string();
    let report = CheckReport {
        scene: file.clone(),
        ok: false,
        position_error: None,
        velocity_error: None,
        energy_error: None,
        why: vec![error.to_string()],
        findings: Vec::new(),
    };
    FileReport { report, file, usable: false }
}

/// Returns a line for the file, and one for each failed expectation.
fn lines(file: &FileReport) -> String {
    let report = &file.report;
    let word = match (file.usable, report.ok) {
        (false, _) => "ERROR",
        (true, true) => "ok",
        (true, false) => "FAILED",
    };
    let error = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{} {unit}", size(value)))
    };
    let mut text = format!(
        "{word:6} {}  position {}  velocity {}  energy {}\n",
        file.file,
        error(report.position_error, "m"),
        error(report.velocity_error, "m/s"),
        error(report.energy_error, "J"),
    );
    for why in report.why.iter().filter(|_| file.usable) {
        text.push_str(&format!("       {why}\n"));
    }
    text
}
