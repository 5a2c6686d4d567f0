//! The time at which a slack rope goes taut.
//!
//! A rope keeps the point of body a inside a circle of the rope's length about the point
//! of body b. Its gap is therefore that of a vertex in a concave arc, with target 0, and the closed forms and the
//! march of feature pairs apply. At the centre of the circle the gap has no normal; the march bounds
//! length^2 - |d|^2 there instead.

use crate::closed::quadratic;
use crate::first_contact::SearchSettings;
use crate::march::{MarchEnd, Pair, Window};
use crate::motion::Motion;
use glam::DVec2;
use halfgap_geometry::{DirectionRange, Feature, PairKind, RoundFeature};

/// A rope between points of two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Rope {
    /// Point of body a [m], in body coordinates.
    pub point_a: DVec2,
    /// Point of body b [m], in body coordinates.
    pub point_b: DVec2,
    /// Length [m].
    pub length: f64,
}

/// Result of a search for the time at which a rope goes taut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RopeSearch {
    /// The rope goes taut at this time [s]: its length is reached, and would be exceeded.
    Taut(f64),
    /// Proof that the rope does not go taut before this time [s].
    NoneBefore(f64),
}

/// Searches [`from`, `span`) [s] for the time at which a rope goes taut, which must not be before `from`. Bodies are
/// given as a motion and the offset [s] in it at time 0 of the search.
///
/// A rope at its length that slackens does not count until it comes back. May pause before `span`, with proof
/// for the part it has searched; every call makes progress. All numbers must be finite, which is not checked.
#[must_use]
pub fn rope_contact<A: Motion, B: Motion>(
    rope: &Rope,
    (motion_a, offset_a): (&A, f64),
    (motion_b, offset_b): (&B, f64),
    from: f64,
    span: f64,
    settings: &SearchSettings,
) -> RopeSearch {
    let end = round(rope.point_a, 0.0);
    let hollow = round(rope.point_b, -rope.length);
    // No rope lies behind, however far it is overstretched.
    let pair = Pair {
        kind: PairKind::Inner,
        feature_a: &end,
        feature_b: &hollow,
        target: 0.0,
        depth: f64::INFINITY,
        slack: [0.0; 2],
        overrun: 0.0,
        rest: 0.0,
    };
    let offsets = [offset_a, offset_b];
    if let Some(search) = by_closed_form(&pair, motion_a, motion_b, offsets, from, span) {
        return search;
    }
    let mut start = from;
    let mut length = None;
    for _ in 0..settings.windows.max(1) {
        if start >= span {
            break;
        }
        let wanted = length
            .unwrap_or_else(|| first_length(rope, &Window::new(motion_a, motion_b, offsets, start, span)));
        let stop = span.min(start + wanted);
        // A window shorter than the resolution of the clock is made one tick long.
        let stop = if stop > start { stop } else { start.next_up() };
        let window = Window::new(motion_a, motion_b, offsets, start, stop);
        match window.march(&pair, start, stop, settings.march_steps.max(1)) {
            MarchEnd::Closes(time) if time < span => return RopeSearch::Taut(time),
            MarchEnd::Closes(_) => return RopeSearch::NoneBefore(span),
            MarchEnd::NoneBefore(time) if time >= stop => start = stop,
            MarchEnd::NoneBefore(time) => return RopeSearch::NoneBefore(time),
        }
        length = Some(2.0 * wanted);
    }
    RopeSearch::NoneBefore(start.min(span))
}

fn by_closed_form<A: Motion, B: Motion>(
    pair: &Pair<'_>,
    motion_a: &A,
    motion_b: &B,
    offsets: [f64; 2],
    from: f64,
    span: f64,
) -> Option<RopeSearch> {
    let (a, b) = ((pair.feature_a, motion_a), (pair.feature_b, motion_b));
    let offsets = offsets.map(|offset| offset + from);
    let curve = quadratic(pair.kind, a, b, offsets, pair.target)?;
    let time = curve.first_closing(pair.depth).map(|wait| from + wait).filter(|&time| time < span);
    Some(time.map_or(RopeSearch::NoneBefore(span), RopeSearch::Taut))
}

/// Length [s] of a first window, in which the ends move by at most half of the rope's length.
fn first_length<A: Motion, B: Motion>(rope: &Rope, whole: &Window<'_, A, B>) -> f64 {
    let turning = whole.spin_a.speed * rope.point_a.length() + whole.spin_b.speed * rope.point_b.length();
    let speed = whole.speed + turning;
    if speed > 0.0 { 0.5 * rope.length / speed } else { f64::INFINITY }
}

fn round(center: DVec2, radius: f64) -> Feature {
    Feature::Round(RoundFeature { center, radius, range: DirectionRange::Full })
}
