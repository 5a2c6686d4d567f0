//! Slips that come to a stop within a group's segment: the speed of a contact that slips falls to zero along the dense output. So does
//! the rate that is left for a motor, or for dry friction in a joint, to take.

use crate::rigid::contacts::friction::{Axis, Grip};
use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::NODES;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::watch::crossing::{Part, node};
use crate::rigid::watch::earliest::Earliest;
use crate::rigid::watch::early_ends::{Watch, fill, find_first};

/// Watch for slips that stop.
const SLIPS: Watch = Watch {
    place: |dynamics, offset| dynamics.place_at(offset),
    place_for: |dynamics, _, offset| dynamics.place_at(offset),
    read: |dynamics, row| slip_at(dynamics, row, Axis::Slip),
    genuine: |_, _, offset| Some(offset),
    end: |row| SegmentEnd::SlipStop(row, Axis::Slip),
};
/// Watch for bodies that stop rolling.
const TURNS: Watch = Watch {
    read: |dynamics, row| slip_at(dynamics, row, Axis::Turn),
    end: |row| SegmentEnd::SlipStop(row, Axis::Turn),
    ..SLIPS
};

/// Offers the first stop of a slip along any axis. One that sets out has no speed yet.
pub(super) fn find_slip_stop(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest) {
    find_stop_along(dynamics, earliest, Axis::Slip, &SLIPS);
    find_stop_along(dynamics, earliest, Axis::Turn, &TURNS);
}

fn find_stop_along(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest, axis: Axis, watch: &Watch) {
    if !dynamics.group.rows().iter().any(|row| row.grip(axis).slip_share().is_some()) {
        return;
    }
    let mut samples = dynamics.stage.lend_force_samples();
    fill(&mut samples, dynamics.group.rows().len());
    let all = Part::all(dynamics.group.span());
    for index in 0..NODES {
        dynamics.place_at(node(index, all.to));
        for (row, sample) in samples.iter_mut().enumerate() {
            let speed = slip_at(dynamics, row, axis);
            sample[index] = if index == 0 { speed.max(0.0) } else { speed };
        }
    }
    find_first(dynamics, earliest, (&samples, all), watch);
    dynamics.stage.take_back_force_samples(samples);
}

/// Speed [m/s] of a contact along an axis to the side to which it slips, with the bodies in place; infinite for other rows.
fn slip_at(dynamics: &Dynamics<'_>, row: usize, axis: Axis) -> f64 {
    let row = &dynamics.group.rows()[row];
    let Grip::Slips { side, left, .. } = row.grip(axis) else { return f64::INFINITY };
    let movings = row.bodies.map(|body| moving_of(dynamics.stage.movings(), body));
    side * (dynamics.physics.mechanism.slip_speed(row, axis, movings) - left)
}

/// Offers the first motor that comes to its speed, or joint with dry friction that comes to rest. One that sets out has no rate yet.
pub(super) fn find_pull_stop(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest) {
    if dynamics.group.pulls().is_empty() {
        return;
    }
    let watch = Watch { read: pull_at, end: SegmentEnd::PullStop, ..SLIPS };
    let mut samples = dynamics.stage.lend_force_samples();
    fill(&mut samples, dynamics.group.pulls().len());
    let all = Part::all(dynamics.group.span());
    for index in 0..NODES {
        dynamics.place_at(node(index, all.to));
        for (pull, sample) in samples.iter_mut().enumerate() {
            let rate = pull_at(dynamics, pull);
            sample[index] = if index == 0 { rate.max(0.0) } else { rate };
        }
    }
    find_first(dynamics, earliest, (&samples, all), &watch);
    dynamics.stage.take_back_force_samples(samples);
}

/// Rate [m/s] that is left for a pull to take, with the bodies in place; infinite for one that holds.
fn pull_at(dynamics: &Dynamics<'_>, pull: usize) -> f64 {
    let pull = &dynamics.group.pulls()[pull];
    let Some(left) = pull.left else { return f64::INFINITY };
    let movings = pull.bodies.map(|body| moving_of(dynamics.stage.movings(), body));
    let rate = dynamics.physics.mechanism.pull_kinematics(pull.id, movings).rate - left;
    if pull.force > 0.0 { -rate } else { rate }
}
