//! Early ends of a group's segment: a contact runs off its features or, touched without force, sinks; contact forces that
//! fall to zero are in `releases`, stops that close and force laws that change branch in `switches`.
//!
//! Each is a function along the dense output whose first fall below zero is an event. Functions of positions are read
//! at once, forces only when the time comes up to which none can vanish.

use crate::ode::Ode;
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::group::{Group, SegmentEnd};
use crate::rigid::group::samples::{EARLY, NODES, Samples};
use crate::rigid::settings::StepControl;
use crate::rigid::watch::crossing::{
    Part, early_fall, early_node, fall_after_rise, first_fall, first_fall_before, node,
};
use crate::rigid::watch::earliest::Earliest;

/// Change of the gap of a contact without force, as a fraction of the distance by which it may sink, up to which it
/// stays where it is.
const STILL_SHARE: f64 = 1e-3;

/// Error of a held contact's gap within a step that is allowed, as a fraction of the accuracy.
const INNER_SHARE: f64 = 0.5;
/// Error of a connector within a step that is allowed, as a multiple of the error of a step: dense output errs some
/// tens of times more than the ends of steps, and much more where connectors determine angles poorly.
const INNER_ERRORS: f64 = 50.0;
/// Place in a step, as a fraction of it, at which the errors of connectors are read.
const MIDDLE: f64 = 0.5;
/// Places in a step at which the errors of contacts are read: since errors often change sign in the middle, two more.
const INNER: [f64; 3] = [MIDDLE, 0.3, 0.7];

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
    read: |dynamics, row| dynamics.way_to_end(row),
    genuine: |_, _, offset| Some(offset),
    end: SegmentEnd::Change,
};
/// Contacts touched without force that sink.
const SINKINGS: Watch = Watch {
    place: |dynamics, offset| dynamics.put_watched_at(offset),
    place_for: |dynamics, row, offset| dynamics.put_idle_at(row, offset),
    read: |dynamics, row| dynamics.height(row),
    // A contact that sinks beyond the ends of its features, or leans over, has neighbours that end the segment.
    genuine: |dynamics, row, offset| {
        if dynamics.is_within(row) { Some(offset) } else { dynamics.first_sinking_within(row) }
    },
    end: SegmentEnd::Sink,
};

/// Makes room for a number of rows.
pub(super) fn fill(list: &mut Vec<[f64; NODES]>, rows: usize) {
    list.clear();
    list.resize(rows, [0.0; NODES]);
}

impl Dynamics<'_> {
    /// Finds the event that ends the segment early; its dense output and end forces must be known. Whether a contact
    /// loses its force takes an evaluation for every offset tried, so that waits until the time up to which none can:
    /// mostly another event has come by then.
    pub(crate) fn find_event(&mut self) {
        self.group.event = self.find_geometric_event();
        let firm = self.firm_part().map(|part| part * self.group.span);
        let earlier = |offset: &f64| self.group.event.is_none_or(|(event, _)| *offset < event);
        self.group.look = firm.filter(earlier);
        if self.group.look == Some(0.0) {
            self.look_for_release();
        }
    }

    /// Earliest event that is found without the forces of contacts.
    fn find_geometric_event(&mut self) -> Option<(f64, SegmentEnd)> {
        let mut earliest = Earliest::default();
        let mut samples = self.sample_rows();
        self.lower_sunk(&mut samples);
        if !self.are_still(&samples.heights) {
            self.group.steady_step = None;
        }
        self.find_early_sinking(&mut earliest, &samples);
        self.find_early_change(&mut earliest, &samples.rooms);
        let all = Part::all(self.group.span);
        self.find_first(&mut earliest, (&samples.rooms, all), &CHANGES);
        let margin = self.physics.mechanism.change_margin();
        let mut overrun = std::mem::take(&mut self.group.overrun);
        self.find_overdue(&mut earliest, (&samples.rooms, all, &mut overrun), &CHANGES, |_, _| margin);
        self.group.overrun = overrun;
        self.find_earlier_ends(&mut earliest, &samples.rooms);
        self.find_first(&mut earliest, (&samples.heights, all), &SINKINGS);
        self.stage.samples = samples;
        for place in 0..self.group.stops.len() {
            let stop = self.group.stops[place];
            earliest.offer(self.find_stop(stop), SegmentEnd::Stop(stop.id));
            earliest.offer(self.find_passing(stop), SegmentEnd::Switch);
        }
        for place in 0..self.group.laws.len() {
            let law = self.group.laws[place];
            for index in 0..self.physics.laws[law].switches() {
                earliest.offer(self.find_switch(law, index), SegmentEnd::Switch);
            }
        }
        earliest.found
    }

    /// True if contacts that are touched without force neither closed nor opened along the segment.
    fn are_still(&self, heights: &[[f64; NODES]]) -> bool {
        let still = STILL_SHARE * self.physics.mechanism.tolerances.sink();
        heights.iter().all(|sample| sample.iter().all(|height| (height - sample[0]).abs() <= still))
    }

    /// Largest error of held rows between the ends of the segment, where dense output is less exact, as a multiple of
    /// the allowed one: for contacts such that nothing overlaps and none is missed, for connectors by the error that
    /// steps may make. Notes the largest error of a connector and the least gap of a contact.
    pub(crate) fn inner_excess(&mut self, accuracy: f64, steps: &StepControl) -> f64 {
        (self.group.largest_error, self.group.least_gap) = (0.0, None);
        let (least, most) = (INNER_SHARE * accuracy, INNER_ERRORS * steps.local_error * steps.length);
        let mut excess = 0.0f64;
        if self.group.rows.is_empty() {
            return excess;
        }
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        for &part in if any_contact { &INNER[..] } else { &INNER[..1] } {
            self.put_at(part * self.group.span);
            for row in self.group.rows.iter().filter(|row| matches!(row.source, RowSource::Contact(_))) {
                let gap = self.physics.mechanism.gap(row, &self.stage.movings);
                excess = excess.max((gap - row.gap).abs() / least);
                self.group.least_gap = Some(self.group.least_gap.map_or(gap, |least| least.min(gap)));
            }
            self.group.largest_error = self.group.largest_error.max(self.connector_error());
        }
        excess.max(self.group.largest_error / most.max(least))
    }

    /// Evaluates the forces of the rows at an offset [s] of the segment, and leaves them in the stage.
    pub(crate) fn evaluate_at(&mut self, offset: f64) {
        self.find_state_at(offset);
        let trial = std::mem::take(&mut self.stage.trial);
        let mut rates = std::mem::take(&mut self.stage.trial_rates);
        rates.resize(trial.len(), 0.0);
        if self.group.tree.is_used() {
            self.find_rates(offset, &trial, &mut rates, Self::hang_and_tell);
        } else {
            let Ok(()) = self.derivative(offset, &trial, &mut rates);
        }
        (self.stage.trial, self.stage.trial_rates) = (trial, rates);
    }

    /// Samples at the nodes the functions of the rows that need no forces.
    fn sample_rows(&mut self) -> Samples {
        let mut samples = std::mem::take(&mut self.stage.samples);
        let Samples { rooms, heights, early, .. } = &mut samples;
        self.find_who_may_leave(rooms);
        self.watch_rows(|row| rooms.get(row).is_some_and(|sample| sample[0].is_finite()));
        fill(heights, self.group.idle.len());
        early.clear();
        early.resize(heights.len(), [0.0; EARLY]);
        for index in 0..if rooms.is_empty() && heights.is_empty() { 0 } else { NODES } {
            self.put_watched_at(node(index, self.group.span));
            for (row, sample) in rooms.iter_mut().enumerate().filter(|(_, sample)| sample[0].is_finite()) {
                sample[index] = self.way_to_end(row);
            }
            for (row, sample) in heights.iter_mut().enumerate() {
                sample[index] = self.height(row);
            }
        }
        for index in 0..if early.is_empty() { 0 } else { EARLY } {
            self.put_watched_at(early_node(index, self.group.span));
            for (row, sample) in early.iter_mut().enumerate() {
                sample[index] = self.height(row);
            }
        }
        samples
    }

    /// Lowers the least gap of a contact without force that is below it by rounding as the segment starts, and corrects
    /// its samples: it would not be seen to sink any more.
    fn lower_sunk(&mut self, samples: &mut Samples) {
        let Samples { heights, early, .. } = samples;
        for (row, (heights, early)) in heights.iter_mut().zip(early).enumerate() {
            if heights[0] >= 0.0 {
                continue;
            }
            self.put_idle_at(row, 0.0);
            if self.is_within(row) {
                let way = self.physics.mechanism.tolerances.sink() - heights[0];
                self.group.idle[row].gap -= way;
                heights.iter_mut().chain(early).for_each(|height| *height += way);
            }
        }
    }

    /// Makes room for samples of how far rows are from running off their features: for none, if bounds tell that all of
    /// them stay; else the samples of rows that stay are infinite.
    fn find_who_may_leave(&mut self, rooms: &mut Vec<[f64; NODES]>) {
        rooms.clear();
        let mechanism = &self.physics.mechanism;
        if !self.group.rows.iter().any(|row| mechanism.can_change(row)) {
            return;
        }
        self.find_bounds();
        self.place_at(MIDDLE * self.group.span);
        rooms.extend((0..self.group.rows.len()).map(|row| {
            let sample = if self.stays(row) { f64::INFINITY } else { 0.0 };
            [sample; NODES]
        }));
        if rooms.iter().all(|sample| sample[0].is_infinite()) {
            rooms.clear();
        }
    }

    /// Offers the earliest contact that sinks before the first node.
    fn find_early_sinking(&mut self, earliest: &mut Earliest, samples: &Samples) {
        for (row, (early, heights)) in samples.early.iter().zip(&samples.heights).enumerate() {
            let fall = early_fall(heights[0], early, self.group.span, |offset| {
                self.put_idle_at(row, offset);
                self.height(row)
            });
            let Some(offset) = fall.filter(|&offset| earliest.is_after(offset)) else { continue };
            self.put_idle_at(row, offset);
            if self.is_within(row) {
                earliest.offer(Some(offset), SegmentEnd::Sink(row));
            }
        }
    }

    /// Offers the earliest contact that comes onto its features and runs off again before the first node: one that has
    /// just taken over from its neighbour starts at the end of its features, or beyond by rounding.
    fn find_early_change(&mut self, earliest: &mut Earliest, rooms: &[[f64; NODES]]) {
        for (row, values) in rooms.iter().enumerate() {
            let fall = fall_after_rise(values, self.group.span, |offset| {
                self.put_row_at(row, offset);
                self.way_to_end(row)
            });
            earliest.offer(fall, SegmentEnd::Change(row));
        }
    }

    /// Offers ends of rails' pieces that were passed for a moment before those that were found. A long step may hold
    /// the way up and down a piece and far beyond: it is searched again up to the end that was found, as often as that
    /// is earlier; and from its start on, where by rounding that lies before the piece.
    fn find_earlier_ends(&mut self, earliest: &mut Earliest, rooms: &[[f64; NODES]]) {
        for (row, rooms) in rooms.iter().enumerate() {
            let is_rail = matches!(self.group.rows[row].source, RowSource::Connector(..));
            for _ in 0..MOST_ZOOMS {
                let is_own = earliest.found.is_some_and(|(_, end)| end == SegmentEnd::Change(row));
                if !is_rail || rooms[0].is_infinite() || !(is_own || rooms[0] < 0.0) {
                    break;
                }
                let limit = earliest.limit().unwrap_or(self.group.span);
                // Neither the rounding of a place at the end of a piece nor the place from which the point sets out
                // counts as beyond.
                let margin = 2.0 * self.physics.mechanism.change_margin().max(-rooms[0]);
                let mut room_at = |offset: f64| {
                    self.put_row_at(row, offset);
                    self.way_to_end(row) + margin
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
        &mut self,
        earliest: &mut Earliest,
        (samples, part): (&[[f64; NODES]], Part),
        watch: &Watch,
    ) {
        if samples.is_empty() {
            return;
        }
        let mut there = std::mem::take(&mut self.stage.there);
        let mut read_at = None;
        for (row, values) in samples.iter().enumerate() {
            let limit = earliest.limit();
            if limit != read_at
                && let Some(offset) = limit
            {
                (watch.place)(self, offset);
                there.clear();
                let is_sampled = |row: usize| samples[row][0].is_finite();
                let read = |row| if is_sampled(row) { (watch.read)(self, row) } else { f64::INFINITY };
                there.extend((0..samples.len()).map(read));
                read_at = limit;
            }
            let limit = limit.map(|offset| (offset - part.from, there[row]));
            let fall = first_fall_before(values, part.span(), limit, |offset| {
                (watch.place_for)(self, row, part.from + offset);
                (watch.read)(self, row)
            });
            let fall = fall.map(|offset| part.from + offset);
            let Some(offset) = fall.filter(|&offset| earliest.is_after(offset)) else { continue };
            (watch.place_for)(self, row, offset);
            earliest.offer((watch.genuine)(self, row, offset), (watch.end)(row));
        }
        self.stage.there = there;
    }

    /// Offset [s] at which a contact that is touched without force sinks on its features, although it was first seen to
    /// sink beyond them: if it is turned away it may be turned back, and then sinks at once. A contact that has gone
    /// round its body by then, and lies behind its features, does not count.
    fn first_sinking_within(&mut self, row: usize) -> Option<f64> {
        let span = self.group.span;
        let mut read = |offset: f64| {
            self.put_idle_at(row, offset);
            self.height(row).max(-self.idle_way(row))
        };
        let values = std::array::from_fn(|index| read(node(index, span)));
        let fall = first_fall_before(&values, span, None, read)?;
        self.put_idle_at(row, fall);
        let mechanism = &self.physics.mechanism;
        let gap = mechanism.gap(&self.group.idle[row], &self.stage.movings);
        (gap > -mechanism.tolerances.distance_tol()).then_some(fall)
    }

    /// Distance [m] of a row from running off its features, infinite for one that cannot.
    pub(crate) fn way_to_end(&self, row: usize) -> f64 {
        self.physics.mechanism.way_to_end(&self.group.rows[row], &self.stage.movings).unwrap_or(f64::INFINITY)
    }

    /// Height [m] of a contact that is touched without force above its least gap.
    fn height(&self, row: usize) -> f64 {
        let row = &self.group.idle[row];
        self.physics.mechanism.gap(row, &self.stage.movings) - row.gap
    }

    /// Lowers the least gaps of contacts that are touched without force to where the end of the segment has them: the
    /// projection onto the held rows may have moved their bodies, and a contact that starts below its least gap is not
    /// seen to sink.
    pub(crate) fn lower_idle(&mut self) {
        let Group { bodies, end_state, idle, .. } = &mut *self.group;
        if idle.is_empty() {
            return;
        }
        self.stage.load(bodies, end_state);
        let mechanism = &self.physics.mechanism;
        for row in idle {
            let gap = mechanism.gap(row, &self.stage.movings);
            row.gap = row.gap.min(gap - mechanism.tolerances.sink());
        }
    }

    /// Sets the held gaps of contacts to their present ones if lifting some has not brought them to their gaps: where
    /// rows contradict each other, each step would be thrown off anew.
    pub(crate) fn leave_lifted(&mut self) {
        let Group { bodies, end_state, rows, .. } = &mut *self.group;
        if !rows.iter().any(|row| row.is_lifted) {
            return;
        }
        self.stage.load(bodies, end_state);
        let mechanism = &self.physics.mechanism;
        for row in rows.iter_mut().filter(|row| !row.bilateral) {
            let gap = mechanism.gap(row, &self.stage.movings);
            if (gap - row.gap).abs() > mechanism.tolerances.sink() {
                row.gap = gap;
            }
        }
    }

    /// True if a contact that is touched without force lies within its features.
    fn is_within(&self, row: usize) -> bool {
        self.idle_way(row) >= 0.0
    }

    /// Distance [m] of a contact that is touched without force from running off its features, infinite if it cannot.
    fn idle_way(&self, row: usize) -> f64 {
        let row = &self.group.idle[row];
        self.physics.mechanism.way_to_end(row, &self.stage.movings).unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use crate::rigid::group::group::SegmentEnd;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    #[test]
    fn a_contact_below_its_least_gap_by_rounding_is_seen_to_sink_farther() {
        /// Rounding [m] of gaps.
        const ROUNDING: f64 = 1e-17;
        for below in [0.0, ROUNDING, 0.5e-9] {
            // A disc that falls, its contact with the floor touched without force.
            let mut rooms = resting_discs(&[0.0]);
            let sink = rooms.assembly.settings.tolerances.sink();
            let mut group = rooms.groups.take(BodyId(1)).expect("it is held");
            group.idle = std::mem::take(&mut group.rows);
            group.idle[0].gap += below - sink;
            group.state[1] -= sink;
            (group.forces, group.end_forces) = (Vec::new(), Vec::new());
            group.find_sides();
            group.next_step = Some(1e-3);
            group.held.set_structure(&[], &group.sides);
            with_group(
                &rooms.assembly,
                &rooms.connectors,
                &mut rooms.groups,
                &mut group,
                |dynamics, tools| {
                    dynamics.set_out();
                    dynamics.extend(tools).expect("it falls");
                    dynamics.make_dense(tools.stepper);
                    dynamics.find_event();
                },
            );
            let Some((offset, SegmentEnd::Sink(0))) = group.event else {
                panic!("{below} m below: {:?}", group.event)
            };
            let way = 0.5 * 9.81 * offset * offset;
            assert!(way < 1.01 * sink, "{below} m below: sinks by {way} m of {sink} m");
        }
    }
}
