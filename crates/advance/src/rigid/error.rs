//! Reasons why the advance of rigid bodies stops.

use crate::rigid::parts::PartsError;
use halfgap_collision::{BodyId, Collision, ConnectorId};
use halfgap_contact::{ImpactError, Problem, SolveError};
use halfgap_geometry::{Rounded, RoundedPlace};

/// The two bodies of a contact, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
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

/// Reason why the advance stopped. Times are on the system's clock.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum AdvanceError {
    /// The impulses of an impact cannot be found.
    #[error("at {} s, between bodies {bodies:?}: {source}", RoundedPlace(*time))]
    Impact {
        /// Time of the impact [s].
        time: f64,
        /// The bodies that take part.
        bodies: Vec<BodyId>,
        /// The two bodies of the row that the error names; `None` if it names none.
        between: Option<Between>,
        /// Error of the impact law.
        source: ImpactError,
    },
    /// The forces of contacts and connectors cannot be found.
    #[error("at {} s, between bodies {bodies:?}: {source}", RoundedPlace(*time))]
    Contacts {
        /// Time at which forces were sought [s].
        time: f64,
        /// The bodies that take part.
        bodies: Vec<BodyId>,
        /// The two bodies of the row that the error names; `None` if it names none.
        between: Option<Between>,
        /// The problem that the solver was given last: accelerations [m/s^2] of the rows by their forces [N].
        problem: Box<Problem>,
        /// Error of the solver.
        source: Box<SolveError>,
    },
    /// The step size of the integrator has fallen to nothing: forces grow beyond all bounds or are not numbers.
    #[error(
        "at {} s the step of bodies {bodies:?} fell to {} s; forces on them: {force_laws:?}",
        RoundedPlace(*time),
        Rounded(*step)
    )]
    StepCollapsed {
        /// Time at the start of the step [s].
        time: f64,
        /// Length of the step [s].
        step: f64,
        /// The bodies that share the step.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// A drive moves a linkage into its dead point, where nothing moves as the drive asks for.
    #[error("at {} s the drive {drive:?} has moved bodies {bodies:?} into a dead point", RoundedPlace(*time))]
    DeadPoint {
        /// Time at the start of the step [s].
        time: f64,
        /// The drive.
        drive: ConnectorId,
        /// The bodies that share the step.
        bodies: Vec<BodyId>,
    },
    /// A rope over pulleys has been pulled in on one side.
    #[error("at {} s nothing is left of one side of the pulley {pulley:?}", RoundedPlace(*time))]
    RanOut {
        /// Time at the start of the step [s].
        time: f64,
        /// The pulley.
        pulley: ConnectorId,
        /// The body at the end of that side.
        body: BodyId,
    },
    /// Steps of a method without an error estimate are too long: they have made bodies faster than anything in the
    /// scene explains.
    #[error(
        "at {} s steps without an error estimate have made bodies {bodies:?} {} m/s fast",
        RoundedPlace(*time),
        Rounded(*speed)
    )]
    RanAway {
        /// Time at the start of the step [s].
        time: f64,
        /// Speed of the fastest point [m/s].
        speed: f64,
        /// The bodies that share the step.
        bodies: Vec<BodyId>,
    },
    /// Forces vary over so short a length that rounding of positions, or the gap that contacts have, would create
    /// energy.
    #[error(
        "at {} s the forces on bodies {bodies:?} vary over {} m, too little for their coordinates or gaps: {force_laws:?}",
        RoundedPlace(*time),
        Rounded(*length)
    )]
    Unresolved {
        /// Time at the start of the step [s].
        time: f64,
        /// Length [m] over which forces vary by their own size.
        length: f64,
        /// The two bodies at this distance from each other, or, where there are none, all that share the step.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// Steps have become so short that the duration told to [`set_duration`](crate::rigid::RigidSystem::set_duration)
    /// would take a hopeless number of them, with no impact in between. The system is intact: with a lesser
    /// duration set, it can be advanced further.
    #[error(
        "at {} s the steps of bodies {bodies:?} are {} s long: too many of them for {duration} s; forces on them: \
         {force_laws:?}",
        RoundedPlace(*time),
        Rounded(*step)
    )]
    Crawls {
        /// Time at the start of the last step [s].
        time: f64,
        /// Mean length of the last steps [s].
        step: f64,
        /// Time to be simulated in all [s].
        duration: f64,
        /// The bodies that share the steps.
        bodies: Vec<BodyId>,
        /// Names of the force laws that act on them.
        force_laws: Vec<String>,
    },
    /// A body turns so fast that the duration told to [`set_duration`](crate::rigid::RigidSystem::set_duration) would
    /// take a hopeless number of turns, each of which has to be followed: bodies are near that it may hit, or ties and
    /// forces act on it. The system is intact: with a lesser duration set, it can be advanced further.
    #[error(
        "at {} s body {} turns at {} rad/s: too many turns in {duration} s",
        RoundedPlace(*time),
        body.0,
        Rounded(*angular_velocity)
    )]
    TooFast {
        /// Time of the error [s].
        time: f64,
        /// The body.
        body: BodyId,
        /// Its angular velocity [rad/s].
        angular_velocity: f64,
        /// Time to be simulated in all [s].
        duration: f64,
    },
    /// A body is held between others of which one is too heavy for it: the forces that pass through it would be lost in
    /// rounding.
    #[error(
        "at {} s body {} of {} kg is held between body {} of {} kg and another",
        RoundedPlace(*time),
        light.0,
        masses[0],
        heavy.0,
        masses[1]
    )]
    Squeezed {
        /// Time of the error [s].
        time: f64,
        /// The light body.
        light: BodyId,
        /// The heavy body.
        heavy: BodyId,
        /// Masses of the two [kg].
        masses: [f64; 2],
    },
    /// Only where contacts carry impulses only: two bodies that are pressed as far into each other as they may sink
    /// collide again and again within a step. In shorter steps they sink less.
    #[error(
        "at {} s bodies {} and {} have collided {events} times, pressed into each other, within a step of {} s",
        RoundedPlace(*time),
        between.primary.0,
        between.normal.0,
        Rounded(*step)
    )]
    Pressed {
        /// Time of the last collision [s].
        time: f64,
        /// The bodies that collided last.
        between: Between,
        /// Number of collisions of sunk contacts within the step.
        events: u32,
        /// Time after which sunk contacts are put back [s].
        step: f64,
    },
    /// Two bodies collide again and again without any time going by.
    #[error(
        "stuck at {} s: bodies {} and {} collided {events} times without any time going by",
        RoundedPlace(*time),
        between.primary.0,
        between.normal.0
    )]
    Stuck {
        /// Time of the collisions [s].
        time: f64,
        /// The bodies that collide.
        between: Between,
        /// Number of collisions.
        events: u32,
    },
    // The last two refuse what is asked: no system ends with them, so they are not saved. They stand last, as skipped
    // variants would be counted by who writes the others, and not by who reads them.
    /// The parts or settings of a system were refused.
    #[error(transparent)]
    #[cfg_attr(feature = "save", serde(skip))]
    Parts(#[from] PartsError),
    /// A time or a velocity change of an intervention is not a finite number: nothing was done.
    #[error("the {quantity} of an intervention must be finite, got {value}")]
    #[cfg_attr(feature = "save", serde(skip))]
    BadIntervention {
        /// Name of the quantity.
        #[cfg_attr(feature = "save", serde(skip))]
        quantity: &'static str,
        /// Its value, in s, m/s or rad/s.
        value: f64,
    },
}
