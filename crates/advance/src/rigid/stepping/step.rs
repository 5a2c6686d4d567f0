//! From one step of a region to the next.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::forest::Forest;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::region::wide::JOINED;
use crate::rigid::settings::RegionSteps;
use crate::rigid::shares::MINOR;
use crate::rigid::stepping::displacements::find_shifts;
use crate::rigid::stepping::exact::Exact;
use crate::rigid::stepping::rows::{StepRow, bend_anew, list_rows};
use crate::rigid::stepping::slips::{StepSlip, list_slips};
use crate::rigid::stepping::spans::{next_span, straight_span};
use crate::rigid::zeno::budget::note_step;
use crate::rigid::zeno::memory::Zeno;
use crate::rigid::zeno::stepped::Pressed;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState};

/// Buffers of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stepper {
    pub(super) rows: Vec<StepRow>,
    pub(super) slips: Vec<StepSlip>,
    /// Velocities (x, y, angle) of the bodies of the region, and of what cannot move.
    velocities: Vec<[f64; 3]>,
    /// Velocities in the middle of the step.
    pub(super) middle: Vec<[f64; 3]>,
    /// Displacements.
    pub(super) shifts: Vec<[f64; 3]>,
    /// Accelerations without contacts.
    accelerations: Vec<[f64; 3]>,
    exact: Exact,
    /// Bodies that are in one step.
    parts: Forest,
    /// What happens in each part, at its root.
    charges: Vec<Charge>,
    /// Places of a region in the order of their parts.
    places: Vec<usize>,
    leaving: Leaving,
}

/// What happens in a part.
#[derive(Clone, Copy, Debug, Default)]
struct Charge {
    /// Contacts begin or end to press.
    changes: bool,
    /// Number of contacts.
    contacts: usize,
    /// Largest speed [m/s] at which one of those closed before, or opens now.
    fastest: f64,
}

/// Bodies whose steps are over, part by part.
#[derive(Clone, Debug, Default)]
pub(crate) struct Leaving {
    bodies: Vec<BodyId>,
    /// Where each part ends among the bodies.
    ends: Vec<usize>,
}

impl Leaving {
    /// The parts.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &[BodyId]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(&start, &end)| &self.bodies[start..end])
    }
}

impl Stepper {
    /// Takes out the bodies whose steps are over.
    pub(crate) fn take_leaving(&mut self) -> Leaving {
        std::mem::take(&mut self.leaving)
    }

    /// The displacements that were found last, one of each body, and one of what cannot move.
    pub(crate) fn shifts(&self) -> &[[f64; 3]] {
        &self.shifts
    }

    /// Gives back the buffers of such a list.
    pub(crate) fn put_leaving(&mut self, mut leaving: Leaving) {
        leaving.bodies.clear();
        leaving.ends.clear();
        self.leaving = leaving;
    }
}

/// Brings the bodies of a region, which are in flight and were collected for a step, to velocities at which nothing
/// closes, and lets those that go on by steps coast. Others are left in flight; [`Stepper::take_leaving`] lists them.
pub(crate) fn step_on(
    (assembly, connectors): (&mut Assembly, &Connectors),
    (books, zeno): (&mut Books, &mut Zeno),
    region: &mut Region,
    stepper: &mut Stepper,
    steps: RegionSteps,
) {
    let proposed = zeno.stepped().next_span(region.bodies().len()).unwrap_or(steps.span);
    let ended = zeno.stepped().ended();
    list_rows(assembly, region, ended, MINOR * steps.slack, &mut stepper.rows);
    list_slips((assembly, connectors), region, ended, &mut stepper.rows, &mut stepper.slips);
    read_motions(assembly, region, stepper);
    let fast = stop_closing(stepper, steps);
    books.note_impacts_in_steps(fast);
    if fast > 0 {
        // How gaps bend depends on the velocities.
        for (place, &body) in region.bodies().iter().enumerate() {
            let motion = (stepper.velocities[place], [0.0; 3]);
            move_on(assembly, books, body, motion, false);
        }
        remeasure(assembly, connectors, region, assembly.now());
        bend_anew(assembly, region, &mut stepper.rows);
    }
    let span = straight_span(&stepper.rows, proposed, steps);
    // It moves a gap by a minor part of the slack.
    find_middle(stepper, span, MINOR * steps.slack / span);
    find_parts(region, stepper, steps);
    find_shifts(stepper, steps);
    set_off((assembly, books, zeno), region, stepper, (steps, span));
}

fn read_motions(assembly: &Assembly, region: &Region, stepper: &mut Stepper) {
    let now = assembly.now();
    let states = region.bodies().iter().map(|&body| assembly.trajectory(body).unwound_at(now));
    stepper.velocities.clear();
    stepper
        .velocities
        .extend(states.map(|state| [state.velocity.x, state.velocity.y, state.angular_velocity]));
    stepper.velocities.push([0.0; 3]);
    let free = region.bodies().iter().map(|&body| assembly.trajectory(body).free_motion().acceleration);
    stepper.accelerations.clear();
    stepper.accelerations.extend(free.map(|free| [free.x, free.y, 0.0]));
    stepper.accelerations.push([0.0; 3]);
    stepper.exact.inertias.clear();
    stepper.exact.inertias.extend(region.bodies().iter().map(|&body| assembly.inertia(body)));
}

/// Rate [m/s] that is as good as none.
fn residual(steps: RegionSteps) -> f64 {
    MINOR * steps.slow
}

/// Stops the contacts that close; those that have come fast open by their elasticity, if that takes no more energy than the approaches
/// have brought. Returns the number of contacts that have come fast since the step before.
fn stop_closing(stepper: &mut Stepper, steps: RegionSteps) -> u64 {
    let Stepper { rows, slips, velocities, shifts, exact, .. } = stepper;
    let (mut any_closes, mut fast, mut brought) = (false, 0, 0.0);
    for row in rows.iter_mut().filter(|row| row.touches) {
        let rate = row.rate(velocities);
        if row.pressed.is_none() {
            row.approach = -rate;
        }
        row.impulse = row.stopped_by;
        let is_fast = row.approach > steps.slow;
        row.offset = if is_fast { -row.elasticity * row.approach } else { 0.0 };
        any_closes |= rate + row.offset < 0.0;
        fast += u64::from(is_fast);
        brought += 0.5 * row.approach * row.approach / row.compliance;
    }
    if !any_closes {
        return 0;
    }
    let before = &mut *shifts;
    before.clone_from(velocities);
    slips.iter_mut().for_each(|slip| slip.impulse = slip.dragged.stopped_by);
    exact.sweep_or_solve((rows, slips), velocities, residual(steps), |row| row.touches);
    // The energy that impulses give is their work at the mean of the rates before and after.
    let given = |rows: &[StepRow], slips: &[StepSlip], velocities: &[[f64; 3]]| -> f64 {
        let works = rows.iter().map(|row| {
            let slip = row.slip.map_or(0.0, |slip| {
                let slip = &slips[slip as usize];
                slip.impulse * (slip.speed(row.places, before) + slip.speed(row.places, velocities))
            });
            0.5 * (row.impulse * (row.rate(before) + row.rate(velocities)) + slip)
        });
        works.sum()
    };
    if fast > 0 && given(rows, slips, velocities) > brought {
        velocities.clone_from(before);
        for row in rows.iter_mut() {
            row.offset = 0.0;
        }
        exact.sweep_or_solve((rows, slips), velocities, residual(steps), |row| row.touches);
    }
    for row in rows.iter_mut() {
        row.stopped_by = row.impulse;
    }
    slips.iter_mut().for_each(|slip| slip.dragged.stopped_by = slip.impulse);
    fast
}

/// Joins the bodies that touch, or come to touch within the step.
fn find_parts(region: &Region, stepper: &mut Stepper, steps: RegionSteps) {
    let Stepper { rows, parts, .. } = stepper;
    let count = region.bodies().len();
    parts.reset(count);
    for row in rows.iter().filter(|row| row.impulse > 0.0 || row.gap <= JOINED * steps.slack) {
        let [a, b] = row.places;
        if a < count && b < count {
            parts.join(a, b);
        }
    }
}

/// Finds the velocities in the middle of a step of a length `span` [s], at which no gap falls below its target.
fn find_middle(stepper: &mut Stepper, span: f64, residual: f64) {
    let Stepper { rows, slips, velocities, middle, accelerations, exact, .. } = stepper;
    let half = 0.5 * span;
    middle.clear();
    middle.extend(
        velocities
            .iter()
            .zip(accelerations)
            .map(|(velocity, acceleration)| [0, 1, 2].map(|k: usize| velocity[k] + half * acceleration[k])),
    );
    for row in rows.iter_mut() {
        row.approach = (-row.rate(velocities)).max(0.0);
        row.offset = row.gap.max(0.0) / span + half * row.bend_within(span);
        row.impulse = row.pressed.unwrap_or(row.stopped_by);
        if let Some(slip) = row.slip {
            let StepSlip { dragged, impulse, .. } = &mut slips[slip as usize];
            *impulse = if row.pressed.is_some() { dragged.impulse } else { dragged.stopped_by };
        }
    }
    exact.sweep_or_solve((rows, slips), middle, residual, |_| true);
}

/// Lets the parts of a region coast that go on by steps; the other bodies get their velocities.
fn set_off(
    (assembly, books, zeno): (&mut Assembly, &mut Books, &mut Zeno),
    region: &Region,
    stepper: &mut Stepper,
    (steps, span): (RegionSteps, f64),
) {
    list_parts(region, stepper, residual(steps));
    let now = assembly.now();
    let mut parts = std::mem::take(&mut stepper.parts);
    let Stepper { rows, slips, velocities, middle, shifts, accelerations, charges, places, leaving, .. } =
        stepper;
    let mut rest = places.as_slice();
    while let Some(&first) = rest.first() {
        let root = parts.root(first);
        let length = rest.iter().take_while(|&&place| parts.root(place) == root).count();
        let (part, others) = rest.split_at(length);
        rest = others;
        let Charge { changes, contacts, fastest } = charges[root];
        let bodies = || part.iter().map(|&place| region.bodies()[place]);
        // A body that touches nothing has nothing to step for.
        let goes_on = note_step(zeno, bodies(), changes, now) && contacts > 0;
        if !goes_on {
            for &place in part {
                let motion = (velocities[place], shifts[place]);
                move_on(assembly, books, region.bodies()[place], motion, false);
            }
            leaving.bodies.extend(bodies());
            leaving.ends.push(leaving.bodies.len());
            continue;
        }
        let mut stepped = zeno.stepped_mut().take_empty();
        let speeds = part
            .iter()
            .map(|&place| assembly.trajectory(region.bodies()[place]).fastest_point(middle[place]));
        let speed = speeds.fold(0.0, f64::max);
        stepped.begin(now, [span, next_span(steps, span, [fastest, speed])]);
        for &place in part {
            stepped.add(region.bodies()[place], accelerations[place]);
        }
        for &StepRow { touch, approach, impulse, stopped_by, places, slip, .. } in rows.iter() {
            if impulse > 0.0 && parts.root(places[0].min(places[1])) == root {
                let dragged = slip.map(|slip| slips[slip as usize].as_dragged()).unwrap_or_default();
                stepped.press(Pressed { touch, approach, impulse, stopped_by, dragged });
            }
        }
        stepped.sort_pressed();
        books.note_region_step();
        let leader = region.bodies()[first];
        zeno.stepped_mut().put(leader, stepped);
        for &place in part {
            let body = region.bodies()[place];
            move_on(assembly, books, body, (middle[place], shifts[place]), true);
            assembly.lead(body, leader);
        }
        assembly.share_span(leader, now.plus(span));
    }
    stepper.parts = parts;
}

/// Lists the places of a region part by part, each part by its bodies, and what happens in each part. Contacts that begin or end to
/// press, or to slip, at no more than a residual [m/s] change nothing.
fn list_parts(region: &Region, stepper: &mut Stepper, residual: f64) {
    let Stepper { rows, slips, middle, parts, places, charges, .. } = stepper;
    let count = region.bodies().len();
    charges.clear();
    charges.resize(count, Charge::default());
    for row in rows.iter() {
        let Charge { changes, contacts, fastest } =
            &mut charges[parts.root(row.places[0].min(row.places[1]))];
        *contacts += 1;
        let speed = row.approach.max(row.rate(middle));
        if row.pressed.is_some() != (row.impulse > 0.0) && speed > residual {
            *changes = true;
            *fastest = fastest.max(speed);
        }
        if let Some(slip) = row.slip {
            *changes |= slips[slip as usize].turns(row.places, middle, residual) && row.impulse > 0.0;
        }
    }
    places.clear();
    places.extend(0..count);
    places.sort_unstable_by_key(|&place| (parts.root(place), region.bodies()[place]));
}

/// Sets a body off with new velocities, from a place to which it is shifted.
fn move_on(
    assembly: &mut Assembly,
    books: &mut Books,
    body: BodyId,
    ([x, y, spin], [u, v, turn]): ([f64; 3], [f64; 3]),
    coasts: bool,
) {
    let now = assembly.now();
    let before = assembly.trajectory(body).unwound_at(now);
    let shift = DVec2::new(u, v);
    let state = BodyState {
        position: before.position + shift,
        angle: before.angle + turn,
        velocity: DVec2::new(x, y),
        angular_velocity: spin,
    };
    let trajectory = assembly.trajectory(body);
    let work = trajectory.free_motion().acceleration.dot(shift) / trajectory.body().inverse_mass;
    let change = assembly.kinetic_energy(body, &state) - assembly.kinetic_energy(body, &before);
    books.book_steps(change - work);
    if coasts {
        assembly.trajectory_mut(body).coast_from(now, state);
    } else {
        assembly.trajectory_mut(body).fly_from(now, state);
    }
}
