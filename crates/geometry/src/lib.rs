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
//! `pose` places a body, by the `sine` of its angle; `line`, `arc` and `edge` are the edges, `crossing` and
//! `edge_distance` the common points and the distance of two edges; `path` chains edges, `outline` orients paths,
//! `simple` refuses paths that meet, `mass` integrates over their inside; `shape` bundles outline, features and tree,
//! `pool` keeps equal shapes once; `build`, `build_mechanism`, `build_gear`, `build_wheel` and `build_cam` are the ready-made shapes, `fit`
//! makes arcs of curves. `feature` and `gap`
//! measure how far apart two features are; `tree` finds the features near a place. The queries on shapes are
//! `inside`, `nearest`, `ray`, `distance` (of two shapes), `bounds` and `swept` (boxes).
//!
//! # Examples
//!
//! ```
//! use halfgap_geometry::{DVec2, Pose, Shape};
//!
//! let roller = Shape::disc(0.5)?;
//! let floor = Shape::block(4.0, 1.0)?;
//! let apart = roller.distance(&Pose::new(DVec2::new(0.0, 1.25), 0.0), &floor, &Pose::IDENTITY);
//! assert!((apart.distance - 0.25).abs() < 1e-15);
//! assert!((floor.mass_properties().moment_per_mass - (16.0 + 1.0) / 12.0).abs() < 1e-15);
//! # Ok::<(), halfgap_geometry::ShapeError>(())
//! ```

#![forbid(unsafe_code)]

mod arc;
mod bounds;
mod build;
mod build_cam;
mod build_gear;
mod build_mechanism;
mod build_wheel;
mod crossing;
mod distance;
mod edge;
mod edge_distance;
mod edge_spec;
mod error;
mod feature;
mod fit;
mod gap;
mod inside;
mod line;
mod mass;
mod nearest;
mod outline;
mod path;
mod pool;
mod pose;
mod ray;
mod rounded;
#[cfg(feature = "save")]
mod saved;
mod shape;
mod simple;
mod sine;
mod swept;
mod tree;

pub use arc::Arc;
pub use bounds::Aabb;
pub use build_cam::Lift;
pub use build_gear::Teeth;
pub use build_wheel::{GenevaWheel, Lean};
pub use crossing::edge_crossings;
pub use distance::{Relation, ShapeDistance};
pub use edge::Edge;
pub use edge_distance::{ClosestPair, edge_distance};
pub use edge_spec::EdgeSpec;
pub use error::{ArcError, EdgeError, LineError, ShapeError};
pub use feature::{
    DirectionRange, EdgeId, Feature, FeatureId, FeatureKind, FeatureSource, LineFeature, RoundFeature,
};
pub use fit::{CurvePoint, FitError, fit_arcs};
pub use gap::{CenterGap, GapKind, GapSample, LineGap, PairKind, pair_kind, touching_distance};
pub use glam::DVec2;
pub use line::Line;
pub use mass::MassProperties;
pub use nearest::NearestPoint;
pub use path::{Path, PathSpec};
pub use pool::ShapePool;
pub use pose::{Pose, Rotation};
pub use ray::{Ray, RayHit};
pub use rounded::{Rounded, RoundedPlace};
pub use shape::Shape;
pub use swept::MotionBound;
pub use tree::{FeatureTree, Node};
