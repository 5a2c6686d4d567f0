//! Handling of an event. `events` is its order: `region` collects the bodies that touch, `cutting` takes them to the
//! event's time, `impacts` applies impulses (`jams`: large impulses of contacts that cancel each other and can be
//! avoided), `groups` merges and splits groups of bodies (`members`: the bodies, rows and touches of each; `harm`: groups
//! whose rows move bodies into others are made anew).
//! `connectors` predicts when a rope goes taut, `rails` finds where on its rail a point is, `corners` takes it through
//! a corner; `ticks` stands in for forces where contacts carry impulses only. `cause` is the reason of an event, with
//! its buffers. The rows held afterwards are found in `held`.

pub(super) mod changing;
pub(super) mod corners;
pub(super) mod coupling;
pub(super) mod cutting;
pub(super) mod events;
pub(super) mod going_on;
pub(super) mod groups;
pub(super) mod handling;
pub(super) mod harm;
pub(super) mod hops;
pub(super) mod impacting;
pub(super) mod intervention;
pub(super) mod joints;
pub(super) mod life;
pub(super) mod lift;
pub(super) mod members;
pub(super) mod rails;
pub(super) mod resolving;
pub(super) mod rooms;
pub(super) mod rules;
pub(super) mod search_on;
pub(super) mod settling;
pub(super) mod shift;
pub(super) mod telling;
pub(super) mod ticks;
pub(super) mod with_work;
pub(super) mod work;
