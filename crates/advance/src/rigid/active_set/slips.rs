//! Friction of an event's candidates: which of them slip, which may stick, and what they do from the event on.
//!
//! A contact that slips as the event begins goes on: its force along the normal is turned against the slip. One without slip
//! has a friction row in the problem, bounded by its static coefficient; where the bound is reached it slips from then on,
//! against its force, by its kinetic coefficient. At one time all contacts of a region are decided together. A contact that resists rolling does so
//! by a friction of its own, along another axis, and has either without knowing of the other.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::{Axis, Grip, slip_of};
use crate::rigid::contacts::rolling::turn_of;
use crate::rigid::contacts::touch::{Touch, sorted};
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::{MOVES, NARROWED, ROUNDED_FORCE};
use crate::rigid::surface::PairSurface;
use halfgap_collision::{BodyId, Collision, TangentRow};
use halfgap_contact::{InverseInertia, Solution};

/// The friction of a candidate along an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    /// Place of the candidate in the problem, and its record in the region.
    pub(super) place: usize,
    pub(super) record: usize,
    pub(super) axis: Axis,
    pub(super) row: TangentRow,
    /// Coefficient if it slips, and that up to which it sticks [-].
    pub(super) kinetic: f64,
    pub(super) sticking: f64,
    /// Acceleration along the axis by a unit of force along it [1/kg].
    pub(super) mobility: f64,
    /// The side to which it slips, 1 or -1; `None` for one that may stick.
    pub(super) side: Option<f64>,
    /// Number of its friction row in the problem, if it has one.
    pub(super) number: Option<usize>,
}

impl Slip {
    /// Bound of the friction row, as a share of the normal force [-].
    pub(super) fn bound(&self, jumps: bool, slack: f64) -> f64 {
        if jumps { self.kinetic } else { (1.0 - slack.max(NARROWED)) * self.sticking }
    }

    /// By what the direction of the force of the contact's row differs from its normal, if it slips.
    pub(super) fn turn(&self) -> Option<[f64; 6]> {
        let share = self.share()?;
        Some(self.row.jacobian.map(|entry| share * entry))
    }

    /// Force along the axis as a share of that along the normal [-], of a contact that slips.
    pub(super) fn share(&self) -> Option<f64> {
        self.side.map(|side| -side * self.kinetic)
    }

    /// Side to which the contact begins to slip in a solution whose bounds are less by a share `slack` [-], for a problem whose `largest`
    /// acceleration [m/s^2] is given; `None` if it sticks.
    fn gives_way(&self, solution: &Solution, largest: f64, slack: f64) -> Option<f64> {
        // A contact slips about as easily as it parts. How easily it rolls depends on its radius, which may be as small as can be.
        let scale = match self.axis {
            Axis::Slip => largest,
            Axis::Turn => self.mobility * solution.force[self.place],
        };
        self.side_in(solution, self.bound(false, slack), MOVES * scale)
    }

    /// Side to which the contact goes in a solution at its bound, given as a share of the normal force [-], by more than `least`.
    pub(super) fn side_in(&self, solution: &Solution, bound: f64, least: f64) -> Option<f64> {
        let number = self.number?;
        // Contacts that contradict each other by rounding have no forces at all.
        let (along, force) = (solution.acceleration.get(number)?, solution.force.get(number)?);
        let is_at_bound = force.abs() >= (1.0 - ROUNDED_FORCE) * bound * solution.force[self.place];
        (is_at_bound && along.abs() > least).then(|| along.signum())
    }
}

/// Lists the friction of the candidates.
pub(super) fn list_slips(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
) {
    let Settling { candidates, slips, given_way, jumps, .. } = settling;
    slips.clear();
    if !assembly.any_friction() {
        return;
    }
    let rest = assembly.slip_rest().max(2.0 * speed_of_stopped(assembly, connectors, region));
    for (place, &record) in candidates.iter().enumerate() {
        slips.extend(Axis::ALL.into_iter().filter_map(|axis| {
            let resistance = resistance_of(assembly, connectors, &region.records()[record], axis)?;
            let (row, [kinetic, sticking]) = resistance;
            let mobility = mobility(assembly, region.records()[record].bodies(), &row.jacobian);
            let given = side_given(given_way, record, axis);
            let side = given.or_else(|| (row.rate.abs() > rest).then(|| row.rate.signum()));
            let side = side.filter(|_| !*jumps);
            Some(Slip { place, record, axis, row, kinetic, sticking, mobility, side, number: None })
        }));
    }
}

/// The motion along an axis at a contact's record, and the kinetic and the static coefficient by which the contact resists it [-]; `None`
/// where it does not.
fn resistance_of(
    assembly: &Assembly,
    connectors: &Connectors,
    record: &Collision,
    axis: Axis,
) -> Option<(TangentRow, [f64; 2])> {
    match axis {
        Axis::Slip => slip_of(assembly, connectors, record)
            .map(|(row, PairSurface { kinetic, sticking, .. })| (row, [kinetic, sticking])),
        Axis::Turn => turn_of(assembly, connectors, record).map(|(row, coefficient)| (row, [coefficient; 2])),
    }
}

/// Acceleration along a row between two bodies by a unit of force along it [1/kg].
pub(super) fn mobility(assembly: &Assembly, bodies: [BodyId; 2], jacobian: &[f64; 6]) -> f64 {
    let of_side = |(side, body): (usize, BodyId)| {
        let InverseInertia { inverse_mass, inverse_moment } = assembly.inertia(body);
        let [x, y, turning] = [0, 1, 2].map(|k: usize| jacobian[3 * side + k]);
        inverse_mass * (x * x + y * y) + inverse_moment * turning * turning
    };
    bodies.into_iter().enumerate().map(of_side).sum()
}

/// The side to which a record's contact has begun to slip along an axis in this event, if it has.
fn side_given(given_way: &[(usize, Axis, f64)], record: usize, axis: Axis) -> Option<f64> {
    given_way.iter().find(|&&(other, along, _)| (other, along) == (record, axis)).map(|&(_, _, side)| side)
}

/// Slip speed [m/s] that is left of a contact whose slip has come to a stop, by the error of the step that led there; 0 if the event
/// is another.
fn speed_of_stopped(assembly: &Assembly, connectors: &Connectors, region: &Region) -> f64 {
    let Cause::Stopped(stopped, axis) = region.cause() else { return 0.0 };
    let record = region.records().iter().find(|record| Touch::of(record) == Some(stopped));
    let resistance = record.and_then(|record| resistance_of(assembly, connectors, record, axis));
    resistance.map_or(0.0, |(row, _)| row.rate.abs())
}

/// Lets contacts slip whose friction has reached its bound; true if any of them has a kinetic coefficient below its static one:
/// then forces must be found anew.
///
/// At the bound itself a contact that sticks and one that slips accelerate alike, and forces of redundant contacts are at their
/// bounds now here, now there. So the bounds of the problem are a little less than those that count, and who cannot stick
/// accelerates. A contact whose slip has just come to a stop does not go on to the same side.
pub(super) fn give_way(region: &Region, settling: &mut Settling) -> bool {
    let Settling { slips, given_way, stopped, solution, problem, slack, .. } = settling;
    let largest = problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    let mut is_new = false;
    for slip in slips.iter().filter(|slip| slip.side.is_none()) {
        let record = slip.record;
        let Some(side) = slip.gives_way(solution, largest, *slack) else { continue };
        let [a, b] = region.records()[record].bodies();
        if !stopped.contains(&(sorted(a, b), slip.axis, side > 0.0)) {
            given_way.push((record, slip.axis, side));
            is_new |= slip.kinetic < slip.sticking;
        }
    }
    is_new
}

/// True if no contact that may stick gives way.
pub(super) fn all_stick(settling: &Settling) -> bool {
    let Settling { slips, solution, problem, slack, .. } = settling;
    let largest = problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    slips.iter().all(|slip| slip.gives_way(solution, largest, *slack).is_none())
}

/// What friction does at the row of a candidate's record along each axis, and the force [N] of one that sticks.
pub(super) fn grips_of(settling: &Settling, record: usize) -> ([Grip; 2], [f64; 2]) {
    let (mut grips, mut forces) = ([Grip::Smooth; 2], [0.0; 2]);
    let first = settling.slips.partition_point(|slip| slip.record < record);
    for slip in settling.slips[first..].iter().take_while(|slip| slip.record == record) {
        let place = slip.axis as usize;
        let force = slip.number.and_then(|number| settling.solution.force.get(number)).copied();
        let given = side_given(&settling.given_way, record, slip.axis);
        (grips[place], forces[place]) = match slip.side.or(given) {
            Some(side) => {
                let left = if given.is_some() { slip.row.rate } else { 0.0 };
                (Grip::Slips { side, coefficient: slip.kinetic, left }, 0.0)
            }
            None => (Grip::Sticks { coefficient: slip.sticking, anchor: None }, force.unwrap_or(0.0)),
        };
    }
    (grips, forces)
}

/// Adds the forces of friction to accelerations of the region's bodies, as `push` does.
pub(super) fn for_each_push(settling: &Settling, mut push: impl FnMut(usize, &[f64; 6], f64)) {
    for slip in &settling.slips {
        let force = &settling.solution.force;
        let along = match (slip.share(), slip.number) {
            (Some(share), _) => force.get(slip.place).map(|normal| share * normal),
            (None, Some(number)) => force.get(number).copied(),
            (None, None) => None,
        };
        if let Some(along) = along {
            push(slip.place, &slip.row.jacobian, along);
        }
    }
}
