//! Which bodies come into contact next, and when. `neighbourhood` is what is known of the bodies; `boxes` are the bodies' room in the broad phase, `pairs`
//! what is known of two bodies near each other (`marks`: a set of bodies), `predictions` ask the
//! collision crate when they touch, `horizon` how far ahead. `rules` say which features of a pair the search
//! leaves alone or lets come nearer: held contacts, corners that pass over each other (`flush`), what only
//! grazes (`graze`).

pub(super) mod boxes;
pub(super) mod flush;
pub(super) mod graze;
pub(super) mod horizon;
pub(super) mod marks;
pub(super) mod neighbourhood;
pub(super) mod pairs;
pub(super) mod predictions;
pub(super) mod rules;
