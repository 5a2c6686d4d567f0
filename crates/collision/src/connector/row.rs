//! The rows of connectors at one moment: gap, normal, Jacobian and gamma.
//!
//! With arms U1, U2 from the centres of mass to the two points, u their relative velocity and
//! p = n.(-wA^2 U1 + wB^2 U2):
//!
//! * a direction n that turns at w (0 in the world, else a body's angular velocity): g = n.(cA - cB), gamma =
//!   p + 2 w (n_perp.u) - w^2 g, n' = w n_perp. On the body that carries the direction the force acts at the
//!   foot of the other body's point; u is taken there too;
//! * two centres: d = cA - cB, n = s d/|d|, gamma = p + s (|u|^2 - (n.u)^2)/|d|, n' = s (u - (n.u) n)/|d|.

use crate::kinematics::GapKinematics;
use crate::motion::Moving;
use glam::DVec2;

/// One row of a connector at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConnectorSample {
    /// Gap of the row [m], whose target is 0.
    pub gap: f64,
    /// Unit vector of the world along which body b pushes body a.
    pub normal: DVec2,
    /// Point at which the force on body a acts [m].
    pub point_a: DVec2,
    /// Point at which the force on body b acts [m].
    pub point_b: DVec2,
    /// Rate, Jacobian over (vA, wA, vB, wB), and the acceleration of the gap that velocities alone cause.
    pub kinematics: GapKinematics,
}

/// The two points of a row as their bodies carry them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    points: [DVec2; 2],
    arms: [DVec2; 2],
    /// Velocity of the point on a relative to that on b [m/s].
    pub(super) velocity: DVec2,
    /// Acceleration of the point on a relative to that on b when no body accelerates [m/s^2].
    pub(super) turning: DVec2,
}

impl Ends {
    #[inline]
    pub(super) fn of(points: [DVec2; 2], [a, b]: [&Moving; 2]) -> Self {
        let arms = [points[0] - a.pose.position, points[1] - b.pose.position];
        let square = |body: &Moving| body.angular_velocity * body.angular_velocity;
        Self {
            points,
            arms,
            velocity: a.velocity_at(arms[0]) - b.velocity_at(arms[1]),
            turning: arms[1] * square(b) - arms[0] * square(a),
        }
    }

    /// Derivative of n.velocity by the bodies' velocities.
    #[inline]
    fn jacobian(&self, n: DVec2) -> [f64; 6] {
        [n.x, n.y, self.arms[0].perp_dot(n), -n.x, -n.y, -self.arms[1].perp_dot(n)]
    }

    /// The row whose rate is n.velocity, given its gap, the rate of its normal and gamma.
    #[inline]
    pub(super) fn row(&self, gap: f64, normal: DVec2, normal_rate: DVec2, gamma: f64) -> ConnectorSample {
        ConnectorSample {
            gap,
            normal,
            point_a: self.points[0],
            point_b: self.points[1],
            kinematics: GapKinematics {
                rate: normal.dot(self.velocity),
                jacobian: self.jacobian(normal),
                gamma,
                normal_rate,
                center_velocity: self.velocity,
            },
        }
    }

    /// The row along a direction that turns at the given angular velocity [rad/s].
    #[inline]
    pub(super) fn along(&self, gap: f64, normal: DVec2, turn: f64) -> ConnectorSample {
        let across = normal.perp();
        let gamma = normal.dot(self.turning) + turn * (2.0 * across.dot(self.velocity) - turn * gap);
        self.row(gap, normal, across * turn, gamma)
    }

    /// The row between two centres. Its gap is the excess of their distance over `length` [m] if `sign` is +1, the
    /// shortfall if it is -1. If the centres coincide, every normal is right, and +x is taken.
    #[inline]
    pub(super) fn between(&self, length: f64, sign: f64) -> ConnectorSample {
        let d = self.points[0] - self.points[1];
        let distance = d.length();
        let gap = sign * (distance - length);
        if distance == 0.0 {
            return self.row(gap, DVec2::X, DVec2::ZERO, self.turning.x);
        }
        let normal = d * (sign / distance);
        let normal_rate = (self.velocity - normal * normal.dot(self.velocity)) * (sign / distance);
        let gamma = normal.dot(self.turning) + normal_rate.dot(self.velocity);
        self.row(gap, normal, normal_rate, gamma)
    }
}
