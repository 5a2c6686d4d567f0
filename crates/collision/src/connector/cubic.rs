//! A piece of a spline: a cubic in the parameter.

use super::path::Foot;
use glam::DVec2;

/// Half [rad] of the angle by which the curve, bent as at the start of a step, may turn along the step for the series
/// to be trusted; a longer Newton step is cut to it.
const SOUND_TURN: f64 = 0.25;
/// Change of a step by the later terms of a series up to which they are trusted, as a fraction of the step [-].
const SOUND_CORRECTION: f64 = 0.5;

/// The cubic Q(u) = from + u (slope + u (bend + u twist)) [m] for u from 0 to `width` [m].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Cubic {
    /// Point at u = 0 [m].
    pub(super) from: DVec2,
    /// First derivative at u = 0 [-].
    pub(super) slope: DVec2,
    /// Half of the second derivative at u = 0 [1/m].
    pub(super) bend: DVec2,
    /// A sixth of the third derivative [1/m^2].
    pub(super) twist: DVec2,
    /// Width of the piece in the parameter [m]: the distance of the points that it joins.
    pub(super) width: f64,
}

/// A cubic expanded about one of its parameters u: Q(u + s) = point + s (slope + s (bend + s twist)).
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) point: DVec2,
    pub(super) slope: DVec2,
    pub(super) bend: DVec2,
    twist: DVec2,
}

impl Cubic {
    #[inline]
    pub(super) fn jet(&self, u: f64) -> Jet {
        let Self { from, slope, bend, twist, .. } = *self;
        Jet { point: from, slope, bend, twist }.moved(u)
    }

    #[inline]
    pub(super) fn point(&self, u: f64) -> DVec2 {
        self.from + (self.slope + (self.bend + self.twist * u) * u) * u
    }

    #[inline]
    pub(super) fn speed(&self, u: f64) -> f64 {
        (self.slope + (self.bend * 2.0 + self.twist * (3.0 * u)) * u).length()
    }

    /// Largest size [1/m] of the second derivative, which is linear, between two parameters [m].
    #[inline]
    pub(super) fn largest_second(&self, from: f64, to: f64) -> f64 {
        let at = |u: f64| (self.bend * 2.0 + self.twist * (6.0 * u)).length_squared();
        at(from).max(at(to)).sqrt()
    }

    /// True if a parameter lies within the piece.
    #[inline]
    pub(super) fn has(&self, u: f64) -> bool {
        (0.0..=self.width).contains(&u)
    }
}

impl Jet {
    /// The cubic expanded about a parameter that is `step` [m] further on.
    #[inline]
    pub(super) fn moved(&self, step: f64) -> Self {
        let Self { point, slope, bend, twist } = *self;
        Self {
            point: point + (slope + (bend + twist * step) * step) * step,
            slope: slope + (bend * 2.0 + twist * (3.0 * step)) * step,
            bend: bend + twist * (3.0 * step),
            twist,
        }
    }

    /// The straight continuation of the curve, expanded about a parameter `u` [m] beyond this one.
    pub(super) fn straight_on(&self, u: f64) -> Self {
        let Self { point, slope, .. } = *self;
        Self { point: point + slope * u, slope, bend: DVec2::ZERO, twist: DVec2::ZERO }
    }

    /// The step [m] towards the parameter nearest to a point; `None` if the distance is not convex here, or not a
    /// number.
    ///
    /// With e the way to the point and t1, t2, t3 slope, bend and twist, half of the squared distance has the
    /// derivative f0 + f1 s + f2 s^2 + f3 s^3 + .. with f0 = -e.t1, f1 = t1.t1 - 2 e.t2, f2 = 3 (t1.t2 -
    /// e.t3) and f3 = 2 t2.t2 + 4 t1.t3. The step s = -f0 (f1^2 - f0 f2)/(f1^3 - 2 f0 f1 f2 + f0^2 f3) is
    /// Householder's, of order 4 and with a single division. Where the series is not to be trusted, because the curve,
    /// bent as it is here, turns much along the step ([`SOUND_TURN`]) or the later terms are large
    /// ([`SOUND_CORRECTION`]), Newton's step -f0/f1 is taken, cut.
    ///
    /// Source: A. Householder, "The Numerical Treatment of a Single Nonlinear Equation", 1970, section 4.4.
    #[inline]
    pub(super) fn step_to_nearest(&self, point: DVec2) -> Option<f64> {
        let Self { point: here, slope: t1, bend: t2, twist: t3 } = *self;
        let seen = point - here;
        let speed_sq = t1.length_squared();
        let convexity = speed_sq - 2.0 * seen.dot(t2);
        if convexity.is_nan() || convexity <= 0.0 {
            return None;
        }
        let ahead = seen.dot(t1);
        let bend_sq = t2.length_squared();
        let square = 3.0 * (t1.dot(t2) - seen.dot(t3));
        let cube = 2.0 * bend_sq + 4.0 * t1.dot(t3);
        let convexity_sq = convexity * convexity;
        let over = convexity_sq + ahead * square;
        let under = convexity * convexity_sq + ahead * (2.0 * convexity * square + ahead * cube);
        let turns_little = ahead * ahead * bend_sq <= SOUND_TURN * SOUND_TURN * speed_sq * convexity_sq;
        if turns_little && (over * convexity - under).abs() <= SOUND_CORRECTION * under {
            return Some(ahead * over / under);
        }
        let sound = SOUND_TURN * (speed_sq / bend_sq).sqrt();
        Some((ahead / convexity).clamp(-sound, sound))
    }

    /// The place of the curve here as the foot of `point`, with the curvature k = (Q' x Q'')/|Q'|^3 and its derivative.
    #[inline]
    pub(super) fn foot(&self, piece: usize, parameter: f64, point: DVec2) -> Foot {
        let (first, second, third) = (self.slope, self.bend * 2.0, self.twist * 6.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_to_the_nearest_point_are_of_order_4() {
        let cubic = Cubic {
            from: DVec2::new(0.3, -0.2),
            slope: DVec2::new(1.0, 0.1),
            bend: DVec2::new(0.1, 0.7),
            twist: DVec2::new(-0.3, 0.2),
            width: 1.0,
        };
        let nearest = 0.4;
        let jet = cubic.jet(nearest);
        let point = jet.point + jet.slope.perp() * 0.1;
        let miss = |ahead: f64| {
            let step = cubic.jet(nearest - ahead).step_to_nearest(point).expect("it is near");
            (step - ahead).abs()
        };
        for ahead in [-0.005, 0.005] {
            let order = (miss(ahead) / miss(0.5 * ahead)).log2();
            assert!((order - 4.0).abs() < 0.2, "order {order}");
        }
    }
}
