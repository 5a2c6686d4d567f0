//! Changes by the caller while the system runs: of velocities, which take effect at once, and of the force laws that act.
//! Contacts and connectors respond as to an impact.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::force_law::{ForceLaw, Snapshot};
use crate::rigid::books::all::Books;
use crate::rigid::books::energy::{book_damping, interrupt};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::impacting::{collect_again, collide};
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::parts::{FINITE, keep_to};
use crate::rigid::region::collecting::collect_region;
use crate::rigid::zeno::memory::Zeno;
use crate::rigid::zeno::pace::forget_paces;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Moving};
use std::sync::Arc;

/// Changes velocities of bodies at once.
pub(crate) fn change_velocities(
    rooms: &mut Rooms,
    work: &mut EventWork,
    changes: &[VelocityChange],
) -> Result<(), AdvanceError> {
    restart(rooms, work, changes.iter().map(|change| change.body), |assembly, books| {
        for change in changes {
            if assembly.is_movable(change.body) {
                change_velocity(assembly, books, change);
            }
        }
    })
}

/// A change of the force laws that act.
pub(crate) enum ForceLawChange {
    /// A law begins to act.
    Add(Arc<dyn ForceLaw>),
    /// The law at an index acts no more.
    Remove(usize),
}

/// Adds or removes a law; what its potential adds to the energy is booked as an intervention.
pub(crate) fn change_force_laws(
    rooms: &mut Rooms,
    work: &mut EventWork,
    change: &ForceLawChange,
) -> Result<(), AdvanceError> {
    let law = match change {
        ForceLawChange::Add(law) => law.clone(),
        ForceLawChange::Remove(index) => rooms.assembly.force_laws().all[*index].clone(),
    };
    restart(rooms, work, law.bodies().iter().copied(), |assembly, books| {
        let now = assembly.now();
        let movings: Vec<Moving> =
            assembly.trajectories().iter().map(|trajectory| trajectory.moving_at(now)).collect();
        let snapshot = Snapshot::of_unwound(now.seconds(), &movings, assembly.trajectories());
        let potential = law.potential(&snapshot).unwrap_or(0.0);
        match change {
            ForceLawChange::Add(law) => {
                let has_potential = law.potential(&snapshot).is_some();
                assembly.force_laws_mut().add(law.clone(), has_potential);
                books.add_force_law();
                books.book_intervention(potential);
            }
            ForceLawChange::Remove(index) => {
                assembly.force_laws_mut().remove(*index);
                books.book_intervention(-potential);
            }
        }
    })
}

/// Ends the motion of bodies and of what moves with them, lets `act` change something about them, and starts them
/// again; contacts and connectors against which they then move respond by the impact law.
fn restart(
    rooms: &mut Rooms,
    work: &mut EventWork,
    bodies: impl Iterator<Item = BodyId>,
    act: impl FnOnce(&mut Assembly, &mut Books),
) -> Result<(), AdvanceError> {
    work.seed(bodies.filter(|&body| rooms.assembly.is_movable(body)));
    if work.seeds.is_empty() {
        act(&mut rooms.assembly, &mut rooms.books);
        return Ok(());
    }
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    work.before.clear();
    work.before.extend(
        work.seeds.iter().map(|&body| rooms.assembly.trajectory(body).unwound_at(rooms.assembly.now())),
    );
    cut_groups(rooms, &mut work.region);
    take_back_cut(&mut rooms.assembly, &mut rooms.books, &work.seeds, &work.before);
    act(&mut rooms.assembly, &mut rooms.books);
    forget_past(&mut rooms.connectors, &mut rooms.pairs, &mut rooms.zeno, work);
    // Velocities and laws decide which contacts take part and what moves together, and they have changed.
    collect_again(rooms, work);
    collide(rooms, work)
}

/// Restores, to the bit, the velocities that bodies had before their groups were cut: the end of a cut step is
/// projected onto its rows, which callers that change a velocity do not expect.
fn take_back_cut(assembly: &mut Assembly, books: &mut Books, bodies: &[BodyId], seen: &[BodyState]) {
    for (&body, &BodyState { velocity, angular_velocity, .. }) in bodies.iter().zip(seen) {
        let cut = assembly.trajectory(body).unwound_at(assembly.now());
        if (cut.velocity, cut.angular_velocity) == (velocity, angular_velocity) {
            continue;
        }
        book_damping(assembly, books, body, assembly.now());
        let change = VelocityChange {
            body,
            velocity: velocity - cut.velocity,
            angular_velocity: angular_velocity - cut.angular_velocity,
        };
        books.book_projection(work_of(assembly, body, &cut, &change));
        let now = assembly.now();
        assembly.trajectory_mut(body).fly_from(now, BodyState { velocity, angular_velocity, ..cut });
    }
}

/// Changes the velocities of a body in flight.
fn change_velocity(assembly: &mut Assembly, books: &mut Books, change: &VelocityChange) {
    let &VelocityChange { body, velocity, angular_velocity } = change;
    book_damping(assembly, books, body, assembly.now());
    let before = assembly.trajectory(body).unwound_at(assembly.now());
    books.book_intervention(work_of(assembly, body, &before, change));
    let now = assembly.now();
    interrupt(assembly, books, body).cut(now, velocity, angular_velocity);
}

/// Change of the kinetic energy [J] of a body in a state.
fn work_of(assembly: &Assembly, body: BodyId, before: &BodyState, change: &VelocityChange) -> f64 {
    let inertia = assembly.inertia(body);
    let linear = change.velocity.dot(before.velocity + 0.5 * change.velocity) / inertia.inverse_mass;
    let spin = before.angular_velocity + 0.5 * change.angular_velocity;
    linear + change.angular_velocity * spin / inertia.inverse_moment
}

/// Forgets the past events of a region's bodies: impacts that follow are neither an accumulation nor bounces that have
/// become low.
fn forget_past(connectors: &mut Connectors, pairs: &mut Pairs, zeno: &mut Zeno, work: &EventWork) {
    for &body in work.region.bodies() {
        zeno.forget_events(body);
        pairs.forget_seen_of(body);
        connectors.forget_seen_of(body);
    }
    forget_paces(zeno, work.region.bodies());
}

/// A change of the velocities of a body. A zero change restarts the body's group, which makes changed parameters of force
/// laws take effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityChange {
    /// The body; a fixed body and the background keep their velocities.
    pub body: BodyId,
    /// Change of the velocity of the centre of mass [m/s].
    pub velocity: DVec2,
    /// Change of the angular velocity [rad/s].
    pub angular_velocity: f64,
}

pub(crate) fn check_finite(time: Time, changes: &[VelocityChange]) -> Result<(), AdvanceError> {
    let check = |numbers: &[(&'static str, f64)]| {
        let bad = |(quantity, _, value)| AdvanceError::BadIntervention { quantity, value };
        keep_to(&[(FINITE.0, FINITE.1, numbers)]).map_err(bad)
    };
    check(&[("time", time.seconds())])?;
    changes.iter().try_for_each(|&VelocityChange { velocity, angular_velocity, .. }| {
        check(&[
            ("velocity.x", velocity.x),
            ("velocity.y", velocity.y),
            ("angular velocity", angular_velocity),
        ])
    })
}
