//! A circular edge.

use crate::error::ArcError;
use crate::feature::DirectionRange;
use crate::pose::Pose;
use glam::DVec2;
use std::f64::consts::TAU;

/// An arc of a circle; a full circle is one arc that ends where it starts.
///
/// As an edge of a shape (solid on the left) an arc that runs counter-clockwise is convex, one that runs clockwise is
/// concave.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Arc {
    center: DVec2,
    radius: f64,
    start_angle: f64,
    sweep_angle: f64,
    from: DVec2,
    to: DVec2,
}

impl Arc {
    /// The arc about `center` [m] that starts at `start_angle` [rad] and turns by `sweep_angle` [rad], which is
    /// positive counter-clockwise and at most a full turn in size.
    ///
    /// # Errors
    /// A radius that is not positive, an empty sweep or one of more than a full turn, or a number that is not finite.
    pub fn new(center: DVec2, radius: f64, start_angle: f64, sweep_angle: f64) -> Result<Self, ArcError> {
        if !(center.is_finite() && start_angle.is_finite()) {
            return Err(ArcError::NotFinite);
        }
        check_radius(radius)?;
        if !(sweep_angle.abs() > 0.0 && sweep_angle.abs() <= TAU) {
            return Err(ArcError::BadSweep(sweep_angle));
        }
        let at = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            center + DVec2::new(cos, sin) * radius
        };
        let from = at(start_angle);
        let to = if sweep_angle.abs() == TAU { from } else { at(start_angle + sweep_angle) };
        Ok(Self { center, radius, start_angle, sweep_angle, from, to })
    }

    /// The full circle about `center` [m] that starts and ends at `from` [m], run clockwise or counter-clockwise.
    ///
    /// # Errors
    /// A radius (the distance of the two points) that is not positive, or a number that is not finite.
    pub fn circle(center: DVec2, from: DVec2, clockwise: bool) -> Result<Self, ArcError> {
        if !(center.is_finite() && from.is_finite()) {
            return Err(ArcError::NotFinite);
        }
        let radius = (from - center).length();
        check_radius(radius)?;
        let start_angle = angle_of(from - center);
        let sweep_angle = if clockwise { -TAU } else { TAU };
        Ok(Self { center, radius, start_angle, sweep_angle, from, to: from })
    }

    /// The arc from `from` to `to` about the point nearest to `center` that is equally far from both [m].
    ///
    /// `fit_tol` [m], which may be infinite, is the largest accepted difference of the radii at the two ends and, for
    /// an arc of more than half a turn, the largest accepted shift of the center.
    ///
    /// # Errors
    /// Ends that coincide, radii that differ by more than `fit_tol`, a center that has to move by more than that, a
    /// radius that overflows, or a number that is not finite.
    pub fn between(
        from: DVec2,
        to: DVec2,
        center: DVec2,
        clockwise: bool,
        fit_tol: f64,
    ) -> Result<Self, ArcError> {
        if !(center.is_finite() && from.is_finite() && to.is_finite() && !fit_tol.is_nan()) {
            return Err(ArcError::NotFinite);
        }
        let chord = to - from;
        if chord == DVec2::ZERO {
            return Err(ArcError::BadSweep(0.0));
        }
        let (from_radius, to_radius) = ((from - center).length(), (to - center).length());
        let middle = from + 0.5 * chord;
        let across = chord.perp() / chord.length();
        let height = across.dot(center - middle);
        let exact_center = middle + across * height;
        // For more than half a turn a shift of the center moves the far side of the arc by as much.
        let beyond_half = clockwise == (height > 0.0);
        let moved = (exact_center - center).length();
        let off = (from_radius - to_radius).abs();
        if off > fit_tol {
            return Err(ArcError::RadiusMismatch { from_radius, to_radius, off });
        }
        if beyond_half && moved > fit_tol {
            return Err(ArcError::CenterOff { off: moved });
        }
        let radius = (from - exact_center).length();
        check_radius(radius)?;
        let start_angle = angle_of(from - exact_center);
        // Half of the sweep is the angle that half of the chord subtends at the center: exact for flat and for nearly
        // full arcs.
        let inwards = if clockwise { -height } else { height };
        let size = 2.0 * libm::atan2(0.5 * chord.length(), inwards);
        let sweep_angle = if clockwise { -size } else { size };
        Ok(Self { center: exact_center, radius, start_angle, sweep_angle, from, to })
    }

    /// Center of the circle [m].
    #[must_use]
    #[inline]
    pub fn center(&self) -> DVec2 {
        self.center
    }

    /// Radius of the circle [m], positive.
    #[must_use]
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Direction [rad] of the first point as seen from the center.
    #[must_use]
    #[inline]
    pub fn start_angle(&self) -> f64 {
        self.start_angle
    }

    /// Signed turn [rad] from the first point to the last, positive counter-clockwise.
    #[must_use]
    #[inline]
    pub fn sweep_angle(&self) -> f64 {
        self.sweep_angle
    }

    /// First point [m].
    #[must_use]
    #[inline]
    pub fn from(&self) -> DVec2 {
        self.from
    }

    /// Last point [m].
    #[must_use]
    #[inline]
    pub fn to(&self) -> DVec2 {
        self.to
    }

    /// True for an arc that is a whole circle.
    #[must_use]
    #[inline]
    pub fn is_circle(&self) -> bool {
        self.sweep_angle.abs() == TAU
    }

    /// True if the arc runs counter-clockwise, which makes an edge with the solid on its left convex.
    #[must_use]
    #[inline]
    pub fn is_convex(&self) -> bool {
        self.sweep_angle > 0.0
    }

    /// Length [m].
    #[must_use]
    #[inline]
    pub fn length(&self) -> f64 {
        self.radius * self.sweep_angle.abs()
    }

    /// Unit vector from the center to the middle of the arc.
    #[must_use]
    #[inline]
    pub fn middle_direction(&self) -> DVec2 {
        let (sin, cos) = libm::sincos(self.start_angle + 0.5 * self.sweep_angle);
        DVec2::new(cos, sin)
    }

    /// Range of directions, seen from the center, in which the arc has points.
    #[must_use]
    #[inline]
    pub fn directions(&self) -> DirectionRange {
        if self.is_circle() {
            return DirectionRange::Full;
        }
        let first = (self.from - self.center) / self.radius;
        let last = (self.to - self.center) / self.radius;
        let (first, last) = if self.is_convex() { (first, last) } else { (last, first) };
        DirectionRange::between(first, last, self.sweep_angle.abs())
    }

    /// Unit vector of travel at the first point.
    #[must_use]
    #[inline]
    pub fn start_direction(&self) -> DVec2 {
        self.direction_at(self.from)
    }

    /// Unit vector of travel at the last point.
    #[must_use]
    #[inline]
    pub fn end_direction(&self) -> DVec2 {
        self.direction_at(self.to)
    }

    /// The arc run the other way.
    #[must_use]
    #[inline]
    pub fn reversed(&self) -> Self {
        Self {
            start_angle: self.start_angle + self.sweep_angle,
            sweep_angle: -self.sweep_angle,
            from: self.to,
            to: self.from,
            ..*self
        }
    }

    /// The arc shifted by `shift` [m].
    #[must_use]
    #[inline]
    pub fn translated(&self, shift: DVec2) -> Self {
        Self { center: self.center + shift, from: self.from + shift, to: self.to + shift, ..*self }
    }

    /// The arc in world coordinates, as a body at the given pose carries it.
    #[must_use]
    #[inline]
    pub fn posed(&self, pose: &Pose) -> Self {
        Self {
            center: pose.point_to_world(self.center),
            start_angle: self.start_angle + libm::atan2(pose.rotation.sin, pose.rotation.cos),
            from: pose.point_to_world(self.from),
            to: pose.point_to_world(self.to),
            ..*self
        }
    }

    /// Signed distance [m] of a point [m] from the whole circle, positive on the side away from the solid: outside of a
    /// convex arc's circle, inside of a concave one's.
    #[must_use]
    #[inline]
    pub fn signed_distance(&self, point: DVec2) -> f64 {
        let from_circle = (point - self.center).length() - self.radius;
        if self.is_convex() { from_circle } else { -from_circle }
    }

    /// Point of the arc nearest to `point` [m]; its first point if all are equally near.
    #[must_use]
    #[inline]
    pub fn nearest(&self, point: DVec2) -> DVec2 {
        let offset = point - self.center;
        let distance = offset.length();
        if distance > 0.0 {
            let direction = offset / distance;
            if self.directions().contains(direction) {
                return self.center + direction * self.radius;
            }
        }
        let (to_from, to_to) = ((point - self.from).length_squared(), (point - self.to).length_squared());
        if to_from <= to_to { self.from } else { self.to }
    }

    fn direction_at(&self, point: DVec2) -> DVec2 {
        let ccw = (point - self.center).perp() / self.radius;
        if self.is_convex() { ccw } else { -ccw }
    }
}

fn check_radius(radius: f64) -> Result<(), ArcError> {
    if radius > 0.0 && radius.is_finite() { Ok(()) } else { Err(ArcError::BadRadius(radius)) }
}

fn angle_of(v: DVec2) -> f64 {
    libm::atan2(v.y, v.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clockwise_quarter_sweeps_a_negative_quarter_turn() {
        let arc = Arc::between(DVec2::new(0.0, 2.0), DVec2::new(2.0, 0.0), DVec2::ZERO, true, 1e-9)
            .expect("the ends are equally far from the center");
        assert!((arc.sweep_angle() + TAU / 4.0).abs() < 1e-15);
        assert!((arc.length() - TAU / 2.0).abs() < 1e-15 * 4.0);
        assert!((arc.start_direction() - DVec2::X).length() < 1e-15);
    }

    #[test]
    fn the_long_way_round_is_found() {
        let arc = Arc::between(DVec2::new(0.0, 2.0), DVec2::new(2.0, 0.0), DVec2::ZERO, false, 1e-9)
            .expect("the ends are equally far from the center");
        assert!((arc.sweep_angle() - 0.75 * TAU).abs() < 1e-15 * 4.0);
        assert!(arc.directions().contains(DVec2::new(-1.0, 0.0)));
        assert!(!arc.directions().contains(DVec2::new(0.8, 0.6)));
    }

    #[test]
    fn a_radius_that_does_not_fit_is_told_with_its_size() {
        let error = Arc::between(DVec2::new(0.0, 2.0), DVec2::new(2.02, 0.0), DVec2::ZERO, true, 1e-6)
            .expect_err("1 % off");
        assert!(matches!(error, ArcError::RadiusMismatch { off, .. } if (off - 0.02).abs() < 1e-12));
    }

    #[test]
    fn a_small_misfit_moves_the_center_onto_the_bisector() {
        let to = DVec2::new(2.0 + 1e-7, 0.0);
        let arc =
            Arc::between(DVec2::new(0.0, 2.0), to, DVec2::ZERO, true, 1e-6).expect("within the tolerance");
        let radii = [(arc.from() - arc.center()).length(), (arc.to() - arc.center()).length()];
        assert!((radii[0] - radii[1]).abs() < 1e-15);
        assert_eq!(arc.to(), to);
    }

    #[test]
    fn the_nearest_point_of_an_arc_may_be_an_end() {
        let arc = Arc::new(DVec2::ZERO, 1.0, 0.0, TAU / 4.0).expect("a fine arc");
        assert_eq!(arc.nearest(DVec2::new(0.5, -1.0)), arc.from());
        assert!((arc.nearest(DVec2::new(3.0, 3.0)).length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_tiny_arc_is_no_circle() {
        let arc = Arc::new(DVec2::new(1.0, 0.0), 1.0, 0.0, 1e-18).expect("a fine arc");
        assert!(!arc.is_circle());
        assert!(!arc.directions().contains(DVec2::NEG_X));
    }

    #[test]
    fn flat_and_nearly_full_arcs_have_exact_sweeps() {
        for bulge in [1e-7, 1e-3, 0.9, 1.0, 1.1, 1e3, 1e7_f64] {
            let height = (1.0 - bulge * bulge) / (4.0 * bulge) * 2.0;
            let arc = Arc::between(DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(1.0, height), false, 1.0)
                .expect("a fine arc");
            let expected = 4.0 * bulge.atan();
            assert!((arc.sweep_angle() / expected - 1.0).abs() < 1e-15 * 4.0, "bulge {bulge}");
        }
    }
}
