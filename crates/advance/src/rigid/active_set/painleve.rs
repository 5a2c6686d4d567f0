//! What there is to tell of Painleve's cases: the energy of a jump at each contact, and contacts whose motion is not unique.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::Slip;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::friction::Axis;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::{ROUNDED, ROUNDED_FORCE};
use halfgap_collision::{BodyId, Collision};
use halfgap_contact::InverseInertia;

/// Changes of the kinetic energy [J] by the jump found last, each with the record of the contact that made it. Records must be as they were
/// before the jump. The impulses P change the speed v that they work on from v- to v+ along a straight line, so each takes P (v- + v+)/2.
pub(crate) fn works_of_jump(region: &Region, settling: &Settling) -> Vec<(usize, f64)> {
    let Settling { candidates, solution, slips, pushed, .. } = settling;
    let work = |index: usize, jacobian: &[f64; 6], rate: f64, impulse: f64| {
        impulse * (rate + 0.5 * change_along(region, &region.records()[index], jacobian, pushed))
    };
    let normal = candidates.iter().zip(&solution.force).map(|(&index, &impulse)| {
        let motion = &region.records()[index].motion;
        let of_two = work(index, &motion.kinematics.jacobian, motion.normal_velocity, impulse);
        let third = region.records()[index].parties.third;
        let turned = third.and_then(|(body, j)| Some(j * pushed[region.place(body)?][2]));
        (index, turned.map_or(of_two, |turned| of_two + 0.5 * impulse * turned))
    });
    let mut works: Vec<(usize, f64)> = normal.collect();
    for slip in slips {
        let impulse = slip.number.and_then(|number| solution.force.get(number)).copied().unwrap_or(0.0);
        works[slip.place].1 += work(slip.record, &slip.row.jacobian, slip.row.rate, impulse);
    }
    let largest = works.iter().fold(0.0f64, |most, (_, work)| most.max(work.abs()));
    works.retain(|(_, work)| work.abs() > ROUNDED_FORCE * largest);
    works
}

/// Change of the rate of a row between the bodies of a record by those of the velocities of the region's bodies.
pub(super) fn change_along(
    region: &Region,
    record: &Collision,
    jacobian: &[f64; 6],
    changes: &[[f64; 3]],
) -> f64 {
    let sides = record.bodies().into_iter().zip(jacobian.chunks_exact(3));
    let of_sides = sides.filter_map(|(body, j)| {
        let change = changes[region.place(body)?];
        Some(j.iter().zip(change).map(|(j, change)| j * change).sum::<f64>())
    });
    of_sides.sum()
}

/// Notes the contacts that slip and whose motion is not unique, of the candidates whose forces were found.
///
/// The gap of a contact accelerates by p f + b, f its force. Where p < 0 < b, both f = 0 and f = -b/p do. That is all there is to it where no
/// other candidate acts on its bodies; of others nothing is told.
pub(super) fn note_undecided(assembly: &Assembly, region: &Region, settling: &mut Settling) {
    let Settling { slips, problem, candidates, undecided, .. } = settling;
    for (number, slip) in slips.iter().enumerate().filter(|(_, slip)| slip.axis == Axis::Slip) {
        let axes = || slips[number..].iter().take_while(|other| other.place == slip.place);
        let opens = problem.offset().get(slip.place).is_some_and(|&offset| offset > 0.0);
        if !opens || axes().any(|other| other.side.is_none()) {
            continue;
        }
        let record = &region.records()[slip.record];
        let acts_on = |body: BodyId| {
            let others = candidates.iter().filter(|&&index| index != slip.record);
            region.place(body).is_some()
                && others.map(|&index| &region.records()[index]).any(|other| other.involves_body(body))
        };
        if pushes_together(assembly, record, axes()) && !record.bodies().into_iter().any(acts_on) {
            undecided.push((slip.record, slip.row.rate));
        }
    }
}

/// True if a force along the normal of a contact, with the friction that it has as it slips, lets the contact close.
fn pushes_together<'a>(
    assembly: &Assembly,
    record: &Collision,
    slips: impl Iterator<Item = &'a Slip>,
) -> bool {
    let normal = &record.motion.kinematics.jacobian;
    let mut direction = *normal;
    for turn in slips.filter_map(Slip::turn) {
        direction.iter_mut().zip(turn).for_each(|(sum, entry)| *sum += entry);
    }
    let (mut response, mut size) = (0.0, 0.0);
    for (side, body) in record.bodies().into_iter().enumerate() {
        let InverseInertia { inverse_mass, inverse_moment } = assembly.inertia(body);
        for (k, inverse) in [inverse_mass, inverse_mass, inverse_moment].into_iter().enumerate() {
            let term = normal[3 * side + k] * inverse * direction[3 * side + k];
            response += term;
            size += term.abs();
        }
    }
    response < -ROUNDED * size
}

impl Settling {
    /// Records of contacts whose motion is not unique, each with the speed [m/s] at which it slips.
    pub(crate) fn undecided(&self) -> &[(usize, f64)] {
        &self.undecided
    }
}
