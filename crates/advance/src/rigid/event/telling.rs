//! What callers are told of the contacts that an event lets begin, and of those whose motion is not unique.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::report::RowForce;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::slip_of;
use crate::rigid::contacts::rows::{ActiveRow, Mechanism, mechanism};
use crate::rigid::region::touching::Region;
use crate::rigid::surface::RowFriction;
use halfgap_collision::Collision;

/// Notes the unilateral rows that are active from now on, and what might go on otherwise.
pub(crate) fn note_begins(
    assembly: &Assembly,
    connectors: &Connectors,
    books: &mut Books,
    region: &Region,
    settling: &Settling,
) {
    let mechanism = mechanism(assembly, connectors);
    for (index, row) in settling.active().iter().filter(|(_, row)| !row.bilateral) {
        let told = RowForce {
            bouncing: bouncing(assembly, books, region, settling),
            ..told_of(&mechanism, &region.records()[*index], row)
        };
        books.begin_contact(told);
    }
    for &(index, slip_speed) in settling.undecided() {
        let record = &region.records()[index];
        let most = slip_of(assembly, connectors, record).map_or(0.0, |(_, surface)| surface.kinetic)
            * record.response.force.unwrap_or(0.0);
        let force = -slip_speed.signum() * most;
        let friction = Some(RowFriction { force, slip_speed, most, sticks: false });
        books.tell_undecided(RowForce { friction, ..told_record(record) });
    }
    books.drop_continued();
}

/// Duration [s] of the bounces that a single contact which was just captured would have gone on to make.
///
/// After an impact at the speed v each flight lasts 2 v/a, and v falls by e each time: 2 e v/(a (1 - e)) in all.
fn bouncing(assembly: &Assembly, books: &Books, region: &Region, settling: &Settling) -> Option<f64> {
    let ([record], Some(acceleration)) = (region.records(), settling.closing_acceleration()) else {
        return None;
    };
    let impact = books
        .told()
        .last_impact()
        .rows
        .first()
        .filter(|_| books.told().last_impact().time == assembly.now())?;
    let elasticity = record.response.elasticity;
    let closing = (-impact.rate_before).max(0.0);
    (elasticity < 1.0).then(|| 2.0 * elasticity * closing / (acceleration * (1.0 - elasticity)))
}

fn told_of(mechanism: &Mechanism<'_>, record: &Collision, row: &ActiveRow) -> RowForce {
    let rolling = mechanism.told_rolling(row, row.load[0], row.load[2]);
    RowForce { friction: row.told_friction(), rolling, ..told_record(record) }
}

/// What callers are told of a record, but its friction.
pub(super) fn told_record(record: &Collision) -> RowForce {
    let sides = [&record.parties.primary, &record.parties.normal].map(|side| side.feature());
    let features = if let [Some(primary), Some(normal)] = sides { Some([primary, normal]) } else { None };
    let (geometry, turning) = (&record.geometry, record.motion.kinematics.jacobian[2]);
    let place = (geometry.point_primary, geometry.normal, turning);
    let force = record.response.force.unwrap_or(0.0);
    RowForce::along(record.bodies(), (record.connector(), features), place, force)
}
