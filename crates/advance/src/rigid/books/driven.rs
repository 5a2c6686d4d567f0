//! The states of driven bodies, for callers: on the rows of their drives, of which dense output is off by its error.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::groups::Groups;
use crate::rigid::group::physics::physics;
use crate::rigid::group::stage::body_state;
use crate::time::Time;
use halfgap_collision::{BodyId, BodyState};

/// Writes the states, at a time within the present segments, of all bodies that step together with one that a drive
/// moves, in ascending order of bodies. Allocates if there are any.
pub(crate) fn write_driven_states(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &Groups,
    time: Time,
    states: &mut Vec<(BodyId, BodyState)>,
) {
    states.clear();
    for group in groups.by_leader().iter().flatten().filter(|group| group.drive(connectors).is_some()) {
        let (start, mut group, mut stage) = (group.start(), group.clone(), groups.stage().clone());
        let physics = physics(assembly, connectors);
        let mut dynamics = Dynamics { physics, group: &mut group, stage: &mut stage, start };
        let on_rows = dynamics.state_on_rows(time.since(start)).to_vec();
        states.extend(group.bodies().iter().enumerate().map(|(place, &body)| {
            let state = body_state(&on_rows, group.bodies().len(), place);
            let angle = assembly.trajectory(body).with_turns(state.angle);
            (body, BodyState { angle, ..state })
        }));
    }
    states.sort_unstable_by_key(|&(body, _)| body);
}
