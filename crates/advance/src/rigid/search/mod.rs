//! Search for the next contacts: between which bodies, and when. `neighbourhood` holds the data of the bodies; `boxes`
//! are the bodies' room in the broad phase, `pairs` the state of two bodies near each other (`marks`: a set of bodies),
//! `predictions` ask the collision crate when they touch, `horizon` limits how far ahead. `rules` are the features of a
//! pair that the search skips or lets come nearer: held contacts, corners that pass over each other (`flush`), contacts
//! that only graze (`graze`).

pub(super) mod boxes;
pub(super) mod flush;
pub(super) mod graze;
pub(super) mod horizon;
pub(super) mod lane;
pub(super) mod marks;
pub(super) mod neighbourhood;
pub(super) mod predictions;
pub(super) mod ropes;
pub(super) mod searching;
