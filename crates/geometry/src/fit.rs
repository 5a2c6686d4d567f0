//! Arcs along a smooth curve, to within a tolerance.
//!
//! A curve is followed by pairs of arcs that share its points and directions at their ends (biarcs), so that no corner is made where the
//! curve has none. *Invariant*: at [`SAMPLES`] places of each pair the curve is no farther from it than the tolerance.
//!
//! Source: K. M. Bolton, Biarc curves, Computer-Aided Design 7 (1975) 89; of all pairs the one whose two ends are equally far
//! from the points where their tangents meet.

use crate::edge_spec::EdgeSpec;
use glam::DVec2;

/// Places at which a pair of arcs is compared with the curve. Its error has at most a few maxima, of which this tells the size to
/// within a hundredth.
const SAMPLES: u32 = 32;
/// Share of the tolerance up to which samples may be off [-], for what lies between them.
const SURE: f64 = 0.95;
/// Largest number of halvings of a part of a curve. The error of a pair of arcs falls with the third power of its length, so that this
/// is enough for any tolerance that numbers resolve; a curve that has a corner never gets there.
const HALVINGS: u32 = 24;

/// A point of a curve, and the direction in which the curve goes on there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The point [m].
    pub point: DVec2,
    /// Unit vector along the curve.
    pub tangent: DVec2,
}

/// Error for a curve that arcs cannot follow.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A point or direction is not finite.
    #[error("the curve is not finite at parameter {parameter}")]
    NotFinite {
        /// Where on the curve.
        parameter: f64,
    },
    /// The curve bends more than arcs can follow, as at a corner.
    #[error(
        "the curve has a corner at parameter {parameter}, or the tolerance of {tolerance} m is beyond the digits of its coordinates"
    )]
    Corner {
        /// Where on the curve.
        parameter: f64,
        /// The tolerance [m].
        tolerance: f64,
    },
}

/// Returns edges along a curve from parameter `from` to `to`, which are no farther from it than `tolerance` [m]. The first
/// starts at the curve's first point.
///
/// # Errors
/// [`FitError`] for a curve that is not finite, or has corners.
///
/// # Examples
/// ```
/// use halfgap_geometry::{CurvePoint, DVec2, fit_arcs};
///
/// // A parabola.
/// let curve = |x: f64| CurvePoint { point: DVec2::new(x, x * x), tangent: DVec2::new(1.0, 2.0 * x).normalize() };
/// let coarse = fit_arcs(&curve, [-1.0, 1.0], 1e-2)?;
/// let fine = fit_arcs(&curve, [-1.0, 1.0], 1e-6)?;
/// assert!(coarse.len() < 10 && fine.len() < 200);
/// # Ok::<(), halfgap_geometry::FitError>(())
/// ```
pub fn fit_arcs(
    curve: &impl Fn(f64) -> CurvePoint,
    [from, to]: [f64; 2],
    tolerance: f64,
) -> Result<Vec<EdgeSpec>, FitError> {
    let mut edges = Vec::new();
    fit_part(curve, [from, to], tolerance, HALVINGS, &mut edges)?;
    Ok(edges)
}

fn fit_part(
    curve: &impl Fn(f64) -> CurvePoint,
    [from, to]: [f64; 2],
    tolerance: f64,
    halvings: u32,
    edges: &mut Vec<EdgeSpec>,
) -> Result<(), FitError> {
    let ends = [finite_at(curve, from)?, finite_at(curve, to)?];
    if let Some(pair) = Biarc::between(ends)
        && pair.error(curve, [from, to])? <= SURE * tolerance
    {
        edges.extend(pair.edges());
        return Ok(());
    }
    let middle = 0.5 * (from + to);
    let Some(left) = halvings.checked_sub(1) else {
        return Err(FitError::Corner { parameter: middle, tolerance });
    };
    fit_part(curve, [from, middle], tolerance, left, edges)?;
    fit_part(curve, [middle, to], tolerance, left, edges)
}

fn finite_at(curve: &impl Fn(f64) -> CurvePoint, parameter: f64) -> Result<CurvePoint, FitError> {
    let at = curve(parameter);
    let is_finite = at.point.is_finite() && at.tangent.is_finite();
    is_finite.then_some(at).ok_or(FitError::NotFinite { parameter })
}

/// Two arcs that go over into each other: from a point in a direction to a point in a direction.
#[derive(Clone, Copy, Debug)]
struct Biarc {
    arcs: [SmallArc; 2],
}

/// An arc of less than a full turn, by its ends and its direction at the first.
#[derive(Clone, Copy, Debug)]
struct SmallArc {
    from: DVec2,
    to: DVec2,
    /// Angle from the direction at the first end to the chord [rad]; a half of the sweep.
    half_sweep: f64,
}

impl SmallArc {
    fn starting(from: DVec2, tangent: DVec2, to: DVec2) -> Self {
        let chord = to - from;
        Self { from, to, half_sweep: libm::atan2(tangent.perp_dot(chord), tangent.dot(chord)) }
    }

    fn edge(self) -> EdgeSpec {
        EdgeSpec::Bulge { to: self.to, bulge: libm::tan(0.5 * self.half_sweep) }
    }

    /// Distance [m] of a point, which is beside the arc and not beyond its ends, from its circle.
    fn distance(self, point: DVec2) -> f64 {
        let chord = self.to - self.from;
        let (length, direction) = (chord.length(), chord.normalize_or_zero());
        let sine = libm::sin(self.half_sweep);
        let off = point - self.from;
        let (along, across) = (direction.dot(off), direction.perp_dot(off));
        // With the curvature k = 2 sin(half sweep)/chord, the circle through both ends is k (x^2 + y^2 - x chord)/2 - y cos = 0.
        let curvature = 2.0 * sine / length;
        let cosine = libm::cos(self.half_sweep);
        let value = 0.5 * curvature * (along * (along - length) + across * across) - across * cosine;
        let gradient = DVec2::new(curvature * (along - 0.5 * length), curvature * across - cosine);
        value.abs() / gradient.length()
    }
}

impl Biarc {
    /// `None` where the directions at the ends point away from each other.
    fn between([first, last]: [CurvePoint; 2]) -> Option<Self> {
        let way = last.point - first.point;
        if way == DVec2::ZERO {
            return None;
        }
        let sum = first.tangent + last.tangent;
        let bend = 2.0 * (1.0 - first.tangent.dot(last.tangent));
        let along = way.dot(sum);
        // The positive root d of bend d^2 + 2 along d = |way|^2, in the form that does not cancel.
        let root = (along * along + bend * way.length_squared()).sqrt();
        let length = if along > 0.0 { way.length_squared() / (along + root) } else { return None };
        let joint = 0.5 * (first.point + last.point + length * (first.tangent - last.tangent));
        let before = SmallArc::starting(first.point, first.tangent, joint);
        // The second arc is told from its end, backwards.
        let after = SmallArc::starting(last.point, -last.tangent, joint);
        let after = SmallArc { from: joint, to: last.point, half_sweep: -after.half_sweep };
        Some(Self { arcs: [before, after] })
    }

    fn edges(self) -> impl Iterator<Item = EdgeSpec> {
        self.arcs.into_iter().map(SmallArc::edge)
    }

    /// Largest distance [m] of the curve.
    fn error(self, curve: &impl Fn(f64) -> CurvePoint, [from, to]: [f64; 2]) -> Result<f64, FitError> {
        let [before, after] = self.arcs;
        let across = (after.to - before.from).normalize_or_zero();
        let mut most = 0.0f64;
        for sample in 1..SAMPLES {
            let part = f64::from(sample) / f64::from(SAMPLES);
            let at = finite_at(curve, from + part * (to - from))?.point;
            let is_before = across.dot(at - before.to) < 0.0;
            most = most.max(if is_before { before } else { after }.distance(at));
        }
        Ok(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge::Edge;

    /// Distance of a point from the nearest of the edges.
    fn distance(start: DVec2, edges: &[EdgeSpec], point: DVec2) -> f64 {
        let mut from = start;
        let mut least = f64::INFINITY;
        for spec in edges {
            let edge: Edge = spec.edge_between(from, spec.to(), 1e-9).expect("a fine edge");
            least = least.min((edge.nearest(point) - point).length());
            from = spec.to();
        }
        least
    }

    fn ellipse(angle: f64) -> CurvePoint {
        let (sin, cos) = libm::sincos(angle);
        CurvePoint { point: DVec2::new(3.0 * cos, sin), tangent: DVec2::new(-3.0 * sin, cos).normalize() }
    }

    #[test]
    fn arcs_keep_within_the_tolerance_of_an_ellipse() {
        let mut last = 0;
        for tolerance in [1e-2, 1e-4, 1e-6] {
            let edges = fit_arcs(&ellipse, [0.0, 3.0], tolerance).expect("it is smooth");
            for sample in 0..=1000 {
                let point = ellipse(3.0 * f64::from(sample) / 1000.0).point;
                let off = distance(DVec2::new(3.0, 0.0), &edges, point);
                assert!(off <= tolerance, "{off} m of {tolerance} m");
            }
            // Errors of third order: ten times as many arcs for a thousandth of the error.
            assert!(
                edges.len() > last && edges.len() <= 4 * (10.0 / libm::cbrt(tolerance)) as usize,
                "{}",
                edges.len()
            );
            last = edges.len();
        }
    }

    #[test]
    fn a_circle_is_met_by_two_arcs() {
        let circle = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            CurvePoint { point: DVec2::new(cos, sin), tangent: DVec2::new(-sin, cos) }
        };
        assert_eq!(fit_arcs(&circle, [0.0, 3.0], 1e-12).map(|edges| edges.len()), Ok(2));
    }

    #[test]
    fn a_corner_is_told_with_its_place() {
        let corner = |at: f64| CurvePoint {
            point: DVec2::new(at, at.abs()),
            tangent: DVec2::new(1.0, if at < 0.0 { -1.0 } else { 1.0 }).normalize(),
        };
        let error = fit_arcs(&corner, [-1.0, 2.0], 1e-12).expect_err("it has a corner");
        assert!(matches!(error, FitError::Corner { parameter, .. } if parameter.abs() < 1e-6), "{error}");
        let nowhere = |at: f64| CurvePoint { point: DVec2::new(at, at.ln()), tangent: DVec2::X };
        assert!(matches!(fit_arcs(&nowhere, [-1.0, 1.0], 1e-6), Err(FitError::NotFinite { .. })));
    }
}
