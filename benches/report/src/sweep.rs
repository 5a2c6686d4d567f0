//! All runs of the report: every scene, every engine, over its settings.

use crate::engines::Engine;
use crate::engines::box2d::{Box2d, Contacts};
use crate::engines::halfgap::Halfgap;
use crate::engines::moved::Drives;
use crate::engines::rapier::{Joints, Rapier, Tuning};
use crate::measure::{Measurement, Repeats, measure};
use crate::scene::{Group, Scene};
use glam::DVec2;

/// A run that was measured, or the reason why it could not be.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Name of the engine.
    pub engine: String,
    /// Its version.
    pub version: String,
    /// Its settings.
    pub settings: String,
    /// Error of the known states themselves [m].
    pub reference_error: f64,
    /// The measurement, or the reason why there is none.
    pub outcome: Result<Measurement, String>,
}

impl Row {
    /// Time [s] per simulated second and error [m], if the run was done and its answer is known.
    #[must_use]
    pub fn time_and_error(&self) -> Option<(f64, f64)> {
        let run = self.outcome.as_ref().ok()?;
        Some((run.wall_per_second, run.error?))
    }
}

/// Adds rows; a run that is there already keeps the lesser time.
pub fn merge(rows: &mut Vec<Row>, more: Vec<Row>) {
    for row in more {
        let same = |old: &&mut Row| {
            old.scene == row.scene
                && old.engine == row.engine
                && old.version == row.version
                && old.settings == row.settings
        };
        match rows.iter_mut().find(same) {
            Some(old) => keep_faster(old, row),
            None => rows.push(row),
        }
    }
}

fn keep_faster(old: &mut Row, new: Row) {
    let time = |row: &Row| row.outcome.as_ref().map_or(f64::INFINITY, |run| run.wall_per_second);
    if time(&new) < time(old) {
        *old = new;
    }
}

/// Tolerance at which scenes without a known answer are run.
const PILE_TOLERANCE: f64 = 1e-3;

/// Thoroughness of a sweep.
#[derive(Clone, Debug)]
pub struct Effort {
    /// Rules for the repetition of each run.
    pub repeats: Repeats,
    /// Runs that would take longer than this [s] are left out.
    pub longest_run: f64,
    /// Tolerances for halfgap.
    pub tolerances: Vec<f64>,
    /// Segments for a full circle where peers cut arcs up.
    pub segments: Vec<usize>,
    /// Number of the peers' variants of settings that are run.
    pub variants: usize,
}

impl Effort {
    /// For a report.
    #[must_use]
    pub fn thorough() -> Self {
        let tolerances = (0..=12).map(|digits| 10_f64.powi(-digits)).collect();
        Self {
            repeats: Repeats::THOROUGH,
            longest_run: 8.0,
            tolerances,
            segments: vec![64, 512, 4096],
            variants: 3,
        }
    }

    /// For a look in a minute.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            repeats: Repeats::QUICK,
            longest_run: 0.3,
            tolerances: vec![1e-3, 1e-6, 1e-9, 1e-12],
            segments: vec![128],
            variants: 2,
        }
    }
}

/// Measures one engine on one scene.
#[must_use]
pub fn run(engine: &dyn Engine, scene: &Scene, effort: &Effort) -> Row {
    Row {
        scene: scene.name.clone(),
        engine: engine.name().to_owned(),
        version: engine.version().to_owned(),
        settings: engine.settings(),
        reference_error: scene.reference_error,
        outcome: measure(engine, scene, &effort.repeats).map_err(|error| error.to_string()),
    }
}

/// Measures halfgap over its tolerances.
#[must_use]
pub fn halfgap_rows(scene: &Scene, effort: &Effort) -> Vec<Row> {
    // A pile at the accuracy of games: nobody would ask for more, and there is no error to show for it.
    let tolerances = if scene.has_answer() { effort.tolerances.as_slice() } else { &[PILE_TOLERANCE] };
    tolerances.iter().map(|&tolerance| run(&Halfgap { tolerance, step: None }, scene, effort)).collect()
}

/// Steps per second of the coarsest run of a peer.
const STOCK_RATE: f64 = 60.0;
/// Factor from the number of steps of one run to that of the next.
const REFINEMENT: f64 = 4.0;
/// Refinements: 60, 240, ... 61,440, 245,760 steps a second.
const REFINEMENTS: i32 = 6;

/// Runs one peer at ever shorter steps, until that takes too long or it fails.
fn refine(make: &dyn Fn(u32) -> Box<dyn Engine>, scene: &Scene, effort: &Effort, rows: &mut Vec<Row>) {
    for refinement in 0..=REFINEMENTS {
        let rate = STOCK_RATE * REFINEMENT.powi(refinement);
        let row = run(&*make((rate * scene.check_grid).ceil() as u32), scene, effort);
        let expected = row.outcome.as_ref().ok().map(|run| REFINEMENT * run.wall_per_second * scene.duration);
        rows.push(row);
        if expected.is_none_or(|expected| expected > effort.longest_run) {
            break;
        }
    }
}

/// Measures Rapier over steps, iterations, segments and tunings.
#[must_use]
pub fn rapier_rows(scene: &Scene, effort: &Effort) -> Vec<Row> {
    let mut rows = Vec::new();
    // Reduced coordinates take no velocities at the start.
    let at_rest = scene.bodies.iter().all(|body| body.start.velocity == DVec2::ZERO);
    let is_linkage = !scene.connectors.is_empty() && !scene.collisions && at_rest;
    let joints: &[Joints] =
        if is_linkage { &[Joints::Impulse, Joints::Multibody] } else { &[Joints::Impulse] };
    let variants = [(Tuning::Stock, 4), (Tuning::Accurate, 4), (Tuning::Accurate, 16)];
    for &segments in segments(scene, effort) {
        for &joints in joints {
            for (tuning, iterations) in variants.into_iter().take(effort.variants) {
                for &drives in drives(scene) {
                    let make = |steps_per_check| -> Box<dyn Engine> {
                        Box::new(Rapier { steps_per_check, iterations, segments, tuning, joints, drives })
                    };
                    refine(&make, scene, effort, &mut rows);
                }
            }
        }
    }
    rows
}

/// Measures Box2D over steps, substeps, segments and scales, and over the stiffness of contacts where bodies may rest on
/// each other, and over that of joints where something acts on them.
#[must_use]
pub fn box2d_rows(scene: &Scene, effort: &Effort) -> Vec<Row> {
    let mut rows = Vec::new();
    let base = |scale: f32, substeps: i32| Box2d {
        steps_per_check: 1,
        substeps,
        segments: 0,
        scale,
        contacts: Contacts::Soft,
        soft_joints: false,
        drives: Drives::Motor,
    };
    let mut variants = vec![base(1.0, 4), base(100.0, 4), base(100.0, 16)];
    variants.truncate(effort.variants);
    let stiff = |substeps| Box2d { contacts: Contacts::Stiff, ..base(100.0, substeps) };
    let has_motors = scene.group() == Group::MotorsAndLimits;
    if scene.has_friction() || has_motors && scene.collisions {
        variants.extend([4, 16].map(stiff));
    }
    if has_motors {
        variants.extend([4, 16].map(|substeps| Box2d { soft_joints: true, ..stiff(substeps) }));
    }
    for &segments in segments(scene, effort) {
        for &variant in &variants {
            for &drives in drives(scene) {
                let make = |steps_per_check| -> Box<dyn Engine> {
                    Box::new(Box2d { steps_per_check, segments, drives, ..variant })
                };
                refine(&make, scene, effort, &mut rows);
            }
        }
    }
    rows
}

/// Forms of drives, where there are any.
fn drives(scene: &Scene) -> &'static [Drives] {
    let is_driven = scene.on_joints.iter().any(|(_, on_joint)| on_joint.rate.is_some());
    if is_driven { &[Drives::Motor, Drives::Moved] } else { &[Drives::Motor] }
}

/// Segments for a full circle; none where nothing is cut.
fn segments<'a>(scene: &Scene, effort: &'a Effort) -> &'a [usize] {
    if scene.has_arcs() { &effort.segments } else { &[0] }
}
