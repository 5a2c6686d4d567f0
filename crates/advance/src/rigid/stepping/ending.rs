//! The end of a step, whole or cut short: its bodies are in flight with the velocities that they have there.

use crate::rigid::agenda::{Agenda, Source};
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::zeno::memory::Zeno;
use crate::rigid::zeno::stepped::Stepped;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState};

/// Ends the step that a body leads at the present time.
pub(crate) fn end_step(
    (assembly, zeno): (&mut Assembly, &mut Zeno),
    (books, agenda): (&mut Books, &mut Agenda),
    leader: BodyId,
) {
    let Some(stepped) = zeno.stepped_mut().take(leader) else { return };
    let now = assembly.now();
    books.book_steps(-work_within(assembly, &stepped, now));
    let since = stepped.since_middle(now);
    for (&body, &[x, y, turn]) in stepped.bodies().iter().zip(stepped.accelerations()) {
        let coasting = assembly.trajectory(body).unwound_at(now);
        let state = BodyState {
            velocity: coasting.velocity + since * DVec2::new(x, y),
            angular_velocity: coasting.angular_velocity + since * turn,
            ..coasting
        };
        books.book_steps(assembly.kinetic_energy(body, &state) - assembly.kinetic_energy(body, &coasting));
        assembly.trajectory_mut(body).fly_from(now, state);
        assembly.trajectory_mut(body).unwind();
        assembly.part(body);
        books.note_backup();
    }
    agenda.clear(Source::Step(leader));
    zeno.stepped_mut().end(stepped);
}

/// Work [J] of the accelerations without contacts since the beginning of a step: bodies that coast do not become faster by
/// it.
pub(crate) fn work_within(assembly: &Assembly, stepped: &Stepped, time: Time) -> f64 {
    let elapsed = time.since(stepped.start());
    let works = stepped.bodies().iter().zip(stepped.accelerations()).map(|(&body, &[x, y, _])| {
        let trajectory = assembly.trajectory(body);
        let way = elapsed * trajectory.unwound_at(time).velocity;
        DVec2::new(x, y).dot(way) / trajectory.body().inverse_mass
    });
    works.sum()
}

/// True if the bodies of all regions in a step coast, led by the right one.
pub(crate) fn all_coast(assembly: &Assembly, zeno: &Zeno) -> bool {
    let coasts = |body: BodyId, leader: Option<BodyId>| {
        assembly.trajectory(body).is_coasting() && assembly.leader_of()[body.index()] == leader
    };
    let mut all = zeno.stepped().iter();
    all.all(|stepped| {
        let leader = stepped.bodies().first().copied();
        stepped.bodies().iter().all(|&body| coasts(body, leader))
    })
}
