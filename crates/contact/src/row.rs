//! Constraint rows made from collision records: the only module here that sees collisions.

use crate::kind::RowKind;
use crate::problem::InverseInertia;
use halfgap_collision::{BodyId, Collision};

/// The third side of a row: the angular velocity of a body that is neither its primary nor its normal one, as of the carrier of a gear.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct CollisionThird {
    /// The body.
    pub body: BodyId,
    /// Coefficient \[m\] of its angular velocity in the rate of the row.
    pub jacobian: f64,
    /// Change of its angular velocity per unit impulse along the row [1/(kg m)].
    pub response: f64,
}

impl CollisionThird {
    /// Makes the third side of a row, with the coefficient \[m\] of the angular velocity of its body and the inertia of that.
    #[must_use]
    #[inline]
    pub fn new(body: BodyId, jacobian: f64, inertia: InverseInertia) -> Self {
        Self { body, jacobian, response: jacobian * inertia.inverse_moment }
    }
}

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
    /// A third body on whose angular velocity the rate depends; none for a contact.
    pub third: Option<CollisionThird>,
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
            third: None,
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
        if self.third.is_some() || other.third.is_some() { sum + self.coupling_by_thirds(other) } else { sum }
    }

    /// The part of the coupling with another row that goes through a third body of either.
    fn coupling_by_thirds(&self, other: &CollisionRow) -> f64 {
        let on_sides = |row: &Self, entries: &[f64; 6], body: BodyId| -> f64 {
            (0..2).filter(|&side| row.bodies[side] == body).map(|side| entries[3 * side + 2]).sum()
        };
        let of_own = self.third.map_or(0.0, |own| {
            let of_both = other.third.filter(|theirs| theirs.body == own.body);
            let of_theirs = of_both.map_or(0.0, |theirs| theirs.response);
            own.jacobian * (on_sides(other, &other.response, own.body) + of_theirs)
        });
        let of_other =
            other.third.map_or(0.0, |theirs| on_sides(self, &self.jacobian, theirs.body) * theirs.response);
        of_own + of_other
    }

    /// The body that an impulse along the row turns by its third side.
    #[must_use]
    pub(crate) fn movable_third(&self) -> Option<BodyId> {
        self.third.filter(|third| third.response != 0.0 && !third.body.is_world()).map(|third| third.body)
    }

    /// The square of the row: its own coupling, as the sum over its entries [1/kg].
    #[must_use]
    pub(crate) fn square(&self) -> f64 {
        let of_two: f64 = self.jacobian.iter().zip(&self.response).map(|(j, r)| j * r).sum();
        self.third.map_or(of_two, |third| of_two + third.jacobian * third.response)
    }

    /// Change of the row's own rate per unit impulse along it [1/kg], through each of its two bodies alone. Without a third
    /// the two add up to its diagonal entry of the Delassus matrix.
    #[must_use]
    pub(crate) fn shares(&self) -> [f64; 2] {
        [0, 3].map(|first: usize| (first..first + 3).map(|k| self.jacobian[k] * self.response[k]).sum())
    }

    /// The two bodies, so far as an impulse along the row moves them; `None` for an immovable one and for the background.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rows_of_three_bodies_couple_as_their_dense_products(
            entries in prop::array::uniform2(prop::array::uniform7(-1.0..1.0f64)),
            bodies in prop::array::uniform2(prop::sample::subsequence(vec![0u32, 1, 2, 3], 3)),
            has_third in prop::array::uniform2(any::<bool>()),
        ) {
            let inertia = |body: u32| InverseInertia {
                inverse_mass: 0.5 + f64::from(body),
                inverse_moment: 2.0 - 0.4 * f64::from(body),
            };
            let row = |at: usize| {
                let sides = [bodies[at][0], bodies[at][1]];
                let jacobian = std::array::from_fn(|k| entries[at][k]);
                let row = CollisionRow::new(sides.map(BodyId), jacobian, sides.map(inertia), 0.0);
                let third = CollisionThird::new(BodyId(bodies[at][2]), entries[at][6], inertia(bodies[at][2]));
                CollisionRow { third: has_third[at].then_some(third), ..row }
            };
            let dense = |at: usize| {
                let mut dense = [[0.0; 3]; 4];
                for side in 0..2 {
                    dense[bodies[at][side] as usize] = std::array::from_fn(|k| entries[at][3 * side + k]);
                }
                if has_third[at] {
                    dense[bodies[at][2] as usize][2] = entries[at][6];
                }
                dense
            };
            let product = |p: usize, q: usize| -> f64 {
                let (p, q) = (dense(p), dense(q));
                let of_body = |body: usize| {
                    let InverseInertia { inverse_mass, inverse_moment } = inertia(body as u32);
                    let weights = [inverse_mass, inverse_mass, inverse_moment];
                    (0..3).map(|k| p[body][k] * weights[k] * q[body][k]).sum::<f64>()
                };
                (0..4).map(of_body).sum()
            };
            let rows = [row(0), row(1)];
            for (p, q) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                prop_assert!((rows[p].coupling(&rows[q]) - product(p, q)).abs() < 1e-13);
            }
            prop_assert!((rows[0].square() - product(0, 0)).abs() < 1e-13);
        }
    }
}
