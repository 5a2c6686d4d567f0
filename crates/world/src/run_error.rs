//! Errors that stop a run early, with the names of bodies, and the outcomes of runs.

use crate::builder::{Joints, LARGEST};
use crate::finding::Finding;
use crate::world::{Named, name_among};
use crate::world_error::{ConnectorName, WorldError};
use halfgap_advance::rigid::{AdvanceError, Between, LARGEST_MASS_RATIO};
use halfgap_collision::{BodyId, ConnectorId};
use halfgap_contact::{ImpactError, Problem, SolveError};
use halfgap_geometry::{Rounded, RoundedPlace};

/// Largest number of names shown in a message; the error itself has all of them.
const MOST_NAMES: usize = 12;

/// Outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "scene", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Outcome {
    /// The run reached its end.
    Done,
    /// The advance could not go on.
    Stuck,
    /// No contact forces or impulses satisfy the constraints.
    Infeasible,
    /// The caller stopped the run.
    Interrupted,
}

impl Outcome {
    /// Name in results: "done", "stuck", "infeasible" or "interrupted".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Stuck => "stuck",
            Self::Infeasible => "infeasible",
            Self::Interrupted => "interrupted",
        }
    }
}

/// Error that stopped a run early, or refused a request.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// An impact cannot be resolved.
    #[error("at {} s in an impact of {}: {source}{}", RoundedPlace(*time), quoted(bodies), on_row(between))]
    Impact {
        /// Time of the error [s].
        time: f64,
        /// Names of the bodies that take part.
        bodies: Vec<String>,
        /// Names of the two bodies of the row that the source names.
        between: Option<[String; 2]>,
        /// Error of the impact law.
        source: ImpactError,
    },
    /// Two bodies collide again and again without any time going by.
    #[error(
        "stuck at {} s: \"{primary}\" and \"{normal}\" collided {events} times without any time going by",
        RoundedPlace(*time)
    )]
    Stuck {
        /// Time of the error [s].
        time: f64,
        /// Name of one body.
        primary: String,
        /// Name of the other body.
        normal: String,
        /// Number of collisions.
        events: u32,
    },
    /// Where contacts carry impulses only: two bodies are pressed as far into each other as they may sink,
    /// and collide again and again within a step.
    #[error(
        "at {} s \"{primary}\" and \"{normal}\" are pressed into each other and collide without end: {events} times \
         within a `time_step` of {} s; a shorter one lets them sink less",
        RoundedPlace(*time),
        Rounded(*step)
    )]
    Pressed {
        /// Time of the error [s].
        time: f64,
        /// Name of one body.
        primary: String,
        /// Name of the other body.
        normal: String,
        /// Number of collisions of bodies that had sunk.
        events: u32,
        /// Interval after which sunk bodies are put back [s].
        step: f64,
    },
    /// The forces of contacts and connectors cannot be found.
    #[error("at {} s in the contacts of {}: {source}{}", RoundedPlace(*time), quoted(bodies), on_row(between))]
    Contacts {
        /// Time of the error [s].
        time: f64,
        /// Names of the bodies that take part.
        bodies: Vec<String>,
        /// Names of the two bodies of the row that the source names.
        between: Option<[String; 2]>,
        /// The problem that was to be solved last: accelerations [m/s^2] of the rows by their forces [N].
        problem: Box<Problem>,
        /// Error of the contact solver.
        source: Box<SolveError>,
    },
    /// The integrator's step has fallen to nothing: forces grow beyond all bounds or are not numbers.
    #[error(
        "at {} s the step of {} fell to {} s{}",
        RoundedPlace(*time),
        quoted(bodies),
        Rounded(*step),
        under(force_laws)
    )]
    StepCollapsed {
        /// Time of the error [s].
        time: f64,
        /// Length of the step [s].
        step: f64,
        /// Names of the bodies that share the step.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// A drive moves a linkage into its dead point, where nothing moves as the drive asks for.
    #[error(
        "at {} s {connector} comes to a dead point of the linkage, beyond which it cannot move it; let it turn less \
         far, or use a motor, whose `max` lets it stop",
        RoundedPlace(*time)
    )]
    DeadPoint {
        /// Time of the error [s].
        time: f64,
        /// The drive.
        connector: Box<ConnectorName>,
    },
    /// A rope over pulleys has been pulled in on one side.
    #[error(
        "at {} s {connector} has run out: \"{body}\" is at the wheel; end the run before, or stop \"{body}\" short of it",
        RoundedPlace(*time)
    )]
    RanOut {
        /// Time of the error [s].
        time: f64,
        /// The pulley.
        connector: Box<ConnectorName>,
        /// Name of the body at the end of the side that ran out.
        body: String,
    },
    /// Errors of an integrator with fixed steps have grown until bodies were fast beyond all measure.
    #[error(
        "at {} s integration errors grew: {} reached {} m/s; use a shorter `time_step` or an adaptive `integrator`",
        RoundedPlace(*time),
        quoted(bodies),
        Rounded(*speed)
    )]
    RanAway {
        /// Time of the error [s].
        time: f64,
        /// Speed of the fastest point [m/s].
        speed: f64,
        /// Names of the bodies that share the step.
        bodies: Vec<String>,
    },
    /// Forces vary over so short a length that rounding of coordinates, or the gap of contacts, would create or destroy
    /// energy.
    #[error(
        "at {} s the forces of {} on {} vary over {} m, too short a length for the rounding of the coordinates or \
         the gap of bodies in contact at this tolerance; keep the bodies farther apart, or nearer the origin",
        RoundedPlace(*time),
        quoted(force_laws),
        quoted(bodies),
        Rounded(*length)
    )]
    Unresolved {
        /// Time of the error [s].
        time: f64,
        /// Length [m] over which forces vary by their own size.
        length: f64,
        /// Names of the two bodies that are so near each other, or of all that share the step.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// Steps have become so short that the planned time would take hopelessly many, and no events happen meanwhile. The
    /// state at that time is sound: an advance over a shorter duration may go on, unless a longer one is planned.
    #[error(
        "at {} s the steps of {} are only {} s long{}; the {} s asked for would take {} of them (see `duration`)",
        RoundedPlace(*time),
        quoted(bodies),
        Rounded(*step),
        under(force_laws),
        Rounded(*duration),
        Rounded(duration / step)
    )]
    Crawls {
        /// Time of the error [s].
        time: f64,
        /// Mean length of the last steps [s].
        step: f64,
        /// Duration to be simulated [s].
        duration: f64,
        /// Names of the bodies that share the steps.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// A body turns so often in the planned time that following it is hopeless: bodies are near that it may hit, or
    /// ties and forces act on it. The state at that time is sound: an advance over a shorter duration may go on, unless
    /// a longer one is planned.
    #[error(
        "at {} s body \"{body}\" turns at {} rad/s: too fast to follow for the {} s asked for, in which it turns {} \
         times beside bodies that it may hit, or with ties or forces on it; slow it down, shorten the `duration`, or \
         let it pass through the others",
        RoundedPlace(*time),
        Rounded(*angular_velocity),
        Rounded(*duration),
        Rounded(angular_velocity.abs() * duration / std::f64::consts::TAU)
    )]
    TooFast {
        /// Time of the error [s].
        time: f64,
        /// Name of the body.
        body: String,
        /// Its angular velocity [rad/s].
        angular_velocity: f64,
        /// Duration to be simulated [s].
        duration: f64,
    },
    /// A body is held between others of which one is too heavy for it: the forces that pass through it would be lost in
    /// rounding.
    #[error(
        "at {} s \"{light}\" ({} kg) is held between \"{heavy}\" ({} kg) and another body: what one body presses or \
         pulls on through another may be {LARGEST_MASS_RATIO:e} times as heavy as that at most; make \"{light}\" \
         heavier or \"{heavy}\" lighter, or join them into one body",
        RoundedPlace(*time),
        Rounded(masses[0]),
        Rounded(masses[1])
    )]
    Squeezed {
        /// Time of the error [s].
        time: f64,
        /// Name of the light body.
        light: String,
        /// Name of the heavy body.
        heavy: String,
        /// Masses of the two [kg].
        masses: [f64; 2],
    },
    /// Connectors have come apart, bodies overlap, or the energy books do not close: further motion would not be that
    /// of the scene.
    #[error("at {} s the world no longer holds together: {}", RoundedPlace(*time), finding.without_time())]
    Astray {
        /// Time of the error [s].
        time: f64,
        /// The broken invariant.
        finding: Finding,
    },
    /// The callback of the run stopped it.
    #[error("interrupted at {} s", RoundedPlace(*time))]
    Interrupted {
        /// Time of the interruption [s].
        time: f64,
    },
    /// The time to advance to is infinite, or not a number.
    #[error("cannot advance to a time that is not a finite number")]
    NotATime,
    /// An intervention names the background, or a body that the world does not have.
    #[error("there is no body {} in this world", body.0)]
    NoSuchBody {
        /// The body.
        body: BodyId,
    },
    /// An intervention names a fixed body, which nothing moves.
    #[error("body \"{body}\" is fixed: nothing moves it")]
    Immovable {
        /// Name of the body.
        body: String,
    },
    /// An intervention has numbers that are not finite, or too large; nothing was done.
    #[error(
        "an intervention on body \"{body}\" must be finite, and change its velocities by {LARGEST:e} at most"
    )]
    BadIntervention {
        /// Name of the body.
        body: String,
    },
    /// A force law cannot be added; nothing was done.
    #[error(transparent)]
    BadForce {
        /// What is wrong with it.
        source: Box<WorldError>,
    },
    /// A force is to be removed that the world never had.
    #[error("this world never had that force law")]
    NoSuchForce,
    /// A plan cannot be followed; nothing was run.
    #[error("the plan's {field} must be {rule}, got {value} s")]
    BadPlan {
        /// Name of the field.
        field: &'static str,
        /// Rule that its value breaks.
        rule: &'static str,
        /// The value [s].
        value: f64,
    },
    /// Any other error of the advance.
    #[error(transparent)]
    Advance(AdvanceError),
}

impl RunError {
    /// The outcome of a run that this error ended.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        match self {
            Self::Contacts { source, .. } if matches!(**source, SolveError::Infeasible(_)) => {
                Outcome::Infeasible
            }
            Self::Impact { source: ImpactError::Infeasible { .. } | ImpactError::DrawnIn { .. }, .. } => {
                Outcome::Infeasible
            }
            Self::Interrupted { .. } => Outcome::Interrupted,
            _ => Outcome::Stuck,
        }
    }

    /// Time at which the run stopped [s]; `None` for a request that was refused before anything moved, and for
    /// [`RunError::Advance`].
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Impact { time, .. }
            | Self::Contacts { time, .. }
            | Self::StepCollapsed { time, .. }
            | Self::DeadPoint { time, .. }
            | Self::RanOut { time, .. }
            | Self::RanAway { time, .. }
            | Self::Unresolved { time, .. }
            | Self::Crawls { time, .. }
            | Self::TooFast { time, .. }
            | Self::Squeezed { time, .. }
            | Self::Astray { time, .. }
            | Self::Pressed { time, .. }
            | Self::Interrupted { time }
            | Self::Stuck { time, .. } => Some(*time),
            Self::NotATime
            | Self::NoSuchBody { .. }
            | Self::Immovable { .. }
            | Self::BadIntervention { .. }
            | Self::BadForce { .. }
            | Self::NoSuchForce
            | Self::BadPlan { .. }
            | Self::Advance(_) => None,
        }
    }

    pub(crate) fn new(error: AdvanceError, bodies: &[Named], joints: &Joints) -> Self {
        let name = |body: BodyId| name_among(bodies, body).to_owned();
        let connector = |id: ConnectorId| Box::new(joints.name(id, bodies));
        let names = |between: Between| (name(between.primary), name(between.normal));
        match error {
            AdvanceError::Impact { time, bodies, between, source } => {
                let between = between.map(|Between { primary, normal }| [primary, normal].map(&name));
                Self::Impact { time, bodies: bodies.into_iter().map(name).collect(), between, source }
            }
            AdvanceError::Contacts { time, bodies, between, problem, source } => {
                let between = between.map(|Between { primary, normal }| [primary, normal].map(&name));
                let bodies = bodies.into_iter().map(name).collect();
                Self::Contacts { time, bodies, between, problem, source }
            }
            AdvanceError::StepCollapsed { time, step, bodies, force_laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::StepCollapsed { time, step, bodies, force_laws }
            }
            AdvanceError::DeadPoint { time, drive, .. } => {
                Self::DeadPoint { time, connector: connector(drive) }
            }
            AdvanceError::RanOut { time, pulley, body } => {
                Self::RanOut { time, connector: connector(pulley), body: name(body) }
            }
            AdvanceError::RanAway { time, speed, bodies } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::RanAway { time, speed, bodies }
            }
            AdvanceError::Unresolved { time, length, bodies, force_laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::Unresolved { time, length, bodies, force_laws }
            }
            AdvanceError::Crawls { time, step, duration, bodies, force_laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::Crawls { time, step, duration, bodies, force_laws }
            }
            AdvanceError::TooFast { time, body, angular_velocity, duration } => {
                Self::TooFast { time, body: name(body), angular_velocity, duration }
            }
            AdvanceError::Squeezed { time, light, heavy, masses } => {
                Self::Squeezed { time, light: name(light), heavy: name(heavy), masses }
            }
            AdvanceError::Stuck { time, between, events } => {
                let (primary, normal) = names(between);
                Self::Stuck { time, primary, normal, events }
            }
            AdvanceError::Pressed { time, between, events, step } => {
                let (primary, normal) = names(between);
                Self::Pressed { time, primary, normal, events, step }
            }
            other => Self::Advance(other),
        }
    }
}

/// The force laws of an error, as the end of a clause.
fn under(force_laws: &[String]) -> String {
    if force_laws.is_empty() { String::new() } else { format!(" under the forces of {}", quoted(force_laws)) }
}

/// Names the two bodies of the row that a message has named by its index.
fn on_row(between: &Option<[String; 2]>) -> String {
    between.as_ref().map_or_else(String::new, |[a, b]| format!("; the row is of \"{a}\" and \"{b}\""))
}

/// Names in a message, in quotes: all of a few, the first of many.
fn quoted(names: &[String]) -> String {
    let (shown, rest) = names.split_at(names.len().min(MOST_NAMES));
    let shown = shown.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    if rest.is_empty() { shown } else { format!("{shown} and {} more", rest.len()) }
}

#[cfg(test)]
mod tests {
    use super::{MOST_NAMES, RunError};

    /// The message of a collapsed step of a number of bodies.
    fn message(bodies: usize) -> String {
        let bodies = (0..bodies).map(|index| format!("disc {index}")).collect();
        RunError::StepCollapsed { time: 1.5, step: 1e-15, bodies, force_laws: Vec::new() }.to_string()
    }

    #[test]
    fn a_message_names_no_more_bodies_than_one_reads() {
        assert_eq!(message(2), "at 1.5 s the step of \"disc 0\", \"disc 1\" fell to 1e-15 s");
        assert!(message(MOST_NAMES).contains("\"disc 11\" fell"));
        assert!(message(200).contains("\"disc 11\" and 188 more fell"));
    }
}
