//! Constraint rows made from collision records: the only module here that sees collisions.

use crate::kind::RowKind;
use crate::problem::InverseInertia;
use halfgap_collision::{BodyId, Collision};

/// One scalar constraint between two bodies of an impact.
///
/// The rate of its gap is J v [m/s] with the velocities v = (vAx, vAy, wA, vBx, vBy, wB) [m/s, m/s, rad/s, ...] of the
/// primary body A and the normal body B.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct CollisionRow {
    /// The primary and the normal body.
    pub bodies: [BodyId; 2],
    /// J [1, 1, m, 1, 1, m]: coefficients of the x, y and angular velocity of the primary, then of the normal body.
    pub jacobian: [f64; 6],
    /// J M^-1 [1/kg, 1/kg, 1/(kg m), ...]: change of the six velocities per unit impulse along the row.
    pub response: [f64; 6],
    /// Restitution [-], 0 to 1: fraction of the closing speed at which the row opens again.
    pub elasticity: f64,
    /// Closing speed [m/s] up to which the elasticity does not act.
    pub velocity_tol: f64,
    /// Which rates are allowed: zero (bilateral), or zero and more (unilateral). Impact laws take no other kinds yet.
    pub kind: RowKind,
    /// True if the row was an active contact before the impact; an opening rate up to `velocity_tol` is then constraint
    /// error, not separation.
    pub was_active: bool,
    /// Rate J v before the impact [m/s], negative when closing.
    pub rate: f64,
}

impl CollisionRow {
    /// Makes the row of a collision record, with the `inertia` of its primary and normal body.
    #[must_use]
    #[inline]
    pub fn of_collision(collision: &Collision, inertia: [InverseInertia; 2]) -> Self {
        let motion = &collision.motion;
        Self {
            elasticity: collision.response.elasticity,
            velocity_tol: collision.tolerances.velocity_tol,
            kind: RowKind::plain(collision.parties.bilateral),
            ..Self::new(collision.bodies(), motion.kinematics.jacobian, inertia, motion.normal_velocity)
        }
    }

    /// Makes a row that comes from no collision record, such as that of a connector: unilateral, without restitution, and
    /// not active before.
    ///
    /// `jacobian` [1, 1, m, 1, 1, m], `inertia` and `rate` [m/s] (negative when closing) are as the fields of
    /// [`CollisionRow`] tell; the other fields can be set. The background ([`BodyId::WORLD`]) and other immovable bodies
    /// have an inertia of zeros.
    #[must_use]
    #[inline]
    pub fn new(bodies: [BodyId; 2], jacobian: [f64; 6], inertia: [InverseInertia; 2], rate: f64) -> Self {
        Self {
            bodies,
            jacobian,
            response: response(&jacobian, inertia),
            elasticity: 0.0,
            velocity_tol: 0.0,
            kind: RowKind::Unilateral,
            was_active: false,
            rate,
        }
    }

    /// True if the rate must be zero (connector), false if it must not be negative (contact).
    #[must_use]
    #[inline]
    pub fn is_bilateral(&self) -> bool {
        self.kind == RowKind::Bilateral
    }

    /// True if the row's elasticity acts when it closes at `speed` [m/s]: that speed, or the closing speed at the start
    /// of the impact, exceeds `velocity_tol`.
    pub(crate) fn rebounds_at(&self, speed: f64) -> bool {
        speed.max(-self.rate) > self.velocity_tol
    }

    /// Change of this row's rate [m/s] by a unit impulse [N s] along another row: an entry of the Delassus matrix
    /// J M^-1 J^T [1/kg].
    #[must_use]
    #[inline]
    pub fn coupling(&self, other: &CollisionRow) -> f64 {
        let mut sum = 0.0;
        for (side, body) in self.bodies.iter().enumerate() {
            for (other_side, other_body) in other.bodies.iter().enumerate() {
                if body == other_body {
                    let (own, theirs) = (&self.jacobian[3 * side..], &other.response[3 * other_side..]);
                    sum += own[0] * theirs[0] + own[1] * theirs[1] + own[2] * theirs[2];
                }
            }
        }
        sum
    }

    /// Change of the row's own rate per unit impulse along it [1/kg], through each of its two bodies alone. The two add
    /// up to its diagonal entry of the Delassus matrix.
    #[must_use]
    pub(crate) fn shares(&self) -> [f64; 2] {
        [0, 3].map(|first: usize| (first..first + 3).map(|k| self.jacobian[k] * self.response[k]).sum())
    }

    /// The bodies that an impulse along the row moves; `None` for an immovable one and for the background.
    pub(crate) fn movable_bodies(&self) -> [Option<BodyId>; 2] {
        [0, 1].map(|side| {
            let moves = self.response[3 * side..3 * side + 3].iter().any(|&x| x != 0.0);
            (moves && !self.bodies[side].is_world()).then_some(self.bodies[side])
        })
    }
}

/// J M^-1.
pub(crate) fn response(jacobian: &[f64; 6], [a, b]: [InverseInertia; 2]) -> [f64; 6] {
    let weights =
        [a.inverse_mass, a.inverse_mass, a.inverse_moment, b.inverse_mass, b.inverse_mass, b.inverse_moment];
    std::array::from_fn(|k| jacobian[k] * weights[k])
}
