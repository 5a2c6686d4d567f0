//! A piece of a spline: a cubic in the parameter.

use super::path::Foot;
use glam::DVec2;

/// Q(u) = from + u (slope + u (bend + u twist)) for u from 0 to `width`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cubic {
    pub(super) from: DVec2,
    pub(super) slope: DVec2,
    pub(super) bend: DVec2,
    pub(super) twist: DVec2,
    /// Width of the piece in the parameter [m]: the distance of the points it joins.
    pub(super) width: f64,
}

/// A point of a cubic with its derivatives by the parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) point: DVec2,
    pub(super) first: DVec2,
    pub(super) second: DVec2,
    pub(super) third: DVec2,
}

impl Cubic {
    #[inline]
    pub(super) fn jet(&self, u: f64) -> Jet {
        let Self { from, slope, bend, twist, .. } = *self;
        Jet {
            point: from + (slope + (bend + twist * u) * u) * u,
            first: slope + (bend * 2.0 + twist * (3.0 * u)) * u,
            second: bend * 2.0 + twist * (6.0 * u),
            third: twist * 6.0,
        }
    }

    #[inline]
    pub(super) fn speed(&self, u: f64) -> f64 {
        (self.slope + (self.bend * 2.0 + self.twist * (3.0 * u)) * u).length()
    }

    /// Largest size of the second derivative between two parameters, in which it is linear.
    #[inline]
    pub(super) fn largest_second(&self, from: f64, to: f64) -> f64 {
        let at = |u: f64| (self.bend * 2.0 + self.twist * (6.0 * u)).length_squared();
        at(from).max(at(to)).sqrt()
    }
}

impl Jet {
    /// The jet of a straight continuation, `u` beyond this one.
    pub(super) fn straight_on(&self, u: f64) -> Self {
        let Self { point, first, .. } = *self;
        Self { point: point + first * u, first, second: DVec2::ZERO, third: DVec2::ZERO }
    }

    /// What the curve is here, as the foot of `point`: k = (Q' x Q'')/|Q'|^3 and its derivative.
    #[inline]
    pub(super) fn foot(&self, piece: usize, parameter: f64, point: DVec2) -> Foot {
        let Jet { first, second, third, .. } = *self;
        let speed_sq = first.length_squared();
        let inverse = 1.0 / speed_sq.sqrt();
        let tangent = first * inverse;
        let normal = tangent.perp();
        let inverse_cubed = inverse * inverse * inverse;
        let curvature = first.perp_dot(second) * inverse_cubed;
        let by_parameter =
            first.perp_dot(third) * inverse_cubed - 3.0 * curvature * first.dot(second) * inverse * inverse;
        Foot {
            piece: u32::try_from(piece).unwrap_or(u32::MAX),
            parameter,
            point: self.point,
            tangent,
            normal,
            curvature,
            curvature_rate: by_parameter * inverse,
            gap: normal.dot(point - self.point),
        }
    }
}
