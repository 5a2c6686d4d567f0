//! Which bodies come into contact next, and when. `boxes` are the bodies' room in the broad phase, `pairs`
//! what is known of two bodies near each other (`by_body`, `marks`: lists of them), `predictions` ask the
//! collision crate when they touch, `horizon` how far ahead. `rules` say which features of a pair the search
//! leaves alone or lets come nearer: held contacts, corners that pass over each other (`flush`), what only
//! grazes (`graze`).

pub(super) mod boxes;
pub(super) mod by_body;
pub(super) mod flush;
pub(super) mod graze;
pub(super) mod horizon;
pub(super) mod marks;
pub(super) mod pairs;
pub(super) mod predictions;
pub(super) mod rules;
