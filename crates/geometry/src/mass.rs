//! Exact area, centroid and second moment of the region that closed paths enclose.
//!
//! Green's theorem turns the integrals over the area into sums over the edges: each edge contributes the triangle
//! between its chord and a reference point, and an arc also the circular segment between chord and arc. With the sweep
//! t (signed) and the radius r a segment has, about the centre of its circle,
//!
//! * area r^2 (t - sin t)/2,
//! * first moment 2/3 r^3 sin^3(t/2) towards the middle of the arc,
//! * polar second moment r^4 (3 t - sin t (2 + cos t))/12.
//!
//! For a shallow arc these are differences of nearly equal numbers, and the centre is far away. There the segment is
//! taken about the middle of its chord instead, over which it rises by h = r (cos a - cos(t/2)) at the angle a from the
//! middle, r sin a along the chord: integrals over a without any cancellation, which a Gauss-Legendre rule sums to full
//! precision.

use crate::arc::Arc;
use crate::edge::Edge;
use crate::path::Path;
use glam::DVec2;

/// Largest sweep [rad] of a segment that is integrated numerically: the rule is exact to rounding up to there.
const SHALLOW: f64 = 0.5;
/// Positive nodes and their weights of the Gauss-Legendre rule with eight points on [-1, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// Area and moments of a region of uniform density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Area [m^2].
    pub area: f64,
    /// Centroid [m].
    pub centroid: DVec2,
    /// Polar second moment of area about the centroid, per area [m^2]: moment of inertia per mass.
    pub moment_per_mass: f64,
}

impl MassProperties {
    /// Integrates over the region to the left of the given closed paths, about `reference` [m].
    #[must_use]
    pub(crate) fn of_paths(paths: &[Path], reference: DVec2) -> Self {
        let sum = paths
            .iter()
            .flat_map(Path::edges)
            .fold(Moments::default(), |sum, edge| sum.plus_edge(edge, reference));
        let offset = sum.first / sum.area;
        Self {
            area: sum.area,
            centroid: reference + offset,
            moment_per_mass: sum.polar / sum.area - offset.length_squared(),
        }
    }

    /// True if area and moment are normal numbers (positive or negative, of full precision) and the centroid is finite.
    pub(crate) fn is_sound(&self) -> bool {
        self.area.is_normal() && self.centroid.is_finite() && self.moment_per_mass.is_normal()
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    area: f64,
    first: DVec2,
    polar: f64,
}

impl Moments {
    fn plus_edge(self, edge: &Edge, reference: DVec2) -> Self {
        let sum = self.plus_triangle(edge.from() - reference, edge.to() - reference);
        match edge {
            Edge::Line(_) => sum,
            Edge::Arc(arc) if arc.sweep_angle().abs() <= SHALLOW => {
                sum.plus_part(shallow_segment(arc), 0.5 * (arc.from() + arc.to()) - reference)
            }
            Edge::Arc(arc) => sum.plus_part(segment(arc), arc.center() - reference),
        }
    }

    fn plus_triangle(self, p: DVec2, q: DVec2) -> Self {
        let twice_area = p.perp_dot(q);
        Self {
            area: self.area + twice_area / 2.0,
            first: self.first + (p + q) * (twice_area / 6.0),
            polar: self.polar + twice_area * (p.dot(p) + p.dot(q) + q.dot(q)) / 12.0,
        }
    }

    /// Adds a part whose moments are about `place` [m], given relative to the reference of the sum.
    fn plus_part(self, part: Moments, place: DVec2) -> Self {
        Self {
            area: self.area + part.area,
            first: self.first + part.first + place * part.area,
            polar: self.polar + part.polar + 2.0 * place.dot(part.first) + place.length_squared() * part.area,
        }
    }
}

/// Moments of the segment between an arc and its chord, about the centre of the circle.
fn segment(arc: &Arc) -> Moments {
    let (r, t) = (arc.radius(), arc.sweep_angle());
    let (sin, cos) = libm::sincos(t);
    let half_sine = libm::sin(t / 2.0);
    Moments {
        area: r * r / 2.0 * (t - sin),
        first: arc.middle_direction() * (2.0 / 3.0 * r * r * r * half_sine * half_sine * half_sine),
        polar: r * r * r * r / 12.0 * (3.0 * t - sin * (2.0 + cos)),
    }
}

/// Moments of the segment between a shallow arc and its chord, about the middle of the chord.
fn shallow_segment(arc: &Arc) -> Moments {
    let (r, half) = (arc.radius(), 0.5 * arc.sweep_angle().abs());
    let (mut area, mut first, mut polar) = (0.0, 0.0, 0.0);
    for (node, weight) in GAUSS {
        let angle = half * node;
        let rise = 2.0 * r * libm::sin(0.5 * (half + angle)) * libm::sin(0.5 * (half - angle));
        let (sin, cos) = libm::sincos(angle);
        // Twice, for both halves of the segment, one on each side of its middle.
        let width = 2.0 * weight * half * r * cos;
        area += rise * width;
        first += 0.5 * rise * rise * width;
        polar += (r * r * sin * sin + rise * rise / 3.0) * rise * width;
    }
    let chord = arc.to() - arc.from();
    let right = -chord.perp() / chord.length();
    if arc.is_convex() {
        Moments { area, first: right * first, polar }
    } else {
        Moments { area: -area, first: right * first, polar: -polar }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_of_a_segment_agree() {
        for sweep in [SHALLOW, -SHALLOW, 0.4, -0.3] {
            let arc = Arc::new(DVec2::new(0.3, -0.2), 2.0, 0.7, sweep).expect("a fine arc");
            let reference = DVec2::new(1.0, 1.0);
            let far = Moments::default().plus_part(segment(&arc), arc.center() - reference);
            let middle = 0.5 * (arc.from() + arc.to());
            let near = Moments::default().plus_part(shallow_segment(&arc), middle - reference);
            assert!((far.area - near.area).abs() < 1e-15, "{sweep}: {} {}", far.area, near.area);
            assert!((far.first - near.first).length() < 1e-14, "{sweep}: {} {}", far.first, near.first);
            assert!((far.polar - near.polar).abs() < 1e-14, "{sweep}: {} {}", far.polar, near.polar);
        }
    }

    #[test]
    fn a_flat_arc_adds_a_parabola() {
        let rise = 1e-6;
        for sign in [1.0, -1.0] {
            let radius = 0.125 / rise + rise / 2.0;
            // Over a chord of 1 m along x, above it as a convex edge run leftwards and as a concave one run rightwards.
            let (from, to, clockwise) =
                if sign > 0.0 { (DVec2::X, DVec2::ZERO, false) } else { (DVec2::ZERO, DVec2::X, true) };
            let center = DVec2::new(0.5, rise - radius);
            let arc = Arc::between(from, to, center, clockwise, 1e-6).expect("a fine arc");
            let part = shallow_segment(&arc);
            assert!((part.area * sign / (rise / 1.5) - 1.0).abs() < 1e-9);
            assert!((part.first.y * sign / (rise * rise * 4.0 / 15.0) - 1.0).abs() < 1e-9);
            assert!((part.polar * sign / (rise / 30.0) - 1.0).abs() < 1e-9);
        }
    }
}
