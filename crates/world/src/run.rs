//! Runs a world to the end of its scene and records it.

use crate::event::{Event, Impact};
use crate::finding::{Finding, Findings};
use crate::invariant_monitor::LOOKS;
use crate::ledger::{Books, Turnover};
use crate::recording::{ContactChange, ContactRecord, Frame, Recording};
use crate::run_error::RunError;
use crate::scene::Scene;
use crate::world::{Energy, World};
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Fraction of an output step before the end within which an output time is taken for the end.
const LAST_STEP_SHARE: f64 = 1e-6;
/// Fraction of a run between two reports of its progress where no outputs are kept. The clock is read as often, which
/// in a run of a few impacts costs as much as they do.
const PROGRESS_SHARE: f64 = 1.0 / 50.0;
/// Number of steps without an event between two reports of the progress. Measured: 0.1 ms of a body on a pin, 2 ms of a
/// heap of 25 discs.
const QUIET_STEPS: u32 = 64;

/// Selects what a run records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// States and forces at all output times, and all events.
    Everything,
    /// States and forces at the start and the end; no events.
    Ends,
}

/// End time of a run, output times, and what to record.
#[derive(Clone, Debug, PartialEq)]
pub struct RunPlan {
    /// Title of the scene.
    pub title: String,
    /// Time at the start [s].
    pub start_time: f64,
    /// Time at the end [s].
    pub end_time: f64,
    /// Interval between output times [s].
    pub output_step: f64,
    /// Selects what to record.
    pub record: Record,
    /// Further times [s], ascending from start to end, whose states are reported in [`RunReport::stops`].
    pub stops: Vec<f64>,
}

impl RunPlan {
    /// Returns the plan that a scene asks for.
    #[must_use]
    pub fn of_scene(scene: &Scene, record: Record) -> Self {
        Self {
            title: scene.title.clone(),
            start_time: scene.run.start_time,
            end_time: scene.run.end_time(),
            output_step: scene.run.output_step_or_default(),
            record,
            stops: Vec::new(),
        }
    }

    /// Checks that times are finite and in order, and the output step positive.
    fn check(&self) -> Result<(), RunError> {
        let bad = |field, rule, value| Err(RunError::BadPlan { field, rule, value });
        for (field, value) in [("start_time", self.start_time), ("end_time", self.end_time)] {
            if !value.is_finite() {
                return bad(field, "finite", value);
            }
        }
        if self.end_time < self.start_time {
            return bad("end_time", "no earlier than start_time", self.end_time);
        }
        if self.output_step.is_nan() || self.output_step <= 0.0 {
            return bad("output_step", "positive", self.output_step);
        }
        let mut last = self.start_time;
        for &stop in &self.stops {
            if !(last..=self.end_time).contains(&stop) {
                return bad("stops", "ascending, between start and end", stop);
            }
            last = stop;
        }
        Ok(())
    }

    /// Returns output time `index` [s]; after the last one, the end.
    fn output_time(&self, index: u64) -> f64 {
        let step = match self.record {
            Record::Everything => self.output_step,
            Record::Ends => self.output_step.max(PROGRESS_SHARE * (self.end_time - self.start_time)),
        };
        // Counted, not summed up: the times are the same however long the run.
        let time = self.start_time + index as f64 * step;
        if time < self.end_time - LAST_STEP_SHARE * step { time } else { self.end_time }
    }
}

/// Report on a run, complete or not.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    /// States, forces and events recorded.
    pub recording: Recording,
    /// The states at the plan's stops, as far as the run got.
    pub stops: Vec<Frame>,
    /// Energy at the start.
    pub start_energy: Energy,
    /// Error that stopped the run early, if one did.
    pub error: Option<RunError>,
    /// Broken invariants at the end, or where the run stopped; with [`Record::Everything`] also those seen on the way.
    pub findings: Vec<Finding>,
    /// Energy in play [J]: the largest sum seen of the kinetic energy, the change of the potential energy and the work
    /// of force laws.
    pub energy_in_play: f64,
    /// Wall time of stepping alone [s]; `None` on platforms without a clock, such as wasm32-unknown-unknown.
    pub wall_seconds: Option<f64>,
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reached {
    /// Fraction of the run that is done, 0 to 1.
    pub fraction: f64,
    /// Time [s].
    pub time: f64,
    /// Number of events so far: impacts, and contacts that began or ended.
    pub events: u64,
}

/// Called at the start, at each event and each output, and now and then in between; return [`ControlFlow::Break`] to
/// stop.
pub type Progress<'a> = &'a mut dyn FnMut(&Reached) -> ControlFlow<()>;

/// A [`Progress`] that never stops the run.
pub fn unwatched(_reached: &Reached) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Runs a world as planned.
///
/// A run that stops early keeps what was recorded, and its last frame is the world where it stopped. The error is in
/// [`RunReport::error`]: [`RunError::Interrupted`] if `progress` stopped the run; [`RunError::BadPlan`], before
/// anything moves, for an output step that is not positive or times out of order; else that of
/// [`World::advance_while`].
pub fn run(world: &mut World, plan: &RunPlan, progress: Progress<'_>) -> RunReport {
    let mut recording = Recording::new(plan.title.clone(), world);
    recording.frames.push(recording.frame_of(world));
    let start_energy = world.energy_to_begin_with();
    let mut stepper = Stepper::new(plan.record);
    let mut stops = Vec::new();
    let mut error = plan.check().err();
    let mut goes_on = |time: f64, events: u64| match progress(&reached(time, events, plan)) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(RunError::Interrupted { time }),
    };
    let mut output = 1;
    // The planned time: the world's own may differ from it by rounding.
    let mut now = plan.start_time;
    let mut turnover = Turnover::new(start_energy);
    let mut findings = Findings::default();
    let mut looks = 1.0;
    findings.look_at_points(world);
    error = error.or_else(|| goes_on(now, 0).err());
    while error.is_none() && now < plan.end_time {
        let output_time = plan.output_time(output);
        let stop_time = plan.stops.get(stops.len()).copied().unwrap_or(f64::INFINITY);
        let target = output_time.min(stop_time);
        if target > now {
            error = stepper.advance(world, target, &mut goes_on).err();
            now = target;
        }
        if error.is_none() && target == stop_time {
            stops.push(recording.frame_of(world));
        }
        if error.is_none() && target == output_time {
            output += 1;
            // A run that has reached its end is complete, whatever the callback answers.
            error = goes_on(now, stepper.events).err().filter(|_| now < plan.end_time);
        }
        turnover.note(&Books::from(&world.ledger()));
        findings.look_at_points(world);
        let wanted = target == output_time && plan.record == Record::Everything;
        if error.is_some() || wanted || target == plan.end_time {
            push_new(&mut recording, world);
        }
        // The monitor checks as often, but not where steps of a given length may err by any amount.
        if wanted && done(now, plan) >= looks / LOOKS {
            findings.look(world);
            looks += 1.0;
        }
    }
    // Stops at the end itself: the loop has passed them.
    while error.is_none() && stops.len() < plan.stops.len() {
        stops.push(recording.frame_of(world));
    }
    recording.impacts = stepper.impacts;
    recording.contacts = stepper.contacts;
    recording.ledger = world.ledger();
    turnover.note_kinetic(world.largest_kinetic_energy());
    let mut findings = findings.at_end(world, turnover.energy);
    if error.is_none() {
        world.find_nothing(&turnover, &mut findings);
    }
    RunReport {
        recording,
        stops,
        start_energy,
        error,
        findings,
        energy_in_play: turnover.energy,
        wall_seconds: stepper.wall.map(|wall| wall.as_secs_f64()),
    }
}

/// Adds a frame of the world, unless the last frame has the present time already.
fn push_new(recording: &mut Recording, world: &World) {
    if recording.frames.last().is_none_or(|frame| frame.time < world.time()) {
        recording.frames.push(recording.frame_of(world));
    }
}

fn reached(time: f64, events: u64, plan: &RunPlan) -> Reached {
    Reached { fraction: done(time, plan), time, events }
}

fn done(time: f64, plan: &RunPlan) -> f64 {
    ((time - plan.start_time) / (plan.end_time - plan.start_time)).clamp(0.0, 1.0)
}

/// Reads the clock; `None` on platforms without one, where reading it would panic.
fn clock() -> Option<Instant> {
    let has_clock = cfg!(not(all(target_family = "wasm", target_os = "unknown")));
    has_clock.then(Instant::now)
}

/// Advances a world, collects its events and measures the wall time of that.
struct Stepper {
    impacts: Vec<Impact>,
    contacts: Vec<ContactRecord>,
    /// Wall time so far; `None` without a clock.
    wall: Option<Duration>,
    record: Record,
    /// Number of events so far.
    events: u64,
    /// Number of steps without an event since the last report.
    quiet: u32,
}

impl Stepper {
    fn new(record: Record) -> Self {
        let wall = Some(Duration::ZERO);
        Self { impacts: Vec::new(), contacts: Vec::new(), wall, record, events: 0, quiet: 0 }
    }

    fn advance(
        &mut self,
        world: &mut World,
        time: f64,
        goes_on: &mut dyn FnMut(f64, u64) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let started = clock();
        let watch = RefCell::new((&mut *self, goes_on, Ok(())));
        let outcome = world.advance_watched(
            time,
            &mut |event| {
                let (stepper, goes_on, interrupted) = &mut *watch.borrow_mut();
                stepper.keep(event);
                if interrupted.is_ok() {
                    *interrupted = goes_on(event.time(), stepper.events);
                }
                flow(interrupted)
            },
            &mut |time| {
                let (stepper, goes_on, interrupted) = &mut *watch.borrow_mut();
                stepper.quiet += 1;
                if stepper.quiet >= QUIET_STEPS && interrupted.is_ok() {
                    stepper.quiet = 0;
                    *interrupted = goes_on(time, stepper.events);
                }
                flow(interrupted)
            },
        );
        let (.., interrupted) = watch.into_inner();
        self.wall = self.wall.zip(started).map(|(wall, started)| wall + started.elapsed());
        outcome.and(interrupted)
    }

    /// Counts an event, and keeps it if everything is recorded.
    fn keep(&mut self, event: &Event) {
        self.events += 1;
        if self.record != Record::Everything {
            return;
        }
        let (change, event) = match event {
            Event::Impact(impact) => return self.impacts.push(impact.clone()),
            Event::ContactBegins(event) => (ContactChange::Begins, event),
            Event::ContactEnds(event) => (ContactChange::Ends, event),
            Event::Slips(event) => (ContactChange::Slips, event),
            Event::Sticks(event) => (ContactChange::Sticks, event),
            Event::Jams(event) => (ContactChange::Jams, event),
            Event::Undecided(event) => (ContactChange::Undecided, event),
        };
        self.contacts.push(ContactRecord { change, event: *event });
    }
}

/// Stops an advance that was interrupted.
fn flow(interrupted: &Result<(), RunError>) -> ControlFlow<()> {
    if interrupted.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
