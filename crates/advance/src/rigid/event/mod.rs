//! The steps of handling an event: gather, impact, active set, groups, predict.
//!
//! **Invariant**: after an event no active contact pulls, no touching pair closes faster than at rest, every movable body is
//! either in flight or in a group with a segment, and all predictions of the bodies involved are new. It keeps
//! nothing but buffers, and sees all rooms but those that call it: which event it is, it is told (`due`).
//!
//! * velocities: `impacting`, `changing` (active rows change), `resolving`, `steps` (regions whose events accumulate), `intervention` (by the caller), `lift` and `shift`
//!   (sunk bodies are put back);
//! * afterwards: `going_on`, `settling`, `hops` (stilled), `one_gap` (where contacts are held), `corners` (left), `rules` (what the
//!   search skips), `telling`;
//! * groups: `coupling` and `members` (who shares steps), `groups` (made), `life` (from start to end), `cutting`, `rails`
//!   (hints);
//! * `rooms`: all rooms together · `work`: buffers.

pub(super) mod changing;
pub(super) mod corners;
pub(super) mod coupling;
pub(super) mod cutting;
pub(super) mod going_on;
pub(super) mod groups;
pub(super) mod hops;
pub(super) mod impacting;
pub(super) mod intervention;
pub(super) mod jamming;
pub(super) mod life;
pub(super) mod lift;
pub(super) mod members;
pub(super) mod one_gap;
pub(super) mod rails;
pub(super) mod resolving;
pub(super) mod rooms;
pub(super) mod rules;
pub(super) mod settling;
pub(super) mod shift;
pub(super) mod steps;
pub(super) mod telling;
pub(super) mod work;
