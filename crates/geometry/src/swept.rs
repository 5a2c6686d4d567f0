//! The box around a shape throughout a motion.
//!
//! Geometry knows no time: a motion is bounded by the box of its positions and the interval of its angles. Of all turns
//! in the interval the extent along an axis is largest where a point's direction meets the axis, or at an end of the
//! interval; in body coordinates it is the axis that turns. The extent of an arc about c of radius r along u is c.u + r
//! if the arc has a point in the direction u from c, and that of one of its ends otherwise.

use crate::bounds::Aabb;
use crate::feature::{DirectionRange, Feature, RoundFeature};
use crate::pose::Rotation;
use crate::shape::Shape;
use crate::tree::Node;
use glam::DVec2;
use std::f64::consts::TAU;

/// Bounds of a body's motion: any of the positions may be taken with any of the angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionBound {
    /// Box [m] around all positions of the body's origin.
    pub positions: Aabb,
    /// Least angle [rad].
    pub from_angle: f64,
    /// Largest angle [rad], not less than `from_angle`.
    pub to_angle: f64,
}

impl Shape {
    /// Smallest axis-aligned box [m, world coordinates] (to rounding) that contains the shape at every position and
    /// angle of a motion.
    ///
    /// # Examples
    ///
    /// ```
    /// # use halfgap_geometry::{Aabb, DVec2, MotionBound, Shape};
    /// // A square that turns by an eighth stands on its corner in the end.
    /// let square = Shape::block(2.0, 2.0)?;
    /// let positions = Aabb::around(DVec2::new(5.0, 0.0));
    /// let to_angle = std::f64::consts::FRAC_PI_4;
    /// let bounds = square.swept_bounds(&MotionBound { positions, from_angle: 0.0, to_angle });
    /// assert!((bounds.max.x - 5.0 - 2f64.sqrt()).abs() < 1e-14);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn swept_bounds(&self, motion: &MotionBound) -> Aabb {
        let turn = motion.to_angle - motion.from_angle;
        let (first, last) = (Rotation::from_angle(motion.to_angle), Rotation::from_angle(motion.from_angle));
        let extent = |axis: DVec2| {
            let axes = if turn >= TAU {
                DirectionRange::Full
            } else {
                DirectionRange::between(first.unapply(axis), last.unapply(axis), turn)
            };
            self.turning_extent(&axes)
        };
        let max = DVec2::new(extent(DVec2::X), extent(DVec2::Y));
        let min = DVec2::new(-extent(DVec2::NEG_X), -extent(DVec2::NEG_Y));
        Aabb { min: motion.positions.min + min, max: motion.positions.max + max }
    }

    /// Largest extent [m] of the shape along any of the given axes.
    fn turning_extent(&self, axes: &DirectionRange) -> f64 {
        let bound = |node: &Node| -(point_extent(node.center, axes) + node.radius);
        let farthest = self
            .tree()
            .find_least(f64::INFINITY, &bound, &mut |id| Some((-feature_extent(self.feature(id), axes), ())));
        farthest.map_or(0.0, |(least, ())| -least)
    }
}

/// Largest extent [m] of a point along any of the axes.
fn point_extent(point: DVec2, axes: &DirectionRange) -> f64 {
    let distance = point.length();
    match axes.ends() {
        Some([from, to]) if distance == 0.0 || !axes.contains(point / distance) => {
            point.dot(from).max(point.dot(to))
        }
        _ => distance,
    }
}

fn feature_extent(feature: &Feature, axes: &DirectionRange) -> f64 {
    match feature {
        Feature::Line(line) => {
            point_extent(line.point_at(line.start), axes).max(point_extent(line.point_at(line.end), axes))
        }
        Feature::Round(round) => round_extent(round, axes),
    }
}

fn round_extent(round: &RoundFeature, axes: &DirectionRange) -> f64 {
    let (center, radius) = (round.center, round.radius.abs());
    let of_ends = round.range.ends().map_or(f64::NEG_INFINITY, |ends| {
        let [first, last] = ends.map(|end| point_extent(center + end * radius, axes));
        first.max(last)
    });
    // The neighbours of a concave arc reach farther than its inner points.
    if round.radius < 0.0 {
        return of_ends;
    }
    let distance = center.length();
    let away = (distance > 0.0).then(|| center / distance);
    let along_center = away.filter(|&away| axes.contains(away) && round.range.contains(away));
    let candidates = along_center.into_iter().chain(axes.ends().into_iter().flatten());
    let of_inside =
        candidates.filter(|&axis| round.range.contains(axis)).map(|axis| center.dot(axis) + radius);
    let of_inside = of_inside.fold(f64::NEG_INFINITY, f64::max);
    // A whole circle about the body's origin reaches equally far along all axes.
    let of_circle =
        if away.is_none() && round.range == DirectionRange::Full { radius } else { f64::NEG_INFINITY };
    of_ends.max(of_inside).max(of_circle)
}
