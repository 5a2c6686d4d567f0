//! The cubic spline through points, with their distances as parameter.
//!
//! `spline_seconds` has its second derivatives at the points.

use super::box_tree::BoxTree;
use super::cubic::{Cubic, Jet};
use super::error::RailError;
use super::path::SplineJoint;
use crate::spline_seconds::{closed_seconds, natural_seconds};
use glam::DVec2;
use halfgap_geometry::Aabb;

/// Distance up to which points count as one, as a fraction of the size of all of them [-].
const COINCIDENT: f64 = 1e-9;
/// Largest turn of a span of a spline [rad], approximately.
const SPAN_TURN: f64 = 0.25;
/// Speed by the parameter [-], mostly about 1, below which the spline has a cusp.
const SLOWEST: f64 = 1e-3;
/// Largest number of spans of a piece: one that needs more is refused as a cusp, but a piece that is nowhere slower
/// than [`SLOWEST`] rarely needs as many.
const MOST_SPANS: f64 = 256.0;
/// Distance to a joint up to which it counts as passed, as a fraction of the width of the piece up to it [-].
const PASSED: f64 = 1.0 / 128.0;

/// A cubic spline.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Spline {
    pub(super) pieces: Vec<Cubic>,
    /// Equal parts of the pieces, each of which turns little, in order.
    pub(super) spans: Vec<Span>,
    /// Index of the first span of every piece.
    pub(super) first_span: Vec<usize>,
    pub(super) closed: bool,
    pub(super) length: f64,
    pub(super) tree: BoxTree,
}

/// A part of a piece that turns little.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Span {
    pub(super) piece: usize,
    /// Parameters at the ends of the span [m].
    pub(super) range: [f64; 2],
    /// Arc length of the spline at the start of the span [m].
    pub(super) start: f64,
}

impl Spline {
    pub(super) fn new(points: &[DVec2], closed: bool) -> Result<Self, RailError> {
        let points = checked_points(points, closed)?;
        let pieces = build_pieces(&points, closed);
        let mut spline = Self::in_spans(pieces, closed)?;
        spline.measure_length();
        Ok(spline)
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// The curve about a parameter of a piece, straight beyond the piece's ends as an open spline is.
    #[inline]
    pub(super) fn jet(&self, piece: usize, u: f64) -> Jet {
        let cubic = &self.pieces[piece];
        if cubic.has(u) {
            return cubic.jet(u);
        }
        let end = u.clamp(0.0, cubic.width);
        cubic.jet(end).straight_on(u - end)
    }

    /// The next joint along a velocity. The ends of an open spline are not joints, since it goes on straight.
    pub(super) fn joint_ahead(&self, (piece, u): (usize, f64), velocity: DVec2) -> Option<SplineJoint> {
        let cubic = self.pieces.get(piece)?;
        let forward = self.jet(piece, u).slope.dot(velocity) >= 0.0;
        let left = if forward { cubic.width - u } else { u };
        let piece = if left > PASSED * cubic.width { piece } else { self.beside(piece, forward)? };
        let (here, next) = (&self.pieces[piece], &self.pieces[self.beside(piece, forward)?]);
        let at = here.jet(if forward { here.width } else { 0.0 });
        let tangent = at.slope.normalize_or_zero() * if forward { 1.0 } else { -1.0 };
        let jump = 6.0 * (next.twist - here.twist).length();
        Some(SplineJoint { point: at.point, tangent, width: here.width, jump })
    }

    /// Index of the piece after another, or before it; `None` beyond an open end.
    fn beside(&self, piece: usize, forward: bool) -> Option<usize> {
        let count = self.pieces.len();
        let next = if forward { piece + 1 } else { piece + count - 1 };
        let is_within = if forward { next < count } else { piece > 0 };
        (self.closed || is_within).then_some(next % count)
    }

    fn in_spans(pieces: Vec<Cubic>, closed: bool) -> Result<Self, RailError> {
        let mut spans = Vec::with_capacity(pieces.len());
        let mut first_span = Vec::with_capacity(pieces.len());
        for (piece, cubic) in pieces.iter().enumerate() {
            first_span.push(spans.len());
            let count = span_count(cubic).ok_or(RailError::Cusp(piece))?;
            for part in 0..count {
                let place = |part: u32| cubic.width * (f64::from(part) / f64::from(count));
                spans.push(Span { piece, range: [place(part), place(part + 1)], start: 0.0 });
            }
        }
        let boxes: Vec<Aabb> = spans.iter().map(|span| span_box(&pieces[span.piece], span.range)).collect();
        let tree = BoxTree::new(&boxes).ok_or(RailError::TooFewPoints { least: 2, got: 0 })?;
        Ok(Self { pieces, spans, first_span, closed, length: 0.0, tree })
    }
}

/// Number of equal parts, a power of two, each of which turns little; `None` if the piece has a cusp.
fn span_count(cubic: &Cubic) -> Option<u32> {
    let mut count = 1u32;
    loop {
        let width = cubic.width / f64::from(count);
        let (mut largest_turn, mut slowest) = (0.0, f64::INFINITY);
        for part in 0..count {
            let from = width * f64::from(part);
            let second = cubic.largest_second(from, from + width);
            let speed = cubic.speed(from + 0.5 * width);
            slowest = f64::min(slowest, speed);
            largest_turn = f64::max(largest_turn, second * width / speed);
        }
        if slowest < SLOWEST {
            return None;
        }
        if largest_turn <= SPAN_TURN {
            return Some(count);
        }
        if f64::from(count) >= MOST_SPANS {
            return None;
        }
        count *= 2;
    }
}

/// A box around a span: its chord, grown by the distance [m] that the curve can leave it.
fn span_box(cubic: &Cubic, [from, to]: [f64; 2]) -> Aabb {
    let rise = cubic.largest_second(from, to) * (to - from) * (to - from) / 8.0;
    Aabb::around(cubic.point(from)).including(cubic.point(to)).grown(rise)
}

/// The points, without a repeated first one at the end of a closed spline.
fn checked_points(points: &[DVec2], closed: bool) -> Result<Vec<DVec2>, RailError> {
    if !points.iter().all(|point| point.is_finite()) {
        return Err(RailError::NotFinite);
    }
    let mut points = points.to_vec();
    let boxes = points.iter().map(|&point| Aabb::around(point));
    let size = boxes.reduce(Aabb::union).map_or(0.0, |bounds| bounds.size().max_element());
    let coincide = |a: DVec2, b: DVec2| (a - b).length() <= COINCIDENT * size;
    if closed && points.len() > 1 && coincide(points[0], points[points.len() - 1]) {
        points.pop();
    }
    let least = if closed { 3 } else { 2 };
    if points.len() < least {
        return Err(RailError::TooFewPoints { least, got: points.len() });
    }
    match points.windows(2).position(|pair| coincide(pair[0], pair[1])) {
        Some(first) => Err(RailError::CoincidentPoints(first + 1)),
        None => Ok(points),
    }
}

fn build_pieces(points: &[DVec2], closed: bool) -> Vec<Cubic> {
    let count = points.len();
    let pieces = if closed { count } else { count - 1 };
    let chords: Vec<DVec2> = (0..pieces).map(|i| points[(i + 1) % count] - points[i]).collect();
    let widths: Vec<f64> = chords.iter().map(|chord| chord.length()).collect();
    let slopes: Vec<DVec2> = chords.iter().zip(&widths).map(|(&chord, &width)| chord / width).collect();
    let seconds = if closed { closed_seconds(&widths, &slopes) } else { natural_seconds(&widths, &slopes) };
    (0..pieces)
        .map(|i| {
            let (width, first, last) = (widths[i], seconds[i], seconds[(i + 1) % count]);
            Cubic {
                from: points[i],
                slope: slopes[i] - (first * 2.0 + last) * (width / 6.0),
                bend: first * 0.5,
                twist: (last - first) / (6.0 * width),
                width,
            }
        })
        .collect()
}
