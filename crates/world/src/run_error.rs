//! Why a run stopped early, in the words of the world: with the names of bodies.

use crate::builder::LARGEST;
use crate::finding::Finding;
use crate::rounded::Rounded;
use halfgap_advance::rigid::{AdvanceError, Between};
use halfgap_collision::BodyId;
use halfgap_contact::{ImpactError, Problem, SolveError};

/// So many names are shown in a message; the error itself has all of them.
const MOST_NAMES: usize = 12;

/// How a run that stopped early is summed up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The advance cannot go on.
    Stuck,
    /// The contact problem has no solution.
    Infeasible,
    /// Somebody stopped it on the way.
    Interrupted,
}

/// Why a run stopped early.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// An impact cannot be resolved.
    #[error("at {time} s in an impact of {}: {source}{}", quoted(bodies), on_row(between))]
    Impact {
        /// When [s].
        time: f64,
        /// Names of the bodies that take part.
        bodies: Vec<String>,
        /// Names of the two bodies of the row that the source names.
        between: Option<[String; 2]>,
        /// Why not.
        source: ImpactError,
    },
    /// The same two bodies collide again and again without any time going by.
    #[error(
        "stuck at {time} s: \"{primary}\" and \"{normal}\" collided {events} times without any time going by"
    )]
    Stuck {
        /// When [s].
        time: f64,
        /// Name of one body.
        primary: String,
        /// Name of the other body.
        normal: String,
        /// How many times.
        events: u32,
    },
    /// Where contacts carry impulses only: two bodies are pressed as far into each other as they may sink,
    /// and collide again and again within a step.
    #[error(
        "at {time} s \"{primary}\" and \"{normal}\" are pressed into each other and collide without end: {events} times within a \
         time_step of {} s, a shorter one lets them sink less",
        Rounded(*step)
    )]
    Pressed {
        /// When [s].
        time: f64,
        /// Name of one body.
        primary: String,
        /// Name of the other body.
        normal: String,
        /// How many times those collided that had sunk.
        events: u32,
        /// After how long what has sunk is put back [s].
        step: f64,
    },
    /// The forces of contacts and connectors cannot be found.
    #[error("at {time} s in the contacts of {}: {source}{}", quoted(bodies), on_row(between))]
    Contacts {
        /// When [s].
        time: f64,
        /// Names of the bodies that take part.
        bodies: Vec<String>,
        /// Names of the two bodies of the row that the source names.
        between: Option<[String; 2]>,
        /// The problem that was to be solved last: accelerations [m/s^2] of the rows by their forces [N].
        problem: Box<Problem>,
        /// Why not.
        source: Box<SolveError>,
    },
    /// The integrator's step has fallen to nothing.
    #[error("at {time} s the step of {} fell to {step:e} s{}", quoted(bodies), under(laws))]
    StepCollapsed {
        /// When [s].
        time: f64,
        /// Length of the step [s].
        step: f64,
        /// Names of the bodies that share the step.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// Steps of a method without an error estimate have made bodies beyond all measure fast.
    #[error(
        "by {time} s errors of steps have made {} {} m/s fast: `time_step` is too long for an `integrator` that does not \
         look at them",
        quoted(bodies),
        Rounded(*speed)
    )]
    RanAway {
        /// When [s].
        time: f64,
        /// Speed of the fastest point [m/s].
        speed: f64,
        /// Names of the bodies that share the step.
        bodies: Vec<String>,
    },
    /// Forces vary over so short a length that rounding of coordinates, or the gap that contacts have, makes energy of
    /// nothing.
    #[error(
        "at {time} s the forces of {} on {} vary over {length:e} m: rounding of the coordinates, or the gap of bodies in \
         contact, makes more of that than the tolerance allows",
        quoted(laws),
        quoted(bodies)
    )]
    Unresolved {
        /// When [s].
        time: f64,
        /// Length [m] over which forces vary by as much as they are.
        length: f64,
        /// Names of the two bodies that are so near each other, or of all that share the step.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// Steps have become so short that those for all the time that is to be simulated would never come to an
    /// end, and nothing happens meanwhile. The world is as it should be at that time: who asks for less may go on.
    #[error(
        "at {time} s {} goes on in steps of {} s{}: for {} s that would be {} of them",
        quoted(bodies), Rounded(*step), under(laws), Rounded(*duration), Rounded(duration / step)
    )]
    Crawls {
        /// When [s].
        time: f64,
        /// Mean length of the last steps [s].
        step: f64,
        /// How long is to be simulated [s].
        duration: f64,
        /// Names of the bodies that share the steps.
        bodies: Vec<String>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// The world does not hold together any more: what it would go on with is not what the scene asks for.
    #[error("stopped at {time} s, as it does not hold together any more: {finding}")]
    Astray {
        /// When [s].
        time: f64,
        /// What does not hold.
        finding: Finding,
    },
    /// Who follows the run wanted it to stop.
    #[error("interrupted at {time} s")]
    Interrupted {
        /// When [s].
        time: f64,
    },
    /// The time to advance to is infinite, or not a number.
    #[error("cannot advance to a time that is not a finite number")]
    NotATime,
    /// There is no such body to do something to.
    #[error("there is no body {} in this world", body.0)]
    NoSuchBody {
        /// The body.
        body: BodyId,
    },
    /// Nothing can be done to a fixed body.
    #[error("body \"{body}\" is fixed: nothing moves it")]
    Immovable {
        /// Name of the body.
        body: String,
    },
    /// What is to be done to a body is not finite, or too large; nothing was done.
    #[error(
        "what is done to body \"{body}\" must be finite, and change its velocities by {LARGEST:e} at most"
    )]
    BadIntervention {
        /// Name of the body.
        body: String,
    },
    /// A plan cannot be followed; nothing was run.
    #[error("the plan's {field} must be {rule}, got {value} s")]
    BadPlan {
        /// Which of its numbers.
        field: &'static str,
        /// What it must be.
        rule: &'static str,
        /// What it is [s].
        value: f64,
    },
    /// The advance stopped for a reason that has no name here.
    #[error(transparent)]
    Advance(AdvanceError),
}

impl RunError {
    /// How the run is summed up.
    #[must_use]
    pub fn status(&self) -> Status {
        match self {
            Self::Contacts { source, .. } if matches!(**source, SolveError::Infeasible(_)) => {
                Status::Infeasible
            }
            Self::Impact { source: ImpactError::Infeasible { .. }, .. } => Status::Infeasible,
            Self::Interrupted { .. } => Status::Interrupted,
            _ => Status::Stuck,
        }
    }

    /// When it stopped [s].
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Impact { time, .. }
            | Self::Contacts { time, .. }
            | Self::StepCollapsed { time, .. }
            | Self::RanAway { time, .. }
            | Self::Unresolved { time, .. }
            | Self::Crawls { time, .. }
            | Self::Astray { time, .. }
            | Self::Pressed { time, .. }
            | Self::Interrupted { time }
            | Self::Stuck { time, .. } => Some(*time),
            Self::NotATime
            | Self::NoSuchBody { .. }
            | Self::Immovable { .. }
            | Self::BadIntervention { .. }
            | Self::BadPlan { .. }
            | Self::Advance(_) => None,
        }
    }

    pub(crate) fn new(error: AdvanceError, name: impl Fn(BodyId) -> String) -> Self {
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
            AdvanceError::StepCollapsed { time, step, bodies, laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::StepCollapsed { time, step, bodies, laws }
            }
            AdvanceError::RanAway { time, speed, bodies } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::RanAway { time, speed, bodies }
            }
            AdvanceError::Unresolved { time, length, bodies, laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::Unresolved { time, length, bodies, laws }
            }
            AdvanceError::Crawls { time, step, duration, bodies, laws } => {
                let bodies = bodies.into_iter().map(name).collect();
                Self::Crawls { time, step, duration, bodies, laws }
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

/// The force laws that may be to blame.
fn under(laws: &[String]) -> String {
    if laws.is_empty() { String::new() } else { format!(" under the forces of {}", quoted(laws)) }
}

/// Names in a message: all of a few, the first of many.
/// Names the two bodies of the row that a message has named by its index.
fn on_row(between: &Option<[String; 2]>) -> String {
    between.as_ref().map_or_else(String::new, |[a, b]| format!("; the row is of \"{a}\" and \"{b}\""))
}

fn quoted(names: &[String]) -> String {
    let (shown, rest) = names.split_at(names.len().min(MOST_NAMES));
    let shown = shown.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    if rest.is_empty() { shown } else { format!("{shown} and {} more", rest.len()) }
}

#[cfg(test)]
mod tests {
    use super::{MOST_NAMES, RunError};

    /// The message of a step of so many bodies that has fallen to nothing.
    fn message(bodies: usize) -> String {
        let bodies = (0..bodies).map(|index| format!("disc {index}")).collect();
        RunError::StepCollapsed { time: 1.5, step: 1e-15, bodies, laws: Vec::new() }.to_string()
    }

    #[test]
    fn a_message_names_no_more_bodies_than_one_reads() {
        assert_eq!(message(2), "at 1.5 s the step of \"disc 0\", \"disc 1\" fell to 1e-15 s");
        assert!(message(MOST_NAMES).contains("\"disc 11\" fell"));
        assert!(message(200).contains("\"disc 11\" and 188 more fell"));
    }
}
