//! Area, centroid and second moment of what closed paths enclose, exactly.
//!
//! Green's theorem turns the integrals over the area into sums over the edges: each edge contributes the triangle
//! between its chord and a reference point, and an arc also the circular segment between chord and arc. With the sweep
//! t (signed) and the radius r a segment has, about the centre of its circle,
//!
//! * area r^2 (t - sin t)/2,
//! * first moment 2/3 r^3 sin^3(t/2) towards the middle of the arc,
//! * polar second moment r^4 (3 t - sin t (2 + cos t))/12,
//!
//! all of them differences of nearly equal numbers for a shallow arc, for which the series are summed instead.

use crate::arc::Arc;
use crate::edge::Edge;
use crate::path::Path;
use glam::DVec2;

/// Below this sweep [rad] the series of the segment integrals are more exact than their closed forms.
const SHALLOW: f64 = 0.5;
/// Terms of the series: enough for full precision below `SHALLOW`.
const SERIES_TERMS: u32 = 9;

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
    /// Integrates over the region to the left of the given closed paths.
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
            Edge::Arc(arc) => sum.plus_segment(arc, reference),
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

    fn plus_segment(self, arc: &Arc, reference: DVec2) -> Self {
        let (r, t) = (arc.radius(), arc.sweep_angle());
        let half_sine = libm::sin(t / 2.0);
        let area = r * r / 2.0 * sweep_minus_sine(t);
        let first = arc.middle_direction() * (2.0 / 3.0 * r * r * r * half_sine * half_sine * half_sine);
        let polar_about_center = r * r * r * r / 12.0 * polar_factor(t);
        let center = arc.center() - reference;
        Self {
            area: self.area + area,
            first: self.first + first + center * area,
            polar: self.polar + polar_about_center + 2.0 * center.dot(first) + center.length_squared() * area,
        }
    }
}

/// t - sin t.
fn sweep_minus_sine(t: f64) -> f64 {
    if t.abs() > SHALLOW { t - libm::sin(t) } else { odd_series(t, |_| 1.0) }
}

/// 3 t - sin t (2 + cos t).
fn polar_factor(t: f64) -> f64 {
    if t.abs() > SHALLOW {
        let (sin, cos) = libm::sincos(t);
        3.0 * t - sin * (2.0 + cos)
    } else {
        odd_series(t, |k| 2.0 + libm::pow(4.0, f64::from(k)))
    }
}

/// Sum over k = 1, 2, ... of (-1)^(k+1) c(k) t^(2k+1) / (2k+1)!.
fn odd_series(t: f64, coefficient: impl Fn(u32) -> f64) -> f64 {
    let mut power = t;
    let mut sum = 0.0;
    for k in 1..=SERIES_TERMS {
        let n = f64::from(2 * k);
        power *= -t * t / (n * (n + 1.0));
        sum -= coefficient(k) * power;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_closed_forms_meet() {
        let t = SHALLOW;
        assert!((odd_series(t, |_| 1.0) / (t - t.sin()) - 1.0).abs() < 1e-14);
        let closed = 3.0 * t - t.sin() * (2.0 + t.cos());
        assert!((odd_series(t, |k| 2.0 + 4f64.powi(k as i32)) / closed - 1.0).abs() < 1e-13);
    }
}
