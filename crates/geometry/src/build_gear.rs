//! Ready-made toothed shapes: involute spur wheels and the racks they run on.
//!
//! Circles, with the module m, z teeth and the pressure angle a: pitch r = m z/2, base r cos(a), tip r + addendum m, root
//! r - dedendum m. Half of a tooth's angle at a radius is its value at the pitch circle plus inv(a) less inv of the
//! pressure angle there, inv(x) = tan(x) - x. Flanks are involutes from the base circle on, and radial below it, down to the root.
//!
//! Source: J. E. Shigley, C. R. Mischke, Mechanical Engineering Design, chapter 13 (spur gears).

use crate::build::check_length;
use crate::edge_spec::EdgeSpec;
use crate::error::ShapeError;
use crate::fit::{CurvePoint, fit_arcs};
use crate::path::PathSpec;
use crate::shape::Shape;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Halvings of an interval of radii, for a limit in a message.
const HALVINGS: u32 = 60;

/// Measures of the teeth of a spur wheel or a rack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Teeth {
    /// Pitch diameter per tooth [m].
    pub module: f64,
    /// Number of teeth.
    pub count: usize,
    /// Angle of the common normal of two teeth to the pitch line [rad].
    pub pressure_angle: f64,
    /// Height of a tooth above the pitch circle, in modules [-].
    pub addendum: f64,
    /// Depth of a tooth below the pitch circle, in modules [-].
    pub dedendum: f64,
    /// Play [m] of two wheels along the pitch circle; each gives half of it.
    pub backlash: f64,
    /// Radius [m] by which the foot of a tooth is rounded; 0 for a sharp one.
    pub root_radius: f64,
    /// By how much flanks may be off [m].
    pub tolerance: f64,
}

impl Teeth {
    /// Pressure angle [rad] of common wheels, 20 degrees.
    pub const PRESSURE_ANGLE: f64 = PI / 9.0;
    /// Share of the module [-] by which flanks may be off, unless one says otherwise.
    pub const TOLERANCE: f64 = 1e-4;

    /// Common teeth: pressure angle 20 degrees, addendum 1, dedendum 1.25, no backlash, sharp feet.
    #[must_use]
    pub fn common(module: f64, count: usize) -> Self {
        Self {
            module,
            count,
            pressure_angle: Self::PRESSURE_ANGLE,
            addendum: 1.0,
            dedendum: 1.25,
            backlash: 0.0,
            root_radius: 0.0,
            tolerance: Self::TOLERANCE * module,
        }
    }

    fn check(&self, least: usize) -> Result<(), ShapeError> {
        check_length("module", self.module)?;
        check_length("tolerance", self.tolerance)?;
        if self.count < least {
            return Err(ShapeError::TooFew { name: "teeth", count: self.count, least });
        }
        if !(self.pressure_angle > 0.0 && self.pressure_angle < FRAC_PI_2) {
            let (name, value, limit) = ("pressure_angle", self.pressure_angle, FRAC_PI_2);
            return Err(ShapeError::BadAngle { name, value, limit });
        }
        for (name, value) in [("addendum", self.addendum), ("dedendum", self.dedendum)] {
            check_length(name, value)?;
        }
        for (name, value) in [("backlash", self.backlash), ("root_radius", self.root_radius)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ShapeError::BadLength { name, value });
            }
        }
        let pitch = PI * self.module;
        below("backlash", self.backlash, pitch)
    }

    /// Thickness [m] of a tooth along the pitch circle.
    fn thickness(&self) -> f64 {
        0.5 * (PI * self.module - self.backlash)
    }
}

/// inv(x) = tan(x) - x of a pressure angle whose tangent this is.
fn involute_of(tangent: f64) -> f64 {
    tangent - libm::atan(tangent)
}

fn below(name: &'static str, value: f64, limit: f64) -> Result<(), ShapeError> {
    if value < limit { Ok(()) } else { Err(ShapeError::OutOfRange { name, value, rule: "less than", limit }) }
}

fn turned(point: DVec2, angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y)
}

fn at_angle(radius: f64, angle: f64) -> DVec2 {
    turned(DVec2::new(radius, 0.0), angle)
}

/// The circles of a spur wheel, and the angle at which its flanks begin.
#[derive(Clone, Copy, Debug)]
struct Wheel {
    teeth: Teeth,
    base: f64,
    tip: f64,
    root: f64,
    /// Angle [rad] from the middle of a tooth to where its flank meets the base circle.
    base_angle: f64,
}

impl Wheel {
    fn new(teeth: Teeth) -> Result<Self, ShapeError> {
        teeth.check(3)?;
        let pitch = 0.5 * teeth.module * teeth.count as f64;
        let (sin, cos) = libm::sincos(teeth.pressure_angle);
        let (tip, root) = (pitch + teeth.addendum * teeth.module, pitch - teeth.dedendum * teeth.module);
        below("dedendum times module", teeth.dedendum * teeth.module, pitch)?;
        let base_angle = 0.5 * teeth.thickness() / pitch + involute_of(sin / cos);
        let wheel = Self { teeth, base: pitch * cos, tip, root, base_angle };
        if wheel.half_angle(tip) <= 0.0 {
            let pointed = bisect([pitch, tip], |radius| wheel.half_angle(radius) > 0.0);
            below("addendum times module", teeth.addendum * teeth.module, pointed - pitch)?;
        }
        Ok(wheel)
    }

    /// Tangent of the pressure angle at a radius; 0 below the base circle.
    fn roll(&self, radius: f64) -> f64 {
        ((radius / self.base).powi(2) - 1.0).max(0.0).sqrt()
    }

    /// Angle [rad] from the middle of a tooth to its flank at a radius [m].
    fn half_angle(&self, radius: f64) -> f64 {
        self.base_angle - involute_of(self.roll(radius))
    }

    /// The upper flank of the tooth on the x axis at a roll angle [rad], on its way to the tip.
    fn flank(&self, roll: f64) -> CurvePoint {
        let (sin, cos) = libm::sincos(self.base_angle - roll);
        let (radial, across) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        CurvePoint { point: self.base * (radial + roll * across), tangent: radial }
    }

    /// Where the foot's rounding touches the flank (a radius [m]) and the root circle (the angle [rad] from the tooth's middle).
    fn foot(&self, rounding: f64) -> (f64, f64) {
        let center = self.root + rounding;
        let on_radial = (center * center - rounding * rounding).sqrt();
        if on_radial <= self.base {
            return (on_radial, self.base_angle + libm::asin(rounding / center));
        }
        // The center is on a tangent of the base circle, as the point of the involute is.
        let length = (center * center - self.base * self.base).sqrt();
        let roll = (length - rounding) / self.base;
        let angle = self.base_angle - roll + libm::atan2(length, self.base);
        (self.base * (1.0 + roll * roll).sqrt(), angle)
    }

    /// The upper half of the tooth on the x axis, from the root circle to its tip.
    fn half_tooth(&self) -> Result<PathSpec, ShapeError> {
        let rounding = self.teeth.root_radius;
        let half_pitch = PI / self.teeth.count as f64;
        let fits = |rounding: f64| {
            let (radius, angle) = self.foot(rounding);
            radius < self.tip && angle < half_pitch
        };
        if !fits(rounding) {
            let limit = bisect([0.0, rounding], fits);
            return Err(ShapeError::OutOfRange {
                name: "root_radius",
                value: rounding,
                rule: "less than",
                limit,
            });
        }
        let (foot, foot_angle) = self.foot(rounding);
        let mut half = PathSpec { start: at_angle(self.root, foot_angle), edges: Vec::new() };
        let first = at_angle(foot, self.half_angle(foot));
        if rounding > 0.0 {
            let center = at_angle(self.root + rounding, foot_angle);
            half.edges.push(EdgeSpec::Arc { to: first, center, clockwise: false });
        }
        if foot < self.base {
            half.edges.push(EdgeSpec::Line { to: at_angle(self.base, self.base_angle) });
        }
        let rolls = [self.roll(foot), self.roll(self.tip)];
        let flank = |roll: f64| self.flank(roll);
        half.edges.extend(fit_arcs(&flank, rolls, self.teeth.tolerance).map_err(ShapeError::Fit)?);
        Ok(half)
    }

    /// The outline, counter-clockwise from the foot of the tooth on the x axis.
    fn outline(&self) -> Result<PathSpec, ShapeError> {
        let half = self.half_tooth()?;
        let up = mirrored(&half, DVec2::new(1.0, -1.0));
        let down = reversed(&half);
        let mut outline = PathSpec { start: up.start, edges: Vec::new() };
        for tooth in 0..self.teeth.count {
            let angle = TAU * (tooth as f64 / self.teeth.count as f64);
            let turn = |edge: &EdgeSpec| turned_edge(edge, angle);
            outline.edges.extend(up.edges.iter().map(turn));
            outline.edges.push(EdgeSpec::Arc {
                to: turned(down.start, angle),
                center: DVec2::ZERO,
                clockwise: false,
            });
            outline.edges.extend(down.edges.iter().map(turn));
            let next = TAU * ((tooth + 1) as f64 / self.teeth.count as f64);
            let to = if tooth + 1 < self.teeth.count { turned(up.start, next) } else { up.start };
            outline.edges.push(EdgeSpec::Arc { to, center: DVec2::ZERO, clockwise: false });
        }
        Ok(outline)
    }
}

/// The last point of an interval up to which something holds, which holds at its start.
fn bisect([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn turned_edge(edge: &EdgeSpec, angle: f64) -> EdgeSpec {
    match *edge {
        EdgeSpec::Line { to } => EdgeSpec::Line { to: turned(to, angle) },
        EdgeSpec::Arc { to, center, clockwise } => {
            EdgeSpec::Arc { to: turned(to, angle), center: turned(center, angle), clockwise }
        }
        EdgeSpec::Bulge { to, bulge } => EdgeSpec::Bulge { to: turned(to, angle), bulge },
    }
}

/// A path on the other side of an axis: coordinates are multiplied by those of `flip`, of which one is -1.
fn mirrored(path: &PathSpec, flip: DVec2) -> PathSpec {
    let edge = |edge: &EdgeSpec| match *edge {
        EdgeSpec::Line { to } => EdgeSpec::Line { to: to * flip },
        EdgeSpec::Arc { to, center, clockwise } => {
            EdgeSpec::Arc { to: to * flip, center: center * flip, clockwise: !clockwise }
        }
        EdgeSpec::Bulge { to, bulge } => EdgeSpec::Bulge { to: to * flip, bulge: -bulge },
    };
    PathSpec { start: path.start * flip, edges: path.edges.iter().map(edge).collect() }
}

/// A path that is open, from its end to its start.
fn reversed(path: &PathSpec) -> PathSpec {
    let starts = std::iter::once(path.start).chain(path.edges.iter().map(EdgeSpec::to));
    let edge = |(edge, to): (&EdgeSpec, DVec2)| match *edge {
        EdgeSpec::Line { .. } => EdgeSpec::Line { to },
        EdgeSpec::Arc { center, clockwise, .. } => EdgeSpec::Arc { to, center, clockwise: !clockwise },
        EdgeSpec::Bulge { bulge, .. } => EdgeSpec::Bulge { to, bulge: -bulge },
    };
    let mut edges: Vec<_> = path.edges.iter().zip(starts).map(edge).collect();
    edges.reverse();
    PathSpec { start: path.edges.last().map_or(path.start, EdgeSpec::to), edges }
}

impl Shape {
    /// An involute spur wheel about the origin, with a tooth on the positive x axis and, if asked for, a round hole of the radius
    /// `bore` [m] in its middle. Flanks are arcs no farther from involutes than the tolerance.
    ///
    /// Below the base circle flanks are radial; wheels of few teeth are not undercut there, so that the tips of others may touch them.
    ///
    /// # Errors
    /// A measure that is not positive, teeth that are pointed below their addendum, feet whose rounding does not fit between two teeth,
    /// or a bore that reaches their root.
    ///
    /// # Examples
    /// ```
    /// use halfgap_geometry::{Shape, Teeth};
    ///
    /// let wheel = Shape::gear(&Teeth::common(0.01, 24), Some(0.02))?;
    /// assert!((wheel.reach() - 0.13).abs() < 1e-15);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    pub fn gear(teeth: &Teeth, bore: Option<f64>) -> Result<Self, ShapeError> {
        let wheel = Wheel::new(*teeth)?;
        let mut paths = vec![wheel.outline()?];
        if let Some(bore) = bore {
            check_length("bore", bore)?;
            below("bore", bore, wheel.root)?;
            paths.push(PathSpec::circle(DVec2::ZERO, bore));
        }
        Self::from_paths(&paths)
    }

    /// A rack: a bar along x with teeth upwards, whose pitch line is the x axis; the middle of the row of teeth is at x = 0. Below the
    /// teeth it is `thickness` [m] thick, and half a space long beyond the first and the last of them.
    ///
    /// # Errors
    /// A measure that is not positive, teeth that are pointed below their addendum, or feet whose rounding does not fit between two teeth.
    pub fn rack_bar(teeth: &Teeth, thickness: f64) -> Result<Self, ShapeError> {
        let rack = Rack::new(*teeth)?;
        check_length("thickness", thickness)?;
        let (right, middle) = (rack.half_tooth(), |tooth: usize| {
            rack.pitch() * (tooth as f64 - 0.5 * (teeth.count - 1) as f64)
        });
        let left = reversed(&mirrored(&right, DVec2::new(-1.0, 1.0)));
        let end = 0.5 * rack.pitch() * teeth.count as f64;
        let start = DVec2::new(end, rack.bottom - thickness);
        let mut edges = vec![EdgeSpec::Line { to: DVec2::new(end, rack.bottom) }];
        for tooth in (0..teeth.count).rev() {
            let shift = DVec2::new(middle(tooth), 0.0);
            for half in [&right, &left] {
                edges.push(EdgeSpec::Line { to: half.start + shift });
                edges.extend(half.edges.iter().map(|edge| edge.translated(shift)));
            }
        }
        let corners = [DVec2::new(-end, rack.bottom), DVec2::new(-end, rack.bottom - thickness), start];
        edges.extend(corners.map(|to| EdgeSpec::Line { to }));
        Self::from_paths(&[PathSpec { start, edges }])
    }
}

/// The lines of a rack.
#[derive(Clone, Copy, Debug)]
struct Rack {
    teeth: Teeth,
    top: f64,
    bottom: f64,
    /// Tangent of the pressure angle.
    slope: f64,
}

impl Rack {
    fn new(teeth: Teeth) -> Result<Self, ShapeError> {
        teeth.check(1)?;
        let slope = libm::tan(teeth.pressure_angle);
        let (top, bottom) = (teeth.addendum * teeth.module, -teeth.dedendum * teeth.module);
        let rack = Self { teeth, top, bottom, slope };
        below("addendum times module", top, 0.5 * teeth.thickness() / slope)?;
        below("dedendum times module", -bottom, 0.5 * (rack.pitch() - teeth.thickness()) / slope)?;
        let flank = (top - bottom) / libm::cos(teeth.pressure_angle);
        let room = 0.5 * rack.pitch() - rack.half_width(bottom);
        below("root_radius", teeth.root_radius, flank.min(room) / rack.foot_share())?;
        Ok(rack)
    }

    fn pitch(&self) -> f64 {
        PI * self.teeth.module
    }

    /// Half of the width of a tooth at a height [m].
    fn half_width(&self, y: f64) -> f64 {
        0.5 * self.teeth.thickness() - y * self.slope
    }

    /// Distance from a foot's corner to where its rounding begins and ends, as a share of its radius [-].
    fn foot_share(&self) -> f64 {
        libm::tan(0.5 * (FRAC_PI_2 - self.teeth.pressure_angle))
    }

    /// The right half of the tooth at x = 0, from its foot to its top.
    fn half_tooth(&self) -> PathSpec {
        let foot = DVec2::new(self.half_width(self.bottom), self.bottom);
        let rounding = self.teeth.root_radius;
        let way = rounding * self.foot_share();
        let (sin, cos) = libm::sincos(self.teeth.pressure_angle);
        let mut half = PathSpec { start: foot + way * DVec2::X, edges: Vec::new() };
        if rounding > 0.0 {
            let (to, center) = (foot + way * DVec2::new(-sin, cos), half.start + rounding * DVec2::Y);
            half.edges.push(EdgeSpec::Arc { to, center, clockwise: true });
        }
        half.edges.push(EdgeSpec::Line { to: DVec2::new(self.half_width(self.top), self.top) });
        half
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;

    /// Largest distance [m] of points of the true flanks of a wheel from its outline.
    fn off(wheel: &Shape, teeth: &Teeth) -> f64 {
        let true_wheel = Wheel::new(*teeth).expect("fine teeth");
        let (foot, _) = true_wheel.foot(teeth.root_radius);
        let (from, to) = (true_wheel.roll(foot), true_wheel.roll(true_wheel.tip));
        let mut most = 0.0f64;
        for sample in 0..1000 {
            let part = f64::from(sample) / 999.0;
            let point = true_wheel.flank(from + part * (to - from)).point;
            let tooth = TAU * f64::from(sample % 7) / teeth.count as f64;
            let side = if sample % 2 == 0 { 1.0 } else { -1.0 };
            most =
                most.max(wheel.nearest(turned(point * DVec2::new(1.0, side), tooth)).signed_distance.abs());
        }
        most
    }

    #[test]
    fn flanks_are_within_the_tolerance_of_the_involute() {
        for (count, pressure_angle, root_radius) in
            [(8, 20.0, 0.0), (20, 20.0, 0.3), (45, 20.0, 0.2), (12, 25.0, 0.25), (200, 14.5, 0.1)]
        {
            for share in [1e-2, 1e-4, 1e-6] {
                let common = Teeth::common(0.02, count);
                let pressure_angle = f64::to_radians(pressure_angle);
                let teeth = Teeth {
                    pressure_angle,
                    root_radius: root_radius * 0.02,
                    tolerance: share * 0.02,
                    ..common
                };
                let wheel = Shape::gear(&teeth, Some(0.01)).expect("a fine wheel");
                assert!(off(&wheel, &teeth) <= teeth.tolerance, "{count} teeth: {} m", off(&wheel, &teeth));
            }
        }
    }

    #[test]
    fn two_wheels_touch_without_play_at_their_center_distance() {
        let teeth = Teeth { tolerance: 1e-9, ..Teeth::common(0.02, 20) };
        let wheel = Shape::gear(&teeth, None).expect("a fine wheel");
        for backlash in [0.0, 1e-3] {
            let thin = Shape::gear(&Teeth { backlash, ..teeth }, None).expect("a fine wheel");
            // A tooth of the one in a space of the other; half of the play on either side, along the common normal.
            let pose = Pose::new(DVec2::new(0.4, 0.0), PI + PI / 20.0);
            let apart = wheel.distance(&Pose::IDENTITY, &thin, &pose).distance;
            let expected = 0.25 * backlash * libm::cos(teeth.pressure_angle);
            assert!((apart - expected).abs() < 1e-8, "{apart} m of {expected} m");
        }
    }

    #[test]
    fn a_rack_is_a_wheel_without_end() {
        let teeth = Teeth { root_radius: 0.004, ..Teeth::common(0.02, 5) };
        let rack = Shape::rack_bar(&teeth, 0.05).expect("a fine rack");
        let sharp = Shape::rack_bar(&Teeth { root_radius: 0.0, ..teeth }, 0.05).expect("a fine rack");
        let (pitch, slope) = (PI * 0.02, libm::tan(teeth.pressure_angle));
        let tooth = (0.5 * pitch + 2.0 * 0.125 * 0.02 * slope) * 2.25 * 0.02;
        let area = sharp.mass_properties().area;
        assert!((area - 5.0 * (tooth + pitch * 0.05)).abs() < 1e-15, "{area}");
        assert!(rack.mass_properties().area > area && rack.mass_properties().centroid.x.abs() < 1e-15);
        // It runs on a wheel whose pitch circle touches its pitch line.
        let wheel =
            Shape::gear(&Teeth { tolerance: 1e-9, ..Teeth::common(0.02, 20) }, None).expect("a fine wheel");
        let pose = Pose::new(DVec2::new(0.0, 0.2), -PI / 2.0 + PI / 20.0);
        let apart = wheel.distance(&pose, &sharp, &Pose::IDENTITY).distance;
        assert!(apart.abs() < 1e-8, "{apart} m");
    }

    #[test]
    fn teeth_that_cannot_be_are_told() {
        let common = Teeth::common(0.02, 20);
        let message = |teeth: Teeth| Shape::gear(&teeth, None).expect_err("impossible").to_string();
        for (teeth, expected) in [
            (Teeth { count: 2, ..common }, "teeth must be at least 3, got 2"),
            (Teeth { module: -1.0, ..common }, "module must be positive and finite, got -1 m"),
            (
                Teeth { addendum: 3.0, ..common },
                "addendum times module is 0.06 m, but must be less than 0.03076675 m",
            ),
            (
                Teeth { root_radius: 0.1, ..common },
                "root_radius is 0.1 m, but must be less than 0.01188445 m",
            ),
            (Teeth { backlash: 0.07, ..common }, "backlash is 0.07 m, but must be less than 0.06283185 m"),
            (
                Teeth { pressure_angle: 0.0, ..common },
                "pressure_angle must be more than 0 and at most 1.570796 rad, got 0 rad",
            ),
        ] {
            assert_eq!(message(teeth), expected);
        }
        let error = Shape::gear(&common, Some(0.2)).expect_err("the bore is too large");
        assert_eq!(error.to_string(), "bore is 0.2 m, but must be less than 0.175 m");
    }
}
