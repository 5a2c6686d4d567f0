//! Arc length along a spline, by Gauss-Legendre quadrature over spans that turn little.
//!
//! The speed |Q'| of a span is smooth: its nearest singularity lies some eight widths away, so that eight
//! nodes give the last digit. Nodes and weights: Abramowitz & Stegun, "Handbook of Mathematical Functions",
//! table 25.4.

use super::cubic::Cubic;
use super::path::RailPlace;
use super::spline::Spline;

/// Positive nodes and their weights of the Gauss-Legendre rule with eight points on [-1, 1].
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];
/// Step of Newton's method up to which it is the last, as a fraction of a span's width [-]: the next would be rounding.
const SETTLED: f64 = 1e-8;
/// Largest number of steps of Newton's method: it starts within a span, along which the speed hardly changes.
const MOST_STEPS: u32 = 16;

impl Spline {
    /// Sets the arc lengths at which the spans start, and the total length.
    pub(super) fn measure_length(&mut self) {
        let mut length = 0.0;
        for span in &mut self.spans {
            span.start = length;
            length += arc_length(&self.pieces[span.piece], span.range[0], span.range[1]);
        }
        self.length = length;
    }

    /// Arc length [m] at a parameter of a piece, which may lie beyond the ends of an open spline.
    pub(super) fn arc_length(&self, piece: usize, u: f64) -> f64 {
        let cubic = &self.pieces[piece];
        if u <= 0.0 {
            let start = self.spans[self.first_span[piece]].start;
            return if u < 0.0 { start + u * cubic.speed(0.0) } else { start };
        }
        if u > cubic.width {
            return self.end_of(piece) + (u - cubic.width) * cubic.speed(cubic.width);
        }
        let last = self.first_span.get(piece + 1).copied().unwrap_or(self.spans.len());
        let spans = &self.spans[self.first_span[piece]..last];
        let part = (u / cubic.width * spans.len() as f64) as usize;
        let span = &spans[part.min(spans.len() - 1)];
        span.start + arc_length(cubic, span.range[0], u)
    }

    /// The place at an arc length [m], of a closed spline in any lap.
    pub(super) fn place_at(&self, arc_length: f64) -> RailPlace {
        let arc_length = if self.closed { arc_length.rem_euclid(self.length) } else { arc_length };
        let (piece, u) = self.parameter_at(arc_length);
        let jet = self.jet(piece, u);
        RailPlace::new(jet.foot(piece, u, jet.point), arc_length)
    }

    fn parameter_at(&self, target: f64) -> (usize, f64) {
        let last = self.pieces.len() - 1;
        if target < 0.0 {
            return (0, target / self.pieces[0].speed(0.0));
        }
        if target > self.length {
            let width = self.pieces[last].width;
            return (last, width + (target - self.length) / self.pieces[last].speed(width));
        }
        let after = self.spans.partition_point(|span| span.start <= target);
        let span = &self.spans[after.saturating_sub(1)];
        let cubic = &self.pieces[span.piece];
        let [from, to] = span.range;
        let mut u = from;
        for _ in 0..MOST_STEPS {
            let missing = target - span.start - arc_length(cubic, from, u);
            let next = (u + missing / cubic.speed(u)).clamp(from, to);
            let step = next - u;
            u = next;
            if step.abs() <= SETTLED * (to - from) {
                break;
            }
        }
        (span.piece, u)
    }

    fn end_of(&self, piece: usize) -> f64 {
        self.first_span.get(piece + 1).map_or(self.length, |&first| self.spans[first].start)
    }
}

/// Arc length [m] between two parameters of one span.
fn arc_length(cubic: &Cubic, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pairs = NODES.map(|(node, weight)| {
        weight * (cubic.speed(middle - half * node) + cubic.speed(middle + half * node))
    });
    half * pairs.iter().sum::<f64>()
}
