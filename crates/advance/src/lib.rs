//! Event-driven advance: predicts events, handles them in order of time, and integrates motions in between.
//!
//! *Invariant*: this crate knows the `ForceLaw` trait, uniform acceleration and linear damping, but no other law, and
//! no scene files; without the feature `rigid` (on by default) it does not even know bodies, and depends on nothing but
//! an error macro and libm.
//!
//! A system proposes motions that can be evaluated at any time (segments) and keeps its predicted events in an
//! [`EventQueue`]; [`advance_until`] handles them in order of their [`Time`], [`advance_while`] as long as its caller
//! wants. Outputs are read from segments and change nothing.
//!
//! ```
//! use halfgap_advance::{EventDriven, EventQueue, SourceId, Time, advance_until};
//! use std::convert::Infallible;
//!
//! /// A clock that strikes each second.
//! struct Clock(EventQueue);
//!
//! impl EventDriven for Clock {
//!     type Report = Time;
//!     type Error = Infallible;
//!
//!     fn next_event(&self) -> Option<Time> {
//!         self.0.first().map(|event| event.time)
//!     }
//!
//!     fn handle_next(&mut self) -> Result<Option<Time>, Infallible> {
//!         let Some(event) = self.0.first() else { return Ok(None) };
//!         self.0.set(event.source, event.time.plus(1.0));
//!         Ok(Some(event.time))
//!     }
//! }
//!
//! let mut clock = Clock(EventQueue::new());
//! clock.0.set(SourceId(0), Time::from_seconds(1.0));
//! let mut strikes = 0;
//! advance_until(&mut clock, Time::from_seconds(12.5), |_, _| strikes += 1)?;
//! assert_eq!(strikes, 12);
//! # Ok::<(), Infallible>(())
//! ```
//!
//! # Code map
//!
//! `time` is a clock that loses no digits, `queue` the event queue, `system` the trait of event-driven systems and the
//! loop over it; [`ode`] integrates motions that have no closed form; `rigid` implements the trait for rigid bodies:
//! free flight in closed form, groups coupled by contacts, connectors and force laws by an integrator, impacts and all
//! changes of contact as events; `stepping` advances them by steps of one length instead, with friction.
//!
//! The examples `bouncing_point` (closed form) and `stick_slip` (integrated) are systems that need this crate alone,
//! without its features.

#![forbid(unsafe_code)]

pub mod ode;
mod queue;
#[cfg(feature = "rigid")]
pub mod rigid;
#[cfg(feature = "rigid")]
pub mod stepping;
mod system;
mod time;

pub use queue::{EventQueue, Scheduled, SourceId};
pub use system::{EventDriven, advance_until, advance_watched, advance_while};
pub use time::Time;
