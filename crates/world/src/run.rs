//! Runs a world to the end of its scene and records it.

use crate::event::{Event, Impact};
use crate::finding::{Finding, Findings};
use crate::ledger::{Books, Turnover};
use crate::recording::{ContactChange, ContactRecord, Frame, Recording};
use crate::run_error::RunError;
use crate::scene::Scene;
use crate::sentry::LOOKS;
use crate::world::{Energy, World};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// An output this part of a step before the end is the end.
const LAST_STEP_SHARE: f64 = 1e-6;
/// Part of a run after which its progress is told where no output is kept: the clock is read as often, which
/// in a run of a few impacts costs as much as they do.
const PROGRESS_SHARE: f64 = 1.0 / 50.0;

/// What a run keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// States and forces at all output times, and all events.
    Everything,
    /// The states at start and end.
    Ends,
}

/// Until when to run, and what to keep on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct RunPlan {
    /// Title of the scene.
    pub title: String,
    /// Time at the start [s].
    pub start_time: f64,
    /// Time at the end [s].
    pub end_time: f64,
    /// Time between output times [s].
    pub output_step: f64,
    /// What to keep.
    pub record: Record,
    /// Times [s] between start and end, ascending, at which states are wanted besides; see [`RunReport::stops`].
    pub stops: Vec<f64>,
}

impl RunPlan {
    /// The plan that a scene asks for.
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

    /// Says why the plan cannot be followed, if so.
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

    /// Output time `index` [s]: the end once there is no other left.
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

/// How a run went, complete or not.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    /// States and impacts.
    pub recording: Recording,
    /// The states at the plan's stops, as far as the run got.
    pub stops: Vec<Frame>,
    /// Energy at the start.
    pub start_energy: Energy,
    /// Why it stopped early, if it did.
    pub error: Option<RunError>,
    /// What does not hold at the end, or where it stopped; where all is recorded, what was seen not to hold
    /// on the way, too.
    pub findings: Vec<Finding>,
    /// Time [s] spent on stepping alone; `None` where the platform has no clock, as wasm32-unknown-unknown.
    pub wall_seconds: Option<f64>,
}

/// Is told at the start, at each event and at each output which part of a run is done, 0 to 1, and says whether
/// it goes on.
pub type Progress<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// The [`Progress`] of whom it does not concern.
pub fn unwatched(_part: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Runs a world as planned; [`RunError::Interrupted`] if `progress` breaks it off.
///
/// A run that stops early keeps what was recorded, and its last frame is the world where it stopped. A plan
/// with an output step that is not positive, or stops out of order, is reported as an error before anything
/// moves.
pub fn run(world: &mut World, plan: &RunPlan, progress: Progress<'_>) -> RunReport {
    let mut recording = Recording::new(plan.title.clone(), world);
    recording.frames.push(recording.frame_of(world));
    let start_energy = world.energy();
    let mut stepper = Stepper::new(plan.record);
    let mut stops = Vec::new();
    let mut error = plan.check().err();
    let mut goes_on = |time: f64| match progress(done(time, plan)) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(RunError::Interrupted { time }),
    };
    let mut output = 1;
    // Not the world's own time, which is free to differ from the target by rounding.
    let mut now = plan.start_time;
    let mut turnover = Turnover::new(start_energy);
    let mut findings = Findings::default();
    let mut looks = 1.0;
    error = error.or_else(|| goes_on(now).err());
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
            // Who has arrived needs not be stopped.
            error = goes_on(now).err().filter(|_| now < plan.end_time);
        }
        turnover.note(&Books::from(&world.ledger()));
        let wanted = target == output_time && plan.record == Record::Everything;
        if error.is_some() || wanted || target == plan.end_time {
            push_new(&mut recording, world);
        }
        // The sentry looks as often, but not where steps err by what they err.
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
    let findings = findings.at_end(world, turnover.energy);
    RunReport {
        recording,
        stops,
        start_energy,
        error,
        findings,
        wall_seconds: stepper.wall.map(|wall| wall.as_secs_f64()),
    }
}

/// Records the world, unless its last frame has this time already.
fn push_new(recording: &mut Recording, world: &World) {
    if recording.frames.last().is_none_or(|frame| frame.time < world.time()) {
        recording.frames.push(recording.frame_of(world));
    }
}

fn done(time: f64, plan: &RunPlan) -> f64 {
    ((time - plan.start_time) / (plan.end_time - plan.start_time)).clamp(0.0, 1.0)
}

/// What the clock says; `None` where there is none, and asking would panic.
fn clock() -> Option<Instant> {
    let has_clock = cfg!(not(all(target_family = "wasm", target_os = "unknown")));
    has_clock.then(Instant::now)
}

/// Advances a world, collects its events and measures the time that takes.
struct Stepper {
    impacts: Vec<Impact>,
    contacts: Vec<ContactRecord>,
    /// As long as there is a clock.
    wall: Option<Duration>,
    record: Record,
}

impl Stepper {
    fn new(record: Record) -> Self {
        Self { impacts: Vec::new(), contacts: Vec::new(), wall: Some(Duration::ZERO), record }
    }

    fn advance(
        &mut self,
        world: &mut World,
        time: f64,
        goes_on: &mut dyn FnMut(f64) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let keep = self.record == Record::Everything;
        let started = clock();
        let mut interrupted = Ok(());
        let outcome = world.advance_while(time, &mut |event| {
            if keep {
                self.keep(event);
            }
            if interrupted.is_ok() {
                interrupted = goes_on(event.time());
            }
            if interrupted.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        self.wall = self.wall.zip(started).map(|(wall, started)| wall + started.elapsed());
        outcome.and(interrupted)
    }

    fn keep(&mut self, event: &Event) {
        match event {
            Event::Impact(impact) => self.impacts.push(impact.clone()),
            Event::ContactBegins(event) => {
                self.contacts.push(ContactRecord { change: ContactChange::Begins, event: *event });
            }
            Event::ContactEnds(event) => {
                self.contacts.push(ContactRecord { change: ContactChange::Ends, event: *event });
            }
        }
    }
}
