//! Why the advance of rigid bodies had to stop.

use super::parts::PartsError;
use halfgap_collision::{BodyId, Collision};
use halfgap_contact::{ImpactError, Problem, SolveError};

/// Two bodies, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Between {
    /// The primary body.
    pub primary: BodyId,
    /// The normal body.
    pub normal: BodyId,
}

impl Between {
    pub(crate) fn of(record: &Collision) -> Self {
        let [primary, normal] = record.bodies();
        Self { primary, normal }
    }
}

/// Why the advance stopped. Times are on the system's clock.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// A system cannot be made of what it was to be made of.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// A time or a velocity of an intervention is not a finite number: nothing is done.
    #[error("the {quantity} of an intervention must be finite, got {value}")]
    BadIntervention {
        /// Which.
        quantity: &'static str,
        /// What it is.
        value: f64,
    },
    /// An impact cannot be resolved.
    #[error("at {time} s, between bodies {bodies:?}: {source}")]
    Impact {
        /// When [s].
        time: f64,
        /// The bodies that take part.
        bodies: Vec<BodyId>,
        /// The two bodies of the row that the source names.
        between: Option<Between>,
        /// Why not.
        source: ImpactError,
    },
    /// The forces of contacts and connectors cannot be found.
    #[error("at {time} s, between bodies {bodies:?}: {source}")]
    Contacts {
        /// When [s].
        time: f64,
        /// The bodies that take part.
        bodies: Vec<BodyId>,
        /// The two bodies of the row that the source names.
        between: Option<Between>,
        /// The problem that was to be solved last: accelerations [m/s^2] of the rows by their forces [N].
        problem: Box<Problem>,
        /// Why not.
        source: Box<SolveError>,
    },
    /// The step size of the integrator has fallen to nothing: forces grow beyond all bounds or are not numbers.
    #[error("at {time} s the step of bodies {bodies:?} fell to {step:e} s; forces on them: {laws:?}")]
    StepCollapsed {
        /// When [s].
        time: f64,
        /// Length of the step [s].
        step: f64,
        /// The bodies that share the step.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// Steps of a method without an error estimate have made bodies beyond all measure fast: they are too long for it.
    #[error("at {time} s steps without an error estimate have made bodies {bodies:?} {speed:e} m/s fast")]
    RanAway {
        /// When [s].
        time: f64,
        /// Speed of the fastest point [m/s].
        speed: f64,
        /// The bodies that share the step.
        bodies: Vec<BodyId>,
    },
    /// Forces vary over so short a length that rounding of positions, or the gap that contacts have, makes
    /// energy of nothing.
    #[error(
        "at {time} s the forces on bodies {bodies:?} vary over {length:e} m, too little for their coordinates or gaps: {laws:?}"
    )]
    Unresolved {
        /// When [s].
        time: f64,
        /// Length [m] over which forces vary by as much as they are.
        length: f64,
        /// The two bodies that are so near each other, or all that share the step.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// Steps have become so short that those for all the time that is to be simulated would never come to an
    /// end, and nothing happens meanwhile. Where less is asked for one may go on.
    #[error(
        "at {time} s the steps of bodies {bodies:?} are {step:e} s long: too many of them for {duration} s; forces on them: {laws:?}"
    )]
    Crawls {
        /// When [s].
        time: f64,
        /// Mean length of the last steps [s].
        step: f64,
        /// How long is to be simulated [s].
        duration: f64,
        /// The bodies that share the steps.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        laws: Vec<String>,
    },
    /// Where contacts carry impulses only: two bodies are pressed as far into each other as they may sink,
    /// and collide again and again within a step. In shorter steps they sink less.
    #[error(
        "at {time} s bodies {} and {} have collided {events} times, pressed into each other, within a step of {step:e} s",
        between.primary.0, between.normal.0
    )]
    Pressed {
        /// When [s].
        time: f64,
        /// Which bodies.
        between: Between,
        /// How many times those collided that had sunk.
        events: u32,
        /// After how long what has sunk is put back [s].
        step: f64,
    },
    /// The same two bodies collide again and again without any time going by.
    #[error(
        "stuck at {time} s: bodies {} and {} collided {events} times without any time going by",
        between.primary.0, between.normal.0
    )]
    Stuck {
        /// When [s].
        time: f64,
        /// Which bodies.
        between: Between,
        /// How many times.
        events: u32,
    },
}
