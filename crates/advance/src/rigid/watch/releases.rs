//! Releases: contacts that lose their force within a group's segment.
//!
//! Each value of a force takes an evaluation of the group, so a release is looked for only when the time comes up to
//! which none can happen. The segment is searched up to its end or to the event found otherwise, in one part, or in as
//! many as the forces ask for.

use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::NODES;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::group::stepping::Stepping;
use crate::rigid::shares::{HALVINGS, ROUNDED_FORCE, SEVERAL};
use crate::rigid::watch::crossing::{Part, interpolated};
use crate::rigid::watch::earliest::Earliest;
use crate::rigid::watch::early_ends::{Watch, fill, find_first};
use crate::rigid::watch::margins::{evaluate_margins_at, list_margins};
use crate::rigid::watch::overdue::find_overdue;

/// Pull of a contact that may be rounding as it becomes active, as a multiple of the force that counts as none.
const PULL: f64 = 16.0;

/// Fractions of a part of the segment at which forces are compared with the quartics through their samples: near the
/// middles of the first and the last interval, where quartics err most, and in an inner one. They have no common divisor
/// with each other and the nodes, so that a fast oscillation does not look the same at all of them.
const BETWEEN_NODES: [f64; 3] = [0.118_034, 0.381_966, 0.854_102];
/// Difference there, as a fraction of the largest sample, up to which quartics show where forces vanish; a difference that
/// is less than the force that counts as none does not matter.
const RESOLVED: f64 = 3e-4;
/// Span of a part, as a fraction of the segment, that is not halved any more: forces jump there.
const NARROWEST: f64 = 1e-8;
/// Largest number of times that parts of one segment are halved, in all, where force laws press the contacts.
const MOST_HALVINGS: usize = 10_000;

/// Watch for contact forces that fall to zero.
const RELEASES: Watch = Watch {
    place: |dynamics, offset| evaluate_margins_at(dynamics, offset),
    place_for: |dynamics, _, offset| evaluate_margins_at(dynamics, offset),
    read: |dynamics, row| dynamics.stage.margins()[row],
    genuine: |_, _, offset| Some(offset),
    end: SegmentEnd::Release,
};

/// Finds the first contact that loses its force on the segment, if that comes before the event found otherwise; not
/// before the offset of the look.
pub(crate) fn look_for_release(dynamics: &mut Dynamics<'_>) {
    let from = dynamics.group.look().unwrap_or(0.0);
    dynamics.group.set_look(None);
    find_least_forces(dynamics);
    let mut earliest = Earliest { found: pull_at_start(dynamics).or(dynamics.group.event()) };
    let mut forces = dynamics.stage.lend_force_samples();
    let mut pulled = dynamics.group.lend_pulled();
    let narrowest = NARROWEST * dynamics.group.span();
    let end = earliest.limit().unwrap_or(dynamics.group.span());
    // Forces of a group with friction are often at a bound without passing it, and no halving tells.
    let is_plain = dynamics.group.force_laws().is_empty() || dynamics.group.is_rough();
    let most = if is_plain { HALVINGS } else { MOST_HALVINGS };
    let (mut part, mut halvings) = (Part::all(end), 0);
    while earliest.is_after(part.from) {
        sample_forces(dynamics, &mut forces, part);
        while halvings < most && part.span() > narrowest && !is_resolved_by(dynamics, &forces, part) {
            part.to = part.node(NODES / 2);
            halvings += 1;
            sample_forces(dynamics, &mut forces, part);
        }
        find_first(dynamics, &mut earliest, (&forces, part), &RELEASES);
        find_overdue(dynamics, &mut earliest, (&forces, part, &mut pulled), &RELEASES, |dynamics, row| {
            PULL * dynamics.stage.least().get(row).copied().unwrap_or(0.0)
        });
        if part.to >= end {
            break;
        }
        // The next part may be twice as long.
        part = Part { from: part.to, to: (part.to + 2.0 * part.span()).min(end) };
    }
    dynamics.group.take_back_pulled(pulled);
    dynamics.group.set_event(earliest.found.map(|(offset, end)| (offset.max(from), end)));
    dynamics.stage.take_back_force_samples(forces);
}

/// True if the quartics through the samples show all that contact forces do on a part of the segment. No error
/// estimate tells how forces vary that hold bodies altogether, nor that forces grow without bound where rows become
/// singular: two corners that hold a body flush come together as it slides off.
fn is_resolved_by(dynamics: &mut Dynamics<'_>, forces: &[[f64; NODES]], part: Part) -> bool {
    BETWEEN_NODES.into_iter().all(|fraction| {
        evaluate_margins_at(dynamics, part.from + fraction * part.span());
        forces.iter().enumerate().filter(|(_, values)| values[0].is_finite()).all(|(row, values)| {
            let size = values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            let least = dynamics.stage.least().get(row).copied().unwrap_or(0.0);
            let allowed = least.max(RESOLVED * size);
            (dynamics.stage.margins()[row] - interpolated(values, fraction)).abs() <= allowed
        })
    })
}

/// Release of a contact that pulls by more than rounding as the group is made.
fn pull_at_start(dynamics: &mut Dynamics<'_>) -> Option<(f64, SegmentEnd)> {
    let group = &*dynamics.group;
    let (start, made) = (group.start(), group.made());
    if dynamics.group.is_patient() || start != made {
        return None;
    }
    let mut margins = dynamics.stage.lend_margins();
    let (group, least) = (&*dynamics.group, dynamics.stage.least());
    list_margins(group, group.forces(), least, &mut margins);
    let pulls = |(margin, least): (&f64, &f64)| *margin < -PULL * least;
    let row = margins.iter().zip(least).position(pulls);
    dynamics.stage.take_back_margins(margins);
    Some((0.0, SegmentEnd::Release(row?)))
}

/// Fraction of the step up to which no contact comes near to losing its force, as its stages tell; `None` if that
/// is so all along. A force is firm all along if its least value at the stages and both ends exceeds its variation,
/// and else for as long as it would take to vanish several times as fast as it varies. Implicit steps have too few
/// stages to tell; along steps that force laws have left too long, the variation does not tell the rate.
pub(crate) fn firm_part(dynamics: &Dynamics<'_>) -> Option<f64> {
    let group = &*dynamics.group;
    let (rows, forces, end_forces, force_laws) =
        (group.rows(), group.forces(), group.end_forces(), group.force_laws());
    let is_known =
        dynamics.group.stepping() != Stepping::Stiff && dynamics.stage.force_ranges().len() == rows.len();
    let range = |index: usize| {
        let (start, end) = (forces[index], end_forces[index]);
        let [least, largest] = if is_known { dynamics.stage.force_ranges()[index] } else { [start, end] };
        [least.min(start).min(end), largest.max(start).max(end)]
    };
    // A margin that starts at `start`, is no less than `least`, and varies by no more than `spread`.
    let part = |start: f64, least: f64, spread: f64| {
        let is_firm = is_known && least > spread;
        let is_slow = is_known && force_laws.is_empty() && start > 0.0;
        let part = if is_slow { start / (SEVERAL * spread) } else { 0.0 };
        (!is_firm).then_some(part)
    };
    let of_contact = |(index, row): (usize, &ActiveRow)| {
        if row.bilateral {
            return None;
        }
        let [least, largest] = range(index);
        part(forces[index], least, largest - least)
    };
    // The bound of each anchor is the sum of those of its contacts.
    let of_anchor = |index: usize, row: &ActiveRow, bound: f64| {
        let (force, [low, high]) = match forces.get(index) {
            Some(&force) => (force, range(index)),
            None => (row.load[0], [row.load[0]; 2]),
        };
        let mut margin = [bound - force.abs(), bound - low.abs().max(high.abs()), high - low];
        for (contact, row) in rows.iter().enumerate() {
            for (_, coefficient) in row.kept_by().filter(|&(anchor, _)| anchor == index) {
                let [least, largest] = range(contact);
                margin[0] += coefficient * forces[contact];
                margin[1] += coefficient * least;
                margin[2] += coefficient * (largest - least);
            }
        }
        part(margin[0], margin[1], margin[2])
    };
    let spare_anchors = &group.spares()[..group.spare_anchors()];
    let anchors = rows.iter().chain(spare_anchors).enumerate();
    let anchors = anchors.filter_map(|(index, row)| of_anchor(index, row, row.anchor_bound()?));
    let contacts = rows.iter().enumerate().filter_map(of_contact);
    contacts.chain(anchors).min_by(f64::total_cmp)
}

/// Finds for each row the force [N] that counts as none: a fraction of the load on the less loaded of its bodies,
/// which is that of the body's acceleration plus the forces of all its rows.
fn find_least_forces(dynamics: &mut Dynamics<'_>) {
    let group = &*dynamics.group;
    let count = group.bodies().len();
    let loads = group.bodies().iter().enumerate().map(|(place, &body)| {
        let at = 3 * (count + place);
        dynamics.physics.mechanism.trajectories[body.index()].load(&group.rates()[at..at + 3])
    });
    dynamics.stage.set_least_forces(ROUNDED_FORCE, group, loads);
}

/// Samples the forces of all rows at the nodes of a part of the segment, raised by the force that counts as none.
fn sample_forces(dynamics: &mut Dynamics<'_>, samples: &mut Vec<[f64; NODES]>, part: Part) {
    fill(samples, dynamics.group.rows().len() + dynamics.group.spare_anchors());
    let mut margins = dynamics.stage.lend_margins();
    for index in 0..NODES {
        let offset = part.node(index);
        let is_inside = offset > 0.0 && offset < dynamics.group.span();
        if is_inside {
            dynamics.evaluate_at(offset);
        }
        let forces = match offset {
            _ if is_inside => dynamics.stage.forces(),
            0.0 => dynamics.group.forces(),
            _ => dynamics.group.end_forces(),
        };
        list_margins(dynamics.group, forces, dynamics.stage.least(), &mut margins);
        for (sample, &margin) in samples.iter_mut().zip(&margins) {
            sample[index] = margin;
        }
    }
    dynamics.stage.take_back_margins(margins);
}

#[cfg(test)]
mod tests {
    use super::{firm_part, look_for_release};
    use crate::rigid::agenda::Source;
    use crate::rigid::event::life::look_further;
    use crate::rigid::group::groups::{group_of, put_group, with_group};
    use crate::rigid::group::state::SegmentEnd;
    use crate::rigid::test_scene::resting_discs;
    use crate::rigid::watch::early_ends::find_event;
    use halfgap_collision::BodyId;

    /// Fraction of the step up to which a contact is firm, if its force [N] goes from `start` to `end`.
    fn firm_from_to(start: f64, end: f64) -> Option<f64> {
        let mut rooms = resting_discs(&[0.0]);
        let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        let [forces, end_forces] = group.forces_mut();
        (forces[0], end_forces[0]) = (start, end);
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, _| {
            dynamics.stage.clear_force_ranges(1);
            firm_part(dynamics)
        })
    }

    #[test]
    fn a_force_is_firm_for_as_long_as_it_cannot_vanish() {
        assert_eq!(firm_from_to(10.0, 9.0), None);
        assert_eq!(firm_from_to(9.0, 10.0), None);
        // The force falls by 8 N along the step, and at first no more than four times as fast.
        assert_eq!(firm_from_to(10.0, 2.0), Some(10.0 / 32.0));
        assert_eq!(firm_from_to(10.0, -6.0), Some(10.0 / 64.0));
        // A contact that starts without force is looked at at once.
        assert_eq!(firm_from_to(0.0, 5.0), Some(0.0));
        assert_eq!(firm_from_to(0.0, 0.0), Some(0.0));
    }

    #[test]
    fn a_contact_that_may_lose_its_force_is_looked_at_when_its_time_comes() {
        let leader = BodyId(1);
        let mut rooms = resting_discs(&[0.0]);
        let mut group = rooms.groups.take(leader).expect("it is in a group");
        // As if the disc's force fell from 20 N, twice its weight, to -20 N at the end.
        let [forces, end_forces] = group.forces_mut();
        (forces[0], end_forces[0]) = (20.0, -20.0);
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, _| {
            dynamics.stage.clear_force_ranges(1);
            find_event(dynamics);
        });
        assert!(group.event().is_none());
        assert_eq!(group.due(), group.start().plus(group.span() / 8.0));
        put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        look_further(
            &mut rooms.assembly,
            &mut rooms.connectors,
            &mut rooms.groups,
            &mut rooms.agenda,
            leader,
        );
        let group = group_of(&rooms.assembly, &rooms.groups, leader).expect("it goes on");
        let Some((offset, SegmentEnd::Release(0))) = group.event() else { panic!("{:?}", group.event()) };
        assert!(offset > 0.75 * group.span(), "{offset} s");
        assert_eq!(rooms.agenda.time_of(Source::Group(leader)), Some(group.start().plus(offset)));
        // An event found for a time that has passed happens now.
        let mut group = rooms.groups.take(leader).expect("it goes on");
        let late = 2.0 * group.span();
        group.set_event(None);
        group.set_look(Some(late));
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, _| {
            look_for_release(dynamics)
        });
        assert_eq!(group.event(), Some((late, SegmentEnd::Release(0))));
    }
}
