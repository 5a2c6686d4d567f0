//! Ready-made wheels that stop and index: ratchets and Geneva wheels.

use crate::build::check_length;
use crate::edge_spec::EdgeSpec;
use crate::error::ShapeError;
use crate::path::PathSpec;
use crate::shape::Shape;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// Least number of teeth of a ratchet, and of slots of a Geneva wheel: with fewer the outline would run through the middle.
const LEAST: usize = 3;

/// To which side the steep faces of a ratchet look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lean {
    /// Counter-clockwise.
    #[default]
    Left,
    /// Clockwise.
    Right,
}

/// Measures of a Geneva wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenevaWheel {
    /// Number of slots.
    pub slots: usize,
    /// Distance [m] from its axis to that of the crank.
    pub center_distance: f64,
    /// Radius [m] of the crank's pin.
    pub pin_radius: f64,
    /// Play [m] of the pin in a slot, to either side and at its end.
    pub clearance: f64,
    /// Radius [m] of the hollows in which the crank's disc holds the wheel; without, the rim is round.
    pub lock_radius: Option<f64>,
}

impl GenevaWheel {
    /// Distance [m] from the crank's axis to its pin, which goes into the slots and out of them along them.
    #[must_use]
    pub fn crank_radius(&self) -> f64 {
        self.center_distance * libm::sin(PI / self.slots as f64)
    }

    /// Distance [m] from the wheel's axis to where the pin comes in.
    fn entry(&self) -> f64 {
        self.center_distance * libm::cos(PI / self.slots as f64)
    }
}

fn at_angle(radius: f64, angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    radius * DVec2::new(cos, sin)
}

fn require(count: usize, name: &'static str) -> Result<(), ShapeError> {
    if count < LEAST { Err(ShapeError::TooFew { name, count, least: LEAST }) } else { Ok(()) }
}

fn within(name: &'static str, value: f64, rule: &'static str, limit: f64) -> Result<(), ShapeError> {
    let holds = if rule == "less than" { value < limit } else { value > limit };
    if holds { Ok(()) } else { Err(ShapeError::OutOfRange { name, value, rule, limit }) }
}

impl Shape {
    /// A ratchet wheel about the origin: each tooth has a radial face between the inner and the outer radius [m] and a straight back.
    /// The first face is on the positive x axis.
    ///
    /// # Errors
    /// Fewer than three teeth, a radius that is not positive and finite, or an inner one that is not less than the outer one.
    pub fn ratchet(teeth: usize, outer: f64, inner: f64, lean: Lean) -> Result<Self, ShapeError> {
        require(teeth, "teeth")?;
        check_length("outer", outer)?;
        check_length("inner", inner)?;
        within("inner", inner, "less than", outer)?;
        let turn = TAU / teeth as f64;
        let side = if lean == Lean::Left { 1.0 } else { -1.0 };
        let corners = (0..teeth).flat_map(|tooth| {
            let angle = side * turn * tooth as f64;
            [at_angle(outer, angle), at_angle(inner, angle)]
        });
        Self::polygon(&corners.collect::<Vec<_>>())
    }

    /// A Geneva wheel about the origin, whose first slot is on the positive x axis. A slot is as deep as the pin needs; its mouth is where the
    /// pin comes in along it.
    ///
    /// # Errors
    /// Fewer than three slots, a length that is not positive and finite, slots that run into each other, or hollows that miss the rim or cut
    /// into the slots.
    pub fn geneva(wheel: &GenevaWheel) -> Result<Self, ShapeError> {
        let GenevaWheel { slots, center_distance, pin_radius, clearance, lock_radius } = *wheel;
        require(slots, "slots")?;
        check_length("center_distance", center_distance)?;
        check_length("pin_radius", pin_radius)?;
        if !(clearance >= 0.0 && clearance.is_finite()) {
            return Err(ShapeError::BadLength { name: "clearance", value: clearance });
        }
        let (half_turn, half_width) = (PI / slots as f64, pin_radius + clearance);
        let (entry, end) = (wheel.entry(), center_distance - wheel.crank_radius());
        within("pin_radius and clearance", half_width, "less than", end * libm::sin(half_turn))?;
        let mouth = DVec2::new(entry, half_width);
        let rim = mouth.length();
        // Angles from the middle of a slot.
        let from = libm::atan2(half_width, entry);
        let hollow = match lock_radius {
            None => None,
            Some(radius) => {
                check_length("lock_radius", radius)?;
                let center = at_angle(center_distance, half_turn);
                within("lock_radius", radius, "more than", center_distance - rim)?;
                within("lock_radius", radius, "less than", (center - mouth).length())?;
                let cosine = (center_distance * center_distance + rim * rim - radius * radius)
                    / (2.0 * center_distance * rim);
                Some(half_turn - libm::acos(cosine.min(1.0)))
            }
        };
        let start = DVec2::new(end, -half_width);
        let mut path = PathSpec { start, edges: Vec::new() };
        for slot in 0..slots {
            let angle = TAU * (slot as f64 / slots as f64);
            let turned = |point: DVec2| {
                let (sin, cos) = libm::sincos(angle);
                DVec2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y)
            };
            let arc = |to: DVec2, center: DVec2, clockwise: bool| EdgeSpec::Arc { to, center, clockwise };
            let next = DVec2::new(entry, -half_width);
            // Of the next slot, in the coordinates of this one.
            let (sin, cos) = libm::sincos(2.0 * half_turn);
            let beyond =
                |point: DVec2| DVec2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y);
            path.edges.push(arc(turned(DVec2::new(end, half_width)), turned(DVec2::new(end, 0.0)), true));
            path.edges.push(EdgeSpec::Line { to: turned(mouth) });
            if let Some(hollow) = hollow {
                let lock_center = turned(at_angle(center_distance, half_turn));
                if hollow > from {
                    path.edges.push(arc(turned(at_angle(rim, hollow)), DVec2::ZERO, false));
                }
                path.edges.push(arc(turned(at_angle(rim, 2.0 * half_turn - hollow)), lock_center, true));
            }
            path.edges.push(arc(turned(beyond(next)), DVec2::ZERO, false));
            let to = if slot + 1 < slots { turned(beyond(start)) } else { start };
            path.edges.push(EdgeSpec::Line { to });
        }
        Self::from_paths(&[path])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratchet_is_made_of_triangles() {
        for lean in [Lean::Left, Lean::Right] {
            let wheel = Shape::ratchet(12, 0.5, 0.4, lean).expect("a fine ratchet");
            let mass = wheel.mass_properties();
            assert!(
                (mass.area - 12.0 * 0.5 * 0.5 * 0.4 * 0.5).abs() < 1e-15 && mass.centroid.length() < 1e-15
            );
            assert!((wheel.reach() - 0.5).abs() < 1e-15 && wheel.edges().count() == 24);
            // Just beyond the face on the x axis, on the side to which it looks, there is nothing.
            let beyond = if lean == Lean::Left { 0.01 } else { -0.01 };
            let [free, solid] = [beyond, -beyond].map(|y| wheel.nearest(DVec2::new(0.45, y)).signed_distance);
            assert!(free > 0.0 && solid < 0.0, "{lean:?}: {free}, {solid}");
        }
    }

    #[test]
    fn a_geneva_wheel_has_room_for_the_pin_and_no_more() {
        for (slots, lock_radius) in [(4, None), (6, Some(0.35)), (3, Some(0.7)), (12, Some(0.2))] {
            let measures =
                GenevaWheel { slots, center_distance: 1.0, pin_radius: 0.02, clearance: 0.001, lock_radius };
            let wheel = Shape::geneva(&measures).expect("a fine wheel");
            assert!(wheel.mass_properties().centroid.length() < 1e-14);
            let (crank, half_turn) = (measures.crank_radius(), PI / slots as f64);
            // The pin on its way through the slot on the x axis, which turns with the wheel.
            for step in 0..=100 {
                let angle = (0.5 * PI - half_turn) * (f64::from(step) / 50.0 - 1.0);
                let pin = DVec2::new(1.0 - crank * libm::cos(angle), crank * libm::sin(angle));
                let room = wheel.nearest(DVec2::new(pin.length(), 0.0)).signed_distance;
                assert!((room - 0.021).abs() < 1e-12, "{slots} slots at {angle}: {room}");
            }
            if let Some(radius) = lock_radius {
                let held = wheel.nearest(at_angle(1.0, half_turn)).signed_distance;
                assert!((held - radius).abs() < 1e-12, "{slots} slots: {held}");
            }
        }
    }

    #[test]
    fn wheels_that_cannot_be_are_told() {
        let measures = GenevaWheel {
            slots: 6,
            center_distance: 1.0,
            pin_radius: 0.02,
            clearance: 0.0,
            lock_radius: None,
        };
        let message = |wheel: GenevaWheel| Shape::geneva(&wheel).expect_err("impossible").to_string();
        for (wheel, expected) in [
            (GenevaWheel { slots: 2, ..measures }, "slots must be at least 3, got 2"),
            (
                GenevaWheel { pin_radius: 0.3, ..measures },
                "pin_radius and clearance is 0.3 m, but must be less than 0.25 m",
            ),
            (
                GenevaWheel { clearance: -0.1, ..measures },
                "clearance must be positive and finite, got -0.1 m",
            ),
            (
                GenevaWheel { lock_radius: Some(0.1), ..measures },
                "lock_radius is 0.1 m, but must be more than 0.1337437 m",
            ),
            (
                GenevaWheel { lock_radius: Some(0.5), ..measures },
                "lock_radius is 0.5 m, but must be less than 0.48 m",
            ),
        ] {
            assert_eq!(message(wheel), expected);
        }
        let error = Shape::ratchet(12, 0.5, 0.5, Lean::Left).expect_err("no teeth");
        assert_eq!(error.to_string(), "inner is 0.5 m, but must be less than 0.5 m");
    }
}
