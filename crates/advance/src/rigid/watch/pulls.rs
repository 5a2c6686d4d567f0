//! Motors that come to their speed, and joints with dry friction that come to rest, within a group's segment.

use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::samples::NODES;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::watch::crossing::{Part, node};
use crate::rigid::watch::earliest::Earliest;
use crate::rigid::watch::early_ends::{Watch, fill, find_first};

/// Watch for rates that come to what they are pulled to.
const PULLS: Watch = Watch {
    place: |dynamics, offset| dynamics.place_at(offset),
    place_for: |dynamics, _, offset| dynamics.place_at(offset),
    read: |dynamics, pull| rate_at(dynamics, pull),
    genuine: |_, _, offset| Some(offset),
    end: SegmentEnd::PullStop,
};

/// Offers the first pull that has done its work. One that sets out has no rate yet.
pub(super) fn find_pull_stop(dynamics: &mut Dynamics<'_>, earliest: &mut Earliest) {
    if dynamics.group.pulls().is_empty() {
        return;
    }
    let mut samples = dynamics.stage.lend_force_samples();
    fill(&mut samples, dynamics.group.pulls().len());
    let all = Part::all(dynamics.group.span());
    for index in 0..NODES {
        dynamics.place_at(node(index, all.to));
        for (pull, sample) in samples.iter_mut().enumerate() {
            let rate = rate_at(dynamics, pull);
            sample[index] = if index == 0 { rate.max(0.0) } else { rate };
        }
    }
    find_first(dynamics, earliest, (&samples, all), &PULLS);
    dynamics.stage.take_back_force_samples(samples);
}

/// Rate [m/s] that is left for a pull to take, with the bodies in place.
fn rate_at(dynamics: &Dynamics<'_>, pull: usize) -> f64 {
    let pull = &dynamics.group.pulls()[pull];
    let movings = pull.bodies.map(|body| moving_of(dynamics.stage.movings(), body));
    let rate = dynamics.physics.mechanism.pull_kinematics(pull.id, movings).rate - pull.left;
    if pull.force > 0.0 { -rate } else { rate }
}
