//! Rate, Jacobian and acceleration term of the slip between two features, and the coordinate whose rate the slip is.
//!
//! With the gap ĝ that a contact keeps, radii are inflated so that both bodies touch at *one* point, p = cA - rA n = cB + rB n:
//! equal and opposite forces at two points would leave a couple. Both grow alike, rA = rhoA (1 + e) and rB = rhoB (1 + e) with
//! e = ĝ/(rhoA + rhoB), so that bodies roll on each other in the ratio of their own radii. A line is shifted by all of ĝ and has
//! rB = 0, and rA = rhoA: a disc rolls on it with its own radius. With t the normal turned +90 degrees, arms R1 = p - xA and
//! R2 = p - xB, U1 and U2 to the centres (line: U2 = p - xB), u the relative velocity of the centres (line: against the
//! material point), w_n = t.n' the turning rate of the normal, and the speeds sA and sB at which the surfaces run
//! counter-clockwise along their outlines:
//!
//! * the slip speed v_t = t.u - rA wA - rB wB - sA - sB, and J = [t, R1 x t, -t, -(R2 x t)];
//! * v_t' = J v' + gamma with gamma = t.(-wA^2 U1 + wB^2 U2) - w_n g', for surfaces of constant speed;
//! * while g' = 0, v_t is the rate of a coordinate: h = rA (th_n - thA) + rB (th_n - thB) for two centres, with th_n the
//!   angle of n; h = t.(cA - b0) - rA (thA - thB) for a line with the material point b0; less the integral of sA + sB. So
//!   in the plane a contact that sticks is holonomic, and its coordinate can be kept as a pin keeps its gap.
//!
//! The formulas were derived for this project; they are checked against finite differences.

use crate::kinematics::{Arms, BodyAcceleration, GapKinematics, rate_of_change};
use crate::motion::Moving;
use glam::DVec2;
use halfgap_geometry::{GapKind, GapSample};
use std::f64::consts::TAU;

/// Gap beside the sum of two radii [-] up to which both grow alike: the point of contact stays within some radii of the bodies'
/// surfaces.
const LEAST_RATIO: f64 = 1e-3;

/// Rate and acceleration terms of the slip at one contact at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct TangentRow {
    /// Slip speed [m/s]: velocity of the primary side's surface against that of the normal side, along the normal turned
    /// +90 degrees.
    pub rate: f64,
    /// Derivative of the slip speed by (vA x, vA y, wA, vB x, vB y, wB): [1, 1, m, 1, 1, m].
    pub jacobian: [f64; 6],
    /// Acceleration of the slip [m/s^2] when no body accelerates.
    pub gamma: f64,
}

/// Two features as they touch: what slip is measured from.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'a> {
    /// The measured gap.
    pub sample: &'a GapSample,
    /// Signed radii [m] of the primary and of the normal feature; `None` for a line.
    pub radii: [Option<f64>; 2],
    /// The primary and the normal body.
    pub bodies: [&'a Moving; 2],
    /// Gap [m] that the contact keeps: that of `sample`, or the target gap.
    pub kept_gap: f64,
}

impl Touch<'_> {
    /// Radii [m] at which the bodies touch; 0 for a line.
    #[must_use]
    #[inline]
    pub fn inflated(&self) -> [f64; 2] {
        let ([a, b], gap) = (self.radii, self.kept_gap);
        let a = a.unwrap_or(0.0);
        let Some(b) = b else { return [a, 0.0] };
        // Two corners, or a disc in a hole of its own size, have no ratio to keep.
        let sum = a + b;
        if gap.abs() < LEAST_RATIO * sum.abs() {
            [a, b].map(|radius| radius * (1.0 + gap / sum))
        } else {
            [a, b].map(|radius| radius + 0.5 * gap)
        }
    }

    /// The point at which each of the two bodies touches [m]. They are one where the gap is the one that is kept.
    #[must_use]
    #[inline]
    pub fn points(&self) -> [DVec2; 2] {
        let (sample, [ra, rb]) = (self.sample, self.inflated());
        let beyond = if self.radii[1].is_some() { rb } else { self.kept_gap };
        [sample.center_primary - sample.normal * ra, sample.center_normal + sample.normal * beyond]
    }

    /// The coordinate h [m] whose rate the slip speed is while the gap neither closes nor opens and no surface runs.
    ///
    /// `normal_angle` [rad] is the angle of the normal with its whole turns, see [`turned`]; a line does not need it. Its
    /// origin is arbitrary: only differences for the same two features mean something.
    #[must_use]
    #[inline]
    pub fn coordinate(&self, normal_angle: f64) -> f64 {
        let ([ra, rb], [primary, normal]) = (self.inflated(), self.bodies);
        match self.sample.kind {
            GapKind::CenterCenter => ra * (normal_angle - primary.angle) + rb * (normal_angle - normal.angle),
            GapKind::CenterLine => {
                let along = self.sample.normal.perp().dot(self.sample.center_primary - normal.pose.position);
                along - ra * (primary.angle - normal.angle)
            }
        }
    }
}

impl TangentRow {
    /// The slip of two features that touch, with the `kinematics` of their gap, and the speeds [m/s] at which the surfaces
    /// of the primary and of the normal body run along their outlines, counter-clockwise positive.
    #[must_use]
    #[inline]
    pub fn of(touch: &Touch<'_>, kinematics: &GapKinematics, surface_speeds: [f64; 2]) -> Self {
        let ([primary, normal], [point_primary, point_normal]) = (touch.bodies, touch.points());
        let t = touch.sample.normal.perp();
        let (wa, wb) = (primary.angular_velocity, normal.angular_velocity);
        let arms = Arms::of(touch.sample, primary, normal);
        // The shift of a line is along n, and so is what wB makes of it: U2 may be the foot's arm.
        let turning = t.dot(arms.normal * (wb * wb) - arms.primary * (wa * wa));
        let [r1, r2] = [point_primary - primary.pose.position, point_normal - normal.pose.position];
        let jacobian = [t.x, t.y, r1.perp_dot(t), -t.x, -t.y, -r2.perp_dot(t)];
        let slip = t.dot(primary.velocity_at(r1) - normal.velocity_at(r2));
        Self {
            rate: slip - surface_speeds[0] - surface_speeds[1],
            jacobian,
            gamma: turning - t.dot(kinematics.normal_rate) * kinematics.rate,
        }
    }

    /// Acceleration of the slip [m/s^2] for given accelerations of the bodies.
    #[must_use]
    #[inline]
    pub fn acceleration(&self, primary: &BodyAcceleration, normal: &BodyAcceleration) -> f64 {
        rate_of_change(&self.jacobian, primary, normal) + self.gamma
    }
}

/// The angle [rad] of a direction, with the whole turns that bring it nearest to `near` [rad].
#[must_use]
#[inline]
pub fn turned(direction: DVec2, near: f64) -> f64 {
    let angle = libm::atan2(direction.y, direction.x);
    angle + ((near - angle) / TAU).round() * TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfgap_geometry::{DirectionRange, Feature, Pose, RoundFeature};

    #[test]
    fn the_angle_of_a_direction_follows_it_through_turns() {
        let mut angle = 0.0;
        for step in 0..400 {
            let truth = 0.05 * f64::from(step);
            angle = turned(DVec2::from_angle(truth), angle);
            assert!((angle - truth).abs() < 1e-13 * (1.0 + truth), "{angle} for {truth}");
        }
    }

    #[test]
    fn bodies_roll_in_the_ratio_of_their_own_radii_and_touch_at_one_point() {
        let round = |radius: f64| {
            Feature::Round(RoundFeature { center: DVec2::ZERO, radius, range: DirectionRange::Full })
        };
        let still = Moving::BACKGROUND;
        for (a, b, apart) in [(0.5, 2.0, 2.5), (0.5, -2.0, 1.5), (0.0, 1.0, 1.0)] {
            let kept_gap = 1e-5;
            let place = DVec2::from_angle(0.7) * if b < 0.0 { apart - kept_gap } else { apart + kept_gap };
            let moved = Moving { pose: Pose::new(place, 0.0), ..still };
            let sample = GapSample::measure_unbounded(&round(a), &moved.pose, &round(b), &still.pose)
                .expect("two discs");
            assert!((sample.gap - kept_gap).abs() < 1e-15, "{}", sample.gap);
            let touch =
                Touch { sample: &sample, radii: [Some(a), Some(b)], bodies: [&moved, &still], kept_gap };
            let [ra, rb] = touch.inflated();
            assert!((ra * b - rb * a).abs() < 1e-15, "{ra} and {rb} of {a} and {b}");
            let [p, q] = touch.points();
            assert!((p - q).length() < 1e-14, "{p} and {q}");
        }
    }

    #[test]
    fn corners_that_lie_on_each_other_share_the_gap() {
        let still = Moving::BACKGROUND;
        let corner =
            Feature::Round(RoundFeature { center: DVec2::ZERO, radius: 0.0, range: DirectionRange::Full });
        let pose = Pose::new(DVec2::new(0.0, 1e-3), 0.0);
        let sample = GapSample::measure_unbounded(&corner, &pose, &corner, &still.pose).expect("two corners");
        let touch = Touch { sample: &sample, radii: [Some(0.0); 2], bodies: [&still; 2], kept_gap: 1e-3 };
        assert_eq!(touch.inflated(), [5e-4; 2]);
    }
}
