//! Events that are overdue when a segment starts: by rounding, the force of a contact is a little below zero already,
//! or the contact is a little beyond its features, and it stays active all the same. `watch` waits for falls from above
//! zero, which such a contact does not make any more: it would pull from then on, or run along an edge that does not
//! exist.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::NODES;
use crate::rigid::watch::crossing::{Part, fall_from_below};
use crate::rigid::watch::earliest::Earliest;
use crate::rigid::watch::early_ends::Watch;

/// Offers the earliest fall of any row of a watch that is below zero at the start and falls on; it may do so along
/// many segments.
///
/// * `samples`: values at the nodes of a part of the segment, row by row;
/// * `below`: how far below zero each row was when that was first seen, 0 for the others; updated;
/// * `rounding`: how far below zero a row may be by rounding alone.
pub(super) fn find_overdue(
    dynamics: &mut Dynamics<'_>,
    earliest: &mut Earliest,
    (samples, part, below): (&[[f64; NODES]], Part, &mut Vec<f64>),
    watch: &Watch,
    rounding: impl Fn(&Dynamics<'_>, usize) -> f64,
) {
    below.resize(samples.len(), 0.0);
    for (row, (values, below)) in samples.iter().zip(below).enumerate() {
        if values[0] >= 0.0 {
            *below = 0.0;
            continue;
        }
        if *below == 0.0 {
            *below = -values[0];
        }
        let allowed = 2.0 * rounding(dynamics, row).max(*below);
        let fall = fall_from_below(values, part.span(), allowed, |offset| {
            (watch.place_for)(dynamics, row, part.from + offset);
            (watch.read)(dynamics, row)
        });
        earliest.offer(fall.map(|offset| part.from + offset), (watch.end)(row));
    }
}

#[cfg(test)]
mod tests {
    use crate::rigid::bodies::force_law::{ForceLaw, Snapshot, Wrenches};
    use crate::rigid::event::life::continue_group;
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::group::groups::{group_of, put_group, with_group};
    use crate::rigid::group::state::{Group, SegmentEnd};
    use crate::rigid::test_scene::{block_on_its_corner, resting_discs, turn_on_its_corner};
    use crate::rigid::watch::early_ends::find_event;
    use crate::time::Time;
    use glam::DVec2;
    use halfgap_collision::BodyId;
    use std::sync::Arc;

    /// A force that lifts body 1 ever more: after a second by the body's weight.
    #[derive(Debug)]
    struct Lift;

    impl ForceLaw for Lift {
        fn name(&self) -> &'static str {
            "lift"
        }

        fn bodies(&self) -> &[BodyId] {
            &[BodyId(1)]
        }

        fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
            wrenches.add_force(BodyId(1), DVec2::new(0.0, 9.81 * now.time), DVec2::ZERO);
        }
    }

    /// Changes the group of body 1, steps it anew, and finds the end of the step.
    fn stepped(mut rooms: Rooms, change: impl FnOnce(&mut Group)) -> Box<Group> {
        let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        change(&mut group);
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            dynamics.set_out();
            dynamics.extend(tools).expect("it moves");
            dynamics.make_dense(tools.stepper);
            find_event(dynamics);
        });
        group
    }

    #[test]
    fn a_contact_that_pulls_a_little_from_the_start_lets_go() {
        for late in [1e-8, 1e-6, 1e-3] {
            let mut rooms = resting_discs(&[0.0]);
            rooms.assembly.set_force_laws(vec![Arc::new(Lift)]);
            let group = stepped(rooms, |group| {
                group.set_force_laws(vec![0]);
                let (start, made) = (Time::from_seconds(1.0 + late), group.made());
                group.set_times(start, made);
                group.set_next_step(Some(1e-2));
            });
            assert!(group.forces()[0] < 0.0, "{} N", group.forces()[0]);
            let Some((offset, SegmentEnd::Release(0))) = group.event() else {
                panic!("{late}: {:?}", group.event())
            };
            // The contact lets go when it pulls twice as much as at the start, or as much as may be rounding.
            let pull = (late + offset) / late;
            assert!(pull > 1.0 && pull < 10.0, "{late} s late: {offset} s");
        }
    }

    #[test]
    fn a_contact_that_is_a_little_beyond_its_features_from_the_start_runs_off() {
        // The corner reaches 0.2 rad farther; the block topples on.
        for beyond in [1e-7, 1e-4] {
            let group = stepped(block_on_its_corner(), |group| {
                turn_on_its_corner(group, group.state()[2] + 0.2 + beyond, 1.0);
                group.set_next_step(Some(1e-2));
            });
            let Some((offset, SegmentEnd::Change(0))) = group.event() else {
                panic!("{beyond}: {:?}", group.event())
            };
            let way = offset / beyond;
            assert!(way > 0.5 && way < 3.0, "{beyond} rad beyond: {offset} s");
        }
    }

    #[test]
    fn a_contact_that_goes_on_beyond_its_features_by_many_short_steps_runs_off() {
        let beyond: f64 = 1e-4;
        let mut rooms = block_on_its_corner();
        rooms.assembly.settings_mut().steps.largest_step = Some(0.3 * beyond);
        let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        let angle = group.state()[2] + 0.2 + beyond;
        turn_on_its_corner(&mut group, angle, 1.0);
        group.end_at_start();
        put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        let mut turned = 0.0;
        for _ in 0..10 {
            continue_group(&mut rooms, BodyId(1)).expect("it topples");
            let group = group_of(&rooms.assembly, &rooms.groups, BodyId(1)).expect("it is in a group");
            if let Some((offset, SegmentEnd::Change(0))) = group.event() {
                turned += offset;
                assert!(turned > 0.5 * beyond && turned < 3.0 * beyond, "{turned} rad");
                return;
            }
            turned += group.span();
        }
        panic!("it is active after {turned} rad");
    }
}
