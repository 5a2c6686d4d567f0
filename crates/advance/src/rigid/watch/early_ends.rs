//! Early ends of a group's segment: a contact runs off its features or, touched without force, sinks; contact forces that
//! fall to zero are in `releases`, stops that close and force laws that change branch in `switches`.
//!
//! Each is a function along the dense output whose first fall below zero is an event. Functions of positions are read
//! at once, forces only when the time comes up to which none can vanish.

use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::{EARLY, NODES, Samples};
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::NEGLIGIBLE;
use crate::rigid::watch::crossing::{
    Part, early_fall, early_node, fall_after_rise, first_fall, first_fall_before, node,
};
use crate::rigid::watch::earliest::Earliest;
use crate::rigid::watch::overdue::find_overdue;
use crate::rigid::watch::releases::{firm_part, look_for_release};
use crate::rigid::watch::slips::{find_pull_stop, find_slip_stop};
use crate::rigid::watch::staying::{find_bounds, stays};
use crate::rigid::watch::switches::{find_kink, find_passing, find_stop, find_switch};

/// Largest number of searches for an end of a rail's piece that comes before the one that was found.
const MOST_ZOOMS: usize = 16;
/// Fraction of the way to an end from which on another end is the same.
const EARLIER_BY: f64 = 1.0 - 1e-6;

/// Functions of the rows along a segment, the first of which to fall below zero is an event.
pub(super) struct Watch {
    /// Places the bodies at an offset [s], with all that reading any row needs.
    pub(super) place: fn(&mut Dynamics<'_>, f64),
    /// Places the bodies on which one row depends at an offset [s].
    pub(super) place_for: fn(&mut Dynamics<'_>, usize, f64),
    /// Value of a row with the bodies in place.
    pub(super) read: fn(&Dynamics<'_>, usize) -> f64,
    /// Offset [s] at which a row that falls at an offset [s] does so in earnest, if at all; the bodies are in place
    /// there.
    pub(super) genuine: fn(&mut Dynamics<'_>, usize, f64) -> Option<f64>,
    /// End of the segment by the fall of a row.
    pub(super) end: fn(usize) -> SegmentEnd,
}

/// Contacts and points of rails that run off their features or pieces.
const CHANGES: Watch = Watch {
    place: |dynamics, offset| dynamics.put_watched_at(offset),
    place_for: |dynamics, row, offset| dynamics.put_row_at(row, offset),
    read: |dynamics, row| way_to_end(dynamics, row),
    genuine: |_, _, offset| Some(offset),
    end: SegmentEnd::Change,
};
/// Contacts touched without force that sink.
const SINKINGS: Watch = Watch {
    place: |dynamics, offset| dynamics.put_watched_at(offset),
    place_for: |dynamics, row, offset| dynamics.put_idle_at(row, offset),
    read: |dynamics, row| height(dynamics, row),
    // A contact that sinks beyond the ends of its features, or leans over, has neighbours that end the segment.
    genuine: |dynamics, row, offset| {
        if is_within(dynamics, row) { Some(offset) } else { first_sinking_within(dynamics, row) }
    },
    end: SegmentEnd::Sink,
};

/// Makes room for a number of rows.
pub(super) fn fill(list: &mut Vec<[f64; NODES]>, rows: usize) {
    list.clear();
    list.resize(rows, [0.0; NODES]);
}

/// Finds the event that ends the segment early; its dense output and end forces must be known. Whether a contact
/// loses its force takes an evaluation for every offset tried, so that waits until the time up to which none can:
/// mostly another event has come by then.
pub(crate) fn find_event(dynamics: &mut Dynamics<'_>) {
    let event = find_geometric_event(dynamics);
    dynamics.group.set_event(event);
    let firm = firm_part(dynamics).map(|part| part * dynamics.group.span());
    let earlier = |offset: &f64| dynamics.group.event().is_none_or(|(event, _)| *offset < event);
    let look = firm.filter(earlier);
    dynamics.group.set_look(look);
    if dynamics.group.look() == Some(0.0) {
        look_for_release(dynamics);
    }
}

/// Earliest event that is found without the forces of contacts.
fn find_geometric_event(dynamics: &mut Dynamics<'_>) -> Option<(f64, SegmentEnd)> {
    let mut earliest = Earliest::default();
    let mut samples = sample_rows(dynamics);
    lower_sunk(dynamics, &mut samples);
    if !are_still(dynamics, &samples.heights) {
        dynamics.group.forget_steadiness();
    }
    find_early_sinking(dynamics, &mut earliest, &samples);
    find_early_change(dynamics, &mut earliest, &samples.rooms);
    let all = Part::all(dynamics.group.span());
    find_first(dynamics, &mut earliest, (&samples.rooms, all), &CHANGES);
    let margin = dynamics.physics.mechanism.change_margin();
    let mut overrun = dynamics.group.lend_overrun();
    find_overdue(dynamics, &mut earliest, (&samples.rooms, all, &mut overrun), &CHANGES, |_, _| margin);
    dynamics.group.take_back_overrun(overrun);
    find_earlier_ends(dynamics, &mut earliest, &samples.rooms);
    find_first(dynamics, &mut earliest, (&samples.heights, all), &SINKINGS);
    dynamics.stage.take_back_samples(samples);
    find_slip_stop(dynamics, &mut earliest);
    find_pull_stop(dynamics, &mut earliest);
    for place in 0..dynamics.group.stops().len() {
        let stop = dynamics.group.stops()[place];
        earliest.offer(find_stop(dynamics, stop), SegmentEnd::Stop(stop.id));
        earliest.offer(find_passing(dynamics, stop), SegmentEnd::Switch);
    }
    earliest.offer(find_kink(dynamics, dynamics.group.span()), SegmentEnd::Switch);
    for place in 0..dynamics.group.force_laws().len() {
        let law = dynamics.group.force_laws()[place];
        for index in 0..dynamics.physics.force_laws[law].switches() {
            earliest.offer(find_switch(dynamics, law, index), SegmentEnd::Switch);
        }
    }
    earliest.found
}

/// True if contacts that are touched without force neither closed nor opened along the segment.
fn are_still(dynamics: &Dynamics<'_>, heights: &[[f64; NODES]]) -> bool {
    let still = NEGLIGIBLE * dynamics.physics.mechanism.tolerances.sink();
    heights.iter().all(|sample| sample.iter().all(|height| (height - sample[0]).abs() <= still))
}

/// Samples at the nodes the functions of the rows that need no forces.
fn sample_rows(dynamics: &mut Dynamics<'_>) -> Samples {
    let mut samples = dynamics.stage.lend_samples();
    let Samples { rooms, heights, early, .. } = &mut samples;
    find_who_may_leave(dynamics, rooms);
    dynamics.watch_rows(|row| rooms.get(row).is_some_and(|sample| sample[0].is_finite()));
    fill(heights, dynamics.group.idle().len());
    early.clear();
    early.resize(heights.len(), [0.0; EARLY]);
    for index in 0..if rooms.is_empty() && heights.is_empty() { 0 } else { NODES } {
        dynamics.put_watched_at(node(index, dynamics.group.span()));
        for (row, sample) in rooms.iter_mut().enumerate().filter(|(_, sample)| sample[0].is_finite()) {
            sample[index] = way_to_end(dynamics, row);
        }
        for (row, sample) in heights.iter_mut().enumerate() {
            sample[index] = height(dynamics, row);
        }
    }
    for index in 0..if early.is_empty() { 0 } else { EARLY } {
        dynamics.put_watched_at(early_node(index, dynamics.group.span()));
        for (row, sample) in early.iter_mut().enumerate() {
            sample[index] = height(dynamics, row);
        }
    }
    samples
}

/// Lowers the least gap of a contact without force that is below it by rounding as the segment starts, and corrects
/// its samples: it would not be seen to sink any more.
fn lower_sunk(dynamics: &mut Dynamics<'_>, samples: &mut Samples) {
    let Samples { heights, early, .. } = samples;
    for (row, (heights, early)) in heights.iter_mut().zip(early).enumerate() {
        if heights[0] >= 0.0 {
            continue;
        }
        dynamics.put_idle_at(row, 0.0);
        if is_within(dynamics, row) && dynamics.physics.remedies.act(Remedy::SunkLowered) {
            let way = dynamics.physics.mechanism.tolerances.sink() - heights[0];
            dynamics.group.lower_idle_gap(row, way);
            heights.iter_mut().chain(early).for_each(|height| *height += way);
        }
    }
}

/// Makes room for samples of how far rows are from running off their features: for none, if bounds tell that all of
/// them stay; else the samples of rows that stay are infinite.
fn find_who_may_leave(dynamics: &mut Dynamics<'_>, rooms: &mut Vec<[f64; NODES]>) {
    rooms.clear();
    let mechanism = &dynamics.physics.mechanism;
    if !dynamics.group.rows().iter().any(|row| mechanism.can_change(row)) {
        return;
    }
    find_bounds(dynamics);
    dynamics.place_at(0.5 * dynamics.group.span());
    rooms.extend((0..dynamics.group.rows().len()).map(|row| {
        let sample = if stays(dynamics, row) { f64::INFINITY } else { 0.0 };
        [sample; NODES]
    }));
    if rooms.iter().all(|sample| sample[0].is_infinite()) {
        rooms.clear();
    }
}

/// Offers the earliest contact that sinks before the first node.
fn find_early_sinking(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest, samples: &Samples) {
    for (row, (early, heights)) in samples.early.iter().zip(&samples.heights).enumerate() {
        let fall = early_fall(heights[0], early, dynamics.group.span(), |offset| {
            dynamics.put_idle_at(row, offset);
            height(dynamics, row)
        });
        let Some(offset) = fall.filter(|&offset| earliest.is_after(offset)) else { continue };
        dynamics.put_idle_at(row, offset);
        if is_within(dynamics, row) {
            earliest.offer(Some(offset), SegmentEnd::Sink(row));
        }
    }
}

/// Offers the earliest contact that runs off its features before the first node, of those that start at the end of their
/// features: one that has just begun there may run off at once and come back, and one that has taken over from its
/// neighbour may start beyond by rounding, come onto its features and run off again.
fn find_early_change(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest, rooms: &[[f64; NODES]]) {
    let at_end = 2.0 * dynamics.physics.mechanism.change_margin();
    for (row, values) in rooms.iter().enumerate().filter(|(_, values)| values[0] <= at_end) {
        let span = dynamics.group.span();
        let mut room_at = |offset: f64| {
            dynamics.put_row_at(row, offset);
            way_to_end(dynamics, row)
        };
        let fall = if values[0] < 0.0 {
            fall_after_rise(values, span, room_at)
        } else {
            let early = std::array::from_fn(|index| room_at(early_node(index, span)));
            early_fall(values[0], &early, span, room_at)
        };
        earliest.offer(fall, SegmentEnd::Change(row));
    }
}

/// Offers ends of rails' pieces that were passed for a moment before those that were found. A long step may hold
/// the way up and down a piece and far beyond: it is searched again up to the end that was found, as often as that
/// is earlier; and from its start on, where by rounding that lies before the piece.
fn find_earlier_ends(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest, rooms: &[[f64; NODES]]) {
    for (row, rooms) in rooms.iter().enumerate() {
        let is_rail = matches!(dynamics.group.rows()[row].source, RowSource::Connector(..));
        for _ in 0..MOST_ZOOMS {
            let is_own = earliest.found.is_some_and(|(_, end)| end == SegmentEnd::Change(row));
            if !is_rail || rooms[0].is_infinite() || !(is_own || rooms[0] < 0.0) {
                break;
            }
            let limit = earliest.limit().unwrap_or(dynamics.group.span());
            // Neither the rounding of a place at the end of a piece nor the place from which the point sets out
            // counts as beyond.
            let margin = 2.0 * dynamics.physics.mechanism.change_margin().max(-rooms[0]);
            let mut room_at = |offset: f64| {
                dynamics.put_row_at(row, offset);
                way_to_end(dynamics, row) + margin
            };
            let mut values = std::array::from_fn(|index| room_at(node(index, limit)));
            values[0] = values[0].max(0.0);
            let fall = first_fall(&values, limit, room_at).filter(|&fall| fall < EARLIER_BY * limit);
            if values[1] < 0.0 || fall.is_none() {
                break;
            }
            earliest.offer(fall, SegmentEnd::Change(row));
        }
    }
}

/// Offers the earliest fall of any row of a watch in a part of the segment, of which the values at the nodes are given,
/// if it comes before the end found so far.
///
/// Placing the bodies costs more than reading a row: once a fall is found, all rows are read there, and those that
/// have not fallen by then need no search of their own.
pub(super) fn find_first(
    dynamics: &mut Dynamics<'_>,
    earliest: &mut Earliest,
    (samples, part): (&[[f64; NODES]], Part),
    watch: &Watch,
) {
    if samples.is_empty() {
        return;
    }
    let mut there = dynamics.stage.lend_there();
    let mut read_at = None;
    for (row, values) in samples.iter().enumerate() {
        let limit = earliest.limit();
        if limit != read_at
            && let Some(offset) = limit
        {
            (watch.place)(dynamics, offset);
            there.clear();
            let is_sampled = |row: usize| samples[row][0].is_finite();
            let read = |row| if is_sampled(row) { (watch.read)(dynamics, row) } else { f64::INFINITY };
            there.extend((0..samples.len()).map(read));
            read_at = limit;
        }
        let limit = limit.map(|offset| (offset - part.from, there[row]));
        let fall = first_fall_before(values, part.span(), limit, |offset| {
            (watch.place_for)(dynamics, row, part.from + offset);
            (watch.read)(dynamics, row)
        });
        let fall = fall.map(|offset| part.from + offset);
        let Some(offset) = fall.filter(|&offset| earliest.is_after(offset)) else { continue };
        (watch.place_for)(dynamics, row, offset);
        earliest.offer((watch.genuine)(dynamics, row, offset), (watch.end)(row));
    }
    dynamics.stage.take_back_there(there);
}

/// Offset [s] at which a contact that is touched without force sinks on its features, although it was first seen to
/// sink beyond them: if it is turned away it may be turned back, and then sinks at once. A contact that has gone
/// round its body by then, and lies behind its features, does not count.
fn first_sinking_within(dynamics: &mut Dynamics<'_>, row: usize) -> Option<f64> {
    let span = dynamics.group.span();
    let mut read = |offset: f64| {
        dynamics.put_idle_at(row, offset);
        height(dynamics, row).max(-idle_way(dynamics, row))
    };
    let values = std::array::from_fn(|index| read(node(index, span)));
    let fall = first_fall_before(&values, span, None, read)?;
    dynamics.put_idle_at(row, fall);
    let mechanism = &dynamics.physics.mechanism;
    let gap = mechanism.gap(&dynamics.group.idle()[row], dynamics.stage.movings());
    (gap > -mechanism.tolerances.distance_tol()).then_some(fall)
}

/// Distance [m] of a row from running off its features, infinite for one that cannot.
pub(crate) fn way_to_end(dynamics: &Dynamics<'_>, row: usize) -> f64 {
    dynamics
        .physics
        .mechanism
        .way_to_end(&dynamics.group.rows()[row], dynamics.stage.movings())
        .unwrap_or(f64::INFINITY)
}

/// Height [m] of a contact that is touched without force above its least gap.
pub(crate) fn height(dynamics: &Dynamics<'_>, row: usize) -> f64 {
    let row = &dynamics.group.idle()[row];
    dynamics.physics.mechanism.gap(row, dynamics.stage.movings()) - row.gap
}

/// True if a contact that is touched without force lies within its features.
pub(crate) fn is_within(dynamics: &Dynamics<'_>, row: usize) -> bool {
    idle_way(dynamics, row) >= 0.0
}

/// Distance [m] of a contact that is touched without force from running off its features, infinite if it cannot.
fn idle_way(dynamics: &Dynamics<'_>, row: usize) -> f64 {
    let row = &dynamics.group.idle()[row];
    dynamics.physics.mechanism.way_to_end(row, dynamics.stage.movings()).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::find_event;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::group::state::SegmentEnd;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    #[test]
    fn a_contact_below_its_least_gap_by_rounding_is_seen_to_sink_farther() {
        // Rounding [m] of gaps.
        let rounding: f64 = 1e-17;
        for below in [0.0, rounding, 0.5e-9] {
            // A disc that falls, its contact with the floor touched without force.
            let mut rooms = resting_discs(&[0.0]);
            let sink = rooms.assembly.settings().tolerances.sink();
            let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
            group.make_idle();
            group.idle_mut()[0].gap += below - sink;
            group.state_mut()[1] -= sink;
            group.forces_mut().into_iter().for_each(Vec::clear);
            group.find_sides();
            group.set_next_step(Some(1e-3));
            group.forget_structure();
            with_group(
                &rooms.assembly,
                &rooms.connectors,
                &mut rooms.groups,
                &mut group,
                |dynamics, tools| {
                    dynamics.set_out();
                    dynamics.extend(tools).expect("it falls");
                    dynamics.make_dense(tools.stepper);
                    find_event(dynamics);
                },
            );
            let Some((offset, SegmentEnd::Sink(0))) = group.event() else {
                panic!("{below} m below: {:?}", group.event())
            };
            let way = 0.5 * 9.81 * offset * offset;
            assert!(way < 1.01 * sink, "{below} m below: sinks by {way} m of {sink} m");
        }
    }
}
