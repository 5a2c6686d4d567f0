//! The point of a spline nearest to a given one.
//!
//! With E = P - Q(u), half of the squared distance has the derivative F = -E.Q' and F' = |Q'|^2 - E.Q''. Near
//! a hint steps of Newton's method, carried to the order of 4, find the root of F. Without one, spans are
//! searched from near to far: a curve leaves its chord by at most |Q''| w^2/8 over a width w, which rules out
//! most; where |Q'|^2 > |E| |Q''| on all of a span the distance has one minimum there, found by Newton's
//! method in a bracket; a span that allows neither is split. The search goes on from the best minimum as from a hint.

use super::cubic::Cubic;
use super::edge_path::NEARER;
use super::path::{Foot, RailHint};
use super::spline::Spline;
use glam::DVec2;

/// Step up to which it is the last, as a fraction of a span's width [-]: its error is of the order of its fourth power.
const SETTLED: f64 = 1e-4;
/// Step over a joint, where the curve goes on as another cubic or straight, up to which it is the last, as a fraction
/// of a span's width [-].
const SETTLED_BEYOND: f64 = 1e-8;
/// Step up to which it is the last of a bracketed search, as a fraction of the searched part's width [-]: enough to
/// tell minima apart and to start Newton's method.
const NEAR: f64 = 1e-5;
/// Number of steps of Newton's method from a hint before the whole spline is searched: from nearby it takes two.
const STEPS_FROM_HINT: u32 = 12;
/// Largest number of steps of the bracketed method: by bisection alone it takes 17.
const BRACKETED_STEPS: u32 = 32;
/// Largest number of halvings of a span: only a point near a centre of curvature, equally far from much of the span,
/// needs as many.
const MOST_HALVINGS: u32 = 12;

/// The nearest point so far.
#[derive(Clone, Copy)]
struct Best {
    piece: usize,
    u: f64,
    distance_sq: f64,
}

/// A part of a piece with its end points and the number of halvings that led to it.
#[derive(Clone, Copy)]
struct Part {
    range: [f64; 2],
    ends: [DVec2; 2],
    halvings: u32,
}

impl Spline {
    #[inline]
    pub(super) fn foot(&self, point: DVec2, hint: Option<&RailHint>) -> Foot {
        let Some(hint) = hint else { return self.foot_of_all(point) };
        self.foot_from(point, (hint.piece as usize, hint.parameter))
            .unwrap_or_else(|| self.foot_of_seen(point))
    }

    /// The foot of a point that was last found elsewhere on the curve, and may have left it by an open end: on a
    /// straight continuation, if that is much nearer ([`NEARER`]), else on the curve.
    fn foot_of_seen(&self, point: DVec2) -> Foot {
        let last = self.pieces.len() - 1;
        let on_curve = self.foot_of_all(point);
        let ends = [(0, 0.0, -1.0), (last, self.pieces[last].width, 1.0)];
        let beyond = ends.into_iter().filter(|_| !self.closed).filter_map(|(piece, end, outward)| {
            let jet = self.jet(piece, end);
            let ahead = (point - jet.point).dot(jet.slope) / jet.slope.length_squared();
            (outward * ahead > 0.0).then(|| jet.straight_on(ahead).foot(piece, end + ahead, point))
        });
        let off = |foot: &Foot| (point - foot.point).length();
        beyond
            .filter(|foot| off(foot) < NEARER * off(&on_curve))
            .min_by(|p, q| off(p).total_cmp(&off(q)))
            .unwrap_or(on_curve)
    }

    /// The foot found by Newton's method from another place; `None` if the distance is not convex on the way, or if it
    /// takes more than [`STEPS_FROM_HINT`] steps.
    fn foot_from(&self, point: DVec2, (piece, mut u): (usize, f64)) -> Option<Foot> {
        let mut piece = piece.min(self.pieces.len() - 1);
        for _ in 0..STEPS_FROM_HINT {
            let cubic = &self.pieces[piece];
            let jet = self.jet(piece, u);
            let step = jet.step_to_nearest(point)?;
            let there = u + step;
            if cubic.has(u) && cubic.has(there) {
                u = there;
                if step.abs() <= SETTLED * self.span_width(piece) {
                    return Some(jet.moved(step).foot(piece, u, point));
                }
                continue;
            }
            let is_last = step.abs() <= SETTLED_BEYOND * self.span_width(piece);
            (piece, u) = self.carried(piece, there)?;
            if is_last {
                return Some(self.jet(piece, u).foot(piece, u, point));
            }
        }
        None
    }

    /// Width [m] of the spans of a piece in its parameter.
    #[inline]
    fn span_width(&self, piece: usize) -> f64 {
        self.spans[self.first_span[piece]].range[1]
    }

    /// The piece in which a parameter, counted from the start of another piece, lies, and the parameter there; beyond
    /// the ends of an open spline, that of the piece at the end. `None` if it is more than a lap away.
    #[inline]
    fn carried(&self, mut piece: usize, mut u: f64) -> Option<(usize, f64)> {
        let last = self.pieces.len() - 1;
        for _ in 0..=last {
            let width = self.pieces[piece].width;
            if u < 0.0 && (self.closed || piece > 0) {
                piece = if piece == 0 { last } else { piece - 1 };
                u += self.pieces[piece].width;
            } else if u > width && (self.closed || piece < last) {
                u -= width;
                piece = if piece == last { 0 } else { piece + 1 };
            } else {
                return Some((piece, u));
            }
        }
        None
    }

    fn foot_of_all(&self, point: DVec2) -> Foot {
        let mut best = Best { piece: 0, u: 0.0, distance_sq: f64::INFINITY };
        self.tree.visit_nearest(point, &mut |index| {
            let span = &self.spans[index];
            let cubic = &self.pieces[span.piece];
            let ends = span.range.map(|u| cubic.point(u));
            search_part(cubic, span.piece, point, Part { range: span.range, ends, halvings: 0 }, &mut best);
            best.distance_sq
        });
        // Distances determine the place only to half of its digits, and not beyond an open end.
        let Best { piece, u, .. } = best;
        self.foot_from(point, (piece, u)).unwrap_or_else(|| self.jet(piece, u).foot(piece, u, point))
    }
}

fn search_part(cubic: &Cubic, piece: usize, point: DVec2, part: Part, best: &mut Best) {
    let [from, to] = part.range;
    let width = to - from;
    let second = cubic.largest_second(from, to);
    let to_chord = distance_to_segment(point, part.ends);
    let at_least = (to_chord - second * width * width / 8.0).max(0.0);
    if at_least * at_least >= best.distance_sq {
        return;
    }
    // Largest change of the speed over the part; from its middle to an end it is half of this.
    let change = second * width;
    let middle = cubic.jet(0.5 * (from + to));
    let speed = middle.slope.length();
    let slowest = (speed - 0.5 * change).max(0.0);
    let farthest = (point - middle.point).length() + 0.5 * width * (speed + 0.5 * change);
    if slowest * slowest > farthest * second || part.halvings == MOST_HALVINGS {
        let u = nearest_in_bracket(cubic, point, part.range);
        let distance_sq = (point - cubic.point(u)).length_squared();
        if distance_sq < best.distance_sq {
            *best = Best { piece, u, distance_sq };
        }
        return;
    }
    let (at, halvings) = (0.5 * (from + to), part.halvings + 1);
    let first = Part { range: [from, at], ends: [part.ends[0], middle.point], halvings };
    let last = Part { range: [at, to], ends: [middle.point, part.ends[1]], halvings };
    let is_first_nearer = (point - part.ends[0]).length_squared() <= (point - part.ends[1]).length_squared();
    for half in if is_first_nearer { [first, last] } else { [last, first] } {
        search_part(cubic, piece, point, half, best);
    }
}

/// The parameter nearest to a point, in a range in which the distance has one minimum.
fn nearest_in_bracket(cubic: &Cubic, point: DVec2, [mut low, mut high]: [f64; 2]) -> f64 {
    let width = high - low;
    let slope_at = |u: f64| {
        let jet = cubic.jet(u);
        let seen = point - jet.point;
        (-seen.dot(jet.slope), jet.slope.length_squared() - 2.0 * seen.dot(jet.bend))
    };
    if slope_at(low).0 >= 0.0 {
        return low;
    }
    if slope_at(high).0 <= 0.0 {
        return high;
    }
    let mut u = 0.5 * (low + high);
    for _ in 0..BRACKETED_STEPS {
        let (slope, convexity) = slope_at(u);
        if slope > 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - slope / convexity;
        let next =
            if convexity > 0.0 && newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let step = next - u;
        u = next;
        if step.abs() <= NEAR * width {
            break;
        }
    }
    u
}

fn distance_to_segment(point: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let (chord, seen) = (to - from, point - from);
    let share = (seen.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
    (seen - chord * share).length()
}
