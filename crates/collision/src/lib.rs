//! Contacts of moving bodies: pairs that touch, records of their contacts, and times of first contact.
//!
//! *Invariant*: this crate knows bodies, motions and thresholds, but no forces and no solvers.
//!
//! ```
//! use halfgap_collision::geometry::{DVec2, Shape};
//! use halfgap_collision::{
//!     BodyState, Flight, MovingShape, Search, SearchSettings, Tolerances, first_contact,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A disc falls onto a fixed one right below it, half a metre away.
//! let disc = Shape::disc(0.5)?;
//! let start = BodyState { position: DVec2::new(0.0, 1.5), ..BodyState::default() };
//! let (fall, rest) = (Flight::new(start, DVec2::new(0.0, -9.81), 0.0, 0.0), Flight::fixed(DVec2::ZERO, 0.0));
//! let [falling, fixed] = [&fall, &rest].map(|motion| MovingShape { shape: &disc, motion, offset: 0.0 });
//! let tolerances = Tolerances { target_gap: 1e-9, accuracy: 6e-10, velocity_tol: 1e-9 };
//! let Search::Contact(contact) =
//!     first_contact(&falling, &fixed, 5.0, &tolerances, &SearchSettings::default())
//! else {
//!     panic!("they meet");
//! };
//! assert!((contact.time - (2.0 * 0.5f64 / 9.81).sqrt()).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! # Conventions
//!
//! SI units, radians, counter-clockwise positive. Every contact is a gap between a *primary* body and a *normal* body;
//! the unit normal points from the normal body to the primary one, and a negative normal velocity closes the gap.
//! Times within a motion are offsets [s] from its start, so that long runs lose no digits.
//!
//! # Code map
//!
//! `motion` and `flight` describe the motion of a body during an interval, `body` its shape and inertia. `record` is
//! the collision record, with its `tolerances` and its `zone`; `gap_state` holds the predicates by which an advance
//! decides, `estimate` the first guess of the time of an event; `kinematics` gives the gap's rate, Jacobian and
//! acceleration term, `tangent` those of the slip along it, `rolling` those of the relative rotation. `detect` finds the
//! records of two bodies at one moment and `merge` drops doubles. `first_contact` finds the time at which two moving bodies first close to their target gap: by `closed` forms (roots of a `quadratic`)
//! where motions are polynomial, by the `march` along second-order bounds otherwise. `connector` ties bodies by rows
//! that are gaps too; `motion_law` tells what drives a coordinate, or moves a body. `broad` finds the bodies whose boxes overlap.

#![forbid(unsafe_code)]

mod body;
mod broad;
mod closed;
mod connector;
mod detect;
mod estimate;
mod first_contact;
mod flight;
mod gap_state;
mod kinematics;
mod march;
mod merge;
mod motion;
mod motion_law;
mod near;
mod quadratic;
mod record;
mod rolling;
mod spline_seconds;
mod tangent;
mod tolerances;
mod zone;

pub use body::{Body, BodyId};
pub use broad::BroadPhase;
pub use connector::{
    Alignment, Anchor, Connector, ConnectorError, ConnectorId, ConnectorKind, ConnectorSample, Coordinate,
    RailError, RailHint, RailKnot, RailPath, RailPlace, Rope, RopeSearch, SlotFrame, SplineJoint,
    Surroundings, Turn, rope_contact,
};
pub use detect::{
    Moment, contact_levers, detect_features_of_pair, detect_pair, pair_tolerances, record_features,
};
pub use estimate::{EstimatePoint, estimate_target_time};
pub use first_contact::{
    FeatureRule, FirstContact, MovingShape, PairSearch, Search, SearchSettings, disc_contact, first_contact,
    search_step,
};
pub use flight::Flight;
pub use gap_state::GapState;
pub use halfgap_geometry as geometry;
pub use kinematics::{Arms, BodyAcceleration, GapKinematics};
pub use merge::{is_same_collision, merge_collisions};
pub use motion::{Ball, BodyState, Motion, MotionBounds, Moving, Polynomial};
pub use motion_law::{
    BodyMotion, MotionLaw, MotionMoment, MotionSpread, MotionTable, MovedPath, Oscillation, PrescribedMotion,
    TableError,
};
pub use near::{Nearness, visit_near_features};
pub use quadratic::first_closing_time;
pub use record::{Collision, ContactGeometry, ContactMotion, Detector, Participant, Parties, Response, Site};
pub use rolling::rolling_radius;
pub use tangent::{TangentRow, Touch, turned};
pub use tolerances::Tolerances;
pub use zone::Zone;
