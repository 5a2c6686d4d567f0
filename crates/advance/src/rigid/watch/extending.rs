//! A group's next segment, with the event that ends it early.

use crate::rigid::group::attempt::StepFailure;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::group::tools::Tools;
use crate::rigid::shares::{ROUNDINGS, ROUNDS};
use crate::rigid::watch::early_ends::find_event;
use crate::rigid::watch::switches::{find_kink, find_switch_at_end};

/// Extends the group by a step, and finds the event that ends it early.
pub(crate) fn extend_watched(dynamics: &mut Dynamics<'_>, tools: &mut Tools<'_>) -> Result<(), StepFailure> {
    if !dynamics.group.is_unwatched() {
        let proposed = dynamics.group.next_step();
        let is_limited = end_before_kink(dynamics);
        let told = dynamics.extend_on_rows(tools)?;
        dynamics.note_stiffness(tools, told);
        if is_limited {
            go_on_as(dynamics, proposed);
        }
        find_event(dynamics);
        return end_before_switch(dynamics, tools, proposed);
    }
    let told = dynamics.extend_unwatched(tools)?;
    dynamics.note_stiffness(tools, told);
    dynamics.limit_next_step(tools.stepper.method().step_factor(0.0));
    dynamics.group.set_event(None);
    dynamics.group.set_look(None);
    // Of projected ends only rounding is left, so the gaps of the last evaluation tell.
    let is_projected = tools.settings.projection;
    let largest_error = if is_projected { dynamics.stage.gap_error() } else { dynamics.connector_error() };
    dynamics.group.set_largest_error(largest_error);
    Ok(())
}

/// Lets the next step end just before the first kink of a law or drive; true if it would have gone over it.
fn end_before_kink(dynamics: &mut Dynamics<'_>) -> bool {
    let Some(proposed) = dynamics.group.next_step() else { return false };
    let before = dynamics.clock_ticks(ROUNDINGS);
    let kink = find_kink(dynamics, proposed).filter(|kink| *kink > 2.0 * before);
    let Some(kink) = kink else { return false };
    dynamics.group.set_next_step(Some(kink - before));
    true
}

/// Lets the next step be as long as one was proposed [s] to be that then had to be shorter.
fn go_on_as(dynamics: &mut Dynamics<'_>, proposed: Option<f64>) {
    if let (Some(next), Some(proposed)) = (dynamics.group.next_step(), proposed) {
        dynamics.group.set_next_step(Some(next.max(proposed)));
    }
}

/// Makes a step over a change of a law's branch anew, so that it ends just before the change. Stages beyond it have
/// the forces of another branch: with them a step may err by any amount, unseen by its error estimate, and so may its
/// dense output, by which the change was found. The next step is then as long as this one was `proposed` [s] to be.
fn end_before_switch(
    dynamics: &mut Dynamics<'_>,
    tools: &mut Tools<'_>,
    proposed: Option<f64>,
) -> Result<(), StepFailure> {
    let start = dynamics.start.seconds();
    let never = dynamics.group.force_laws().is_empty()
        && dynamics.group.next_kink(&dynamics.physics, start).is_none();
    if never || !tools.stepper.method().is_adaptive() {
        return Ok(());
    }
    let mut before = dynamics.clock_ticks(ROUNDINGS);
    for _ in 0..ROUNDS {
        let Some((offset, SegmentEnd::Switch)) = dynamics.group.event() else { break };
        if offset <= 2.0 * before {
            break;
        }
        dynamics.group.set_next_step(Some(offset - before));
        dynamics.extend_on_rows(tools)?;
        find_event(dynamics);
        go_on_as(dynamics, proposed);
        before *= WIDER;
    }
    if dynamics.group.event().is_none() {
        let event = find_switch_at_end(dynamics).map(|offset| (offset, SegmentEnd::Switch));
        dynamics.group.set_event(event);
    }
    Ok(())
}

/// Factor by which that time grows where the change then turns out to come earlier.
const WIDER: f64 = 8.0;
