//! First contact of a feature pair along any motions, by marching with second-order bounds.
//!
//! At a time t the gap less its target, c, and its rate v are known, and over the window its acceleration is
//! bounded from below by -K. Then c + v s - K s^2/2 > 0 proves that the pair does not fire before the first root s:
//! the march steps there and measures again. It never passes a contact and, since the bound touches the gap to
//! second order, it converges to a transversal one as Newton's method does, from before.
//!
//! A bound on an acceleration keeps its direction, but for the angle by which the normal can turn in the window, so
//! that accelerations that both bodies have in common, or that lie along the contact, do not count.
//!
//! Over a window, with a_rel and u bounding the relative acceleration and velocity of the two centres:
//!
//! * vertices and convex arcs: the distance of the centres is convex but for their acceleration, K = a_rel;
//! * inside a concave arc H = R^2 - |d|^2 replaces the gap, which is singular at the centre: H'' >= -2 (u^2 +
//!   |d| a_rel);
//! * a line that turns with wB about the centre of mass xB: with E = cA - xB the gap is n.E less constants, so that
//!   K = (|alphaB| + wB^2) |E| + 2 |wB| |E'| + |E''|. The place of the foot along the line obeys the same bound.
//!
//! A pair whose contact point lies outside of its features does not fire before that point can come within
//! them; a pair deeper than `depth` lies on the far side of a body (its gap is negative, but the features do not touch)
//! and does not fire before it can come back.
//!
//! Source: the one-sided bound is conservative advancement (B. Mirtich, "Impulse-based dynamic simulation of rigid body
//! systems", 1996, 2.3) carried to second order.

use crate::motion::{Ball, Motion, MotionBounds, Moving};
use crate::tolerances::rounding;
use glam::DVec2;
use halfgap_geometry::{
    CenterGap, Feature, LineFeature, LineGap, PairKind, Pose, RoundFeature, touching_distance,
};
use std::cell::OnceCell;
use std::f64::consts::PI;

/// Largest rounding [rad] that is allowed for in the direction between two centres.
pub(crate) const UNKNOWN_DIRECTION: f64 = 0.1;

/// Motions of two bodies over a window of time, with bounds that hold in all of it.
#[derive(Clone, Debug)]
pub(crate) struct Window<'a, A, B> {
    pub(crate) motion_a: &'a A,
    pub(crate) motion_b: &'a B,
    /// Offsets [s] of the search's time 0 in the two motions.
    pub(crate) offsets: [f64; 2],
    /// Time of the search [s] at which the window begins.
    start: f64,
    /// Poses and velocities of the bodies at `start`, which every march reads first.
    at_start: OnceCell<(Moving, Moving)>,
    /// Largest relative speed [m/s] of the centres of mass.
    pub(crate) speed: f64,
    /// Bound on the acceleration [m/s^2] of the centre of mass of a relative to that of b.
    pub(crate) acceleration: Ball,
    pub(crate) spin_a: SpinBound,
    pub(crate) spin_b: SpinBound,
}

/// Bounds on the angular motion of a body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SpinBound {
    /// Largest angular speed [rad/s].
    pub(crate) speed: f64,
    /// Largest angular acceleration in size [rad/s^2].
    pub(crate) acceleration: f64,
}

impl SpinBound {
    fn of(bounds: &MotionBounds) -> Self {
        Self { speed: bounds.angular_speed, acceleration: bounds.angular_acceleration }
    }

    /// Bound on the acceleration [m/s^2] of a point with the given arm [m] relative to the centre of mass.
    fn arm_acceleration(&self, arm: f64) -> f64 {
        (self.acceleration + self.speed * self.speed) * arm
    }
}

/// Result of a march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MarchEnd {
    /// The pair closes to its target at this time [s].
    Closes(f64),
    /// The pair does not fire before this time [s], at which the march stopped.
    NoneBefore(f64),
}

/// State of a pair at one time, with bounds that hold over the rest of the window.
#[derive(Clone, Copy, Debug)]
struct Look {
    /// Gap less target [m], or H [m^2] for two centres of an inner pair or of one that lies behind.
    value: f64,
    /// Rate of the value, per second.
    rate: f64,
    /// Bound on the downward acceleration of the value, and on the upward one while behind, per second squared.
    curvature: f64,
    /// A lower bound of that kind, and the time [s] for which it holds, if there is one.
    at_first: Option<(f64, f64)>,
    /// Gap less target [m].
    height: f64,
    /// Rounding of the value, in its unit.
    value_rounding: f64,
    /// Rounding of the rate, in its unit, or the pair's `rest` if that is more.
    rate_rounding: f64,
    /// Time [s] in which the pair moves by no more than rounding.
    resolution: f64,
    /// Time [s] for which the contact point surely stays outside of the features; `None` if it is within.
    outside_for: Option<f64>,
}

/// One feature pair under search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a> {
    pub(crate) kind: PairKind,
    pub(crate) feature_a: &'a Feature,
    pub(crate) feature_b: &'a Feature,
    /// Target gap [m].
    pub(crate) target: f64,
    /// Depth [m] below the target beyond which the pair lies behind.
    pub(crate) depth: f64,
    /// Angles [rad] by which the contact may lie outside of the ranges of the two features and still counts as within.
    pub(crate) slack: [f64; 2],
    /// Distance [m] beyond the ends of a line at which the contact still counts as within.
    pub(crate) overrun: f64,
    /// Opening rate [m/s] up to which a pair at its target counts as closing.
    pub(crate) rest: f64,
}

/// The round side of a pair, with the angle [rad] by which a contact may lie outside of its range.
type RoundSide<'a> = (&'a RoundFeature, &'a Moving, SpinBound, f64);
type LineSide<'a> = (&'a LineFeature, &'a Moving, SpinBound);

impl<'a, A: Motion, B: Motion> Window<'a, A, B> {
    /// The window from `start` to `end` [s].
    pub(crate) fn new(motion_a: &'a A, motion_b: &'a B, offsets: [f64; 2], start: f64, end: f64) -> Self {
        let mut window = Self {
            motion_a,
            motion_b,
            offsets,
            start,
            at_start: OnceCell::new(),
            speed: 0.0,
            acceleration: Ball::default(),
            spin_a: SpinBound::default(),
            spin_b: SpinBound::default(),
        };
        window.end_at(end);
        window
    }

    /// Sets another end of the window [s], with the bounds up to it.
    pub(crate) fn end_at(&mut self, end: f64) {
        let bounds_a = self.motion_a.bounds(self.offsets[0] + self.start, self.offsets[0] + end);
        let bounds_b = self.motion_b.bounds(self.offsets[1] + self.start, self.offsets[1] + end);
        self.speed = bounds_a.velocity.largest_difference(&bounds_b.velocity);
        self.acceleration = bounds_a.acceleration.minus(&bounds_b.acceleration);
        self.spin_a = SpinBound::of(&bounds_a);
        self.spin_b = SpinBound::of(&bounds_b);
    }

    /// Poses and velocities of the two bodies at a time [s] of the search.
    #[inline]
    pub(crate) fn at(&self, time: f64) -> (Moving, Moving) {
        (self.motion_a.moving_at(self.offsets[0] + time), self.motion_b.moving_at(self.offsets[1] + time))
    }

    /// Marches one pair from `start` to `end` [s], at most `steps` steps.
    pub(crate) fn march(&self, pair: &Pair<'_>, start: f64, end: f64, steps: u32) -> MarchEnd {
        let mut time = start;
        // A pair that is at its target in all steps, and opens too slowly to leave it, is reported as resting there.
        let mut stays = pair.rest > 0.0;
        for _ in 0..steps {
            let look = self.look(pair, time, end - time);
            if look.is_closing(pair.depth) {
                return MarchEnd::Closes(time);
            }
            stays &= look.touches(pair.depth);
            let next = time + look.quiet_for(pair.depth).max(look.resolution);
            // A step below the resolution of the clock is one tick: the rest of the gap is rounding.
            let next = if next > time { next } else { time.next_up() };
            if next >= end {
                return MarchEnd::NoneBefore(end);
            }
            time = next;
        }
        if stays { MarchEnd::Closes(time) } else { MarchEnd::NoneBefore(time) }
    }

    fn look(&self, pair: &Pair<'_>, time: f64, ahead: f64) -> Look {
        let (a, b) =
            if time == self.start { *self.at_start.get_or_init(|| self.at(time)) } else { self.at(time) };
        match (pair.kind, pair.feature_a, pair.feature_b) {
            (PairKind::RoundLine, Feature::Round(round), Feature::Line(line)) => {
                let slack = pair.slack[0];
                let sides = ((round, &a, self.spin_a, slack), (line, &b, self.spin_b));
                self.look_at_line(pair, sides, &self.acceleration, ahead)
            }
            (PairKind::LineRound, Feature::Line(line), Feature::Round(round)) => {
                let slack = pair.slack[1];
                let sides = ((round, &b, self.spin_b, slack), (line, &a, self.spin_a));
                self.look_at_line(pair, sides, &self.acceleration.mirrored(), ahead)
            }
            (kind, Feature::Round(round_a), Feature::Round(round_b)) => {
                self.look_at_centers(pair, (round_a, &a), (round_b, &b), kind == PairKind::Inner, ahead)
            }
            (_, Feature::Line(_), Feature::Line(_))
            | (PairKind::Outer | PairKind::Inner | PairKind::RoundLine, Feature::Line(_), _)
            | (PairKind::Outer | PairKind::Inner | PairKind::LineRound, _, Feature::Line(_)) => Look::NEVER,
        }
    }

    fn look_at_centers(
        &self,
        pair: &Pair<'_>,
        (round_a, a): (&RoundFeature, &Moving),
        (round_b, b): (&RoundFeature, &Moving),
        inner: bool,
        ahead: f64,
    ) -> Look {
        let gap = CenterGap::measure(round_a, &a.pose, round_b, &b.pose, inner);
        let height = gap.gap - pair.target;
        let arms = [round_a.center.length(), round_b.center.length()];
        let u = a.velocity_at(gap.center_a - a.pose.position) - b.velocity_at(gap.center_b - b.pose.position);
        let u_max = self.speed + self.spin_a.speed * arms[0] + self.spin_b.speed * arms[1];
        let of_arms = self.spin_a.arm_acceleration(arms[0]) + self.spin_b.arm_acceleration(arms[1]);
        let a_max = self.acceleration.largest() + of_arms;
        // While the centres keep half of their distance the direction turns at a rate of at most u/(d/2).
        let direction_turn = quotient(2.0 * u_max, gap.center_distance);
        let turned =
            if quotient(0.5 * gap.center_distance, u_max) >= ahead { direction_turn * ahead } else { PI };
        let downward = fastest_against(&self.acceleration, gap.normal, turned) + of_arms;
        let size = gap.center_a.abs().max(gap.center_b.abs()).max_element()
            + round_a.radius.abs()
            + round_b.radius.abs();
        let mut look = Look {
            value: height,
            rate: gap.normal.dot(u),
            curvature: downward,
            at_first: None,
            height,
            value_rounding: rounding(size),
            rate_rounding: rounding(u.length()).max(pair.rest),
            resolution: quotient(rounding(size), u_max),
            outside_for: None,
        };
        if inner || look.is_behind(pair.depth) {
            // In terms of H = +-(|d|^2 - reach^2), whose acceleration +-2 (|u|^2 + d.d'') is bounded at the centre too.
            let distance = gap.center_distance;
            let reach = (touching_distance(round_a, round_b) + pair.target).abs();
            let d_max =
                if look.is_behind(pair.depth) { distance + u_max * ahead } else { reach.max(distance) };
            look.value *= distance + reach;
            look.rate *= 2.0 * distance;
            look.curvature = 2.0 * (u_max * u_max + d_max.max(reach) * a_max);
            if !look.is_behind(pair.depth) {
                // A pin moves slowly in its hole compared with its bodies, and not much faster while it crosses the
                // hole.
                let across = quotient(reach, u.length()).min(quotient(reach, a_max).sqrt());
                let u_first = u.length() + a_max * across;
                look.at_first = Some((2.0 * (u_first * u_first + reach.max(distance) * a_max), across));
            }
            look.value_rounding *= distance + reach;
            look.rate_rounding *= 2.0 * distance.max(reach);
        }
        // The angles cost more than everything else.
        if !look.is_clear_for(ahead) {
            let rates = (turning_rate(&gap, u, inner), u.length(), u_max, a_max);
            look.outside_for = self.outside_ranges(pair, &gap, (round_a, a), (round_b, b), rates);
        }
        look
    }

    fn look_at_line(
        &self,
        pair: &Pair<'_>,
        ((round, a, spin_a, slack), (line, b, spin_b)): (RoundSide<'_>, LineSide<'_>),
        acceleration: &Ball,
        ahead: f64,
    ) -> Look {
        let gap = LineGap::measure(round, &a.pose, line, &b.pose);
        let height = gap.gap - pair.target;
        let arm = round.center.length();
        let e = gap.center - b.pose.position;
        let e_rate = a.velocity_at(gap.center - a.pose.position) - b.velocity;
        let e_speed = self.speed + spin_a.speed * arm;
        let e_max = e.length() + e_speed * ahead;
        let (n, w) = (gap.normal, b.angular_velocity);
        let of_turning = (spin_b.acceleration + spin_b.speed * spin_b.speed) * e_max
            + 2.0 * spin_b.speed * e_speed
            + spin_a.arm_acceleration(arm);
        let in_any_direction = of_turning + acceleration.largest();
        let curvature = if height < -pair.depth {
            in_any_direction
        } else {
            of_turning + fastest_against(acceleration, n, spin_b.speed * ahead)
        };
        let rate = n.dot(e_rate) + w * n.perp().dot(e);
        let size = gap.center.abs().max(b.pose.position.abs()).max_element() + e.length() + round.radius;
        let look = Look {
            value: height,
            rate,
            curvature,
            at_first: None,
            height,
            value_rounding: rounding(size),
            rate_rounding: rounding(e_rate.length() + w.abs() * e.length()).max(pair.rest),
            resolution: quotient(rounding(size), e_speed + spin_b.speed * e_max),
            outside_for: None,
        };
        if look.is_clear_for(ahead) {
            return look;
        }
        let along_rate = n.perp().dot(e_rate) - w * n.dot(e);
        let beyond =
            overrun_for(gap.along, along_rate, line, in_any_direction, rounding(size).max(pair.overrun));
        let excess = gap.excess(round, &a.pose);
        let turning = (a.angular_velocity - w).abs();
        let askew = (excess > rounding(1.0).max(slack)).then(|| {
            let room = excess - slack;
            let by_speed = quotient(room, spin_a.speed + spin_b.speed);
            by_speed.max(first_descent(room, -turning, spin_a.acceleration + spin_b.acceleration))
        });
        Look { outside_for: longer(beyond, askew), ..look }
    }

    /// Time [s] for which the direction between two centres surely stays outside of one of the ranges; `None` if it is
    /// within both.
    fn outside_ranges(
        &self,
        pair: &Pair<'_>,
        gap: &CenterGap,
        (round_a, a): (&RoundFeature, &Moving),
        (round_b, b): (&RoundFeature, &Moving),
        (direction_rate, u, u_max, a_max): (f64, f64, f64, f64),
    ) -> Option<f64> {
        let [excess_a, excess_b] = gap.excess(round_a, &a.pose, round_b, &b.pose);
        let [slack_a, slack_b] =
            pair.slack.map(|slack| slack.max(direction_rounding(gap.center_a, gap.center_b)));
        if excess_a <= slack_a && excess_b <= slack_b {
            return None;
        }
        let distance = gap.center_distance;
        let half_way = quotient(0.5 * distance, u_max).max(first_descent(0.5 * distance, -u, a_max));
        // Over that time the direction's angular acceleration is at most a/(d/2) + 2 u^2/(d/2)^2.
        let direction_speed = quotient(2.0 * u_max, distance);
        let direction_acceleration =
            quotient(2.0 * a_max, distance) + quotient(8.0 * u_max * u_max, distance * distance);
        let wait = |excess: f64, slack: f64, rate: f64, spin: SpinBound| {
            (excess > slack).then(|| {
                let room = excess - slack;
                let by_speed = quotient(room, direction_speed + spin.speed);
                // Centres near each other may stay so for long, if they hardly move relative to each other.
                let now = quotient(2.0 * u, distance) + spin.speed;
                let by_speed = by_speed.max(first_descent(room, -now, quotient(2.0 * a_max, distance)));
                let turning = (direction_rate - rate).abs();
                let acceleration = direction_acceleration + spin.acceleration;
                half_way.min(by_speed.max(first_descent(room, -turning, acceleration)))
            })
        };
        longer(
            wait(excess_a, slack_a, a.angular_velocity, self.spin_a),
            wait(excess_b, slack_b, b.angular_velocity, self.spin_b),
        )
    }
}

/// Rate [rad/s] at which the normal turns, counter-clockwise positive; 0 for centres that coincide.
fn turning_rate(gap: &CenterGap, u: DVec2, inner: bool) -> f64 {
    if gap.center_distance > 0.0 {
        let across = if inner { -gap.normal.perp_dot(u) } else { gap.normal.perp_dot(u) };
        across / gap.center_distance
    } else {
        0.0
    }
}

/// Bound [m/s^2], not negative, on the component of the accelerations in the ball against a direction, which may turn
/// by the given angle [rad].
fn fastest_against(acceleration: &Ball, direction: DVec2, turned: f64) -> f64 {
    let off = turned.min(2.0) * acceleration.center.length();
    (acceleration.radius + off - direction.dot(acceleration.center)).max(0.0)
}

impl Look {
    const NEVER: Look = Look {
        value: f64::INFINITY,
        rate: 0.0,
        curvature: 0.0,
        at_first: None,
        height: f64::INFINITY,
        value_rounding: 0.0,
        rate_rounding: 0.0,
        resolution: f64::INFINITY,
        outside_for: Some(f64::INFINITY),
    };

    fn is_behind(&self, depth: f64) -> bool {
        self.height < -depth
    }

    /// True if the gap alone proves that the pair does not fire for the next `ahead` [s], wherever the contact point
    /// lies.
    #[inline]
    fn is_clear_for(&self, ahead: f64) -> bool {
        self.value > self.value_rounding && first_descent(self.value, self.rate, self.curvature) >= ahead
    }

    /// True if the pair is at or below its target, within both features, and not behind.
    fn touches(&self, depth: f64) -> bool {
        !self.is_behind(depth) && self.value <= self.value_rounding && self.outside_for.is_none()
    }

    /// True if the pair touches and does not open. A rate that is only rounding does not count as opening: a pair at
    /// rest must be reported, or the march would crawl along it.
    fn is_closing(&self, depth: f64) -> bool {
        self.touches(depth) && self.rate <= self.rate_rounding
    }

    /// Time [s] for which the pair surely does not fire.
    fn quiet_for(&self, depth: f64) -> f64 {
        let always = self.quiet_with(self.curvature, depth);
        let at_first = self.at_first.filter(|(curvature, _)| *curvature < self.curvature);
        let by_value = at_first
            .map_or(always, |(curvature, end)| self.quiet_with(curvature, depth).min(end).max(always));
        self.outside_for.map_or(by_value, |wait| wait.max(by_value))
    }

    /// Time [s] for which the value surely does not let the pair fire, given a bound on its acceleration.
    fn quiet_with(&self, curvature: f64, depth: f64) -> f64 {
        if self.is_behind(depth) {
            // Mirrored: the pair does not come back before the value could rise to the target.
            first_descent(-self.value, -self.rate, curvature)
        } else if self.value > self.value_rounding {
            first_descent(self.value, self.rate, curvature)
        } else if self.rate >= 0.0 {
            // At the target and opening: the pair does not fire before the rate could turn.
            quotient(self.rate, curvature)
        } else {
            0.0
        }
    }
}

/// First root s of c + v s - K s^2/2 for c > 0, K >= 0 (`curvature`); infinite if there is none.
#[inline]
fn first_descent(c: f64, v: f64, curvature: f64) -> f64 {
    let root = (v * v + 2.0 * curvature * c).sqrt();
    if v <= 0.0 { quotient(2.0 * c, root - v) } else { quotient(v + root, curvature) }
}

/// The quotient of two numbers that are not negative; infinite over 0.
#[inline]
fn quotient(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { numerator / denominator } else { f64::INFINITY }
}

/// Time [s] for which the foot surely stays beyond the ends of the line, given its place [m], its rate [m/s] and a
/// bound on its acceleration [m/s^2]; `None` if it is not beyond them by more than `slack` [m].
fn overrun_for(along: f64, rate: f64, line: &LineFeature, curvature: f64, slack: f64) -> Option<f64> {
    let (before, after) = (line.start - along, along - line.end);
    if before > slack {
        Some(first_descent(before - slack, -rate, curvature))
    } else if after > slack {
        Some(first_descent(after - slack, rate, curvature))
    } else {
        None
    }
}

/// Rounding [rad] of the direction between two centres, of which [`UNKNOWN_DIRECTION`] at most comes from their
/// nearness.
///
/// A contact that lies outside of its features by more than this really does: centres that all but coincide were
/// farther apart before, so corners that pass through each other have come from a place where they do not touch.
pub(crate) fn direction_rounding(center_a: DVec2, center_b: DVec2) -> f64 {
    let size = center_a.abs().max(center_b.abs()).max_element();
    rounding(1.0) + quotient(rounding(size), center_a.distance(center_b)).min(UNKNOWN_DIRECTION)
}

/// The longer of two times [s], either of which may be absent.
fn longer(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (only, None) | (None, only) => only,
    }
}

/// True if the contact point of a pair lies within both of its features, up to its slack.
pub(crate) fn contact_is_within(pair: &Pair<'_>, poses: [&Pose; 2]) -> bool {
    let [slack_a, slack_b] = pair.slack;
    match (pair.feature_a, pair.feature_b) {
        (Feature::Round(a), Feature::Round(b)) => {
            let gap = CenterGap::measure(a, poses[0], b, poses[1], pair.kind == PairKind::Inner);
            let least = direction_rounding(gap.center_a, gap.center_b);
            let [excess_a, excess_b] = gap.excess(a, poses[0], b, poses[1]);
            excess_a <= least.max(slack_a) && excess_b <= least.max(slack_b)
        }
        (Feature::Round(round), Feature::Line(line)) => {
            is_within_line((round, poses[0], slack_a), (line, poses[1]), pair.overrun)
        }
        (Feature::Line(line), Feature::Round(round)) => {
            is_within_line((round, poses[1], slack_b), (line, poses[0]), pair.overrun)
        }
        (Feature::Line(_), Feature::Line(_)) => false,
    }
}

fn is_within_line(
    (round, pose_round, slack): (&RoundFeature, &Pose, f64),
    (line, pose_line): (&LineFeature, &Pose),
    overrun: f64,
) -> bool {
    let gap = LineGap::measure(round, pose_round, line, pose_line);
    let size = gap.center.abs().max(pose_line.position.abs()).max_element();
    gap.overrun(line) <= rounding(size).max(overrun)
        && gap.excess(round, pose_round) <= rounding(1.0).max(slack)
}

/// The round feature that stands for a whole body far away: a circle of its reach [m] about its centre of mass.
pub(crate) fn reach_circle(reach: f64) -> Feature {
    Feature::Round(RoundFeature {
        center: DVec2::ZERO,
        radius: reach,
        range: halfgap_geometry::DirectionRange::Full,
    })
}
