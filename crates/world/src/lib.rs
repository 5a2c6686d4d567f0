//! Exact, fast 2D rigid-body mechanics with true circular arcs.
//!
//! A [`World`] is a set of bodies in motion, built in code by a [`WorldBuilder`] or (feature `scene`, on by default)
//! from a scene file. It advances from event to event; reading it in between changes nothing. Bodies fly,
//! collide, rest and slide on each other; connectors ([`ConnectorSpec`]) tie them, forces ([`force`]) move them.
//! [`Event`]s report impacts and contacts that begin or end; [`World::contact_forces`] gives the forces that hold,
//! [`World::ledger`] where the energy went; [`World::intervene`] changes velocities from outside; `World::save` (feature
//! `save`, on by default) writes a world to bytes, from which it goes on. [`AdvanceBy::Steps`]
//! advances it by steps instead, with friction, which events do not know yet.
//!
//! *Invariant*: this crate prints nothing, and leaves geometry, collisions, contacts and events to the layers below.
//!
//! ```
//! use halfgap::geometry::{DVec2, Shape};
//! use halfgap::{BodySpec, BodyState, WorldBuilder, WorldSettings};
//!
//! let mut builder = WorldBuilder::new(WorldSettings::default());
//! builder.add(BodySpec::fixed("floor", Shape::block(10.0, 1.0)?, DVec2::new(0.0, -0.5)));
//! let start = BodyState { position: DVec2::new(0.0, 2.0), ..BodyState::default() };
//! let ball = builder.add(BodySpec::movable("ball", Shape::disc(0.5)?, 1.0, start));
//! builder.add_gravity(ball, DVec2::new(0.0, -10.0));
//!
//! let mut world = builder.build()?;
//! let mut impacts = 0;
//! world.advance_to(2.0, &mut |_| impacts += 1)?;
//! assert_eq!(impacts, 2);
//! assert!((world.energy().total() - 20.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! On wasm the default feature `qp` needs wasm-bindgen; the rest of the crate does not.

#![forbid(unsafe_code)]

mod advance;
#[cfg(feature = "scene")]
mod build;
mod builder;
#[cfg(feature = "scene")]
mod check;
mod connector;
#[cfg(feature = "scene")]
mod estimate;
mod event;
mod finding;
pub mod force;
mod force_change;
mod intervention;
mod invariant_monitor;
mod ledger;
#[cfg(feature = "scene")]
mod names;
mod near;
mod overlap;
#[cfg(feature = "scene")]
pub mod picture;
#[cfg(feature = "scene")]
mod probe;
mod query;
#[cfg(feature = "scene")]
mod recording;
#[cfg(feature = "scene")]
mod result;
mod rigid_settings;
#[cfg(feature = "scene")]
mod run;
mod run_error;
#[cfg(feature = "save")]
mod saving;
#[cfg(feature = "scene")]
pub mod scene;
mod settings;
mod start;
mod strategy;
mod unmeant;
mod world;
mod world_error;

pub use builder::{BodySpec, WorldBuilder};
#[cfg(feature = "scene")]
pub use check::{CheckReport, check};
pub use connector::{ConnectorSpec, JointSpring, Limits, Motor, OnCoordinate};
#[cfg(feature = "scene")]
pub use estimate::{Difference, ErrorEstimate, FrictionThreshold, TimedDifference, estimate_error};
pub use event::{ContactEvent, ContactForce, ContactFriction, Event, Impact, ImpactRow};
pub use halfgap_advance::rigid::{Remedy, RemedyCounts, RemedySet};
pub use halfgap_collision::{
    Anchor, BodyId, BodyMotion, BodyState, Connector, ConnectorError, ConnectorId, ConnectorKind, Coordinate,
    MotionLaw, MotionMoment, MotionSpread, MotionTable, Oscillation, PrescribedMotion, RailError, RailPath,
    SlotFrame, TableError, Tolerances, Turn,
};

pub use finding::Finding;
pub use halfgap_advance::rigid::{PairRule, Surface};
pub use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};
pub use halfgap_geometry as geometry;
pub use intervention::Intervention;
pub use ledger::{LawWork, Ledger};
#[cfg(feature = "scene")]
pub use names::{short_names, short_text};
#[cfg(feature = "scene")]
pub use probe::{Probe, ProbeKind, ProbeTable, Quantity};
pub use query::WorldHit;
#[cfg(feature = "scene")]
pub use recording::{ContactChange, ContactRecord, Frame, RecordedBody, Recording, csv_field};
#[cfg(feature = "scene")]
pub use result::{EnergyResult, ResultScales, RunResult, StatisticsResult};
#[cfg(feature = "scene")]
pub use run::{Progress, Reached, Record, RunPlan, RunReport, run, unwatched};
pub use run_error::{Outcome, RunError};
#[cfg(feature = "save")]
pub use saving::{LoadError, SaveError};
pub use settings::{
    AdvanceBy, DEFAULT_TOLERANCE, Integrator, LONGEST_STEP, Stabilization, ToleranceOverrides, WorldSettings,
};
pub use world::{Energy, Inertia, Statistics, World};
pub use world_error::{ConnectorName, WorldError};
