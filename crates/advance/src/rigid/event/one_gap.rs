//! What touches lies at the target gap: active contacts are brought to it when they begin to be active.
//!
//! Contacts form anywhere within their target zone. Held where they formed, they would tilt what rests on them, and neighbours at
//! different heights of one zone would contradict each other. So the least displacement, weighted by mass, is made that brings all
//! active contacts of the event's region to their target, and leaves no other that rests below it. It is far less than a zone that can be
//! seen; where zones can be seen, contacts are held where they formed, as bodies would be lifted visibly again and again.
//!
//! Contacts that carry no force sink a little each time they are touched; one that lies below its zone is lifted with the others.
//!
//! *Invariant*: after an event no active contact is farther from its target than it was, or than its zone; none of a region where all could be
//! brought there is off by more than a minor part of the zone.

use crate::rigid::active_set::choosing::{SUNK, lower_end};
use crate::rigid::active_set::settle::may_carry_force;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::event::lift::{displace, longest_way};
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::shift::Lift;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::MINOR;
use halfgap_collision::{Collision, Tolerances};

/// Number of displacements: the second one corrects what the first leaves as gaps are curved.
const DISPLACEMENTS: usize = 2;

/// Brings the active contacts of an event, whose bodies are in flight, to their target gap.
pub(crate) fn bring_to_one_gap(rooms: &mut Rooms, work: &mut EventWork) {
    for _ in 0..DISPLACEMENTS {
        let EventWork { region, settling, lift, .. } = &mut *work;
        if !pose(&rooms.assembly, region, settling, lift) || settling.solve(&lift.problem).is_err() {
            return;
        }
        lift.find_shifts(&rooms.assembly, region, settling);
        let Tolerances { target_gap, accuracy, .. } = rooms.assembly.settings().tolerances;
        // Rows that nearly depend on each other may ask for more. What is not in the region is farther apart than two target gaps,
        // and stays above the lower end of the zone.
        if longest_way(&rooms.assembly, region, &lift.shifts).0 > target_gap + accuracy {
            return;
        }
        let before = farthest(&rooms.assembly, &work.region, &work.settling);
        let change = displace(rooms, &work.region, &work.lift.shifts);
        rooms.books.book_projection(change);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
        if farthest(&rooms.assembly, &work.region, &work.settling) > before.max(accuracy) {
            // Redundant contacts may contradict each other: those stay where they are.
            work.lift.shifts.as_flattened_mut().iter_mut().for_each(|shift| *shift = -*shift);
            let change = displace(rooms, &work.region, &work.lift.shifts);
            rooms.books.book_projection(change);
            remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
            return;
        }
        work.settling.hold_where_they_are(&work.region);
    }
}

/// True if the place of a contact in its zone cannot be seen.
fn is_one(assembly: &Assembly, record: &Collision) -> bool {
    Touch::of(record).is_some() && !assembly.is_zone_seen(record.bodies())
}

/// True for a contact that has sunk below its zone: it is lifted before the search takes it for the far side of a body.
fn lies_deep(assembly: &Assembly, record: &Collision) -> bool {
    may_carry_force(assembly, record)
        && record.gap_state().is_sunk_below(lower_end(record) - SUNK * record.tolerances.sink())
}

/// Largest distance [m] of an active contact from its target.
fn farthest(assembly: &Assembly, region: &Region, settling: &Settling) -> f64 {
    let active = settling.active().iter().map(|&(index, _)| &region.records()[index]);
    let off =
        active.filter(|record| is_one(assembly, record)).map(|record| record.distance_to_target().abs());
    off.fold(0.0, f64::max)
}

/// Sets up the least displacement that brings the active contacts to their target; false if they are there.
fn pose(assembly: &Assembly, region: &Region, settling: &Settling, lift: &mut Lift) -> bool {
    let minor = MINOR * assembly.settings().tolerances.accuracy;
    let any_lies_deep =
        region.records().iter().any(|record| is_one(assembly, record) && lies_deep(assembly, record));
    if farthest(assembly, region, settling) <= minor && !any_lies_deep {
        return false;
    }
    region.begin(&mut lift.problem, |body| assembly.inertia(body));
    lift.rows.clear();
    lift.active.clear();
    lift.active.resize(region.records().len(), false);
    settling.active().iter().for_each(|&(index, _)| lift.active[index] = true);
    for (index, record) in region.records().iter().enumerate() {
        let is_active = lift.active[index];
        let offset = match (is_active, is_one(assembly, record)) {
            (true, true) => record.distance_to_target(),
            // Connectors, and contacts in zones that can be seen, stay where they are.
            (true, false) => 0.0,
            (false, _) => record.distance_to_target().max(0.0),
        };
        let Some(row) = region.row_of(record, offset) else { continue };
        let row = if is_active { row.bilateral() } else { row };
        lift.problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
        lift.rows.push(index);
    }
    true
}
