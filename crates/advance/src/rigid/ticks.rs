//! Contacts that carry impulses only: slow ones sink, and are put back once a step.
//!
//! A pair that closes more slowly than `velocity_tol`, or has not left its target zone since it was last seen, does not
//! fire. At the next tick of the step an impulse stops its velocity, and it is moved back to its target gap by the
//! least displacement in the metric of the masses. A pair that is pressed so hard that it sinks deep before the tick is
//! stopped there, too.
//!
//! Until then the two bodies are searched, and take part in impacts, as deep as they may have sunk: another impact may
//! drive one further into the other, and a body that has turned meanwhile touches at other places.

use crate::rigid::agenda::{Agenda, Source};
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::bounces::has_stayed_low;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::PairId;
use crate::rigid::contacts::table::Mode;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::event::impacting::handle_impact;
use crate::rigid::event::rooms::{Rooms, with_work};
use crate::rigid::region::cause::Cause;
use crate::rigid::shares::NEARLY_ALL;
use crate::rigid::sinking::depth::{BEHIND, DEEP_SHARE, FIRST_SHARE, FURTHER_SHARE, Sinking, room_to_sink};
use crate::time::Time;
use halfgap_collision::Zone;
use halfgap_geometry::FeatureId;

/// Largest number of collisions of sunk contacts within a step.
const MOST_PRESSED: u32 = 100_000;

/// Leaves a pair that fires to sink until the next tick; false if it has to be handled now.
pub(crate) fn sinks(rooms: &mut Rooms, pair: PairId, features: [FeatureId; 2]) -> bool {
    let Some(step) = rooms.assembly.settings().impulse_step else { return false };
    let bodies = rooms.pairs.bodies(pair);
    let touch = Touch::new(bodies, features);
    let gap = gap_at(&rooms.assembly, touch, rooms.assembly.now());
    if gap.distance == f64::INFINITY {
        return false;
    }
    let tolerances = rooms.assembly.settings().tolerances;
    let room = room_to_sink(&rooms.assembly, bodies);
    let sinks_by = |share: f64| gap.is_sunk_below(tolerances.target_gap - share * room);
    let down = -gap.normal_velocity;
    let stays_low = || has_stayed_low(&rooms.assembly, &rooms.pairs, pair, features, down, &tolerances);
    if sinks_by(NEARLY_ALL) || gap.rebounds() && (sinks_by(DEEP_SHARE) || !stays_low()) {
        return false;
    }
    let lowest = (tolerances.target_gap - FIRST_SHARE * room).min(gap.distance - FURTHER_SHARE * room);
    let tick = next_tick(&rooms.assembly, &mut rooms.sinking, step);
    rooms.pairs.set_mode(pair, features, Mode::Open(lowest));
    rooms.sinking.wait(touch);
    // The search goes on for the other features of the two bodies.
    rooms.searching().predict(pair);
    rooms.agenda.set(Source::Tick, tick);
    true
}

/// Counts a collision of a touch, if it has sunk.
///
/// # Errors
/// More than `MOST_PRESSED` such collisions since the last tick.
pub(crate) fn note_pressed(
    assembly: &Assembly,
    sinking: &mut Sinking,
    touch: Touch,
) -> Result<(), AdvanceError> {
    let Some(step) = assembly.settings().impulse_step else { return Ok(()) };
    let sunk = assembly.settings().tolerances.target_gap - DEEP_SHARE * room_to_sink(assembly, touch.bodies);
    if !gap_at(assembly, touch, assembly.now()).is_sunk_below(sunk) {
        return Ok(());
    }
    let events = sinking.note_pressed();
    if events <= MOST_PRESSED {
        return Ok(());
    }
    let [primary, normal] = touch.bodies;
    let time = assembly.now().seconds();
    Err(AdvanceError::Pressed { time, between: Between { primary, normal }, events, step })
}

/// Time of the first tick after the present time.
fn next_tick(assembly: &Assembly, sinking: &mut Sinking, step: f64) -> Time {
    let passed = (assembly.now().since(assembly.start()) / step).floor();
    let passed = sinking.passed(passed);
    let tick = assembly.start().plus((passed + 1.0) * step);
    if tick > assembly.now() { tick } else { assembly.start().plus((passed + 2.0) * step) }
}

/// Stops and puts back bodies that have sunk.
pub(crate) fn handle_tick(rooms: &mut Rooms) -> Result<(), AdvanceError> {
    rooms.agenda.clear(Source::Tick);
    rooms.sinking.begin_tick();
    for index in 0..rooms.sinking.waiting().len() {
        let gap = gap_at(&rooms.assembly, rooms.sinking.waiting()[index], rooms.assembly.now());
        rooms.books.note_gap(gap.distance);
    }
    let outcome = with_work(rooms, Cause::Tick, |rooms, work| {
        work.seed(rooms.sinking.waiting().iter().flat_map(|touch| touch.bodies));
        work.sort_seeds();
        handle_impact(rooms, work)
    });
    keep_what_is_sunk(&rooms.assembly, &mut rooms.sinking, &mut rooms.agenda);
    outcome
}

/// Keeps waiting the touches that could not be put back altogether, and sets the next tick for them.
fn keep_what_is_sunk(assembly: &Assembly, sinking: &mut Sinking, agenda: &mut Agenda) {
    let mut waiting = sinking.take_waiting();
    waiting.retain(|touch| {
        let gap = gap_at(assembly, *touch, assembly.now());
        gap.zone() > Zone::Target && !gap.is_illegal(BEHIND * room_to_sink(assembly, touch.bodies))
    });
    sinking.put_waiting(waiting);
    if let Some(step) = assembly.settings().impulse_step.filter(|_| !sinking.waiting().is_empty()) {
        let tick = next_tick(assembly, sinking, step);
        agenda.set(Source::Tick, tick);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::shares::NEARLY_ALL;
    use crate::rigid::sinking::depth::sinks_to;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::{BodyId, Tolerances};

    #[test]
    fn a_contact_stopped_deep_sinks_a_part_of_the_depth_left() {
        let mut rooms = resting_discs(&[0.0]);
        let Tolerances { target_gap, .. } = rooms.assembly.settings().tolerances;
        let bodies = [BodyId(0), BodyId(1)];
        let touch = Touch { bodies, features: [FeatureId(5), FeatureId(0)] };
        // With contact forces the contact sinks by no more than can be told.
        assert_eq!(sinks_to(&rooms.assembly, touch, -1e-3), -1e-3 - rooms.assembly.sink());
        rooms.assembly.settings_mut().impulse_step = Some(1e-3);
        let room = room_to_sink(&rooms.assembly, bodies);
        let sinks_by = |depth: f64| {
            let gap = target_gap - depth * room;
            (gap - sinks_to(&rooms.assembly, touch, gap)) / room
        };
        assert!((sinks_by(0.0) * room / rooms.assembly.sink() - 1.0).abs() < 1e-9, "it has not sunk yet");
        for depth in [0.5, 0.75] {
            assert!((sinks_by(depth) - (NEARLY_ALL - depth) * FURTHER_SHARE).abs() < 1e-9);
        }
        assert!(
            (sinks_by(NEARLY_ALL) * room / rooms.assembly.sink() - 1.0).abs() < 1e-9,
            "no farther than that"
        );
    }
    #[test]
    fn a_pressed_contact_collides_only_so_often_in_a_step() {
        let mut rooms = resting_discs(&[0.0]);
        let bodies = [BodyId(0), BodyId(1)];
        let touch = Touch { bodies, features: [FeatureId(5), FeatureId(0)] };
        let step = 1e-3;
        rooms.assembly.settings_mut().impulse_step = Some(step);
        let notes = |rooms: &mut Rooms, times: u32| {
            (0..times).find_map(|_| note_pressed(&rooms.assembly, &mut rooms.sinking, touch).err())
        };
        assert_eq!(notes(&mut rooms, 2 * MOST_PRESSED), None, "nothing has sunk");
        dissolve(&mut rooms, bodies[1]);
        let mut state = rooms.assembly.trajectory(bodies[1]).state_at(rooms.assembly.now());
        state.position.y -= 0.5 * room_to_sink(&rooms.assembly, bodies);
        let now = rooms.assembly.now();
        rooms.assembly.trajectory_mut(BodyId(1)).fly_from(now, state);
        assert_eq!(notes(&mut rooms, MOST_PRESSED), None);
        let between = Between { primary: bodies[0], normal: bodies[1] };
        let (time, events) = (rooms.assembly.now().seconds(), MOST_PRESSED + 1);
        let expected = AdvanceError::Pressed { time, between, events, step };
        assert_eq!(notes(&mut rooms, 1), Some(expected));
        handle_tick(&mut rooms).expect("it can be put back");
        assert_eq!(rooms.sinking.note_pressed(), 1, "counting begins anew");
    }
}
