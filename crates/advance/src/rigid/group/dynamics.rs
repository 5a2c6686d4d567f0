//! The equations of motion of a group: force laws, damping, and the forces of held rows.
//!
//! With the rows J of the basis and their gap accelerations J v' + gamma, the forces f satisfy
//! (J M^-1 J^T) f = -(J v'_0 + gamma), v'_0 being the acceleration without them; then v' = v'_0 + M^-1 J^T f.

use crate::ode::Ode;
use crate::rigid::bodies::flyer::Flyer;
use crate::rigid::bodies::law::{Wrench, Wrenches};
use crate::rigid::contacts::rows::{HeldRow, RowMoment, RowSource, moving_of};
use crate::rigid::group::physics::Physics;
use crate::rigid::group::samples::Samples;
use crate::rigid::group::state::{Group, Work};
use crate::rigid::settings::ExtraAcceleration;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, MotionBounds, Moving, Spin};
use halfgap_contact::HeldRows;
use std::convert::Infallible;

/// Fraction of the sum of the rows' forces on a body below which their resultant is rounding; a slope [rad] below it is
/// level.
pub(crate) const LEVEL: f64 = 1e-12;

/// Buffers for the evaluation of one moment, one set for the whole system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stage {
    /// States of all bodies; those of movable ones are valid only while their group is evaluated.
    pub(super) movings: Vec<Moving>,
    /// Sums of the force laws' wrenches, one for each body.
    pub(super) wrenches: Vec<Wrench>,
    /// The wrenches of one law.
    pub(super) single: Vec<Wrench>,
    /// Accelerations of the group's bodies (x, y, angle).
    pub(super) accelerations: Vec<[f64; 3]>,
    /// Jacobian of each row: three entries for the primary body, three for the normal body.
    pub(super) jacobians: Vec<[f64; 6]>,
    /// Right-hand side b of A f + b = 0 for each row: its acceleration [m/s^2] without forces of rows; during a
    /// projection its gap error [m] or rate [m/s].
    pub(super) offsets: Vec<f64>,
    /// Forces of the rows [N].
    pub(super) forces: Vec<f64>,
    /// M^-1 J^T f of each body (x, y, angle).
    pub(super) changes: Vec<[f64; 3]>,
    /// Sum of the sizes of all rows' forces on each body [N].
    pub(super) gross: Vec<f64>,
    /// True for each body whose acceleration is rounding.
    pub(super) levels: Vec<bool>,
    /// Force [N] below which each row counts as without force.
    pub(super) least: Vec<f64>,
    /// The least and the largest force [N] of each row at the stages of the last step.
    pub(super) force_ranges: Vec<[f64; 2]>,
    /// Evaluations note `force_ranges`.
    pub(super) asks_force_ranges: bool,
    /// Largest error [m] of a held gap where forces of rows were last found.
    pub(super) gap_error: f64,
    /// Largest acceleration [m/s^2] of a point of the group's bodies without the forces of rows, as last noted.
    pub(super) free_acceleration: f64,
    /// Evaluations note `free_acceleration` and `force_length`.
    pub(super) asks_free_acceleration: bool,
    /// Length [m] over which the forces of laws vary, as last noted.
    pub(super) force_length: f64,
    /// The same length of the laws that name one body: such a law depends on where the body is.
    pub(super) field_length: f64,
    /// Rates of rows during a projection [m/s].
    pub(super) rates: Vec<f64>,
    /// A state along the segment.
    pub(super) trial: Vec<f64>,
    /// Rates of `trial`.
    pub(super) trial_rates: Vec<f64>,
    /// A state moved onto the held rows.
    pub(super) on_rows: Vec<f64>,
    /// Bounds on the motion of the group's bodies along the segment.
    pub(super) bounds: Vec<MotionBounds>,
    /// Places in the group of the bodies that are watched along the segment.
    pub(super) watched: Vec<u32>,
    /// Values of watched functions at the nodes.
    pub(super) samples: Samples,
    /// Values of watched functions at the earliest event found so far.
    pub(super) there: Vec<f64>,
    /// Number of evaluations so far.
    pub(super) evaluations: u64,
    /// Number of solves of held rows so far.
    pub(super) solves: u64,
}

impl Stage {
    /// Sets the motion of a body.
    pub(crate) fn place(&mut self, body: BodyId, moving: Moving) {
        self.movings[body.index()] = moving;
    }

    /// Lends out the buffers of watched functions.
    pub(crate) fn lend_samples(&mut self) -> Samples {
        std::mem::take(&mut self.samples)
    }

    /// Takes back the buffers of watched functions.
    pub(crate) fn take_back_samples(&mut self, samples: Samples) {
        self.samples = samples;
    }

    /// Lends out the buffer of values at the earliest event.
    pub(crate) fn lend_there(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.there)
    }

    /// Takes that buffer back.
    pub(crate) fn take_back_there(&mut self, there: Vec<f64>) {
        self.there = there;
    }

    /// Sets the force [N] below which each row counts as without force, from the load [N] on each body beside its rows:
    /// `share` of that on the less loaded of the row's bodies, with the forces of all its rows.
    pub(crate) fn set_least_forces(&mut self, share: f64, group: &Group, loads: impl Iterator<Item = f64>) {
        self.gross.clear();
        self.gross.extend(loads);
        for (index, sides) in group.sides.iter().enumerate() {
            let force = group.forces[index].abs().max(group.end_forces[index].abs());
            sides.iter().flatten().for_each(|&place| self.gross[place as usize] += force);
        }
        let Self { gross, least, .. } = self;
        least.clear();
        least.extend(group.sides.iter().map(|sides| {
            let loads = sides.iter().flatten().map(|&place| gross[place as usize]);
            share * loads.fold(f64::INFINITY, f64::min)
        }));
    }

    /// Sets bounds on the motion of bodies along the segment.
    pub(crate) fn set_bounds(&mut self, bounds: impl Iterator<Item = MotionBounds>) {
        self.bounds.clear();
        self.bounds.extend(bounds);
    }

    pub(crate) fn new(movings: Vec<Moving>) -> Self {
        let count = movings.len();
        Self {
            movings,
            wrenches: vec![Wrench::default(); count],
            single: vec![Wrench::default(); count],
            ..Self::default()
        }
    }

    /// Places the bodies of a group according to its state.
    pub(crate) fn load(&mut self, bodies: &[BodyId], state: &[f64]) {
        for (place, body) in bodies.iter().enumerate() {
            self.movings[body.index()] = Moving::from(&body_state(state, bodies.len(), place));
        }
    }

    /// Finds the accelerations without the forces of rows, of bodies that are in place, and the powers [W] of `works`.
    pub(crate) fn accelerate(
        &mut self,
        physics: &Physics<'_>,
        (bodies, laws): (&[BodyId], &[usize]),
        time: f64,
        works: &[Work],
        powers: &mut [f64],
    ) {
        for body in bodies {
            self.wrenches[body.index()] = Wrench::default();
        }
        let mut next = 0;
        for &law in laws {
            // Works are in the order of their laws.
            let does_work = works.get(next) == Some(&Work::Law(law));
            let power = does_work.then(|| &mut powers[next]);
            self.add_law(physics, law, time, power);
            next += usize::from(does_work);
        }
        let damping = works.iter().position(|&work| work == Work::Damping);
        let mut damped = 0.0;
        self.accelerations.clear();
        for &body in bodies {
            let flyer = &physics.mechanism.flyers[body.index()];
            let (law, inertia) = (flyer.law(), flyer.body());
            let (moving, wrench) = (&self.movings[body.index()], &self.wrenches[body.index()]);
            let (v, w) = (moving.velocity, moving.angular_velocity);
            let linear = law.acceleration - v * law.linear_rate + wrench.force * inertia.inverse_mass;
            let angular = wrench.torque * inertia.inverse_moment - law.angular_rate * w;
            self.accelerations.push([linear.x, linear.y, angular]);
            if damping.is_some() && law.is_damped() {
                damped -= law.linear_rate * v.length_squared() / inertia.inverse_mass
                    + law.angular_rate * w * w / inertia.inverse_moment;
            }
        }
        if let Some(place) = damping {
            powers[place] = damped;
        }
    }

    /// Adds the next row, as measured, to the equations; the stage holds the accelerations without the forces of rows.
    #[inline(always)]
    fn take_row(
        &mut self,
        row: &HeldRow,
        sides: [Option<u32>; 2],
        moment: &RowMoment,
        extra: Option<&ExtraAcceleration>,
    ) {
        let [first, second] = sides.map(|place| self.spin_at(place));
        let mut offset = moment.kinematics.acceleration(&first, &second);
        let error = moment.gap - row.gap;
        if let Some(extra) = extra.filter(|extra| row.bilateral || !extra.joints_only) {
            offset += extra.acceleration(error, moment.kinematics.rate);
        }
        self.gap_error = self.gap_error.max(error.abs());
        self.offsets.push(offset);
        self.jacobians.push(moment.kinematics.jacobian);
    }

    #[inline]
    pub(crate) fn spin_at(&self, place: Option<u32>) -> Spin {
        place.map_or(Spin::default(), |place| {
            let [x, y, angular] = self.accelerations[place as usize];
            Spin { linear: DVec2::new(x, y), angular }
        })
    }

    /// Notes the largest acceleration of a point of some bodies, before the forces of rows are added.
    fn note_free_acceleration(&mut self, flyers: &[Flyer], bodies: &[BodyId]) {
        let of_points = |(&body, &rate): (&BodyId, &[f64; 3])| flyers[body.index()].fastest_point(rate);
        self.free_acceleration = bodies.iter().zip(&self.accelerations).map(of_points).fold(0.0, f64::max);
    }

    /// Notes the least length over which the forces of some laws vary.
    fn note_force_length(&mut self, physics: &Physics<'_>, laws: &[usize], time: f64) {
        let now = physics.snapshot(time, &self.movings);
        (self.force_length, self.field_length) = (f64::INFINITY, f64::INFINITY);
        for law in laws.iter().map(|&law| &physics.laws[law]) {
            let Some(length) = law.length(&now) else { continue };
            self.force_length = self.force_length.min(length);
            if law.bodies().len() == 1 {
                self.field_length = self.field_length.min(length);
            }
        }
    }

    /// Clears the noted ranges of forces, for a number of rows.
    pub(crate) fn clear_force_ranges(&mut self, rows: usize) {
        self.force_ranges.clear();
        self.force_ranges.resize(rows, [f64::INFINITY, f64::NEG_INFINITY]);
    }

    fn widen_force_ranges(&mut self) {
        for ([least, largest], &force) in self.force_ranges.iter_mut().zip(&self.forces) {
            (*least, *largest) = (least.min(force), largest.max(force));
        }
    }

    fn add_law(&mut self, physics: &Physics<'_>, law: usize, time: f64, power: Option<&mut f64>) {
        let now = physics.snapshot(time, &self.movings);
        let law = &physics.laws[law];
        let Some(power) = power else {
            law.apply(&now, &mut Wrenches::new(&mut self.wrenches));
            return;
        };
        // A law acts on the bodies that it names, which may be few of many.
        let named = || law.bodies().iter().filter(|body| !body.is_world()).map(|body| body.index());
        named().for_each(|index| self.single[index] = Wrench::default());
        law.apply(&now, &mut Wrenches::new(&mut self.single));
        *power = 0.0;
        for index in named() {
            // The wrench is taken out, since a body may be named twice.
            let (moving, wrench) = (&self.movings[index], std::mem::take(&mut self.single[index]));
            *power += wrench.force.dot(moving.velocity) + wrench.torque * moving.angular_velocity;
            let sum = &mut self.wrenches[index];
            sum.force += wrench.force;
            sum.torque += wrench.torque;
        }
    }
}

/// Response of the body on one side of a row to a unit force of the row.
#[derive(Clone, Copy, Debug, Default)]
struct Response {
    /// Place of the body in its group; `None` if it cannot move.
    place: Option<u32>,
    /// M^-1 J^T of the body.
    acceleration: [f64; 3],
    /// J M^-1 J^T of the body.
    square: f64,
}

/// State of a body in a group's state.
pub(crate) fn body_state(state: &[f64], bodies: usize, place: usize) -> BodyState {
    let (q, v) = (&state[3 * place..3 * place + 3], &state[3 * (bodies + place)..3 * (bodies + place) + 3]);
    BodyState {
        position: DVec2::new(q[0], q[1]),
        angle: q[2],
        velocity: DVec2::new(v[0], v[1]),
        angular_velocity: v[2],
    }
}

/// Writes the state of a body into a group's state.
pub(crate) fn set_body_state(state: &mut [f64], bodies: usize, place: usize, body: &BodyState) {
    state[3 * place..3 * place + 3].copy_from_slice(&[body.position.x, body.position.y, body.angle]);
    let velocity = [body.velocity.x, body.velocity.y, body.angular_velocity];
    state[3 * (bodies + place)..3 * (bodies + place) + 3].copy_from_slice(&velocity);
}

/// A group with the physics and the buffers from which its motion is computed.
#[derive(Debug)]
pub(crate) struct Dynamics<'a> {
    pub(crate) physics: Physics<'a>,
    pub(crate) group: &'a mut Group,
    pub(crate) stage: &'a mut Stage,
    /// Offset 0 [s] of the segment.
    pub(crate) start: Time,
}

impl Dynamics<'_> {
    /// Measures the rows with the bodies in place and factorises A = J M^-1 J^T; calls `visit` with the error [m] of
    /// each gap and its rate [m/s]. Returns the number of rows that depend on others. For a group that is stepped as a
    /// tree, only the rows beside its pins count, and the number is 0.
    pub(crate) fn factorize(&mut self, mut visit: impl FnMut(f64, f64)) -> usize {
        if self.group.tree.is_used() {
            self.factorize_by_tree(visit);
            return 0;
        }
        self.stage.jacobians.clear();
        let mut twin = None;
        for row in &self.group.rows {
            let moment = self.physics.mechanism.measure_next(row, &self.stage.movings, &mut twin);
            self.stage.jacobians.push(moment.kinematics.jacobian);
            visit(moment.gap - row.gap, moment.kinematics.rate);
        }
        self.group.held.factorize(&self.stage.jacobians)
    }

    /// Solves A x = -`offsets`, leaves x in `forces`, and M^-1 J^T x in `changes`.
    pub(crate) fn respond(&mut self) {
        if self.group.tree.is_used() {
            self.respond_by_tree();
        } else {
            self.respond_by_rows();
        }
    }

    fn respond_by_rows(&mut self) {
        self.respond_with(HeldRows::solve);
    }

    /// As [`respond`](Self::respond), but the forces of soft rows lack a small part. Not for trees.
    pub(crate) fn respond_roughly(&mut self) {
        self.respond_with(HeldRows::solve_roughly);
    }

    fn respond_with(&mut self, solve: fn(&mut HeldRows, &[f64], &mut [f64])) {
        let Stage { offsets, forces, changes, solves, .. } = &mut *self.stage;
        forces.resize(offsets.len(), 0.0);
        solve(&mut self.group.held, offsets, forces);
        changes.resize(self.group.bodies.len(), [0.0; 3]);
        changes.fill([0.0; 3]);
        self.group.held.respond(forces, changes);
        *solves += 1;
    }

    /// True if a single row holds the group: two bodies, or one against the background.
    fn is_held_by_one(&self) -> bool {
        matches!(self.group.sides.as_slice(), [[a, b]] if a != b) && !self.group.held.is_soft()
    }

    /// Adds the response to the only row to the accelerations: many groups have just one, and need no factorisation.
    fn accelerate_by_row(&mut self) {
        let (first, second) = (self.response_to_row(0), self.response_to_row(1));
        let Stage { offsets, forces, accelerations, solves, .. } = &mut *self.stage;
        let square = first.square + second.square;
        let force = if square > 0.0 { -offsets[0] / square } else { 0.0 };
        for Response { place, acceleration, .. } in [first, second] {
            if let Some(place) = place {
                let sum = &mut accelerations[place as usize];
                (0..3).for_each(|k| sum[k] += force * acceleration[k]);
            }
        }
        forces.clear();
        forces.push(force);
        *solves += 1;
    }

    /// Response of the body on one side of the only row.
    #[inline(always)]
    fn response_to_row(&self, side: usize) -> Response {
        let Some(place) = self.group.sides[0][side] else { return Response::default() };
        let inertia = self.physics.mechanism.flyers[self.group.bodies[place as usize].index()].body();
        let jacobian = &self.stage.jacobians[0];
        let [x, y, turning] = [0, 1, 2].map(|k: usize| jacobian[3 * side + k]);
        let acceleration =
            [inertia.inverse_mass * x, inertia.inverse_mass * y, inertia.inverse_moment * turning];
        let square = acceleration[0] * x + acceleration[1] * y + acceleration[2] * turning;
        Response { place: Some(place), acceleration, square }
    }

    pub(crate) fn solve_rows(&mut self) {
        self.stage.jacobians.clear();
        self.stage.offsets.clear();
        self.stage.gap_error = 0.0;
        let Physics { mechanism, extra, .. } = self.physics;
        let mut twin = None;
        for (row, &sides) in self.group.rows.iter().zip(&self.group.sides) {
            // `measure_next` would tell contacts apart as well; doing it here keeps their measurements in registers.
            if let RowSource::Contact(features) = row.source {
                let movings = row.bodies.map(|body| moving_of(&self.stage.movings, body));
                let moment = mechanism.measure_contact(row.bodies, features, movings);
                self.stage.take_row(row, sides, &moment, extra.as_ref());
            } else {
                let moment = mechanism.measure_next(row, &self.stage.movings, &mut twin);
                self.stage.take_row(row, sides, &moment, extra.as_ref());
            }
        }
        if self.is_held_by_one() {
            self.accelerate_by_row();
        } else {
            self.group.held.factorize(&self.stage.jacobians);
            self.respond_by_rows();
            let Stage { accelerations, changes, .. } = &mut *self.stage;
            for (acceleration, change) in accelerations.iter_mut().zip(changes) {
                (0..3).for_each(|k| acceleration[k] += change[k]);
            }
        }
        if self.stage.asks_force_ranges {
            self.stage.widen_force_ranges();
        }
        if self.group.rows.iter().any(|row| !row.bilateral) {
            self.level();
        }
    }

    /// Sets accelerations to zero that are only rounding of the contact forces, so that a standing body does not creep
    /// because its sides are level only up to rounding.
    fn level(&mut self) {
        let all: f64 = self.stage.forces.iter().map(|force| force.abs()).sum();
        let mut bodies = self.stage.accelerations.iter().zip(&self.group.bodies);
        if !bodies.any(|(acceleration, &body)| self.is_level(acceleration, body, LEVEL * all)) {
            return;
        }
        let Stage { forces, gross, .. } = &mut *self.stage;
        gross.clear();
        gross.resize(self.group.bodies.len(), 0.0);
        for (sides, force) in self.group.sides.iter().zip(forces.iter()) {
            sides.iter().flatten().for_each(|&place| gross[place as usize] += force.abs());
        }
        let mut levels = std::mem::take(&mut self.stage.levels);
        levels.clear();
        let bodies = self.stage.accelerations.iter().zip(&self.group.bodies).zip(&self.stage.gross);
        levels.extend(
            bodies.map(|((acceleration, &body), gross)| self.is_level(acceleration, body, LEVEL * gross)),
        );
        self.stage.levels = levels;
        self.keep_pushed();
        let Stage { accelerations, levels, .. } = &mut *self.stage;
        for (acceleration, _) in accelerations.iter_mut().zip(levels).filter(|(_, is_level)| **is_level) {
            *acceleration = [0.0; 3];
        }
    }

    /// True if an acceleration is no larger than a force [N] at the centre, or at the body's reach, would make it.
    #[inline]
    fn is_level(&self, &[x, y, angular]: &[f64; 3], body: BodyId, force: f64) -> bool {
        let flyer = &self.physics.mechanism.flyers[body.index()];
        let (inertia, reach) = (flyer.body(), flyer.reach());
        let linear = force * inertia.inverse_mass;
        x * x + y * y <= linear * linear && angular.abs() <= force * inertia.inverse_moment * reach
    }

    /// Removes from the level bodies those that a row ties to a body which is not level and for which their
    /// acceleration counts: what is rounding for a light body under large forces need not be so for a heavy one under
    /// small ones.
    fn keep_pushed(&mut self) {
        let flyers = self.physics.mechanism.flyers;
        let Stage { jacobians, accelerations, gross, levels, .. } = &mut *self.stage;
        let mut any = levels.contains(&true) && levels.contains(&false);
        while std::mem::take(&mut any) {
            for (sides, jacobian) in self.group.sides.iter().zip(jacobians.iter()) {
                let &[Some(a), Some(b)] = sides else { continue };
                let (a, b) = (a as usize, b as usize);
                let (side, level, other) = if levels[a] { (0, a, b) } else { (1, b, a) };
                if levels[a] == levels[b] {
                    continue;
                }
                let row = &jacobian[3 * side..3 * side + 3];
                let pushed: f64 = row.iter().zip(&accelerations[level]).map(|(j, a)| j * a).sum();
                let inertia = flyers[self.group.bodies[other].index()].body();
                if pushed.abs() > LEVEL * gross[other] * inertia.inverse_mass {
                    levels[level] = false;
                    any = true;
                }
            }
        }
    }
}

impl Ode for Dynamics<'_> {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        if self.group.held.is_soft() || self.passes_by_rows() {
            self.find_rates_on_rows(offset, state, rates);
        } else {
            self.find_rates(offset, state, rates, Self::solve_rows);
        }
        let Group { held, loops, kept, dependent, .. } = &mut *self.group;
        if kept.is_open() && (loops.any() || held.is_soft()) {
            kept.note(offset, held.kept_beyond(*dependent));
        }
        Ok(())
    }
}

impl Dynamics<'_> {
    /// True if the stages of the group are moved onto its rows because it passes a bifurcation point of its loops.
    /// Errors that are only rounding are not corrected then: they would come into each stage anew.
    pub(crate) fn passes_by_rows(&self) -> bool {
        let Group { tree, kept, held, .. } = &*self.group;
        tree.is_bypassed() || (!tree.is_used() && !held.is_soft() && kept.is_near_singular())
    }

    /// Finds the rates of a state of the group; `constrain` adds the response to the rows to the accelerations in the
    /// stage.
    pub(crate) fn find_rates(
        &mut self,
        offset: f64,
        state: &[f64],
        rates: &mut [f64],
        constrain: fn(&mut Self),
    ) {
        let bodies = self.group.bodies.len();
        self.stage.evaluations += 1;
        self.stage.load(&self.group.bodies, state);
        let (position_rates, rest) = rates.split_at_mut(3 * bodies);
        let (velocity_rates, powers) = rest.split_at_mut(3 * bodies);
        let time = self.start.seconds() + offset;
        let of_group = (self.group.bodies.as_slice(), self.group.laws.as_slice());
        self.stage.accelerate(&self.physics, of_group, time, &self.group.works, powers);
        if self.stage.asks_free_acceleration {
            self.stage.note_free_acceleration(self.physics.mechanism.flyers, &self.group.bodies);
            self.stage.note_force_length(&self.physics, &self.group.laws, time);
        }
        if !self.group.rows.is_empty() {
            constrain(self);
        }
        let velocities = state[3 * bodies..6 * bodies].as_chunks::<3>().0;
        position_rates.as_chunks_mut::<3>().0.copy_from_slice(velocities);
        velocity_rates.as_chunks_mut::<3>().0.copy_from_slice(&self.stage.accelerations);
    }

    /// Finds the rates of a state of the group, whether it is stepped as a tree or not.
    pub(crate) fn find_rates_at(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) {
        let constrain = if self.group.tree.is_used() { Self::hang } else { Self::solve_rows };
        self.find_rates(offset, state, rates, constrain);
    }

    /// Finds the rates of a state of the group, its largest acceleration without the forces of rows, and the length
    /// over which forces vary. The forces of rows are left in the stage, unless the group is stepped as a tree.
    pub(crate) fn evaluate_with_free(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) {
        self.stage.asks_free_acceleration = true;
        self.find_rates_at(offset, state, rates);
        self.stage.asks_free_acceleration = false;
        self.group.free_acceleration = self.stage.free_acceleration;
        self.group.force_length = self.stage.force_length;
        self.group.field_length = self.stage.field_length;
    }

    /// Largest error [m] of a connector, with the bodies in place; the rows of one connector follow each other.
    pub(crate) fn connector_error(&self) -> f64 {
        let (mut last, mut square, mut largest) = (None, 0.0, 0.0f64);
        for row in &self.group.rows {
            let RowSource::Connector(id, _) = row.source else { continue };
            let error = self.physics.mechanism.gap(row, &self.stage.movings) - row.gap;
            square = error * error + if last.replace(id) == Some(id) { square } else { 0.0 };
            largest = largest.max(square);
        }
        largest.sqrt()
    }

    /// Largest error [m] of a held gap, with the bodies in place.
    pub(crate) fn largest_gap_error(&self) -> f64 {
        let mut twin = None;
        let gaps = self.group.rows.iter().map(|row| {
            self.physics.mechanism.measure_next(row, &self.stage.movings, &mut twin).gap - row.gap
        });
        gaps.fold(0.0, |most, error| most.max(error.abs()))
    }
}

impl Stage {
    // getters of Stage
    /// Accelerations of the group's bodies (x, y, angle).
    #[inline]
    pub(crate) fn accelerations(&self) -> &[[f64; 3]] {
        &self.accelerations
    }

    /// Bounds on the motion of the group's bodies along the segment.
    #[inline]
    pub(crate) fn bounds(&self) -> &[MotionBounds] {
        &self.bounds
    }

    /// Number of evaluations so far.
    #[inline]
    pub(crate) fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// The least and the largest force [N] of each row at the stages of the last step.
    #[inline]
    pub(crate) fn force_ranges(&self) -> &[[f64; 2]] {
        &self.force_ranges
    }

    /// Forces of the rows [N].
    #[inline]
    pub(crate) fn forces(&self) -> &[f64] {
        &self.forces
    }

    /// Largest error [m] of a held gap where forces of rows were last found.
    #[inline]
    pub(crate) fn gap_error(&self) -> f64 {
        self.gap_error
    }

    /// Force [N] below which each row counts as without force.
    #[inline]
    pub(crate) fn least(&self) -> &[f64] {
        &self.least
    }

    /// States of all bodies; those of movable ones are valid only while their group is evaluated.
    #[inline]
    pub(crate) fn movings(&self) -> &[Moving] {
        &self.movings
    }

    /// Number of solves of held rows so far.
    #[inline]
    pub(crate) fn solves(&self) -> u64 {
        self.solves
    }
}
