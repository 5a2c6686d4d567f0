//! Exact planar shapes whose edges are straight lines and true circular arcs, and the gaps between them.
//!
//! *Invariant*: this crate knows no time, no mass, no velocity, and no threshold for touching.
//!
//! # Conventions
//!
//! * Lengths in metres, angles in radians, counter-clockwise positive, y up.
//! * A path runs with the solid on its left: outer paths counter-clockwise, holes clockwise (shapes turn paths round
//!   that were drawn the other way). The outward normal is on the right of the direction of travel.
//! * Signed radius: a vertex has 0, a convex arc `+r`, a concave arc `-r`.
//! * The gap of two features is positive when they are apart; its normal points from the *normal* feature to the
//!   *primary* one.
//!
//! # Code map
//!
//! `pose` places a body; `line`, `arc` and `edge` are the edges; `path` chains them, `outline` orients and validates
//! paths, `mass` integrates over them, and `shape` bundles outline, features and tree. `feature` and `gap` answer how
//! far apart two features are; `tree` finds the features near a place.

mod arc;
mod bounds;
mod build;
mod build_mechanism;
mod crossing;
mod edge;
mod edge_distance;
mod error;
mod feature;
mod gap;
mod line;
mod mass;
mod outline;
mod path;
mod pose;
mod shape;
mod simple;
mod tree;

pub use arc::Arc;
pub use bounds::Aabb;
pub use crossing::edge_crossings;
pub use edge::Edge;
pub use edge_distance::{ClosestPair, edge_distance};
pub use error::{ArcError, LineError, ShapeError};
pub use feature::{
    DirectionRange, Feature, FeatureId, FeatureKind, FeatureSource, LineFeature, RoundFeature,
};
pub use gap::{CenterGap, GapKind, GapSample, LineGap, PairKind, pair_kind};
pub use glam::DVec2;
pub use line::Line;
pub use mass::MassProperties;
pub use path::{EdgeSpec, Path, PathSpec};
pub use pose::{Pose, Rotation};
pub use shape::Shape;
pub use tree::{FeatureTree, Node};
