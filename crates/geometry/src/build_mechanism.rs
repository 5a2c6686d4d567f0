//! Ready-made shapes for mechanisms: capsules, regular polygons, sectors, slotted blocks.

use crate::build::check_length;
use crate::edge_spec::EdgeSpec;
use crate::error::ShapeError;
use crate::path::PathSpec;
use crate::shape::Shape;
use glam::DVec2;
use std::f64::consts::TAU;

impl Shape {
    /// A capsule (stadium) about the origin, lying along x: two half circles of the given radius [m] about centers
    /// `length` [m] apart, joined by straight edges. It is `length + 2 radius` long in total.
    ///
    /// # Errors
    /// A length between the centers or a radius [m] that is not positive and finite.
    pub fn capsule(length: f64, radius: f64) -> Result<Self, ShapeError> {
        check_length("length", length)?;
        check_length("radius", radius)?;
        Self::from_paths(&[stadium(length, radius)])
    }

    /// The regular polygon about the origin whose corners lie on the circle of the given radius [m], the first of them
    /// on the positive x axis.
    ///
    /// # Errors
    /// Fewer than three sides, or a radius [m] that is not positive and finite.
    pub fn regular_polygon(sides: usize, circumradius: f64) -> Result<Self, ShapeError> {
        check_length("circumradius", circumradius)?;
        #[expect(clippy::cast_precision_loss, reason = "nobody draws 2^53 sides")]
        let corner = |index: usize| on_circle(circumradius, TAU * (index as f64 / sides as f64));
        Self::polygon(&(0..sides).map(corner).collect::<Vec<_>>())
    }

    /// The sector (pie slice) of a disc of the given radius [m] about the origin, between the angles `-sweep / 2` and
    /// `sweep / 2` [rad] from the x axis; a full turn gives the disc. Its centroid is not the origin.
    ///
    /// # Errors
    /// A radius [m] that is not positive and finite, a sweep [rad] that is not positive or more than a full
    /// turn, or one so near to a full turn that the straight edges touch.
    pub fn sector(radius: f64, sweep: f64) -> Result<Self, ShapeError> {
        check_length("radius", radius)?;
        if !(sweep > 0.0 && sweep <= TAU) {
            return Err(ShapeError::BadAngle { name: "sweep", value: sweep, limit: TAU });
        }
        if sweep == TAU {
            return Self::disc(radius);
        }
        let (first, last) = (on_circle(radius, -sweep / 2.0), on_circle(radius, sweep / 2.0));
        let arc = EdgeSpec::Arc { to: last, center: DVec2::ZERO, clockwise: false };
        let edges = vec![EdgeSpec::Line { to: first }, arc, EdgeSpec::Line { to: DVec2::ZERO }];
        Self::from_paths(&[PathSpec { start: DVec2::ZERO, edges }])
    }

    /// A rectangle about the origin with a slot along x in its middle: a hole in the form of a capsule, `slot_length`
    /// [m] between the centers of its round ends and `2 slot_radius` [m] wide.
    ///
    /// (A solid in the form of a slot is a [`capsule`](Self::capsule).)
    ///
    /// # Errors
    /// A measure [m] that is not positive and finite, or a slot that does not fit into the rectangle.
    pub fn slotted_block(
        width: f64,
        height: f64,
        slot_length: f64,
        slot_radius: f64,
    ) -> Result<Self, ShapeError> {
        check_length("width", width)?;
        check_length("height", height)?;
        check_length("slot_length", slot_length)?;
        check_length("slot_radius", slot_radius)?;
        let rule = "less than";
        if slot_radius >= height / 2.0 {
            let (name, limit) = ("slot_radius", height / 2.0);
            return Err(ShapeError::OutOfRange { name, value: slot_radius, rule, limit });
        }
        if slot_length >= width - 2.0 * slot_radius {
            let (name, limit) = ("slot_length", width - 2.0 * slot_radius);
            return Err(ShapeError::OutOfRange { name, value: slot_length, rule, limit });
        }
        let corner = DVec2::new(width / 2.0, height / 2.0);
        let flip = DVec2::new(-corner.x, corner.y);
        let rectangle = PathSpec::polygon(&[-corner, -flip, corner, flip]);
        Self::from_paths(&[rectangle, stadium(slot_length, slot_radius)])
    }
}

fn on_circle(radius: f64, angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin) * radius
}

/// The counter-clockwise outline of a capsule, see [`Shape::capsule`].
fn stadium(length: f64, radius: f64) -> PathSpec {
    let (x, y) = (length / 2.0, radius);
    let cap =
        |x: f64, y: f64| EdgeSpec::Arc { to: DVec2::new(x, y), center: DVec2::new(x, 0.0), clockwise: false };
    let edges = vec![
        EdgeSpec::Line { to: DVec2::new(x, -y) },
        cap(x, y),
        EdgeSpec::Line { to: DVec2::new(-x, y) },
        cap(-x, -y),
    ];
    PathSpec { start: DVec2::new(-x, -y), edges }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_capsule_is_a_block_and_a_disc() {
        let shape = Shape::capsule(3.0, 0.5).expect("a fine capsule");
        let mass = shape.mass_properties();
        assert!((mass.area - (3.0 + PI * 0.25)).abs() < 1e-14 && mass.centroid.length() < 1e-15);
        assert_eq!(shape.features().len(), 4, "a capsule is smooth");
        assert_eq!(shape.reach(), 2.0);
    }

    #[test]
    fn a_regular_polygon_tends_to_a_disc() {
        let mass = Shape::regular_polygon(1000, 2.0).expect("a fine polygon").mass_properties();
        assert!((mass.area / (4.0 * PI) - 1.0).abs() < 1e-5);
        assert!((mass.moment_per_mass / 2.0 - 1.0).abs() < 1e-5);
        assert_eq!(Shape::regular_polygon(2, 1.0).err(), Some(ShapeError::TooFewVertices(2)));
    }

    #[test]
    fn a_sector_has_its_share_of_the_disc() {
        for sweep in [0.1, 1.0, PI, 4.0, 6.0, TAU - 1e-6, TAU] {
            let mass = Shape::sector(2.0, sweep).expect("a fine sector").mass_properties();
            assert!((mass.area - 2.0 * sweep).abs() < 1e-14, "sweep {sweep}");
            let expected = 4.0 / 3.0 * 2.0 * (sweep / 2.0).sin() / sweep;
            assert!((mass.centroid - DVec2::new(expected, 0.0)).length() < 1e-14, "sweep {sweep}");
            assert!((mass.moment_per_mass - (2.0 - expected * expected)).abs() < 1e-14, "sweep {sweep}");
        }
    }

    #[test]
    fn a_slotted_block_lacks_a_capsule() {
        let mass = Shape::slotted_block(4.0, 2.0, 1.0, 0.5).expect("a fine block").mass_properties();
        assert!((mass.area - (8.0 - 1.0 - PI * 0.25)).abs() < 1e-14);
    }
}
