//! Early ends of a group's segment that no active row shows: a stop that closes, a force law that changes branch.

use crate::ode::Spread;
use crate::rigid::connectors::store::Stop;
use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::NODES;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::shares::HALVINGS;
use crate::rigid::watch::crossing::{between_nodes, first_fall, node};
use crate::rigid::watch::earliest::Earliest;
use halfgap_collision::{ConnectorKind, Coordinate};

/// Factor by which the search for a stop that is touched is shortened, until its point is off it at the first node.
const SHORTER: f64 = 0.25;
/// Largest number of times that the wait after a change of sign is doubled until it shows: slow changes show late.
const MOST_TICKS: usize = 16;
/// Times after the end of a segment at which a change of sign is looked for, in ticks of the clock. The last is longer than
/// the shortest step.
const TICKS_AFTER_END: [f64; 4] = [128.0, 512.0, 2048.0, 8192.0];
/// Part of a segment's length by which its dense output may be read beyond its end; also after which the sign of a
/// switching function is read on the first segment of a group.
const LOOK_AHEAD: f64 = 1.0 / 1024.0;

/// Offset [s] at which an inactive stop closes. A stop from which its point has just set out is touched at
/// the start: the search then covers so short a part of the segment that the point is off the stop. On a closed
/// rail a point that has gone by a stop seems to have come round: laps are told apart by the value read before.
pub(crate) fn find_stop(dynamics: &mut Dynamics<'_>, stop: Stop) -> Option<f64> {
    if stays_off(dynamics, stop) {
        return None;
    }
    let lap = lap_of(dynamics, stop);
    let mut reach = dynamics.group.span();
    for _ in 0..HALVINGS {
        let mut values = sample_stop(dynamics, stop, reach, lap);
        let touches = values[0] <= 0.0;
        values[0] = values[0].max(0.0);
        if !touches || values[1] >= 0.0 {
            return first_fall(&values, reach, |offset| {
                in_lap(stop_at(dynamics, stop, offset), between_nodes(&values, reach, offset), lap)
            });
        }
        reach *= SHORTER;
    }
    Some(reach)
}

/// True for the limit of an angle that is farther off than its bodies turn along the segment.
fn stays_off(dynamics: &mut Dynamics<'_>, stop: Stop) -> bool {
    let connector = &dynamics.physics.mechanism.connectors[stop.id.index()];
    let ConnectorKind::Limit { coordinate: Coordinate::Angle { a, b, lever }, .. } = connector.kind else {
        return false;
    };
    let turns = [a, b].map(|body| match dynamics.group.bodies().binary_search(&body) {
        Ok(place) => {
            let angle = &dynamics.group.paths()[place][2];
            let Spread { center, radius } = angle.value_spread();
            radius + (center - angle.value_at(0.0)).abs()
        }
        Err(_) => {
            let trajectory = dynamics.physics.mechanism.trajectories.get(body.index());
            if trajectory.is_some_and(|trajectory| trajectory.moved().is_some()) {
                f64::INFINITY
            } else {
                0.0
            }
        }
    });
    stop_at(dynamics, stop, 0.0) > lever * (turns[0] + turns[1])
}

/// Offset [s] at which the point of a stop on a closed rail passes it from behind, where it does not hold the
/// point: from then on it does.
pub(crate) fn find_passing(dynamics: &mut Dynamics<'_>, stop: Stop) -> Option<f64> {
    let (lap, span) = (lap_of(dynamics, stop)?, dynamics.group.span());
    let values = sample_stop(dynamics, stop, span, Some(lap));
    let room = |value: f64| lap + stop.slack - value;
    first_fall(&values.map(room), span, |offset| {
        room(in_lap(stop_at(dynamics, stop, offset), between_nodes(&values, span, offset), Some(lap)))
    })
}

/// Length [m] of the rail of a stop; `None` if it is not closed.
fn lap_of(dynamics: &Dynamics<'_>, stop: Stop) -> Option<f64> {
    let path = dynamics.physics.mechanism.connectors[stop.id.index()].path();
    path.filter(|path| path.is_closed()).map(|path| path.length())
}

/// Gaps of a stop [m], raised by its slack, at the nodes of a part of the segment [s].
fn sample_stop(dynamics: &mut Dynamics<'_>, stop: Stop, reach: f64, lap: Option<f64>) -> [f64; NODES] {
    let mut values = [0.0; NODES];
    for index in 0..NODES {
        let before = values[index.saturating_sub(1)];
        let value = stop_at(dynamics, stop, node(index, reach));
        values[index] = if index == 0 { value } else { in_lap(value, before, lap) };
    }
    values
}

/// Gap of a stop [m], raised by its slack, at an offset [s].
fn stop_at(dynamics: &mut Dynamics<'_>, stop: Stop, offset: f64) -> f64 {
    dynamics.place_at(offset);
    let mechanism = &dynamics.physics.mechanism;
    let bodies = mechanism.connectors[stop.id.index()].bodies();
    let sides = bodies.map(|body| moving_of(dynamics.stage.movings(), body));
    mechanism.measure_connector((stop.id, 0), sides, None, stop.hint.as_ref()).gap + stop.slack
}

fn switch_at(dynamics: &mut Dynamics<'_>, law: usize, index: usize, offset: f64) -> f64 {
    dynamics.place_at(offset);
    let now = dynamics.physics.snapshot(dynamics.start.seconds() + offset, dynamics.stage.movings());
    dynamics.physics.force_laws[law].switch(index, &now)
}

/// Offset [s] of the first change of sign of a switching function.
pub(crate) fn find_switch(dynamics: &mut Dynamics<'_>, law: usize, index: usize) -> Option<f64> {
    let (span, sign_at, sign) = (dynamics.group.span(), sign_at(dynamics), sign_before(dynamics, law, index));
    let values = std::array::from_fn(|node_index| {
        let value = sign * switch_at(dynamics, law, index, node(node_index, span));
        if node_index == 0 { value.max(0.0) } else { value }
    });
    let offset = first_fall(&values, span, |offset| {
        let value = sign * switch_at(dynamics, law, index, offset);
        if offset <= sign_at { value.max(0.0) } else { value }
    })?;
    Some(beyond_switch(dynamics, (law, index), sign, offset))
}

/// Offset [s] just after the first kink of a force law or drive within so many seconds of the start of the segment.
pub(crate) fn find_kink(dynamics: &Dynamics<'_>, reach: f64) -> Option<f64> {
    let start = dynamics.start.seconds();
    let offset = dynamics.group.next_kink(&dynamics.physics, start)? - start;
    // The clock resolves a tick; sums of clock times and offsets are rounded once more.
    (offset <= reach).then(|| offset + dynamics.clock_ticks(2.0))
}

/// Offset [s] of the first change of sign of a switching function just after the end of the segment: so soon that the
/// next step would have to go over it, however short. Dense output reaches that far beyond its end.
pub(crate) fn find_switch_at_end(dynamics: &mut Dynamics<'_>) -> Option<f64> {
    let mut earliest = Earliest::default();
    let span = dynamics.group.span();
    let last = TICKS_AFTER_END[TICKS_AFTER_END.len() - 1] * dynamics.clock_ticks(1.0);
    earliest.offer(find_kink(dynamics, span + last.min(LOOK_AHEAD * span)), SegmentEnd::Switch);
    for place in 0..dynamics.group.force_laws().len() {
        let law = dynamics.group.force_laws()[place];
        for index in 0..dynamics.physics.force_laws[law].switches() {
            earliest.offer(find_change_at_end(dynamics, law, index), SegmentEnd::Switch);
        }
    }
    earliest.limit()
}

/// Offset [s] just after the end of the segment at which one switching function has changed its sign.
fn find_change_at_end(dynamics: &mut Dynamics<'_>, law: usize, index: usize) -> Option<f64> {
    let (span, tick, sign) =
        (dynamics.group.span(), dynamics.clock_ticks(1.0), sign_before(dynamics, law, index));
    let offsets = TICKS_AFTER_END.map(|ticks| span + (ticks * tick).min(LOOK_AHEAD * span));
    let is_changed =
        |dynamics: &mut Dynamics<'_>, offset| sign * switch_at(dynamics, law, index, offset) < 0.0;
    let found = offsets.iter().position(|&offset| is_changed(dynamics, offset))?;
    let mut after = offsets[found];
    let mut before = if found == 0 { span } else { offsets[found - 1] };
    while after - before > 2.0 * tick {
        let middle = f64::midpoint(before, after);
        *(if is_changed(dynamics, middle) { &mut after } else { &mut before }) = middle;
    }
    // Sums of clock times and offsets are rounded once more.
    Some(after + tick)
}

/// Sign of a switching function along the segment, before it changes. As a group is made just after a change, the
/// function is zero: its sign is read a little later.
fn sign_before(dynamics: &mut Dynamics<'_>, law: usize, index: usize) -> f64 {
    let offset = sign_at(dynamics);
    switch_at(dynamics, law, index, offset).signum()
}

/// Offset [s] at which the signs of switching functions are read.
fn sign_at(dynamics: &Dynamics<'_>) -> f64 {
    let group = &*dynamics.group;
    let (span, start, made) = (group.span(), group.start(), group.made());
    if start == made { span * LOOK_AHEAD } else { 0.0 }
}

/// First offset [s] that the clock resolves after a switching function has changed its sign from the given one,
/// near where it does. Where the function is zero the law may take either branch, and a segment that starts there
/// must be on the one that the law goes on with.
fn beyond_switch(dynamics: &mut Dynamics<'_>, (law, index): (usize, usize), sign: f64, offset: f64) -> f64 {
    // Sums of clock times and offsets are rounded once more.
    let tick = dynamics.clock_ticks(1.0);
    let mut wait = tick;
    for _ in 0..MOST_TICKS {
        if offset + wait + tick >= dynamics.group.span() {
            break;
        }
        if sign * switch_at(dynamics, law, index, offset + wait) < 0.0 {
            return offset + wait + tick;
        }
        wait *= 2.0;
    }
    offset
}

/// Distance [m] along a closed path, known up to laps: the one nearest to another.
fn in_lap(value: f64, near: f64, lap: Option<f64>) -> f64 {
    lap.map_or(value, |lap| value + lap * ((near - value) / lap).round())
}

#[cfg(test)]
mod tests {
    use super::find_switch;
    use crate::rigid::bodies::force_law::{ForceLaw, Snapshot, Wrenches};
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::test_scene::{FINE, rooms_of};
    use crate::rigid::watch::switches::LOOK_AHEAD;
    use crate::time::Time;
    use halfgap_collision::{Body, BodyId, BodyState};
    use halfgap_geometry::Shape;
    use std::sync::Arc;

    /// A law without force that changes branch at a time [s].
    #[derive(Debug)]
    struct Clock {
        rings: f64,
        bodies: [BodyId; 1],
    }

    impl ForceLaw for Clock {
        fn name(&self) -> &str {
            "clock"
        }

        fn bodies(&self) -> &[BodyId] {
            &self.bodies
        }

        fn apply(&self, _now: &Snapshot<'_>, _wrenches: &mut Wrenches<'_>) {}

        fn switches(&self) -> usize {
            1
        }

        fn switch(&self, _index: usize, now: &Snapshot<'_>) -> f64 {
            now.time - self.rings
        }
    }

    /// Offset [s] at which a clock rings that is set to a delay [s] after the start of a segment, which is the first of
    /// its group or not.
    fn rings_at(delay: f64, is_first: bool) -> Option<f64> {
        let later = Time::from_seconds(1.0);
        let body = BodyId(0);
        let shape = Shape::disc(0.5).expect("a fine radius");
        let disc = Body { shape, inverse_mass: 1.0, inverse_moment: 8.0, elasticity: 0.0 };
        let disc = BodyPart::new(disc, FreeMotion::default(), BodyState::default());
        let clock = Clock { rings: later.seconds() + delay, bodies: [body] };
        let parts =
            RigidParts { bodies: vec![disc], force_laws: vec![Arc::new(clock)], ..RigidParts::default() };
        let mut rooms = rooms_of(parts, FINE, Time::ZERO);
        let mut group = rooms.groups.take(body).expect("the law makes a group");
        group.set_times(later, if is_first { later } else { Time::ZERO });
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, _| {
            dynamics.group.set_span(1.0);
            find_switch(dynamics, 0, 0)
        })
    }

    #[test]
    fn a_law_that_changes_branch_just_after_a_step_has_begun_is_seen_to() {
        for delay in [1e-9, 1e-6, 0.5 * LOOK_AHEAD, 0.3] {
            let offset = rings_at(delay, false).expect("it rings");
            assert!((offset - delay).abs() < 1e-12, "{offset}");
        }
        let value = |offset: f64| (1.0 + offset) - (1.0 + 0.3);
        let offset = rings_at(0.3, false).expect("it rings");
        assert!(value(offset) > 0.0, "what sets out there is on the new branch: {offset}");
        // Where a group is made because its law has just changed branch, rounding may say that the law is about to.
        assert_eq!(rings_at(1e-15, true), None);
    }
}
