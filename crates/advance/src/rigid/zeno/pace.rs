//! Pace: the mean length of a group's steps. A group whose steps are so short that the run would take days must be
//! reported.
//!
//! Steps may be tiny for good reasons, and for a while: a light body rattles between heavy ones, two centres pass each
//! other closely. So only steps without an impact between them count, in long series, and only if the time to be
//! simulated would take a hopeless number of them. Impacts no faster than `velocity_tol` do not interrupt a series: they may
//! be of contacts that take turns.
//!
//! A group may also be hasty, making short steps because contacts that count as resting take turns: holding one stops
//! its slow opening, and another, which is moved along, pulls or closes. In a hasty group contacts that open are let
//! go, even if they open much more slowly than counts as rest elsewhere, or would come back at once in a low hop.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::error::AdvanceError;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::rigid::shares::TINY;
use crate::rigid::zeno::memory::Zeno;
use crate::rigid::zeno::steps::Pace;
use crate::rigid::zeno::turns::too_fast;
use halfgap_collision::{BodyId, BodyState};
use std::f64::consts::TAU;

/// Number of steps that no run may take: a mean length is hopeless if the total time would take more steps of it.
const HOPELESS: f64 = 1e10;
/// Number of hopeless means in succession after which the run is given up: steps may be short for a while.
const PACES: u32 = 10;

/// Notes the step that a group has begun. If its steps have become hopelessly short, the error is kept in the
/// memory, to be returned once the event is over.
pub(crate) fn note_pace(assembly: &Assembly, zeno: &mut Zeno, group: &Group) {
    let pace = &mut zeno.paces[group.leader().index()];
    if let Some(mean) = pace.few.note(group.start()) {
        pace.is_hasty = mean < TINY * assembly.settings().resolution_time;
    }
    let mean = pace.all.note(group.start());
    zeno.crawls = None;
    let Some(step) = mean else { return };
    let crawls = step * HOPELESS < zeno.duration;
    let fast = if crawls { None } else { turns_without_end(assembly, zeno, group, step) };
    let pace = &mut zeno.paces[group.leader().index()];
    pace.hopeless = if crawls || fast.is_some() { pace.hopeless + 1 } else { 0 };
    if pace.hopeless < PACES {
        return;
    }
    zeno.crawls = Some(fast.unwrap_or_else(|| AdvanceError::Crawls {
        time: group.start().seconds(),
        step,
        duration: zeno.duration,
        bodies: group.bodies().to_vec(),
        force_laws: names_of_force_laws(assembly, group),
    }));
}

/// Error of a body of a group that turns too often in the time to be simulated, and is stepped turn by turn.
fn turns_without_end(assembly: &Assembly, zeno: &Zeno, group: &Group, step: f64) -> Option<AdvanceError> {
    let elapsed = group.start().since(assembly.start());
    group.bodies().iter().enumerate().find_map(|(place, &body)| {
        let BodyState { angle, angular_velocity, .. } =
            body_state(group.state(), group.bodies().len(), place);
        // One that swings to and fro does not get anywhere; one that turns more than once in a step is not
        // followed.
        let mean = assembly.trajectory(body).with_turns(angle).abs() / elapsed;
        let is_followed = angular_velocity.abs() * step < TAU;
        let spin = mean.min(angular_velocity.abs()).copysign(angular_velocity);
        if is_followed { too_fast(zeno, body, spin, group.start()) } else { None }
    })
}

/// Names of the laws that act on a group.
pub(crate) fn names_of_force_laws(assembly: &Assembly, group: &Group) -> Vec<String> {
    group.force_laws().iter().map(|&law| assembly.force_laws().all[law].name().to_owned()).collect()
}

/// Forgets the steps of bodies that have taken part in an impact: their groups make progress.
pub(crate) fn forget_paces(zeno: &mut Zeno, bodies: &[BodyId]) {
    bodies.iter().for_each(|body| zeno.paces[body.index()] = Pace::default());
}

/// True if one of some bodies has led a hasty group; that is then forgotten.
pub(crate) fn take_haste(zeno: &mut Zeno, bodies: &[BodyId]) -> bool {
    let mut any = false;
    for body in bodies {
        any |= std::mem::take(&mut zeno.paces[body.index()].is_hasty);
    }
    any
}

#[cfg(test)]
mod tests {
    use crate::rigid::zeno::steps::{Count, STEPS};
    use crate::time::Time;

    #[test]
    fn the_mean_is_that_of_the_steps_since_it_was_last_told() {
        let mut pace = Count::<STEPS>::default();
        let mut told = Vec::new();
        for step in 0..=2 * STEPS {
            // The second half at a tenth of the pace.
            let tenths = if step < STEPS { 10 * step } else { 9 * STEPS + step };
            told.extend(pace.note(Time::from_seconds(0.1 * f64::from(tenths))));
        }
        assert!(
            matches!(told[..], [first, second] if (first - 1.0).abs() < 1e-12 && (second - 0.1).abs() < 1e-12),
            "{told:?}"
        );
    }
}
