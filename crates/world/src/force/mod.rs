//! Force laws: forces and torques on bodies beside uniform gravity and damping.
//!
//! Each law is a type that implements [`ForceLaw`]: [`MutualGravity`], [`Spring`], [`Dashpot`], [`ConstantForce`], [`PointForce`],
//! [`RotatingForce`], [`CoordinateSpring`], [`CoordinateDamper`], or yours. [`Varied`] lets a law vary with the time. The module `anchor` holds points that move with bodies, `sum` adds up several laws.
//!
//! A law has a potential V only if its force is -dV/dx at all times, over all positions and angles x. Mutual gravity
//! and springs have one; a constant force has none, although its size never changes: whether it turns with its body or
//! acts at a point fixed in the world, it does work around a closed loop of positions and angles.
//!
//! # A law of your own
//!
//! ```
//! use halfgap::force::{ForceLaw, Snapshot, Wrenches};
//! use halfgap::geometry::{DVec2, Shape};
//! use halfgap::{BodyId, BodySpec, BodyState, WorldBuilder, WorldSettings};
//! use std::sync::Arc;
//!
//! /// Pulls a body back to the origin with a force of 3 N per metre.
//! #[derive(Debug)]
//! struct Well([BodyId; 1]);
//!
//! impl ForceLaw for Well {
//!     fn name(&self) -> &str {
//!         "well"
//!     }
//!     fn bodies(&self) -> &[BodyId] {
//!         &self.0
//!     }
//!     fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
//!         let position = now.body(self.0[0]).pose.position;
//!         wrenches.add_force(self.0[0], -3.0 * position, DVec2::ZERO);
//!     }
//!     fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
//!         Some(1.5 * now.body(self.0[0]).pose.position.length_squared())
//!     }
//! }
//!
//! let mut builder = WorldBuilder::new(WorldSettings::default());
//! let start = BodyState { position: DVec2::new(2.0, 0.0), ..BodyState::default() };
//! let ball = builder.add(BodySpec::movable("ball", Shape::disc(0.5)?, 1.0, start));
//! builder.add_force(Arc::new(Well([ball])));
//! assert_eq!(builder.build()?.energy().potential, 6.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod anchor;
mod constant;
mod coordinate_spring;
mod dashpot;
#[cfg(test)]
mod law_check;
mod mutual_gravity;
mod point_force;
mod rotating;
mod spring;
mod sum;
mod vary;

pub use constant::{ConstantForce, ForceFrame, Push};
pub use coordinate_spring::{CoordinateDamper, CoordinateSpring};
pub use dashpot::Dashpot;
pub use halfgap_advance::rigid::{ForceLaw, Snapshot, Wrench, Wrenches};
pub use halfgap_collision::{Anchor, Moving};
pub use mutual_gravity::MutualGravity;
pub use point_force::{PointForce, PointPush};
pub use rotating::{RotatingForce, Turning};
pub use spring::Spring;
pub use vary::{Varied, Vary, VaryError};
/// Names a force law of a world: one that was removed keeps its id, which is not given again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ForceId(pub(crate) usize);

pub(crate) use sum::{potential_of, wrenches_of};
