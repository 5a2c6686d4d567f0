//! Why the advance of rigid bodies had to stop.

use halfgap_collision::BodyId;
use halfgap_contact::ImpactError;

/// Two bodies, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Between {
    /// The primary body.
    pub primary: BodyId,
    /// The normal body.
    pub normal: BodyId,
}

/// Why the advance stopped. Times are on the system's clock.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// Two bodies would stay in contact.
    #[error(
        "at {time} s bodies {} and {} come to rest on each other: resting contacts are not supported yet",
        between.primary.0, between.normal.0
    )]
    RestingContact {
        /// When [s].
        time: f64,
        /// Which bodies.
        between: Between,
    },
    /// An impact cannot be resolved.
    #[error("at {time} s, between bodies {bodies:?}: {source}")]
    Impact {
        /// When [s].
        time: f64,
        /// Indices of the bodies that take part.
        bodies: Vec<u32>,
        /// Why not.
        source: ImpactError,
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
