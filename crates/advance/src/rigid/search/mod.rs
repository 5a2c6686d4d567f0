//! The search for the next contact of each pair, and for ropes that go taut.
//!
//! **Invariant**: on return every pair is clear until the time that it says, by the motions known now; what is not clear has
//! an entry in the agenda. The search reads motions, contacts and connectors; it writes predictions, boxes and lanes, and
//! nothing that moves a body. It knows no group and no force.
//!
//! `searching`: what it works on · `neighbourhood`: its data · `boxes`: a body's room to move · `lane`: a body's motion,
//! packed · `predictions`: when a pair meets · `horizon`: how far ahead it looks · `ropes` · `ghost_corner`: corners
//! that pass over each other · `dead_point`: features that turn back before they touch · `marks`: a set of bodies.

pub(super) mod boxes;
pub(super) mod dead_point;
pub(super) mod ghost_corner;
pub(super) mod horizon;
pub(super) mod lane;
pub(super) mod marks;
pub(super) mod neighbourhood;
pub(super) mod predictions;
pub(super) mod ropes;
pub(super) mod searching;
