//! Kinetic energy in the books, and motions that are cut short.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::books::all::Books;
use crate::rigid::books::report::ImpactReport;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::time::Time;
use halfgap_collision::BodyId;

/// Books the work of damping on a body in flight, which starts another segment at a time.
pub(crate) fn book_damping(assembly: &mut Assembly, books: &mut Books, body: BodyId, time: Time) {
    if assembly.trajectory(body).free_motion().is_damped() {
        books.ledger.damping += assembly.damping_loss(body, time);
        let state = assembly.trajectory(body).unwound_at(time);
        assembly.trajectory_mut(body).fly_from(time, state);
    }
}

/// Notes the kinetic energy of a group's bodies at the end of its segment, which may be evaluated nowhere else.
pub(crate) fn note_kinetic_energy(assembly: &Assembly, books: &mut Books, group: &Group) {
    let count = group.bodies().len();
    let of_bodies =
        group.bodies().iter().enumerate().map(|(place, &body)| {
            assembly.kinetic_energy(body, &body_state(group.end_state(), count, place))
        });
    let kinetic = of_bodies.sum::<f64>();
    books.counts.largest_kinetic_energy = books.counts.largest_kinetic_energy.max(kinetic);
}

/// Notes the kinetic energy of the bodies of an impact just before it.
pub(crate) fn note_kinetic_energy_before(assembly: &Assembly, books: &mut Books, impact: &ImpactReport) {
    let after = impact.states.iter().map(|(body, state)| assembly.kinetic_energy(*body, state)).sum::<f64>();
    let kinetic = after - impact.energy_change;
    books.counts.largest_kinetic_energy = books.counts.largest_kinetic_energy.max(kinetic);
}

/// Counts that the segment of a body is cut short, and returns the body.
pub(crate) fn interrupt<'a>(
    assembly: &'a mut Assembly,
    books: &mut Books,
    body: BodyId,
) -> &'a mut Trajectory {
    books.counts.segments += 1;
    books.counts.backups += 1;
    assembly.trajectory_mut(body)
}
