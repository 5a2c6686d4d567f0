//! Contacts that fire repeatedly while time stands still. They are counted; beyond a first limit they fire at a lower
//! gap (see `rules`), beyond a second the advance fails as stuck.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::instant::is_same_time;
use crate::rigid::contacts::pairs::{PairId, Pairs};
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::zeno::memory::Zeno;
use crate::time::Time;

/// Number of collisions of a pair at one time beyond which it fires at a lower gap.
pub(crate) const CALM_REPEATS: u32 = 20;
/// Number of collisions of a pair at one time beyond which the advance is stuck.
const MOST_REPEATS: u32 = 100;

/// True if a group was ended at a time as soon as it was made, because one of its contacts pulled.
pub(crate) fn has_pulled(zeno: &Zeno, time: Time) -> bool {
    zeno.last_pull.is_some_and(|last| is_same_time(last, time))
}

/// Number of times beyond [`CALM_REPEATS`] that a pair has fired at the present time.
pub(crate) fn repeats_beyond_calm(assembly: &Assembly, pairs: &Pairs, pair: PairId) -> u32 {
    let past = pairs.past(pair);
    let is_now = past.last_contact().is_some_and(|last| is_same_time(last, assembly.now()));
    if is_now { past.repeats().saturating_sub(CALM_REPEATS) } else { 0 }
}

/// Counts an event of a pair; returns how often it has fired before at the present time.
pub(crate) fn note_repeat(
    assembly: &Assembly,
    pairs: &mut Pairs,
    zeno: &mut Zeno,
    pair: PairId,
) -> Result<u32, AdvanceError> {
    let now = assembly.now();
    let bodies = pairs.bodies(pair);
    let (events, [primary, normal]) = (pairs.count_contact(pair, now), bodies);
    if events > CALM_REPEATS {
        zeno.last_insistent = Some(now);
    }
    if events > MOST_REPEATS {
        let between = Between { primary, normal };
        return Err(AdvanceError::Stuck { time: now.seconds(), between, events });
    }
    Ok(events)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::due::events::handle_contact;
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::test_scene::{FINE, rooms_of};
    use glam::DVec2;
    use halfgap_collision::{Body, BodyId, BodyState};
    use halfgap_geometry::{FeatureId, Shape};

    /// Two elastic discs at their target gap that close at 2 m/s, and their pair.
    fn meeting() -> (Rooms, PairId, [FeatureId; 2]) {
        let disc = |side: f64| {
            let shape = Shape::disc(0.5).expect("a fine radius");
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
            let position = DVec2::new(side * (0.5 + 0.5e-10), 0.0);
            let state = BodyState { position, velocity: DVec2::new(-side, 0.0), ..BodyState::default() };
            BodyPart::new(body, FreeMotion::default(), state)
        };
        let parts = RigidParts { bodies: vec![disc(-1.0), disc(1.0)], ..RigidParts::default() };
        let rooms = rooms_of(parts, FINE, Time::from_seconds(1.0));
        let pair = rooms.pairs.between(BodyId(0), BodyId(1)).expect("they are near each other");
        let features = [FeatureId(0), FeatureId(0)];
        (rooms, pair, features)
    }

    #[test]
    fn a_pair_that_fires_for_the_first_time_bounces() {
        let (mut rooms, pair, features) = meeting();
        // The start has seen the pair at its target: a moment later it has been elsewhere.
        rooms.pairs.forget_seen_of(BodyId(0));
        rooms.books.begin_event(rooms.assembly.now());
        handle_contact(&mut rooms, pair, features).expect("one row");
        assert!(rooms.books.told().has_hit());
        assert_eq!(rooms.books.told().last_impact().rows[0].rate_after, 2.0);
    }

    #[test]
    fn a_pair_that_does_not_stop_then_is_stuck() {
        let (mut rooms, pair, _) = meeting();
        for count in 0..=MOST_REPEATS {
            assert_eq!(note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair), Ok(count));
        }
        let between = Between { primary: BodyId(0), normal: BodyId(1) };
        let stuck = AdvanceError::Stuck { time: 1.0, between, events: MOST_REPEATS + 1 };
        assert_eq!(note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair), Err(stuck));
    }

    #[test]
    fn time_that_goes_by_ends_the_count() {
        let (mut rooms, pair, _) = meeting();
        for _ in 0..3 * MOST_REPEATS {
            let later = rooms.assembly.now().plus(1e-12);
            rooms.assembly.set_now(later);
            assert_eq!(note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair), Ok(0));
        }
    }
}
