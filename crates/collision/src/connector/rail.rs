//! The rows of a point on a rail: across the path, and along it up to a stop.
//!
//! With tangent T, left normal n, curvature k (positive to the left) at the nearest point and u, u' the
//! point's velocity and acceleration, differentiating the foot of the point gives
//!
//! * across: g = n.(c - foot), g' = n.u, g'' = n.u' - k s' (T.u), n' = -k s' T;
//! * along: s' = T.u/(1 - k g), s'' = (T.u' + 2 k s' g' + (dk/ds) s'^2 g)/(1 - k g), T' = k s' n.

use super::path::{Foot, RailHint, RailPath};
use super::row::{ConnectorSample, Ends};
use crate::motion::Moving;
use glam::DVec2;

/// Distance beyond a stop of a closed rail up to which a point counts as just at it, as a fraction of a lap [-]; used
/// if the side that it came from is not known.
const AT_STOP: f64 = 1e-9;

/// The row across the path, its gap positive to the left, or to the right if the hint faces there.
#[inline]
pub(super) fn rail_row(
    point: DVec2,
    body: &Moving,
    path: &RailPath,
    hint: Option<&RailHint>,
) -> ConnectorSample {
    let point = body.pose.point_to_world(point);
    let foot = path.foot(point, hint);
    let ends = Ends::of([point, foot.point], [body, &Moving::BACKGROUND]);
    let lateral = foot.tangent.dot(ends.velocity);
    let turn = foot.curvature * lateral * foot.stretch();
    let gamma = foot.normal.dot(ends.turning) - turn * lateral;
    if hint.is_some_and(|hint| hint.faces_right) {
        return ends.row(-foot.gap, -foot.normal, foot.tangent * turn, -gamma);
    }
    ends.row(foot.gap, foot.normal, foot.tangent * -turn, gamma)
}

/// The row along the path: `sign` is +1 if the rail ends below the arc length `at` [m], -1 if above it.
pub(super) fn stop_row(
    point: DVec2,
    body: &Moving,
    path: &RailPath,
    hint: Option<&RailHint>,
    (at, sign): (f64, f64),
) -> ConnectorSample {
    let point = body.pose.point_to_world(point);
    let place = path.nearest(point, hint);
    let foot = place.foot();
    let ends = Ends::of([point, foot.point], [body, &Moving::BACKGROUND]);
    let stretch = foot.stretch();
    let along = foot.tangent.dot(ends.velocity) * stretch;
    let across = foot.normal.dot(ends.velocity);
    let normal = foot.tangent * sign;
    let bend = along * (2.0 * foot.curvature * across + foot.curvature_rate * along * foot.gap);
    let gamma = (normal.dot(ends.turning) + sign * bend) * stretch;
    let normal_rate = foot.normal * (sign * foot.curvature * along);
    let near = hint.and_then(RailHint::before_stop);
    let gap = distance_to_stop(path, place.arc_length, (at, sign), near);
    let mut row = ends.row(gap, normal, normal_rate, gamma);
    // The foot of a point beside the rail moves faster or slower than the point itself.
    row.kinematics.rate = sign * along;
    row.kinematics.jacobian = row.kinematics.jacobian.map(|entry| entry * stretch);
    row
}

/// Arc length [m] left before the stop, negative beyond it; on a closed path, in the lap nearest to the last one,
/// `near`.
fn distance_to_stop(path: &RailPath, arc_length: f64, (at, sign): (f64, f64), near: Option<f64>) -> f64 {
    let left = sign * (arc_length - at);
    if !path.is_closed() {
        return left;
    }
    let lap = path.length();
    match near {
        Some(near) => left + lap * ((near - left) / lap).round(),
        None => (left + AT_STOP * lap).rem_euclid(lap) - AT_STOP * lap,
    }
}

impl Foot {
    /// Speed of the foot per speed of the point along the tangent, 1/(1 - k g); 0 at the centre of curvature, where the
    /// foot is no single point.
    #[inline]
    pub(super) fn stretch(&self) -> f64 {
        let reach = 1.0 - self.curvature * self.gap;
        if reach > 0.0 { 1.0 / reach } else { 0.0 }
    }
}
