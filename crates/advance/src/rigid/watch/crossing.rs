//! Finds the time at which a function that is sampled along a segment first falls below zero.
//!
//! Five samples decide: a change of sign brackets the fall; where the samples stay positive, the quartic through them
//! shows where the function may dip below zero in between, however briefly, and is followed by samples there. The
//! first look into the bracket is at the time that `collision` estimates for a gap, by the values at both ends and the
//! quartic's rates there. Inverse parabolas go on where they are sure to serve, else bisection: some functions have a
//! kink where they fall (T. Chandrupatla, "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear
//! function without using derivatives", Advances in Engineering Software 28, 1997).

use crate::rigid::group::samples::{EARLY, NODES, middle_node};
use crate::rigid::shares::{HALVINGS, NEGLIGIBLE};
use halfgap_collision::{EstimatePoint, estimate_target_time};

/// Number of parts of the way between two nodes, in each of which the quartic has one minimum at most.
const PARTS: usize = 4;
/// Widths, in nodes, of the parabolas that lead from the quartic's minimum to the function's own.
const WIDTHS: [f64; 2] = [0.1, 0.01];
/// Largest number of steps that close a bracket.
const MOST_STEPS: usize = 200;
/// Width of a closed bracket as a fraction of the segment.
const CLOSED: f64 = 1e-14;

/// Offset of an early sample as a fraction of that of the next.
const EARLIER: f64 = 0.25;

/// Offset [s] of an early sample of a segment of the given span.
pub(crate) fn early_node(index: usize, span: f64) -> f64 {
    (index..EARLY).fold(node(1, span), |offset, _| offset * EARLIER)
}

/// First offset [s], up to the first node, at which `f` has fallen below zero, given its values at the start, which
/// must not be negative, and at the early nodes.
pub(crate) fn early_fall(
    start: f64,
    values: &[f64; EARLY],
    span: f64,
    f: impl FnMut(f64) -> f64,
) -> Option<f64> {
    let index = values.iter().position(|&value| value < 0.0).filter(|_| start >= 0.0)?;
    let above =
        index.checked_sub(1).map_or((0.0, start), |before| (early_node(before, span), values[before]));
    Some(close(above, (early_node(index, span), values[index]), span, None, f))
}

/// Offset [s], up to the first node, at which `f` has fallen below zero after the last early node at which it was not.
/// For a function that is below zero at the start, if only by rounding, and at the first node; `None` for others.
pub(crate) fn fall_after_rise(
    values: &[f64; NODES],
    span: f64,
    mut f: impl FnMut(f64) -> f64,
) -> Option<f64> {
    if values[0] >= 0.0 || values[1] >= 0.0 {
        return None;
    }
    let above = (0..EARLY).rev().find_map(|index| {
        let offset = early_node(index, span);
        let value = f(offset);
        (value >= 0.0).then_some((offset, value))
    })?;
    Some(close(above, (node(1, span), values[1]), span, None, f))
}

/// A part of a segment, between two offsets [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Part {
    /// All of a segment of the given span [s].
    pub(crate) fn all(span: f64) -> Self {
        Self { from: 0.0, to: span }
    }

    pub(crate) fn span(&self) -> f64 {
        self.to - self.from
    }

    /// Offset [s] in the segment of a node of the part.
    pub(crate) fn node(&self, index: usize) -> f64 {
        if index + 1 == NODES { self.to } else { self.from + node(index, self.span()) }
    }
}

/// Value at a fraction of a part of a segment of the quartic through the values at its nodes.
pub(crate) fn interpolated(values: &[f64; NODES], fraction: f64) -> f64 {
    Quartic::through(values).value(fraction * (NODES - 1) as f64 - middle_node())
}

/// Offset [s] of a node of a segment of the given span.
pub(crate) fn node(index: usize, span: f64) -> f64 {
    if index + 1 == NODES { span } else { span * (index as f64 / (NODES - 1) as f64) }
}

/// Linear interpolation between the values at the nodes, at an offset [s].
pub(crate) fn between_nodes(values: &[f64; NODES], span: f64, offset: f64) -> f64 {
    let place = (offset / span).clamp(0.0, 1.0) * (NODES - 1) as f64;
    let index = (place as usize).min(NODES - 2);
    let part = place - index as f64;
    values[index] + part * (values[index + 1] - values[index])
}

/// First offset [s] in (0, `span`] at which `f` has fallen below zero, given its values at the nodes.
///
/// A function that starts below zero must rise first, but see [`fall_from_below`]. The answer lies behind the fall:
/// there `f` is negative.
pub(crate) fn first_fall(values: &[f64; NODES], span: f64, f: impl FnMut(f64) -> f64) -> Option<f64> {
    first_fall_before(values, span, None, f)
}

/// First offset [s] at which `f` has fallen below zero, as of [`first_fall`], before a limit, given as offset and value
/// there.
pub(crate) fn first_fall_before(
    values: &[f64; NODES],
    span: f64,
    limit: Option<(f64, f64)>,
    mut f: impl FnMut(f64) -> f64,
) -> Option<f64> {
    if values.iter().any(|value| value.is_infinite()) {
        return None;
    }
    let quartic = Quartic::through(values);
    for index in 0..NODES - 1 {
        let (from, mut to, mut end) = (node(index, span), node(index + 1, span), values[index + 1]);
        match limit {
            Some((offset, _)) if from >= offset => return None,
            Some((offset, value)) if to > offset => (to, end) = (offset, value),
            _ => {}
        }
        if values[index] < 0.0 {
            continue;
        }
        if end < 0.0 {
            let guess = quartic.estimate((from, values[index]), (to, end), span);
            return Some(close((from, values[index]), (to, end), span, guess, f));
        }
        let dip = quartic.dip_between(index).and_then(|dip| find_dip(dip, [from, to], span, &mut f));
        if let Some(below) = dip {
            let guess = quartic.estimate((from, values[index]), below, span);
            return Some(close((from, values[index]), below, span, guess, f));
        }
    }
    None
}

/// Offset [s] strictly between two others at which `f` is negative, with its value, near a minimum of the quartic,
/// which is given in nodes.
fn find_dip(dip: f64, [from, to]: [f64; 2], span: f64, mut f: impl FnMut(f64) -> f64) -> Option<Sample> {
    let scale = span / (NODES - 1) as f64;
    let is_inside = |place: f64| from < place && place < to;
    let mut place = scale * dip;
    if !is_inside(place) {
        return None;
    }
    let mut value = f(place);
    for width in WIDTHS.map(|width| width * scale) {
        if value < 0.0 {
            return Some((place, value));
        }
        let [before, after] = [place - width, place + width].map(&mut f);
        let bend = before - 2.0 * value + after;
        let moved = place + (0.5 * width * (before - after) / bend).clamp(-width, width);
        if !is_inside(moved) {
            return None;
        }
        (place, value) = (moved, f(moved));
    }
    (value < 0.0).then_some((place, value))
}

/// First offset [s] at which `f`, which is below zero at the start, has fallen below -`allowed`, given its values at
/// the nodes.
pub(crate) fn fall_from_below(
    values: &[f64; NODES],
    span: f64,
    allowed: f64,
    mut f: impl FnMut(f64) -> f64,
) -> Option<f64> {
    if values[0] < -allowed {
        return Some(0.0);
    }
    let mut raised = |offset| f(offset) + allowed;
    let values = values.map(|value| value + allowed);
    // A function that starts below zero may go far and come back before the first node.
    let early = std::array::from_fn(|index| raised(early_node(index, span)));
    early_fall(values[0], &early, span, &mut raised).or_else(|| first_fall(&values, span, raised))
}

/// The quartic through the samples: its coefficients for powers of the distance, in nodes, from the middle node.
struct Quartic {
    coefficients: [f64; NODES],
    /// Size of the largest sample.
    size: f64,
}

impl Quartic {
    fn through(values: &[f64; NODES]) -> Self {
        let [a, b, c, d, e] = *values;
        let coefficients = [
            c,
            ((a - e) - 8.0 * (b - d)) / 12.0,
            (16.0 * (b + d) - (a + e) - 30.0 * c) / 24.0,
            (2.0 * (b - d) - (a - e)) / 12.0,
            ((a + e) - 4.0 * (b + d) + 6.0 * c) / 24.0,
        ];
        Self { coefficients, size: values.iter().fold(0.0, |most, value| most.max(value.abs())) }
    }

    fn value(&self, from_middle: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * from_middle + coefficient)
    }

    fn slope(&self, from_middle: f64) -> f64 {
        let [_, first, second, third, fourth] = self.coefficients;
        first + from_middle * (2.0 * second + from_middle * (3.0 * third + from_middle * 4.0 * fourth))
    }

    /// Estimates the offset [s] of a fall between two samples of a segment, by their values and the quartic's rates there.
    fn estimate(&self, above: Sample, below: Sample, span: f64) -> Option<f64> {
        let scale = span / (NODES - 1) as f64;
        let [earlier, later] = [above, below].map(|(time, distance)| {
            let normal_velocity = self.slope(time / scale - middle_node()) / scale;
            EstimatePoint { time, distance, normal_velocity }
        });
        estimate_target_time(earlier, later, 0.0)
    }

    /// Place, in nodes, of the lowest minimum between two nodes, if it is below zero or nearly so.
    fn dip_between(&self, index: usize) -> Option<f64> {
        let first = index as f64 - middle_node();
        let edge = |part: usize| first + part as f64 / PARTS as f64;
        let enough = NEGLIGIBLE * self.size;
        let mut lowest: Option<Sample> = None;
        let mut before = self.slope(edge(0));
        for part in 0..PARTS {
            let after = self.slope(edge(part + 1));
            // The quartic is nowhere far below its tangents.
            let may_dip = || self.value(edge(part)) + before / (PARTS as f64) < enough;
            if before < 0.0 && after >= 0.0 && may_dip() {
                let place = self.minimum_between(edge(part), edge(part + 1));
                let value = self.value(place);
                if lowest.is_none_or(|(_, least)| value < least) {
                    lowest = Some((place, value));
                }
            }
            before = after;
        }
        let (place, value) = lowest?;
        (value < enough).then_some(place + middle_node())
    }

    /// Place, in nodes from the middle, at which the slope, negative at `low` and not so at `high`, vanishes.
    fn minimum_between(&self, mut low: f64, mut high: f64) -> f64 {
        let mut place = 0.5 * (low + high);
        for _ in 0..HALVINGS {
            let slope = self.slope(place);
            if slope < 0.0 {
                low = place
            } else {
                high = place
            }
            let [_, _, second, third, fourth] = self.coefficients;
            let bend = 2.0 * second + place * (6.0 * third + place * 12.0 * fourth);
            let newton = place - slope / bend;
            let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
            if next == place || next == low || next == high {
                break;
            }
            place = next;
        }
        place
    }
}

/// An offset [s], or place, and the value there.
type Sample = (f64, f64);

/// Closes a bracket from `above` (not negative) to `below` (negative), and returns an offset [s] at which `f` is
/// negative. The first look is at a `guess`, if there is one, else where the chord through the two samples vanishes.
pub(crate) fn close(
    above: Sample,
    below: Sample,
    span: f64,
    guess: Option<f64>,
    mut f: impl FnMut(f64) -> f64,
) -> f64 {
    // The bracket is between the last place and the far one; the one before was left.
    let (mut last, mut far, mut left) = (above, below, None);
    for _ in 0..MOST_STEPS {
        let width = far.0 - last.0;
        // A guess is no nearer to the ends than that: once the fall is found, the next place is on its other side.
        let nearest = 0.5 * CLOSED * span / width.abs();
        if nearest > 0.5 {
            break;
        }
        let part = match left {
            None => guess.map_or(last.1 / (last.1 - far.1), |guess| (guess - last.0) / width),
            Some(left) => part_by_parabola(last, far, left).unwrap_or(0.5),
        };
        let inside = last.0 + part.clamp(nearest, 1.0 - nearest) * width;
        if inside == last.0 || inside == far.0 {
            break;
        }
        let value = f(inside);
        if (value < 0.0) == (last.1 < 0.0) {
            left = Some(last);
        } else {
            left = Some(far);
            far = last;
        }
        last = (inside, value);
    }
    if last.1 < 0.0 { last.0 } else { far.0 }
}

/// Fraction of the way from the last place to the far one at which the inverse parabola through three samples vanishes;
/// `None` where that parabola is no function between them.
fn part_by_parabola(last: Sample, far: Sample, left: Sample) -> Option<f64> {
    let place = (last.0 - far.0) / (left.0 - far.0);
    let height = (last.1 - far.1) / (left.1 - far.1);
    let is_function = height * height < place && (1.0 - height) * (1.0 - height) < 1.0 - place;
    let share = |p: Sample, q: Sample| p.1 / (q.1 - p.1);
    let way = (left.0 - last.0) / (far.0 - last.0);
    is_function.then(|| {
        share(last, far) * left.1 / (far.1 - left.1) + way * share(last, left) * far.1 / (left.1 - far.1)
    })
}

#[cfg(test)]
mod tests {

    use super::*;

    fn sampled(span: f64, f: impl Fn(f64) -> f64 + Copy) -> Option<f64> {
        let values = std::array::from_fn(|index| f(node(index, span)));
        first_fall(&values, span, f)
    }

    #[test]
    fn a_fall_is_found_from_behind() {
        let fall = sampled(2.0, |t| 1.0 - t * t).expect("it falls at 1");
        assert!((fall - 1.0).abs() < 1e-12 && fall >= 1.0);
    }

    #[test]
    fn a_smooth_fall_takes_few_looks() {
        for (start, end) in [(0.3, 1.0), (1.0, 1e-3), (1e-6, 1.0)] {
            let mut looks = 0;
            // The function falls from the start to minus the end, ever steeper.
            let f = |t: f64| start - (start + end) * t * (1.0 + t * t) / 2.0;
            let fall = close((0.0, f(0.0)), (1.0, f(1.0)), 1.0, None, |t| {
                looks += 1;
                f(t)
            });
            assert!(f(fall) < 0.0 && f(fall - 2.0 * CLOSED) >= 0.0, "{fall}");
            assert!(looks <= 11, "{looks} looks");
        }
    }

    #[test]
    fn the_first_look_at_a_free_fall_is_at_its_end() {
        let f = |t: f64| 0.3 - 0.1 * t - 0.5 * t * t;
        let values = std::array::from_fn(|index| f(node(index, 1.0)));
        let mut first = None;
        let fall = first_fall(&values, 1.0, |t| {
            first.get_or_insert(t);
            f(t)
        });
        let (first, fall) = (first.expect("it looks"), fall.expect("it falls"));
        assert!(
            (first - fall).abs() < 1e-13,
            "the estimate is exact under a constant acceleration: {first}, {fall}"
        );
    }

    #[test]
    fn a_fall_from_a_flat_edge_is_found() {
        let fall = sampled(2.0, |t| 1e-16 - (t - 1.3).max(0.0)).expect("it falls at 1.3");
        assert!((fall - 1.3).abs() < 1e-13 && fall >= 1.3, "{fall}");
    }

    #[test]
    fn a_dip_between_two_samples_is_found() {
        let fall = sampled(1.0, |t| (t - 0.6) * (t - 0.6) - 1e-3).expect("it dips");
        assert!((fall - (0.6 - 1e-3f64.sqrt())).abs() < 1e-12);
        assert_eq!(sampled(1.0, |t| (t - 0.6) * (t - 0.6) + 1e-3), None);
    }

    #[test]
    fn a_dip_is_found_however_shallow() {
        for depth in [1e-3, 1e-6, 1e-9, 1e-12] {
            for lowest in [0.04, 0.137, 0.26, 0.61, 0.9871] {
                let parabola = |t: f64| 3.0 * (t - lowest) * (t - lowest) - depth;
                let wave = |t: f64| 1.0 - depth - (1.7 * (t - lowest)).cos();
                let fall = [sampled(1.0, parabola), sampled(1.0, wave)];
                let expected = [(depth / 3.0).sqrt(), (1.0 - depth).acos() / 1.7].map(|way| lowest - way);
                for (fall, expected) in fall.into_iter().zip(expected) {
                    let fall = fall.unwrap_or_else(|| panic!("it dips at {lowest} by {depth}"));
                    // Good to the rounding of the function, by its slope.
                    let sharp = 1e-15 / depth.sqrt() + 1e-12;
                    assert!((fall - expected).abs() < sharp, "{fall} {expected}");
                }
                let touches = |t: f64| parabola(t) + 2.0 * depth;
                assert_eq!(sampled(1.0, touches), None);
            }
        }
    }

    #[test]
    fn a_function_that_rises_from_just_below_and_falls_before_the_first_node_is_found() {
        let after_rise = |room: f64| {
            let f = |t: f64| t * (room - t) - 1e-18;
            fall_after_rise(&std::array::from_fn(|index| f(node(index, 2.0))), 2.0, f)
        };
        for room in [0.3, 0.13, 0.01] {
            let fall = after_rise(room).expect("it leaves");
            assert!((fall - room).abs() < 1e-12 && fall >= room, "{fall}");
        }
        // A function that only goes farther below has not been above, and a function that is above at the first node
        // has not left.
        assert_eq!(after_rise(-0.1), None);
        assert_eq!(after_rise(1.0), None);
    }

    #[test]
    fn a_dip_soon_after_the_start_is_found() {
        // The function rises as t^6, to some ten thousand times the depth of its dip.
        let f = |t: f64| 1e-14 - 1e-10 * t * t + 1e-6 * t.powi(6);
        let early = |span: f64| std::array::from_fn(|index| f(early_node(index, span)));
        let fall = early_fall(f(0.0), &early(1.0), 1.0, f).expect("it dips");
        assert!((fall - 1.00005e-2).abs() < 1e-6 && f(fall) < 0.0, "{fall}");
        let rises = |t: f64| 1e-14 + 1e-10 * t;
        let early = std::array::from_fn(|index| rises(early_node(index, 1.0)));
        assert_eq!(early_fall(rises(0.0), &early, 1.0, rises), None);
    }

    #[test]
    fn a_function_that_starts_below_zero_and_goes_on_falling_has_fallen() {
        let below: f64 = 1e-14;
        let fall = |allowed: f64, rate: f64| {
            let f = |t: f64| -below - rate * t;
            fall_from_below(&std::array::from_fn(|index| f(node(index, 2.0))), 2.0, allowed, f)
        };
        for allowed in [1.9 * below, 2.0 * below, 200.0 * below] {
            let offset = fall(allowed, 1e-3).expect("it falls");
            assert!((offset / (1e3 * (allowed - below)) - 1.0).abs() < 1e-2, "{offset}");
        }
        // A function that stays where it is, or rises, has not fallen.
        assert_eq!(fall(2.0 * below, 0.0), None);
        assert_eq!(fall(2.0 * below, -1.0), None);
        // A function that is lower already has fallen.
        assert_eq!(fall(0.5 * below, -1.0), Some(0.0));
        // A function that is back by the first node had fallen.
        let dips = |t: f64| -below - t * (0.3 - t);
        let values = std::array::from_fn(|index| dips(node(index, 2.0)));
        let offset = fall_from_below(&values, 2.0, 2.0 * below, dips).expect("it dips");
        assert!(dips(offset) < -2.0 * below && offset < 1e-12, "{offset}");
    }

    #[test]
    fn a_function_that_starts_below_zero_must_rise_first() {
        assert_eq!(sampled(1.0, |t| t - 2.0), None);
        let fall = sampled(4.0, |t| (t - 0.5) * (3.0 - t)).expect("it falls at 3");
        assert!((fall - 3.0).abs() < 1e-12);
    }
}
