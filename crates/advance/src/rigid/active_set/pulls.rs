//! Motors and dry friction in joints at an event: which of them act with all their force, and which hold.
//!
//! One whose rate is off acts with all its force. One at its speed has a row in the problem, bounded by a constant; where the bound is
//! reached it acts with all its force from then on. Those that act so are rows, too, whose bounds are one and the same force.

use crate::rigid::active_set::holding::{refine_pulls, take_redundant};
use crate::rigid::active_set::pulling::Pulling;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::mobility;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::MOVES;
use crate::time::Time;
use halfgap_collision::{ConnectorId, ConnectorKind};

/// Finds those that give way in the last solution, with the sides to which they do.
fn find_giving(assembly: &Assembly, region: &Region, settling: &mut Settling) -> Vec<(ConnectorId, f64)> {
    let give_way = |settling: &Settling| -> Vec<_> {
        let Settling { pulls, solution, problem, slack, .. } = settling;
        let of_loads = problem.offset().iter().map(|b| b.abs());
        let of_pulls = pulls.iter().map(|pull| pull.most * pull.mobility);
        let largest = of_loads.chain(of_pulls).fold(0.0f64, f64::max);
        let giving = |pull: &Pulling| Some((pull.id, pull.gives_way(solution, (MOVES * largest, *slack))?));
        pulls.iter().filter_map(giving).collect()
    };
    let giving = give_way(settling);
    if giving.is_empty() {
        return giving;
    }
    refine_pulls(assembly, region, settling);
    give_way(settling)
}

/// Lists what pulls on the region's bodies. Motors do nothing in a jump.
pub(super) fn list_pulls(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
    time: Time,
) {
    settling.pulls.clear();
    if settling.jumps || !connectors.any_pulls() {
        return;
    }
    for (place, &body) in region.bodies().iter().enumerate() {
        for &id in connectors.of(body) {
            let ConnectorKind::Pull { coordinate, most, .. } = &connectors.connector(id).kind else {
                continue;
            };
            let bodies = coordinate.bodies();
            if bodies.into_iter().filter_map(|other| region.place(other)).any(|other| other < place) {
                continue;
            }
            let row = connectors.measure_connector(assembly, id, 0, time);
            let rate = row.kinematics.rate;
            // What the error of the step leaves of a rate that has come to an end is none.
            let rests = matches!(region.cause(), Cause::Rests(rested, _) if rested == id);
            let rest = if rests { 2.0 * rate.abs() } else { assembly.slip_rest() };
            let given = settling.given_up.iter().find(|(other, _)| *other == id).map(|&(_, side)| side);
            let side = given.or_else(|| (rate.abs() > rest).then(|| rate.signum()));
            let most = most / coordinate.scale();
            let mobility = mobility(assembly, bodies, &row.kinematics.jacobian);
            settling.pulls.push(Pulling { id, bodies, row, most, mobility, side, number: None });
        }
    }
}

/// Lets those pull with all their force that cannot hold in the last solution. One that has just come to its speed does not go on to the
/// same side.
pub(super) fn give_up_holding(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    let giving = find_giving(assembly, region, settling);
    let goes_on = |&(id, side): &(ConnectorId, f64)| region.cause() == Cause::Rests(id, side > 0.0);
    settling.given_up.extend(giving.into_iter().filter(|giving| !goes_on(giving)));
}

/// True if all hold that may.
pub(super) fn all_hold(assembly: &Assembly, region: &Region, settling: &mut Settling) -> bool {
    find_giving(assembly, region, settling).is_empty()
}

/// Sorts those that hold from those that act with all their force. Of several that hold one motion, those nearest to their bounds go on with
/// the force that they have: forces that are not unique would be others in a group, and beyond bounds.
pub(super) fn choose_pulls(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    settling.held.clear();
    settling.pulled.clear();
    let force_of = |settling: &Settling, pull: &Pulling| {
        pull.number.and_then(|number| settling.solution.force.get(number)).copied().unwrap_or(0.0)
    };
    let mut holding = Vec::new();
    for (index, pull) in settling.pulls.iter().enumerate() {
        let given = settling.given_up.iter().find(|(other, _)| *other == pull.id).map(|&(_, side)| side);
        match pull.side.or(given) {
            Some(side) => {
                let left = if given.is_some() { pull.row.kinematics.rate } else { 0.0 };
                let (id, bodies, force) = (pull.id, pull.bodies, -side * pull.most);
                settling.pulled.push(Pull { id, bodies, force, left: Some(left) });
            }
            None => holding.push(index),
        }
    }
    let room =
        |index: usize| 1.0 - force_of(settling, &settling.pulls[index]).abs() / settling.pulls[index].most;
    holding.sort_by(|&a, &b| room(b).total_cmp(&room(a)));
    let redundant = take_redundant(assembly, region, settling, &mut holding);
    for index in redundant {
        let pull = settling.pulls[index];
        let force = force_of(settling, &pull);
        settling.pulled.push(Pull { id: pull.id, bodies: pull.bodies, force, left: None });
    }
    holding.sort_unstable();
    for index in holding {
        let Pulling { id, bodies, row, most, .. } = settling.pulls[index];
        let force = force_of(settling, &settling.pulls[index]);
        settling.held.push(ActiveRow {
            source: RowSource::Pull(id),
            bodies,
            third: None,
            bilateral: true,
            gap: row.gap,
            hint: None,
            leans: false,
            grips: [Grip::Bounded { most }, Grip::Smooth],
            load: [force, 0.0, 0.0],
        });
    }
}
