//! Groups whose held rows do harm, and which are made anew. A body that is held by two corners next to each other turns far
//! for a small way or rate between them: held as equations, such rows may move it into others, or have immense forces.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::groups::regroup;
use crate::rigid::event::life::undo_groups;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::settling::settle_and_still;
use crate::rigid::event::work::EventWork;
use crate::rigid::held::settle::HASTY_SHARE;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::measure_touches;
use crate::rigid::remedies::Remedy;

/// Makes groups, and makes them anew if holding their rows does harm. If one of them cannot make a step, or its
/// projection brings contacts nearer by more than their zone, contacts that nearly depend on others are spared, as
/// equations such rows may have immense forces, and none is lifted. If the groups drive other contacts together,
/// contacts that open slowly are let go.
pub(crate) fn regroup_soundly(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    loop {
        work.before.clear();
        work.before.extend(
            work.region
                .bodies()
                .iter()
                .map(|&body| rooms.assembly.trajectory(body).unwound_at(rooms.assembly.now())),
        );
        let projections = rooms.books.ledger().projections;
        let outcome = regroup(rooms, &work.region, &work.settling);
        let [displaces, drives] = match outcome {
            Ok(()) => harm_done(&rooms.assembly, work),
            Err(AdvanceError::StepCollapsed { .. }) => [true, false],
            Err(_) => [false; 2],
        };
        let remedies = rooms.assembly.remedies();
        let displaces = displaces && !work.region.is_unsound() && remedies.act(Remedy::Displaced);
        let drives = drives && !work.region.is_hasty() && remedies.act(Remedy::Driven);
        // Each remedy is tried once.
        let region = &mut work.region;
        if !(displaces || drives) {
            return outcome;
        }
        if displaces {
            region.set_unsound();
        }
        if drives {
            region.set_hasty(true);
        }
        undo_groups(
            &mut rooms.assembly,
            &mut rooms.connectors,
            &mut rooms.groups,
            &mut rooms.agenda,
            &work.region,
            &work.before,
        );
        rooms.books.unbook_projections(projections);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
        settle_and_still(rooms, work)?;
        measure_touches(&rooms.assembly, &mut work.region);
    }
}

/// Tells whether moving held contacts to their gaps has brought touching features nearer by more than their zone, and
/// whether stopping the slow opening of held contacts has driven others together, faster than they opened. Where a
/// body is held by two corners that are next to each other, a small way between them is a large turn, and so is a
/// slow rate.
fn harm_done(assembly: &Assembly, EventWork { region, settling, .. }: &EventWork) -> [bool; 2] {
    let held = settling.held().iter().filter(|(_, row)| !row.bilateral);
    let (mut is_moved, mut opening) = (false, 0.0f64);
    for (index, row) in held {
        let record = &region.records()[*index];
        is_moved |= row.gap != record.geometry.distance;
        opening = opening.max(record.motion.normal_velocity);
    }
    let is_stopped = opening > HASTY_SHARE * assembly.rest_speed();
    let mut harm = [false; 2];
    if is_moved || is_stopped {
        for (touch, before) in region.touches().iter().zip(region.motions()) {
            let gap = gap_at(assembly, *touch, assembly.now());
            harm[0] |= is_moved && gap.is_sunk_below(before.distance - gap.tolerances.accuracy);
            harm[1] |= is_stopped && gap.normal_velocity < before.normal_velocity.min(0.0) - opening;
        }
    }
    harm
}

#[cfg(test)]
mod tests {
    use crate::rigid::event::harm::harm_done;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::event::work::EventWork;
    use crate::rigid::held::settle::settle;
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::region::touching::measure_touches;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    /// Harm that is told of a disc at rest on a floor. Its contact is held `lifted` [m] above where it is, and opened at a
    /// rate [m/s]; since then the disc has sunk by `sunk` [m], and falls at a speed [m/s].
    fn harm([lifted, opening]: [f64; 2], [sunk, falling]: [f64; 2]) -> [bool; 2] {
        let disc = BodyId(1);
        let mut rooms = resting_discs(&[0.0]);
        let mut work = rooms.work.take().expect("the start has made it");
        dissolve(&mut rooms, disc);
        let EventWork { region, settling, .. } = &mut *work;
        collect_region(&rooms.view(), region, &[disc], rooms.assembly.now());
        measure_touches(&rooms.assembly, region);
        let mut stage = rooms.groups.take_stage();
        settling.set_likely([None].into_iter());
        settle(&rooms.view(), region, settling, &mut stage, rooms.assembly.now(), false).expect("it rests");
        settling.held_mut()[0].1.gap += lifted;
        region.records_mut()[0].motion.normal_velocity = opening;
        let mut state = rooms.assembly.trajectory(disc).unwound_at(rooms.assembly.now());
        (state.position.y, state.velocity.y) = (state.position.y - sunk, -falling);
        let now = rooms.assembly.now();
        rooms.assembly.trajectory_mut(disc).fly_from(now, state);
        harm_done(&rooms.assembly, &work)
    }

    #[test]
    fn a_touch_that_is_nearer_by_a_zone_or_driven_together_is_harm() {
        let rooms = resting_discs(&[0.0]);
        let (zone, slow) = (rooms.assembly.settings().tolerances.accuracy, 0.5 * rooms.assembly.rest_speed());
        let lifted = 1e-3 * zone;
        assert_eq!(harm([lifted, 0.0], [2.0 * zone, 0.0]), [true, false]);
        assert_eq!(harm([lifted, 0.0], [0.5 * zone, 0.0]), [false; 2]);
        assert_eq!(harm([0.0, slow], [0.0, 2.0 * slow]), [false, true]);
        assert_eq!(harm([0.0, slow], [0.0, 0.5 * slow]), [false; 2]);
        // Where no row was lifted, or stopped, others have moved the disc.
        assert_eq!(harm([0.0, slow], [2.0 * zone, 0.0]), [false; 2]);
        assert_eq!(harm([lifted, 0.0], [0.0, 2.0 * slow]), [false; 2]);
    }
}
