//! Bounces too low to be told from contact: between two events the gap of a feature pair, or of a rope or stop, stayed
//! within the target zone.
//!
//! The height of a bounce follows from the opening rate v1 at the event before, the closing rate v2 now, and the time t
//! between: under a constant acceleration it is v1^2 t / (2 (v1 + v2)). Such a pair meets without elasticity, unless
//! another contact in the same event closes fast. The motion that is lost is shorter than the fall through the zone and
//! no higher than it.
//!
//! This holds for a pair that forces have turned back. A pair of which a body has been struck since bounces with its
//! elasticity, unless it is so slow that forces give it that speed within the zone.
//!
//! A perfectly elastic body that bounces a few target gaps high, as when a light body hits it while it rests, would go
//! on for ever, hundreds of thousands of times a second. The energy of such a bounce is that of a fall through a few
//! gaps: after very many of them in a row the pair meets without elasticity as well.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::{Connectors, SeenRow};
use crate::rigid::contacts::pairs::{PairId, Pairs};
use crate::rigid::contacts::table::Seen;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::shares::{HUGE, LARGE, MAJOR};
use crate::time::Time;
use halfgap_collision::{BodyId, Collision, Detector, GapState, Tolerances};
use halfgap_geometry::FeatureId;

/// Number of low bounces in a row after which elasticity no longer acts.
const MOST_LOW: u32 = 1000;

/// Remembers the gaps of features that touch, whose bodies have their new velocities. `fired` is the
/// contact that caused the event, if one did, and whether it fired although it did not close.
pub(crate) fn note_seen(
    assembly: &Assembly,
    pairs: &mut Pairs,
    touching: impl Iterator<Item = (Touch, GapState)>,
    fired: Option<(Touch, bool)>,
) {
    for (touch, GapState { distance: gap, normal_velocity: rate, .. }) in touching {
        let Some(pair) = pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
        let before = pairs.seen(pair, touch.features);
        let low = before.map_or(0, |before| low_bounces(assembly, before, gap));
        let formed = before.map_or(gap, |before| before.formed.max(gap));
        let goes_on = || before.is_some_and(|before| before.fires_open);
        let fires_open = match fired {
            Some((fired, is_open)) if fired == touch => is_open,
            _ => goes_on(),
        };
        let fires_open = fires_open && gap < assembly.settings().tolerances.target_gap;
        pairs.see(pair, touch.features, Seen { time: assembly.now(), gap, formed, rate, low, fires_open });
    }
}

/// Number of low bounces in a row of a contact that was seen before and has a gap [m] now.
fn low_bounces(assembly: &Assembly, seen: &Seen, gap: f64) -> u32 {
    let way = seen.rate.max(0.0) * assembly.now().since(seen.time);
    // Under a constant acceleration, the distance [m] by which the acceleration has brought it back in the
    // meantime.
    let back = way - (gap - seen.gap);
    let rise = if back > 0.0 { 0.25 * way * (way / back) } else { way };
    let is_low = seen.gap + rise <= LARGE * assembly.settings().tolerances.target_gap;
    if is_low { seen.low.saturating_add(u32::from(seen.rate > assembly.rest_speed())) } else { 0 }
}

/// True if some of the given contacts close fast, and each of these has stayed within the target zone since it was last
/// seen.
pub(crate) fn bounces_low(
    assembly: &Assembly,
    connectors: &Connectors,
    pairs: &Pairs,
    records: &[Collision],
) -> bool {
    let mut fast = records.iter().filter(|record| record.gap_state().rebounds()).peekable();
    fast.peek().is_some() && fast.all(|record| is_low_bounce(assembly, connectors, pairs, record))
}

fn is_low_bounce(assembly: &Assembly, connectors: &Connectors, pairs: &Pairs, record: &Collision) -> bool {
    let (down, tolerances) = (-record.motion.normal_velocity, &record.tolerances);
    if let Detector::Connector { id, .. } = record.parties.detector {
        let Some(SeenRow { time, gap, rate }) = connectors.states()[id.index()].seen() else { return false };
        let is_struck = is_struck_since(assembly, record.bodies(), time);
        return stayed_low(
            assembly,
            &Before { time, gap, rate, is_often_low: false, is_struck },
            down,
            tolerances,
        );
    }
    let Some((pair, features)) = features_of(pairs, record) else { return false };
    has_stayed_low(assembly, pairs, pair, features, down, tolerances)
}

/// True if a contact of a pair has fired although it did not close, and has not left its target gap since.
pub(crate) fn fires_open(pairs: &Pairs, pair: PairId, features: [FeatureId; 2]) -> bool {
    pairs.seen(pair, features).is_some_and(|seen| seen.fires_open)
}

/// The pair of bodies of a record, and its features, that of the body with the lower id first.
fn features_of(pairs: &Pairs, record: &Collision) -> Option<(PairId, [FeatureId; 2])> {
    let Touch { bodies: [a, b], features } = Touch::of(record)?;
    Some((pairs.between(a, b)?, features))
}

/// Largest gap [m] at which the features of a record have touched; their present gap if they have not been seen
/// before.
pub(crate) fn formed_at(pairs: &Pairs, record: &Collision) -> f64 {
    let before = features_of(pairs, record)
        .and_then(|(pair, features)| pairs.seen(pair, features).map(|seen| seen.formed));
    before.unwrap_or(record.geometry.distance)
}

/// True if two features that close with a speed `down` [m/s] have stayed within the target zone since they were
/// last seen.
pub(crate) fn has_stayed_low(
    assembly: &Assembly,
    pairs: &Pairs,
    pair: PairId,
    features: [FeatureId; 2],
    down: f64,
    tolerances: &Tolerances,
) -> bool {
    let Some(&Seen { time, gap, rate, low, .. }) = pairs.seen(pair, features) else { return false };
    let is_struck = is_struck_since(assembly, pairs.bodies(pair), time);
    stayed_low(
        assembly,
        &Before { time, gap, rate, is_often_low: low >= MOST_LOW, is_struck },
        down,
        tolerances,
    )
}

/// State of a pair of features, or of a rope or stop, at the end of the event in which it was seen last.
struct Before {
    time: Time,
    /// Gap [m].
    gap: f64,
    /// Rate of the gap [m/s].
    rate: f64,
    /// It has bounced low very many times in a row.
    is_often_low: bool,
    /// An impulse has changed the velocity of one of its bodies since: then it need not have been turned back by
    /// forces.
    is_struck: bool,
}

/// True if what closes with a speed `down` [m/s] has stayed within the target zone since it was last seen.
fn stayed_low(
    assembly: &Assembly,
    seen: &Before,
    down: f64,
    &Tolerances { target_gap, accuracy, velocity_tol }: &Tolerances,
) -> bool {
    // A pair that closed fast then has not been stopped since.
    if seen.rate < -velocity_tol {
        return false;
    }
    let up = seen.rate.max(0.0);
    let lasted = assembly.now().since(seen.time);
    let rise = 0.5 * up * up * lasted / (up + down);
    let most = if seen.is_often_low { LARGE * target_gap } else { target_gap + accuracy };
    // A pair that moved under a constant acceleration is back where it was (`went` is small). Else, as when
    // something has lifted it in between, it has stayed only if it is no faster than forces make it within the
    // zone. With contacts that carry impulses only it would then sink, so there only `went` counts.
    let went = 0.5 * (up - down).abs() * lasted;
    let forced = |times: f64| {
        assembly.settings().impulse_step.is_none()
            && down * down <= 2.0 * times * assembly.acceleration() * most
    };
    // Forces may press bodies together with many times the scene's acceleration. A pair of which a body was struck, as in a
    // deep heap, must be slower: else the energy of a blow is lost, which an elastic body passes on and gets back at once.
    let is_low = || {
        if seen.is_struck { forced(MAJOR) } else { went <= most || forced(HUGE) }
    };
    seen.gap + rise <= most && is_low()
}

/// True if an impulse has changed the velocity of one of two bodies since a time.
fn is_struck_since(assembly: &Assembly, bodies: [BodyId; 2], time: Time) -> bool {
    let movable = bodies.into_iter().filter(|body| !body.is_world());
    let strikes = movable.filter_map(|body| assembly.struck()[body.index()]);
    strikes.into_iter().any(|strike| strike > time)
}
