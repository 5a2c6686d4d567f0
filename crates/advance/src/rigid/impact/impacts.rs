//! The impulses of an event, and their report.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::squeezed::LARGEST_MASS_RATIO;
use crate::rigid::books::all::Books;
use crate::rigid::books::energy::{book_damping, interrupt};
use crate::rigid::books::report::{ImpactReport, RowReport};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::bounces::bounces_low;
use crate::rigid::contacts::friction::slip_of;
use crate::rigid::contacts::pairs::{Pairs, is_likely};
use crate::rigid::contacts::rows::row_of;
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::region::records::{rate_along, rate_of};
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::remedies::Remedy;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Detector};
use halfgap_contact::{CollisionRow, FrictionRow, Impact, ImpactError};

/// Manner in which an impact is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// By the impact law of the settings; the number of impacts before this one tells serial laws their order.
    Lawful(u64),
    /// Without elasticity.
    Inelastic,
}

/// Finds the impulses of a region's rows.
pub(crate) fn find_impulses(
    view: &View<'_>,
    region: &Region,
    impact: &mut Impact,
    manner: Manner,
) -> Result<(), ImpactError> {
    set_rows(view.assembly, view.connectors, view.pairs, region, impact);
    match manner {
        Manner::Lawful(number) => {
            view.assembly.settings().impact_law.resolve(impact, view.assembly.settings().order, number)
        }
        Manner::Inelastic => impact.resolve_inelastic(),
    }
}

/// True if the contact or unilateral connector of a record was active until now.
fn was_active(connectors: &Connectors, pairs: &Pairs, record: &Collision) -> bool {
    match record.parties.detector {
        Detector::Connector { id, .. } => connectors.is_active_unilaterally(id),
        _ => is_likely(pairs, record).is_some(),
    }
}

/// Sets the rows of an impact to those of a region.
pub(crate) fn set_rows(
    assembly: &Assembly,
    connectors: &Connectors,
    pairs: &Pairs,
    region: &Region,
    impact: &mut Impact,
) {
    let dull = assembly.settings().impulse_step.is_none()
        && bounces_low(assembly, connectors, pairs, region.records())
        && assembly.remedies().act(Remedy::LowBounces);
    let rows = region.records().iter().map(|record| {
        let row = row_of(assembly, record);
        let elasticity = if dull && record.gap_state().rebounds() { 0.0 } else { row.elasticity };
        CollisionRow { elasticity, was_active: was_active(connectors, pairs, record), ..row }
    });
    impact.set_rows(rows);
    if !assembly.any_friction() {
        return;
    }
    impact.set_restitution(assembly.settings().restitution);
    for (index, record) in region.records().iter().enumerate() {
        let Some((slip, surface)) = slip_of(assembly, connectors, record) else { continue };
        let inertia = record.bodies().map(|body| assembly.inertia(body));
        let friction = FrictionRow {
            tangential_elasticity: surface.tangential_elasticity,
            ..FrictionRow::new(slip.jacobian, inertia, slip.rate, surface.kinetic)
        };
        impact.set_friction(index, friction);
    }
}

/// Gives the bodies of a region, which must be in flight, their velocities after a resolved impact, and writes the
/// report.
pub(crate) fn conclude_impact(
    assembly: &mut Assembly,
    books: &mut Books,
    region: &mut Region,
    impact: &Impact,
    report: &mut ImpactReport,
    time: Time,
) {
    books.note_solves(impact.solves());
    apply_impulses(assembly, books, region, impact, time);
    write_report(assembly, region, impact, report, time);
}

fn apply_impulses(
    assembly: &mut Assembly,
    books: &mut Books,
    region: &mut Region,
    impact: &Impact,
    time: Time,
) {
    region.sum_changes(impact);
    for (&body, &[x, y, spin]) in region.bodies().iter().zip(region.changes()) {
        book_damping(assembly, books, body, time);
        interrupt(assembly, books, body).cut(time, DVec2::new(x, y), spin);
        if [x, y, spin] != [0.0; 3] {
            assembly.note_struck(body, time);
        }
    }
    region.set_impulses(impact.impulses());
    for record in region.records() {
        // Beyond the end of a feature its gap is no distance between bodies.
        if record.parties.primary.site.is_some() && record.geometry.outside <= 0.0 {
            books.note_gap(record.geometry.distance);
        }
    }
}

fn write_report(
    assembly: &Assembly,
    region: &Region,
    impact: &Impact,
    report: &mut ImpactReport,
    time: Time,
) {
    report.begin(time);
    for (index, record) in region.records().iter().enumerate() {
        let impulse = impact.impulses()[index];
        let (rate_before, rate_after) = (impact.rows()[index].rate, impact.rates()[index]);
        if impulse != 0.0 {
            // The rate afterwards is that of the bodies: by long arms the rounding of their velocities moves rows
            // by more than the rounding of the rows' own rates.
            let energy = 0.5 * impulse * (rate_before + rate_of(assembly, record, time));
            report.add(RowReport { collision: *record, rate_before, rate_after, impulse }, energy);
            let moved = assembly.moved_rate(record.bodies(), &record.motion.kinematics.jacobian, time);
            let third = record.parties.third.filter(|(body, _)| assembly.is_moved(*body));
            let third = third.map_or(0.0, |(body, j)| j * assembly.moving_at(body, time).angular_velocity);
            report.add_drive(-impulse * (moved + third + record.motion.prescribed));
        }
    }
    for (record, slip) in region.records().iter().zip(impact.friction()) {
        let Some((friction, impulse)) = slip.filter(|(_, impulse)| *impulse != 0.0) else { continue };
        let running: f64 = record.bodies().iter().map(|&body| assembly.surfaces().speed(body)).sum();
        let after = rate_along(assembly, record, &friction.jacobian, time);
        report.add_friction(0.5 * impulse * (friction.rate + running + after), impulse * running);
        report.add_drive(-impulse * assembly.moved_rate(record.bodies(), &friction.jacobian, time));
    }
    report.set_friction_loss(impact.friction_loss());
    let struck = region.bodies().iter().zip(region.struck()).filter(|&(_, &is_struck)| is_struck);
    report.add_states(struck.map(|(&body, _)| (body, assembly.trajectory(body).state_at(time))));
}

pub(crate) fn impact_error(
    assembly: &Assembly,
    region: &Region,
    time: Time,
    source: ImpactError,
) -> AdvanceError {
    let touching = region.records().iter().map(Collision::bodies);
    if let Err(squeezed) = assembly.refuse_squeezed(touching, LARGEST_MASS_RATIO, time) {
        return squeezed;
    }
    let mut bodies: Vec<BodyId> = region.records().iter().flat_map(Collision::bodies).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let record = source.row().and_then(|row| region.records().get(row));
    AdvanceError::Impact { time: time.seconds(), bodies, between: record.map(Between::of), source }
}
