//! Constraint rows made from collision records: the only module here that sees collisions.

use crate::problem::InverseInertia;
use halfgap_collision::{BodyId, Collision};

/// One scalar constraint between two bodies: its rate is J v over (vA, wA, vB, wB).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionRow {
    /// The primary and the normal body.
    pub bodies: [BodyId; 2],
    /// J: [1, 1, m, 1, 1, m], three entries a body.
    pub jacobian: [f64; 6],
    /// J M^-1: what a unit impulse changes the six velocities by [1/kg, 1/kg, 1/(kg m), ...].
    pub response: [f64; 6],
    /// Share of the closing speed that is given back, 0 to 1.
    pub elasticity: f64,
    /// Closing speed [m/s] below which the elasticity no longer acts.
    pub velocity_tol: f64,
    /// True if the rate must be zero, false if it must not be negative.
    pub bilateral: bool,
    /// True for what was held until now: if it opens slower than `velocity_tol`, that is what its holding errs by.
    pub held: bool,
    /// Rate [m/s], negative when closing.
    pub rate: f64,
}

impl CollisionRow {
    /// The row of a collision between two bodies of the given inertia (primary, normal).
    #[must_use]
    pub fn of_collision(collision: &Collision, inertia: [InverseInertia; 2]) -> Self {
        let jacobian = collision.motion.kinematics.jacobian;
        Self {
            bodies: collision.bodies(),
            jacobian,
            response: response(&jacobian, inertia),
            elasticity: collision.response.elasticity,
            velocity_tol: collision.tolerances.velocity_tol,
            bilateral: collision.parties.bilateral,
            held: false,
            rate: collision.motion.normal_velocity,
        }
    }

    /// A row that comes from no collision record, as of a connector. The background ([`BodyId::WORLD`]) and
    /// other bodies that nothing moves have an inertia of zeros.
    #[must_use]
    pub fn new(
        bodies: [BodyId; 2],
        jacobian: [f64; 6],
        inertia: [InverseInertia; 2],
        rate: f64,
        elasticity: f64,
        velocity_tol: f64,
        bilateral: bool,
    ) -> Self {
        let response = response(&jacobian, inertia);
        Self { bodies, jacobian, response, elasticity, velocity_tol, bilateral, held: false, rate }
    }

    /// True if its elasticity acts when it closes at a speed [m/s], now or at the start of the impact.
    pub(crate) fn rebounds_at(&self, speed: f64) -> bool {
        speed.max(-self.rate) > self.velocity_tol
    }

    /// Change of this row's rate [m/s] by a unit impulse [N s] along another row: an entry of the Delassus matrix
    /// J M^-1 J^T [1/kg].
    #[must_use]
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

    /// What a unit impulse along the row changes its rate by through each of its bodies alone [1/kg]; they
    /// add up to the row's own coupling.
    #[must_use]
    pub(crate) fn shares(&self) -> [f64; 2] {
        [0, 3].map(|first: usize| (first..first + 3).map(|k| self.jacobian[k] * self.response[k]).sum())
    }

    /// True if the rows act on a common body that can move.
    #[must_use]
    pub fn shares_movable_body(&self, other: &CollisionRow) -> bool {
        let theirs = other.movable_bodies();
        self.movable_bodies().iter().any(|body| body.is_some() && theirs.contains(body))
    }

    /// The bodies that an impulse along the row moves; the background is none of them.
    pub(crate) fn movable_bodies(&self) -> [Option<BodyId>; 2] {
        [0, 1].map(|side| {
            let moves = self.response[3 * side..3 * side + 3].iter().any(|&x| x != 0.0);
            (moves && !self.bodies[side].is_world()).then_some(self.bodies[side])
        })
    }
}

/// J M^-1.
fn response(jacobian: &[f64; 6], [a, b]: [InverseInertia; 2]) -> [f64; 6] {
    let weights =
        [a.inverse_mass, a.inverse_mass, a.inverse_moment, b.inverse_mass, b.inverse_mass, b.inverse_moment];
    std::array::from_fn(|k| jacobian[k] * weights[k])
}
