//! How two features roll on each other: the radius of their relative curvature, and their relative rotation as a row.
//!
//! Against rolling a contact bears a torque of at most c R times its force along the normal. With the rate R (wA - wB) and
//! J = R [0, 0, 1, 0, 0, -1] the torque over R is a force that is bounded as friction is, by c [-], and the rate is a speed.

use crate::motion::Moving;
use crate::tangent::TangentRow;

/// Radius R = 1/|1/rA + 1/rB| \[m\] at which two features roll on each other, of their signed radii; `None` stands for a line,
/// and for the radius on a vertex and where the curvatures cancel: there nothing rolls.
#[must_use]
#[inline]
pub fn rolling_radius(radii: [Option<f64>; 2]) -> Option<f64> {
    if radii.contains(&Some(0.0)) {
        return None;
    }
    let curvature: f64 = radii.iter().flatten().map(|&radius| 1.0 / radius).sum();
    (curvature != 0.0).then(|| 1.0 / curvature.abs())
}

impl TangentRow {
    /// The relative rotation of the primary and of the normal body as the slip \[m/s\] of two circles of a radius \[m\].
    #[must_use]
    #[inline]
    pub fn of_turning(radius: f64, [primary, normal]: [&Moving; 2]) -> Self {
        Self {
            rate: radius * (primary.angular_velocity - normal.angular_velocity),
            jacobian: [0.0, 0.0, radius, 0.0, 0.0, -radius],
            gamma: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvatures_add_up_with_their_signs() {
        for (radii, expected) in [
            ([Some(0.5), None], Some(0.5)),
            ([None, Some(0.5)], Some(0.5)),
            ([Some(1.0), Some(3.0)], Some(0.75)),
            // A disc in a bowl, and a bowl on a disc.
            ([Some(0.5), Some(-2.0)], Some(2.0 / 3.0)),
            ([Some(-2.0), Some(0.5)], Some(2.0 / 3.0)),
            ([Some(2.0), Some(-2.0)], None),
            ([Some(0.0), None], None),
            ([Some(1.0), Some(0.0)], None),
            ([None, None], None),
        ] {
            let found = rolling_radius(radii);
            let is_same = found.zip(expected).map_or(found == expected, |(p, q)| (p - q).abs() < 1e-15);
            assert!(is_same, "{radii:?}: {found:?}");
        }
    }
}
