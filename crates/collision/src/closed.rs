//! First contact of a feature pair whose gap is a quadratic in time.
//!
//! Two cases have closed forms: two centres in uniform relative motion, for which |d|^2 is a quadratic, and a
//! centre on a parabola against a line that does not turn, for which the gap itself is one. A centre moves on
//! its body's parabola if it is the centre of mass or if the body does not turn.

use crate::motion::{Motion, Polynomial};
use crate::quadratic::{first_closing_by, first_closing_time};
use crate::tolerances::rounding;
use glam::DVec2;
use halfgap_geometry::{Feature, LineFeature, PairKind, Pose, RoundFeature, touching_distance};

/// The gap of a feature pair, less its target, as c + v t + a t^2/2 in a unit that is zero at the target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quadratic {
    c: f64,
    v: f64,
    a: f64,
    /// The discriminant v^2 - 2 a c.
    discriminant: f64,
    /// Units of c per metre of gap near the target: c over it is a distance [m].
    scale: f64,
    /// Rounding of v, in its unit: a smaller rate is rounding only.
    v_rounding: f64,
}

impl Quadratic {
    /// First time [s] at which the pair is at or below its target and closes; `None` if it never does.
    ///
    /// A pair that starts deeper than `depth` [m] lies behind: it must rise to its target before it can close to it.
    #[inline]
    pub(crate) fn first_closing(&self, depth: f64) -> Option<f64> {
        let deepest = -depth * self.scale;
        if self.c < deepest {
            // A rate that is only rounding does not count as rising.
            let rises = self.v > self.v_rounding
                && self.a < 0.0
                && self.c - 0.5 * self.v * self.v / self.a >= deepest;
            if !rises {
                return None;
            }
        }
        // At the target a rate that is only rounding neither closes nor opens: the acceleration decides.
        let still = self.c <= 0.0 && self.v.abs() <= self.v_rounding;
        if still {
            first_closing_time(self.c, 0.0, self.a)
        } else {
            first_closing_by(self.c, self.v, self.a, self.discriminant)
        }
    }

    /// Time [s] up to which a pair that closes at `time` [s] goes on closing and is no deeper than `depth` [m].
    pub(crate) fn closes_until(&self, time: f64, depth: f64) -> f64 {
        let (c, v) = (self.c + (self.v + 0.5 * self.a * time) * time, self.v + self.a * time);
        let turns = if self.a > 0.0 { (-v / self.a).max(0.0) } else { f64::INFINITY };
        let is_deep = first_closing_time(c + depth * self.scale, v, self.a).unwrap_or(f64::INFINITY);
        time + turns.min(is_deep)
    }

    /// [`Self::first_closing`] [s] of two centres outside of each other, for which a is not negative; infinite if
    /// there is none.
    ///
    /// Whether two discs near each other meet is unpredictable: except for discs that touch already, this is computed
    /// without branches.
    #[inline]
    pub(crate) fn first_meeting(&self, depth: f64) -> f64 {
        if self.c <= 0.0 {
            return self.first_closing(depth).unwrap_or(f64::INFINITY);
        }
        let meets = (self.v < 0.0) & (self.discriminant >= 0.0);
        let time = 2.0 * self.c / (self.discriminant.max(0.0).sqrt() - self.v);
        [f64::INFINITY, time][usize::from(meets)]
    }
}

/// The quadratic of a feature pair, `None` if it has none. `offsets` [s] are the offsets in the two motions at t = 0,
/// `target` [m] is the target gap.
pub(crate) fn quadratic<A: Motion, B: Motion>(
    kind: PairKind,
    (feature_a, motion_a): (&Feature, &A),
    (feature_b, motion_b): (&Feature, &B),
    offsets: [f64; 2],
    target: f64,
) -> Option<Quadratic> {
    match (kind, feature_a, feature_b) {
        (PairKind::RoundLine, Feature::Round(round), Feature::Line(line)) => {
            let center = center_path(round, motion_a, offsets[0])?;
            of_line(center, round.radius, line, motion_b, offsets[1], target)
        }
        (PairKind::LineRound, Feature::Line(line), Feature::Round(round)) => {
            let center = center_path(round, motion_b, offsets[1])?;
            of_line(center, round.radius, line, motion_a, offsets[0], target)
        }
        (_, Feature::Round(round_a), Feature::Round(round_b)) => {
            let a = center_path(round_a, motion_a, offsets[0])?;
            let b = center_path(round_b, motion_b, offsets[1])?;
            let radii = touching_distance(round_a, round_b);
            of_centers(&a, &b, radii, kind == PairKind::Inner, target)
        }
        _ => None,
    }
}

/// The parabola of a feature's centre from `offset` [s] on; `None` if it follows another curve.
fn center_path<M: Motion>(round: &RoundFeature, motion: &M, offset: f64) -> Option<Polynomial> {
    let body = motion.polynomial_from(offset)?;
    if round.center == DVec2::ZERO {
        return Some(body);
    }
    motion.is_rotation_free().then(|| {
        let arm = motion.moving_at(offset).pose.vector_to_world(round.center);
        Polynomial { position: body.position + arm, ..body }
    })
}

/// The quadratic of two centres on parabolas, `radii` [m] being the sum of the signed radii, `target` [m] the target
/// gap. `None` if their accelerations differ.
#[inline]
pub(crate) fn of_centers(
    a: &Polynomial,
    b: &Polynomial,
    radii: f64,
    inner: bool,
    target: f64,
) -> Option<Quadratic> {
    if a.acceleration != b.acceleration {
        return None;
    }
    let d = a.position - b.position;
    let u = a.velocity - b.velocity;
    let speeds = a.velocity.length() + b.velocity.length();
    let sign = if inner { -1.0 } else { 1.0 };
    // sign (|d|^2 - reach^2) by the product, in which the gap's digits survive.
    let reach = sign * (radii + target);
    let distance = d.length();
    let c = sign * (distance - reach) * (distance + reach);
    let (v, a) = (2.0 * sign * d.dot(u), 2.0 * sign * u.length_squared());
    // v^2 - 2 a c is 4 (|u|^2 reach^2 - (d x u)^2): in this form the distance at which the centres pass keeps its
    // digits, however far away they are now and however small the radii.
    let (near, pass) = (u.length() * reach, d.perp_dot(u).abs());
    let discriminant = 4.0 * (near - pass) * (near + pass);
    let v_rounding = 2.0 * distance * rounding(speeds);
    Some(Quadratic { c, v, a, discriminant, scale: 2.0 * reach, v_rounding })
}

fn of_line<M: Motion>(
    center: Polynomial,
    radius: f64,
    line: &LineFeature,
    motion: &M,
    offset: f64,
    target: f64,
) -> Option<Quadratic> {
    let body = motion.polynomial_from(offset)?;
    if !motion.is_rotation_free() {
        return None;
    }
    let Pose { position, rotation } = motion.moving_at(offset).pose;
    let normal = rotation.apply(line.normal);
    let height = normal.dot(center.position - position);
    let c = height - line.offset - radius - target;
    let v = normal.dot(center.velocity - body.velocity);
    let a = normal.dot(center.acceleration - body.acceleration);
    let v_rounding = rounding(center.velocity.length() + body.velocity.length());
    Some(Quadratic { c, v, a, discriminant: v * v - 2.0 * a * c, scale: 1.0, v_rounding })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_behind_a_hole_that_does_not_move_against_it_never_closes() {
        // A corner four radii outside of a body's hole, with which it falls, up to the last digit of its velocity.
        let acceleration = DVec2::new(0.0, -10.0);
        let hole = Polynomial { position: DVec2::ZERO, velocity: DVec2::new(0.2, -0.3), acceleration };
        for towards in [-f64::EPSILON, f64::EPSILON] {
            let velocity = hole.velocity - DVec2::new(towards * 0.2, 0.0);
            let corner = Polynomial { position: DVec2::new(5.0, 0.0), velocity, acceleration };
            let gap = of_centers(&corner, &hole, -1.0, true, 1e-8).expect("both fall alike");
            assert_eq!(gap.first_closing(1e-6), None, "{gap:?}");
        }
    }
}
