//! Rate of a gap, its Jacobian, and the part of its acceleration that velocities alone cause.
//!
//! With arms U1 = cA - xA and U2 = cB - xB from the centres of mass (line: b - xB, b the foot), u the
//! relative velocity of the centres (line: against the material point at b) and p = n.(-wA^2 U1 + wB^2 U2):
//!
//! * g' = J v with J = [n, U1 x n, -n, -(U2 x n)] over v = (vA, wA, vB, wB);
//! * g'' = J v' + gamma; centre to centre gamma = p + s (|u|^2 - (n.u)^2)/|d|, centre to line
//!   gamma = p + 2 wB (n_perp.u) - wB^2 (g + rhoA);
//! * n' = s (u - (n.u) n)/|d|, or wB n_perp for a line.
//!
//! Sources: D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH '94, appendix;
//! E. Neumann, "Curved Edge Physics", 2015. Checked against finite differences.

use crate::motion::Moving;
use glam::DVec2;
use halfgap_geometry::{GapKind, GapSample};

/// Arms from the two centres of mass to the two feature centres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Arms {
    /// Arm from the primary body's centre of mass [m].
    pub primary: DVec2,
    /// Arm from the normal body's centre of mass [m].
    pub normal: DVec2,
}

/// Rate and acceleration terms of one gap at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct GapKinematics {
    /// Rate of the gap [m/s], negative when closing.
    pub rate: f64,
    /// Derivative of the rate by (vA x, vA y, wA, vB x, vB y, wB): [1, 1, m, 1, 1, m].
    pub jacobian: [f64; 6],
    /// Acceleration of the gap [m/s^2] when no body accelerates.
    pub gamma: f64,
    /// Time derivative of the normal [1/s].
    pub normal_rate: DVec2,
    /// Velocity [m/s] of the primary feature's centre relative to that of the normal feature (for a line, to its
    /// material point at the foot).
    pub center_velocity: DVec2,
}

/// Linear and angular acceleration of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyAcceleration {
    /// Acceleration of the centre of mass [m/s^2].
    pub linear: DVec2,
    /// Angular acceleration [rad/s^2].
    pub angular: f64,
}

impl GapKinematics {
    /// The kinematics of a measured gap between two moving bodies.
    #[must_use]
    #[inline(always)]
    pub fn of(sample: &GapSample, primary: &Moving, normal: &Moving) -> Self {
        let n = sample.normal;
        let arms = Arms::of(sample, primary, normal);
        let (wa, wb) = (primary.angular_velocity, normal.angular_velocity);
        let u = primary.velocity_at(arms.primary) - normal.velocity_at(arms.normal);
        let p = n.dot(arms.normal * (wb * wb) - arms.primary * (wa * wa));
        let (gamma, normal_rate) = match sample.kind {
            GapKind::CenterCenter => {
                let d = sample.center_primary - sample.center_normal;
                let distance = d.length();
                let sign = if n.dot(d) < 0.0 { -1.0 } else { 1.0 };
                let turning =
                    if distance > 0.0 { (u - n * n.dot(u)) * (sign / distance) } else { DVec2::ZERO };
                (p + turning.dot(u), turning)
            }
            GapKind::CenterLine => {
                let height = n.dot(sample.center_primary - sample.center_normal);
                (p + 2.0 * wb * n.perp().dot(u) - wb * wb * height, n.perp() * wb)
            }
        };
        let jacobian = [n.x, n.y, arms.primary.perp_dot(n), -n.x, -n.y, -arms.normal.perp_dot(n)];
        Self { rate: n.dot(u), jacobian, gamma, normal_rate, center_velocity: u }
    }

    /// Acceleration of the gap [m/s^2] for given accelerations of the bodies.
    #[must_use]
    #[inline]
    pub fn acceleration(&self, primary: &BodyAcceleration, normal: &BodyAcceleration) -> f64 {
        rate_of_change(&self.jacobian, primary, normal) + self.gamma
    }
}

/// J v' of a row [m/s^2] for accelerations v' of its bodies.
#[inline]
pub(crate) fn rate_of_change(j: &[f64; 6], primary: &BodyAcceleration, normal: &BodyAcceleration) -> f64 {
    j[0] * primary.linear.x
        + j[1] * primary.linear.y
        + j[2] * primary.angular
        + j[3] * normal.linear.x
        + j[4] * normal.linear.y
        + j[5] * normal.angular
}

impl Arms {
    /// Arms to the feature centres (line: to the foot) of a measured gap.
    #[must_use]
    #[inline]
    pub fn of(sample: &GapSample, primary: &Moving, normal: &Moving) -> Self {
        Self {
            primary: sample.center_primary - primary.pose.position,
            normal: sample.center_normal - normal.pose.position,
        }
    }
}
