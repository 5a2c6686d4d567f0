//! Which of the candidates become active rows, and at which gap.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::grips_of;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::bounces::formed_at;
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::contacts::rows::{ActiveRow, RowSource, source_of, with_lean};
use crate::rigid::contacts::touch::{DEEPEST, Touch};
use crate::rigid::group::stage::Stage;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::{HALF_ZONE, NEGLIGIBLE};
use crate::time::Time;
use halfgap_collision::{Collision, Tolerances};

/// Makes the contacts inactive that carry next to no force; true if any of them carries some at all.
pub(crate) fn deactivate_idle(
    assembly: &Assembly,
    pairs: &Pairs,
    region: &mut Region,
    settling: &mut Settling,
    stage: &Stage,
) -> bool {
    let Settling { candidates, solution, gross, .. } = settling;
    // Loads [N] of each body: its own and those of its rows.
    gross.clear();
    let bodies = region.bodies().iter().zip(stage.accelerations());
    gross.extend(bodies.map(|(&body, acceleration)| assembly.trajectory(body).load(acceleration)));
    for (&index, force) in candidates.iter().zip(&solution.force) {
        for place in places_of(region, &region.records()[index]) {
            gross[place] += force.abs();
        }
    }
    let mut any = false;
    let mut forces = solution.force.iter();
    candidates.retain(|&index| {
        let force = forces.next().copied().unwrap_or_default();
        let record = region.records()[index];
        let loads = places_of(region, &record).map(|place| gross[place]);
        let is_released = Touch::of(&record).is_some_and(|touch| region.cause() == Cause::Released(touch));
        // With less force, a contact that was just released sinks so slowly that it may as well be touched again.
        let share = if is_released { NEGLIGIBLE } else { IDLE_SHARE };
        let least = share * loads.fold(f64::INFINITY, f64::min);
        let lies_deep = lifted(assembly, pairs, &record).is_some();
        let stays = record.parties.bilateral || force > least || lies_deep;
        region.set_force(index, if stays { force } else { 0.0 });
        any |= !stays && force > 0.0;
        stays
    });
    any
}

/// Makes active rows of the remaining candidates.
pub(crate) fn choose_rows(
    assembly: &Assembly,
    connectors: &Connectors,
    pairs: &Pairs,
    region: &Region,
    settling: &mut Settling,
    time: Time,
) {
    for place in 0..settling.candidates.len() {
        let index = settling.candidates[place];
        let (grips, along) = grips_of(settling, index);
        let record = &region.records()[index];
        let lifted = lifted(assembly, pairs, record);
        if lifted.is_some() {
            assembly.remedies().act(Remedy::Lifting);
        }
        settling.active.extend(
            active_row(assembly, connectors, (record, grips, along), lifted, time).map(|row| (index, row)),
        );
    }
    settling.list_touches();
}

/// The row of a record, held at its present gap or at the one [m] to which it is `lifted`.
fn active_row(
    assembly: &Assembly,
    connectors: &Connectors,
    (record, grips, [slip, turn]): (&Collision, [Grip; 2], [f64; 2]),
    lifted: Option<f64>,
    time: Time,
) -> Option<ActiveRow> {
    let source = source_of(record)?;
    let bodies = record.bodies();
    let hint = match source {
        RowSource::Connector(id, index) => connectors.states()[id.index()].hint_of(index).copied(),
        RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => None,
    };
    // Bilateral rows are kept at gap 0, the others where they are, unless they have sunk too deep: moving a rope to
    // its length would move a body that hangs on it by a long arm by much more.
    let bilateral = record.parties.bilateral;
    let gap = if bilateral { 0.0 } else { lifted.unwrap_or(record.geometry.distance) };
    let load = [record.response.force.unwrap_or(0.0), slip, turn];
    let third = record.parties.third;
    let row = ActiveRow { source, bodies, third, bilateral, gap, hint, leans: false, grips, load };
    Some(with_lean(assembly, connectors, row, time))
}

/// The gap [m] to which a row that has sunk too deep is lifted; `None` for others. A contact without force sinks a
/// little each time it is touched. It is lifted before the search takes it for the far side of a body; where zones
/// can be seen, it is lifted into its zone, lest bodies overlap, unless it formed lower.
#[inline]
pub(crate) fn lifted(assembly: &Assembly, pairs: &Pairs, record: &Collision) -> Option<f64> {
    let is_contact = record.connector().is_none();
    let gap = record.gap_state();
    let (lowest, sunk) = (lower_end(record), SUNK * record.tolerances.sink());
    if !gap.is_sunk_below(lowest - sunk) || !assembly.remedies().is_on(Remedy::Lifting) {
        return None;
    }
    let depth = DEEPEST * record.tolerances.target_gap;
    if !is_seen(assembly, record) {
        return (is_contact && gap.is_illegal(depth)).then_some(-depth);
    }
    let formed = if is_contact { formed_at(pairs, record).max(-depth) } else { lowest };
    let lowest = lowest.min(formed);
    gap.is_sunk_below(lowest - sunk).then_some(lowest)
}

/// True if the target zone of a record is so wide relative to its bodies that their place in it can be seen.
fn is_seen(assembly: &Assembly, record: &Collision) -> bool {
    assembly.is_zone_seen(record.bodies())
}

/// The lower end [m] of the zone in which a row is active. Ropes and stops, which are taut at 0, must not exceed their
/// ends by more than `accuracy`, however they sink.
pub(crate) fn lower_end(record: &Collision) -> f64 {
    let Tolerances { target_gap, accuracy, .. } = record.tolerances;
    if record.connector().is_some() { -HALF_ZONE * accuracy } else { target_gap - accuracy }
}

/// Depth below its zone from which a row is lifted, as a multiple of the distance by which a contact sinks at a time: a
/// row that has just been lifted may sink once.
pub(crate) const SUNK: f64 = 1.5;

/// Force of a contact that is rounding, as a fraction of the loads of its bodies; such a contact need not be active. A
/// little more may keep a body in balance: a brick on the joint of two others, which stands on corners next to each
/// other, would fall over without it.
const IDLE_SHARE: f64 = 1e-13;

/// Places of the movable bodies of a record.
pub(crate) fn places_of<'a>(region: &'a Region, record: &Collision) -> impl Iterator<Item = usize> + use<'a> {
    let third = record.parties.third.map(|(body, _)| body);
    record.bodies().into_iter().chain(third).filter_map(|body| region.place(body))
}
