//! The equations of motion of a group: force laws, damping, and the forces of active rows.
//!
//! With the rows J of the basis and their gap accelerations J v' + gamma, the forces f satisfy
//! (J M^-1 J^T) f = -(J v'_0 + gamma), v'_0 being the acceleration without them; then v' = v'_0 + M^-1 J^T f.

use crate::ode::Ode;
use crate::rigid::contacts::friction::Axis;
use crate::rigid::contacts::rows::{RowSource, moving_of};
use crate::rigid::group::physics::Physics;
use crate::rigid::group::stage::Stage;
use crate::rigid::group::state::{Group, Work};
use crate::time::Time;
use halfgap_contact::ActiveRows;
use std::convert::Infallible;

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
        self.group.active.factorize(&self.stage.jacobians)
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
        self.respond_with(ActiveRows::solve);
    }

    /// As [`respond`](Self::respond), but the forces of soft rows lack a small part. Not for trees.
    pub(crate) fn respond_roughly(&mut self) {
        self.respond_with(ActiveRows::solve_roughly);
    }

    fn respond_with(&mut self, solve: fn(&mut ActiveRows, &[f64], &mut [f64])) {
        let Stage { offsets, forces, changes, solves, .. } = &mut *self.stage;
        forces.resize(offsets.len(), 0.0);
        solve(&mut self.group.active, offsets, forces);
        changes.resize(self.group.bodies.len(), [0.0; 3]);
        changes.fill([0.0; 3]);
        self.group.active.respond(forces, changes);
        *solves += 1;
    }

    /// True if a single row holds the group: two bodies, or one against the background.
    fn has_a_single_row(&self) -> bool {
        matches!(self.group.sides.as_slice(), [[a, b]] if a != b)
            && self.group.thirds.is_empty()
            && !self.group.active.is_soft()
    }

    /// Adds the response to the only row to the accelerations: many groups have just one, and need no factorisation.
    fn accelerate_by_row(&mut self) {
        let direction = self.only_direction();
        let (first, second) = (self.response_to_row(0, &direction), self.response_to_row(1, &direction));
        let Stage { offsets, forces, accelerations, solves, .. } = &mut *self.stage;
        let square = first.square + second.square;
        let force = if square != 0.0 { -offsets[0] / square } else { 0.0 };
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

    /// Direction of the force of the only row.
    #[inline(always)]
    fn only_direction(&self) -> [f64; 6] {
        let normal = self.stage.jacobians[0];
        let Some(turn) = self.stage.slipping.only_turn() else { return normal };
        std::array::from_fn(|k| normal[k] + turn[k])
    }

    /// Response of the body on one side of the only row to a force of a direction.
    #[inline(always)]
    fn response_to_row(&self, side: usize, direction: &[f64; 6]) -> Response {
        let Some(place) = self.group.sides[0][side] else { return Response::default() };
        let inertia = self.physics.mechanism.trajectories[self.group.bodies[place as usize].index()].body();
        let jacobian = &self.stage.jacobians[0];
        let [x, y, turning] = [0, 1, 2].map(|k: usize| jacobian[3 * side + k]);
        let [along_x, along_y, torque] = [0, 1, 2].map(|k: usize| direction[3 * side + k]);
        let acceleration =
            [inertia.inverse_mass * along_x, inertia.inverse_mass * along_y, inertia.inverse_moment * torque];
        let square = acceleration[0] * x + acceleration[1] * y + acceleration[2] * turning;
        Response { place: Some(place), acceleration, square }
    }

    pub(crate) fn solve_rows(&mut self) {
        self.stage.jacobians.clear();
        self.stage.offsets.clear();
        self.stage.gap_error = 0.0;
        self.stage.slipping.clear();
        let Physics { mechanism, extra, .. } = self.physics;
        let mut twin = None;
        for (index, (row, &sides)) in self.group.rows.iter().zip(&self.group.sides).enumerate() {
            // `measure_next` would tell contacts apart as well; doing it here keeps their measurements in registers.
            if let RowSource::Contact(features) = row.source {
                let Stage { movings, slipping, .. } = &mut *self.stage;
                let movings = row.bodies.map(|body| moving_of(movings, body));
                let contact = (row.bodies, features);
                let moment = match row.grip(Axis::Slip).slip_share() {
                    None => mechanism.measure_contact(row.bodies, features, movings),
                    Some(share) => {
                        let (moment, slip) = mechanism.measure_slip(contact, movings, row.gap);
                        slipping.add(index, &slip, share);
                        moment
                    }
                };
                if let Some(share) = row.grip(Axis::Turn).slip_share() {
                    slipping.add(index, &mechanism.turning(contact, movings), share);
                }
                self.stage.take_row(row, sides, &moment, extra.as_ref());
            } else {
                let moment = mechanism.measure_next(row, &self.stage.movings, &mut twin);
                self.stage.take_row(row, sides, &moment, extra.as_ref());
            }
        }
        self.stage.take_thirds(&self.group.thirds);
        self.follow_moved();
        self.push_as_prescribed();
        if self.has_a_single_row() {
            self.accelerate_by_row();
        } else {
            self.group.active.factorize(&self.stage.jacobians);
            if self.stage.slipping.is_empty() {
                self.respond_by_rows();
            } else {
                self.respond_turned();
            }
            let Stage { accelerations, changes, .. } = &mut *self.stage;
            for (acceleration, change) in accelerations.iter_mut().zip(changes) {
                (0..3).for_each(|k| acceleration[k] += change[k]);
            }
        }
        let Stage { forces, .. } = &mut *self.stage;
        forces.iter_mut().zip(&self.group.stress).for_each(|(force, stress)| *force += stress);
        for &(row, force) in &self.group.prescribed {
            forces[row as usize] += force;
        }
        if self.stage.asks_force_ranges {
            self.stage.widen_force_ranges();
        }
        if self.group.rows.iter().any(|row| !row.bilateral) {
            self.level();
        }
    }
}

impl Ode for Dynamics<'_> {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        if self.group.active.is_soft() || self.passes_by_rows() {
            self.find_rates_on_rows(offset, state, rates);
        } else {
            self.find_rates(offset, state, rates, Self::solve_rows);
        }
        let Group { active, loops, kept, dependent, .. } = &mut *self.group;
        if kept.is_open() && (loops.any() || active.is_soft()) {
            kept.note(offset, active.kept_beyond(*dependent));
        }
        Ok(())
    }
}

impl Dynamics<'_> {
    /// True if the stages of the group are moved onto its rows because it passes a bifurcation point of its loops.
    /// Errors that are only rounding are not corrected then: they would come into each stage anew.
    pub(crate) fn passes_by_rows(&self) -> bool {
        let Group { tree, kept, active, .. } = &*self.group;
        tree.is_bypassed() || (!tree.is_used() && !active.is_soft() && kept.is_near_singular())
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
        self.load(state, offset);
        let (position_rates, rest) = rates.split_at_mut(3 * bodies);
        let (velocity_rates, powers) = rest.split_at_mut(3 * bodies);
        let time = self.start.seconds() + offset;
        let Group { bodies: of_group, force_laws, pulls, .. } = &*self.group;
        let of_group = (of_group.as_slice(), force_laws.as_slice(), pulls.as_slice());
        self.stage.accelerate(&self.physics, of_group, time, &self.group.works, powers);
        if self.stage.asks_free_acceleration {
            self.stage.note_free_acceleration(self.physics.mechanism.trajectories, &self.group.bodies);
            self.stage.note_force_length(&self.physics, &self.group.force_laws, time);
        }
        if !self.group.rows.is_empty() {
            constrain(self);
        }
        let asks = |work: &Work| !matches!(work, Work::Law(_) | Work::Damping);
        if self.group.works.last().is_some_and(asks) {
            self.note_friction_powers(powers);
            self.note_driving_powers(powers);
        }
        let velocities = state[3 * bodies..6 * bodies].as_chunks::<3>().0;
        position_rates.as_chunks_mut::<3>().0.copy_from_slice(velocities);
        velocity_rates.as_chunks_mut::<3>().0.copy_from_slice(&self.stage.accelerations);
    }

    /// Finds the rates of a state of the group, whether it is stepped as a tree or not.
    pub(crate) fn find_rates_at(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) {
        if self.group.tree.is_used() {
            self.find_rates(offset, state, rates, Self::hang);
            // Those beside the pins are not all.
            self.stage.forces.clear();
        } else {
            self.find_rates(offset, state, rates, Self::solve_rows);
        }
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

    /// Largest error [m] of an active gap, with the bodies in place.
    pub(crate) fn largest_gap_error(&self) -> f64 {
        let mut twin = None;
        let gaps = self.group.rows.iter().map(|row| {
            self.physics.mechanism.measure_next(row, &self.stage.movings, &mut twin).gap - row.gap
        });
        gaps.fold(0.0, |most, error| most.max(error.abs()))
    }
}
