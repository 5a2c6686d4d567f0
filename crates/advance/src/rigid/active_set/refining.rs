//! Accelerations of motors and joints with dry friction in a solution, to all digits.
//!
//! Where several of them, or one beside contacts that stick, hold the same motion, their rows depend on each other, and a solution leaves them
//! more than rounding. That tells nothing of one at its bound: whether its rate changes shows once the rows that hold do so exactly.

use crate::rigid::active_set::redundant::{Redundant, Rows};
use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::region::touching::Region;
use halfgap_collision::BodyId;

/// Corrects the accelerations of what pulls by forces that take from the rows that hold what the solution has left them.
pub(super) fn refine_pulls(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    let Settling { redundant, solution, pulls, pushed: changes, .. } = settling;
    let Redundant { rows, active, as_active: forces, .. } = redundant;
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

/// Lists the rows that hold in the last solution, each with the acceleration [m/s^2] that it has left it.
pub(super) fn list_holding(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    let Settling { candidates, slips, pulls, solution, redundant, slack, .. } = settling;
    let Rows { inertia, sides, thirds, jacobians, forces, bilateral, .. } = &mut redundant.rows;
    inertia.clear();
    inertia.extend(region.bodies().iter().map(|&body| assembly.inertia(body)));
    sides.clear();
    thirds.clear();
    jacobians.clear();
    forces.clear();
    bilateral.clear();
    let place = |body: BodyId| region.place(body).and_then(|place| u32::try_from(place).ok());
    let mut push = |bodies: [BodyId; 2], third: Option<(u32, f64)>, jacobian: [f64; 6], left: f64| {
        sides.push(bodies.map(place));
        thirds.push(third);
        jacobians.push(jacobian);
        forces.push(left);
        bilateral.push(true);
    };
    for (&index, (&force, &left)) in candidates.iter().zip(solution.force.iter().zip(&solution.acceleration))
    {
        let record = &region.records()[index];
        if record.parties.bilateral || force > 0.0 {
            let third =
                record.parties.third.and_then(|(body, coefficient)| Some((place(body)?, coefficient)));
            push(record.bodies(), third, record.motion.kinematics.jacobian, left);
        }
    }
    for slip in &*slips {
        let Some(number) = slip.number else { continue };
        if slip.side_in(solution, slip.bound(false, *slack), 0.0).is_none() {
            let left = solution.acceleration.get(number).copied().unwrap_or(0.0);
            push(region.records()[slip.record].bodies(), None, slip.row.jacobian, left);
        }
    }
    for pull in &*pulls {
        if let Some((left, false)) = pull.held(solution, *slack) {
            push(pull.bodies, None, pull.row.kinematics.jacobian, left);
        }
    }
}
