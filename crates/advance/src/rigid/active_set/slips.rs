//! Friction of an event's candidates: which of them slip, which may stick, and what they do from the event on.
//!
//! A contact that slips as the event begins goes on: its force along the normal is turned against the slip. One without slip
//! has a friction row in the problem, bounded by its static coefficient; where the bound is reached it slips from then on,
//! against its force, by its kinetic coefficient. At one time all contacts of a region are decided together.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::{Grip, slip_of};
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::ROUNDED_FORCE;
use crate::rigid::surface::PairSurface;
use halfgap_collision::TangentRow;
use halfgap_contact::Solution;

/// Share [-] by which the bounds of a problem are less than those that count. A contact that is this near its bound and slips by mistake
/// is slowed down, and stops at once.
const NARROWED: f64 = 1e-7;
/// Share [-] of the largest acceleration from which a slip accelerates: between what solutions are off, and what a contact at its
/// bound does where bounds are less by [`NARROWED`].
const MOVES: f64 = 3e-13;

/// The friction of a candidate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    /// Place of the candidate in the problem, and its record in the region.
    pub(super) place: usize,
    pub(super) record: usize,
    pub(super) row: TangentRow,
    pub(super) surface: PairSurface,
    /// The side to which it slips, 1 or -1; `None` for one that may stick.
    pub(super) side: Option<f64>,
    /// Number of its friction row in the problem, if it has one.
    pub(super) number: Option<usize>,
}

impl Slip {
    /// Bound of the friction row, as a share of the normal force [-].
    pub(super) fn bound(&self, jumps: bool, slack: f64) -> f64 {
        if jumps { self.surface.kinetic } else { (1.0 - slack.max(NARROWED)) * self.surface.sticking }
    }

    /// By what the direction of the force of the contact's row differs from its normal, if it slips.
    pub(super) fn turn(&self) -> Option<[f64; 6]> {
        let share = self.share()?;
        Some(self.row.jacobian.map(|entry| share * entry))
    }

    /// Force along the tangent as a share of that along the normal [-], of a contact that slips.
    pub(super) fn share(&self) -> Option<f64> {
        self.side.map(|side| -side * self.surface.kinetic)
    }

    /// Side to which the contact begins to slip in a solution whose accelerations count from `least` [m/s^2] on; `None` if it
    /// sticks.
    fn gives_way(&self, solution: &Solution, slack: f64, least: f64) -> Option<f64> {
        self.side_in(solution, self.bound(false, slack), least)
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
    let rest = assembly.rest_speed().max(2.0 * speed_of_stopped(assembly, connectors, region));
    slips.extend(candidates.iter().enumerate().filter_map(|(place, &index)| {
        let (row, surface) = slip_of(assembly, connectors, &region.records()[index])?;
        let given = given_way.iter().find(|(record, _)| *record == index).map(|(_, side)| *side);
        let side = given.or_else(|| (row.rate.abs() > rest).then(|| row.rate.signum())).filter(|_| !*jumps);
        Some(Slip { place, record: index, row, surface, side, number: None })
    }));
}

/// Slip speed [m/s] that is left of a contact whose slip has come to a stop, by the error of the step that led there; 0 if the event
/// is another.
fn speed_of_stopped(assembly: &Assembly, connectors: &Connectors, region: &Region) -> f64 {
    let Cause::Stopped(stopped, _) = region.cause() else { return 0.0 };
    let record = region.records().iter().find(|record| Touch::of(record) == Some(stopped));
    record.and_then(|record| slip_of(assembly, connectors, record)).map_or(0.0, |(row, _)| row.rate.abs())
}

/// Lets contacts slip whose friction has reached its bound; true if any of them has a kinetic coefficient below its static one:
/// then forces must be found anew.
///
/// At the bound itself a contact that sticks and one that slips accelerate alike, and forces of redundant contacts are at their
/// bounds now here, now there. So the bounds of the problem are a little less than those that count, and who cannot stick
/// accelerates. A contact whose slip has just come to a stop does not go on to the same side.
pub(super) fn give_way(region: &Region, settling: &mut Settling) -> bool {
    let Settling { slips, given_way, solution, problem, slack, .. } = settling;
    let largest = problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    let mut is_new = false;
    for slip in slips.iter().filter(|slip| slip.side.is_none()) {
        let record = slip.record;
        let Some(side) = slip.gives_way(solution, *slack, MOVES * largest) else { continue };
        let stopped = region.cause().stopped(region.records()[record].bodies());
        if stopped != Some(side > 0.0) {
            given_way.push((record, side));
            is_new |= slip.surface.kinetic < slip.surface.sticking;
        }
    }
    is_new
}

/// True if no contact that may stick gives way.
pub(super) fn all_stick(settling: &Settling) -> bool {
    let Settling { slips, solution, problem, slack, .. } = settling;
    let largest = problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    slips.iter().all(|slip| slip.gives_way(solution, *slack, MOVES * largest).is_none())
}

/// What friction does at the row of a candidate's record, and its force [N] along the tangent.
pub(super) fn grip_of(settling: &Settling, record: usize) -> (Grip, f64) {
    let Ok(found) = settling.slips.binary_search_by_key(&record, |slip| slip.record) else {
        return (Grip::Smooth, 0.0);
    };
    let slip = &settling.slips[found];
    let force = slip.number.and_then(|number| settling.solution.force.get(number)).copied().unwrap_or(0.0);
    let given = settling.given_way.iter().find(|(other, _)| *other == record).map(|(_, side)| *side);
    match slip.side.or(given) {
        Some(side) => {
            let left = if given.is_some() { slip.row.rate } else { 0.0 };
            (Grip::Slips { side, coefficient: slip.surface.kinetic, left }, 0.0)
        }
        None => (Grip::Sticks { coefficient: slip.surface.sticking, anchor: None }, force),
    }
}

/// Adds the forces along tangents to accelerations of the region's bodies, as `push` does.
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
