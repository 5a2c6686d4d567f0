//! The rows that hold in a solution, as equations: what motors and joints with dry friction that hold beside them add to these.
//!
//! Where several hold the same motion, or one beside contacts that stick, their rows depend on each other. A solution then leaves them
//! more than rounding of an acceleration, which tells nothing of one at its bound; and their forces are not unique.

use crate::rigid::active_set::pulling::Pulling;
use crate::rigid::active_set::redundant::{Redundant, Rows};
use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::region::touching::Region;
use halfgap_collision::BodyId;

/// Corrects the accelerations of what pulls by forces that take from the rows that hold what the solution has left them.
pub(super) fn refine_pulls(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    list_holding(assembly, region, settling);
    let Settling { redundant, solution, pulls, pushed: changes, slack, .. } = settling;
    let Redundant { rows, active, as_active: forces, .. } = redundant;
    for pull in &*pulls {
        if let Some((left, false)) = pull.held(solution, *slack) {
            rows.push_pull(region, pull, left);
        }
    }
    rows.factorize(active);
    forces.clear();
    forces.resize(rows.forces.len(), 0.0);
    // What the solution has left stands where forces do otherwise.
    active.solve(&rows.forces, forces);
    changes.clear();
    changes.resize(region.bodies().len(), [0.0; 3]);
    active.respond(forces, changes);
    for pull in &*pulls {
        let Some(along) = pull.number.and_then(|number| solution.acceleration.get_mut(number)) else {
            continue;
        };
        for (side, body) in pull.bodies.into_iter().enumerate() {
            let Some(place) = region.place(body).filter(|_| assembly.is_movable(body)) else { continue };
            let j = &pull.row.kinematics.jacobian[3 * side..3 * side + 3];
            *along += j.iter().zip(&changes[place]).map(|(j, change)| j * change).sum::<f64>();
        }
    }
}

/// Removes from `holding`, indices of what pulls, those that hold a motion that the rows before them in the list hold already; returns
/// them.
pub(super) fn take_redundant(
    assembly: &Assembly,
    region: &Region,
    settling: &mut Settling,
    holding: &mut Vec<usize>,
) -> Vec<usize> {
    if holding.is_empty() {
        return Vec::new();
    }
    list_holding(assembly, region, settling);
    let Settling { redundant: Redundant { rows, active, .. }, pulls, .. } = settling;
    let before = rows.factorize(active);
    holding.iter().for_each(|&index| rows.push_pull(region, &pulls[index], 0.0));
    if rows.factorize(active) == before {
        return Vec::new();
    }
    holding.iter().for_each(|_| rows.pop());
    let mut redundant = Vec::new();
    holding.retain(|&index| {
        rows.push_pull(region, &pulls[index], 0.0);
        let depends = rows.factorize(active) > before;
        if depends {
            rows.pop();
            redundant.push(index);
        }
        !depends
    });
    redundant
}

impl Rows {
    /// Adds the row of what pulls, with the acceleration [m/s^2] that a solution has left it.
    fn push_pull(&mut self, region: &Region, pull: &Pulling, left: f64) {
        self.push(region, pull.bodies, None, pull.row.kinematics.jacobian, left);
    }

    fn push(
        &mut self,
        region: &Region,
        bodies: [BodyId; 2],
        third: Option<(BodyId, f64)>,
        jacobian: [f64; 6],
        left: f64,
    ) {
        let place = |body: BodyId| region.place(body).and_then(|place| u32::try_from(place).ok());
        self.sides.push(bodies.map(place));
        self.thirds.push(third.and_then(|(body, coefficient)| Some((place(body)?, coefficient))));
        self.jacobians.push(jacobian);
        self.forces.push(left);
        self.bilateral.push(true);
    }

    fn pop(&mut self) {
        self.sides.pop();
        self.thirds.pop();
        self.jacobians.pop();
        self.forces.pop();
        self.bilateral.pop();
    }
}

/// Lists the rows of connectors and contacts that hold in the last solution, and those of slips that stick, each with the acceleration
/// [m/s^2] that it has left it in place of a force.
fn list_holding(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    let Settling { candidates, slips, solution, redundant, slack, .. } = settling;
    let rows = &mut redundant.rows;
    rows.inertia.clear();
    rows.inertia.extend(region.bodies().iter().map(|&body| assembly.inertia(body)));
    rows.sides.clear();
    rows.thirds.clear();
    rows.jacobians.clear();
    rows.forces.clear();
    rows.bilateral.clear();
    let solved = solution.force.iter().zip(&solution.acceleration);
    for (&index, (&force, &left)) in candidates.iter().zip(solved) {
        let record = &region.records()[index];
        if record.parties.bilateral || force > 0.0 {
            rows.push(region, record.bodies(), record.parties.third, record.motion.kinematics.jacobian, left);
        }
    }
    for slip in &*slips {
        let Some(&left) = slip.number.and_then(|number| solution.acceleration.get(number)) else { continue };
        if slip.side_in(solution, slip.bound(false, *slack), 0.0).is_none() {
            rows.push(region, region.records()[slip.record].bodies(), None, slip.row.jacobian, left);
        }
    }
}
