//! Ready-made cams: the outline on which a roller does what it is to do.

use crate::build::check_length;
use crate::error::ShapeError;
use crate::fit::{CurvePoint, fit_arcs};
use crate::path::PathSpec;
use crate::shape::Shape;
use glam::DVec2;
use std::f64::consts::TAU;

/// Parts in which a turn is followed; nothing of a lift that bends more often shows between their ends.
const PARTS: u32 = 16;
/// Angles at which a lift is looked at for what cannot be.
const LOOKS: u32 = 4096;
/// Share of its size [-] by which lift and slope after a turn may differ from those before it: what sums and products leave.
const ROUNDING: f64 = 1e-9;

/// Lift of a cam's roller at a share of a turn, and its first and second derivative by that share [m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lift {
    /// The lift.
    pub value: f64,
    /// Its derivative by the share of a turn.
    pub rate: f64,
    /// Its second derivative.
    pub acceleration: f64,
}

/// The way of a roller's center about a cam.
struct Pitch<'a, F> {
    lift: &'a F,
    /// Distance [m] of the roller's center from the axis without lift.
    rest: f64,
    roller: f64,
}

impl<F: Fn(f64) -> Lift> Pitch<'_, F> {
    /// Distance of the roller's center from the axis at an angle, and its derivatives by the angle.
    fn distance(&self, angle: f64) -> [f64; 3] {
        let Lift { value, rate, acceleration } = (self.lift)(angle / TAU);
        [self.rest + value, rate / TAU, acceleration / (TAU * TAU)]
    }

    /// The point at which the roller touches the cam, and the direction of the outline there.
    fn profile(&self, angle: f64) -> CurvePoint {
        let [distance, slope, _] = self.distance(angle);
        let (sin, cos) = libm::sincos(angle);
        let (radial, across) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let tangent = (slope * radial + distance * across).normalize();
        // The outward normal is on the right of the direction of travel.
        CurvePoint { point: distance * radial + self.roller * tangent.perp(), tangent }
    }

    /// Curvature [1/m] of the way of the roller's center, positive where it is round to the outside.
    fn curvature(&self, angle: f64) -> f64 {
        let [distance, slope, bend] = self.distance(angle);
        let square = distance * distance + slope * slope;
        (square + slope * slope - distance * bend) / (square * square.sqrt())
    }
}

impl Shape {
    /// A cam about the origin for a radial follower with a roller: with the roller's center on the ray at an angle a from the x axis, it is
    /// `base` + `roller` + lift(a/2 pi) from the origin. The outline is arcs no farther from the true one than `tolerance` [m].
    ///
    /// # Errors
    /// A length that is not positive and finite, a lift that is not the same after a turn (with its slope), that pulls the roller to the axis, or
    /// that bends more than the roller can follow (undercut).
    ///
    /// # Examples
    /// ```
    /// use halfgap_geometry::{Lift, Shape};
    /// use std::f64::consts::TAU;
    ///
    /// let lift = |turn: f64| {
    ///     let (sin, cos) = (TAU * turn).sin_cos();
    ///     Lift { value: 0.01 * (1.0 - cos), rate: 0.01 * TAU * sin, acceleration: 0.01 * TAU * TAU * cos }
    /// };
    /// let cam = Shape::cam(0.04, 0.01, &lift, 1e-6)?;
    /// assert!((cam.reach() - 0.06).abs() < 1e-6);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    pub fn cam(
        base: f64,
        roller: f64,
        lift: &impl Fn(f64) -> Lift,
        tolerance: f64,
    ) -> Result<Self, ShapeError> {
        check_length("base", base)?;
        check_length("roller", roller)?;
        check_length("tolerance", tolerance)?;
        let pitch = Pitch { lift, rest: base + roller, roller };
        check_closed(lift(0.0), lift(1.0), base)?;
        for look in 0..LOOKS {
            let angle = TAU * f64::from(look) / f64::from(LOOKS);
            let [distance, ..] = pitch.distance(angle);
            if distance <= roller {
                return Err(ShapeError::CamTooDeep { angle });
            }
            if pitch.curvature(angle) * roller >= 1.0 {
                return Err(ShapeError::Undercut { angle, radius: pitch.curvature(angle).recip(), roller });
            }
        }
        let profile = |angle: f64| pitch.profile(angle);
        let mut path = PathSpec { start: pitch.profile(0.0).point, edges: Vec::new() };
        for part in 0..PARTS {
            let ends = [part, part + 1].map(|end| TAU * (f64::from(end) / f64::from(PARTS)));
            path.edges.extend(fit_arcs(&profile, ends, tolerance)?);
        }
        Self::from_paths(&[path])
    }
}

/// Refuses a lift that jumps or has a corner where a turn ends.
fn check_closed(first: Lift, last: Lift, base: f64) -> Result<(), ShapeError> {
    let differ = |a: f64, b: f64| (a - b).abs() > ROUNDING * (a.abs() + b.abs() + base);
    if differ(first.value, last.value) {
        return Err(ShapeError::LiftJumps { by: last.value - first.value });
    }
    if differ(first.rate, last.rate) { Err(ShapeError::LiftHasCorner) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(amplitude: f64, count: f64) -> impl Fn(f64) -> Lift {
        move |turn: f64| {
            let frequency = TAU * count;
            let (sin, cos) = libm::sincos(frequency * turn);
            Lift {
                value: amplitude * sin,
                rate: amplitude * frequency * cos,
                acceleration: -amplitude * frequency * frequency * sin,
            }
        }
    }

    #[test]
    fn a_roller_on_the_cam_has_the_lift() {
        for (lift, count) in [(0.06, 1.0), (0.02, 3.0)] {
            for tolerance in [1e-3, 1e-5, 1e-7] {
                let (base, roller) = (0.3, 0.05);
                let cam = Shape::cam(base, roller, &sine(lift, count), tolerance).expect("a fine cam");
                for look in 0..1000 {
                    let angle = TAU * f64::from(look) / 1000.0;
                    let distance = base + roller + lift * libm::sin(count * angle);
                    let (sin, cos) = libm::sincos(angle);
                    let off = cam.nearest(distance * DVec2::new(cos, sin)).signed_distance - roller;
                    assert!(off.abs() <= tolerance, "{off} m of {tolerance} m at {angle}");
                }
            }
        }
    }

    #[test]
    fn cams_that_cannot_be_are_told() {
        let error = |base: f64, roller: f64, lift: &dyn Fn(f64) -> Lift| {
            Shape::cam(base, roller, &lift, 1e-5).expect_err("impossible")
        };
        let [jumps, corner] = [Lift { value: 0.1, ..Lift::default() }, Lift { rate: 0.1, ..Lift::default() }];
        let at_end = |last: Lift| move |turn: f64| if turn < 1.0 { Lift::default() } else { last };
        assert_eq!(error(0.3, 0.05, &at_end(jumps)), ShapeError::LiftJumps { by: 0.1 });
        assert_eq!(error(0.3, 0.05, &at_end(corner)), ShapeError::LiftHasCorner);
        assert!(matches!(error(0.1, 0.05, &sine(0.2, 1.0)), ShapeError::CamTooDeep { angle } if angle > 3.0));
        let ShapeError::Undercut { radius, .. } = error(0.3, 0.2, &sine(0.06, 5.0)) else {
            panic!("the roller is too large")
        };
        assert!(radius > 0.0 && radius < 0.2, "{radius} m");
        assert_eq!(error(0.3, -0.2, &sine(0.06, 5.0)), ShapeError::BadLength { name: "roller", value: -0.2 });
    }
}
