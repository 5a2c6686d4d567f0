//! Buffers for the evaluation of one moment, one set for the whole system.

use crate::rigid::bodies::force_law::{Wrench, Wrenches};
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::{ActiveRow, RowMoment, moving_of};
use crate::rigid::group::friction::Slipping;
use crate::rigid::group::physics::Physics;
use crate::rigid::group::samples::Samples;
use crate::rigid::group::state::{Group, Work};
use crate::rigid::settings::ExtraAcceleration;
use glam::DVec2;
use halfgap_collision::{BodyAcceleration, BodyId, BodyState, MotionBounds, Moving};
use halfgap_contact::ThirdSide;

/// Buffers for the evaluation of one moment, one set for the whole system.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
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
    /// The contacts that slip.
    pub(super) slipping: Slipping,
    /// M^-1 J^T f of each body (x, y, angle).
    pub(super) changes: Vec<[f64; 3]>,
    /// Sum of the sizes of all rows' forces on each body [N].
    pub(super) gross: Vec<f64>,
    /// True for each body whose acceleration is rounding.
    pub(super) levels: Vec<bool>,
    /// Force [N] below which each row counts as without force.
    pub(super) least: Vec<f64>,
    /// Margin [N] of each row: how much force it may lose before an event.
    pub(super) margins: Vec<f64>,
    /// The least and the largest force [N] of each row at the stages of the last step.
    pub(super) force_ranges: Vec<[f64; 2]>,
    /// Evaluations note `force_ranges`.
    pub(super) asks_force_ranges: bool,
    /// Largest error [m] of an active gap where forces of rows were last found.
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
    /// A state moved onto the active rows.
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
    /// Number of solves of active rows so far.
    pub(super) solves: u64,
}

impl Stage {
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

    /// Largest error [m] of an active gap where forces of rows were last found.
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

    /// Number of solves of active rows so far.
    #[inline]
    pub(crate) fn solves(&self) -> u64 {
        self.solves
    }
}

impl Stage {
    /// Sets the motion of a body.
    pub(crate) fn place(&mut self, body: BodyId, moving: Moving) {
        self.movings[body.index()] = moving;
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
        for third in &group.thirds {
            let row = third.row as usize;
            self.gross[third.body as usize] += group.forces[row].abs().max(group.end_forces[row].abs());
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
        (bodies, force_laws, pulls): (&[BodyId], &[usize], &[Pull]),
        time: f64,
        works: &[Work],
        powers: &mut [f64],
    ) {
        for body in bodies {
            self.wrenches[body.index()] = Wrench::default();
        }
        let mut next = 0;
        for &law in force_laws {
            // Works are in the order of their laws.
            let does_work = works.get(next) == Some(&Work::Law(law));
            let power = does_work.then(|| &mut powers[next]);
            self.add_force_law(physics, law, time, power);
            next += usize::from(does_work);
        }
        for pull in pulls {
            let movings = pull.bodies.map(|body| moving_of(&self.movings, body));
            let jacobian = physics.mechanism.pull_kinematics(pull.id, movings).jacobian;
            for (body, entries) in pull.bodies.into_iter().zip(jacobian.as_chunks::<3>().0) {
                let Some(sum) = self.wrenches.get_mut(body.index()) else { continue };
                sum.force += pull.force * DVec2::new(entries[0], entries[1]);
                sum.torque += pull.force * entries[2];
            }
        }
        let damping = works.iter().position(|&work| work == Work::Damping);
        let mut damped = 0.0;
        self.accelerations.clear();
        for &body in bodies {
            let trajectory = &physics.mechanism.trajectories[body.index()];
            let (free, inertia) = (trajectory.free_motion(), trajectory.body());
            let (moving, wrench) = (&self.movings[body.index()], &self.wrenches[body.index()]);
            let (v, w) = (moving.velocity, moving.angular_velocity);
            let linear = free.acceleration - v * free.linear_rate + wrench.force * inertia.inverse_mass;
            let angular = wrench.torque * inertia.inverse_moment - free.angular_rate * w;
            self.accelerations.push([linear.x, linear.y, angular]);
            if damping.is_some() && free.is_damped() {
                damped -= free.linear_rate * v.length_squared() / inertia.inverse_mass
                    + free.angular_rate * w * w / inertia.inverse_moment;
            }
        }
        if let Some(place) = damping {
            powers[place] = damped;
        }
    }

    /// Adds the next row, as measured, to the equations; the stage holds the accelerations without the forces of rows.
    #[inline(always)]
    pub(crate) fn take_row(
        &mut self,
        row: &ActiveRow,
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

    /// Adds what the third bodies of rows, which have all been taken, do to the accelerations of their gaps.
    pub(super) fn take_thirds(&mut self, thirds: &[ThirdSide]) {
        for third in thirds {
            let [.., angular] = self.accelerations[third.body as usize];
            self.offsets[third.row as usize] += third.coefficient * angular;
        }
    }

    #[inline]
    pub(crate) fn spin_at(&self, place: Option<u32>) -> BodyAcceleration {
        place.map_or(BodyAcceleration::default(), |place| {
            let [x, y, angular] = self.accelerations[place as usize];
            BodyAcceleration { linear: DVec2::new(x, y), angular }
        })
    }

    /// Notes the largest acceleration of a point of some bodies, before the forces of rows are added.
    pub(crate) fn note_free_acceleration(&mut self, trajectories: &[Trajectory], bodies: &[BodyId]) {
        let of_points = |(&body, &rate): (&BodyId, &[f64; 3])| trajectories[body.index()].fastest_point(rate);
        self.free_acceleration = bodies.iter().zip(&self.accelerations).map(of_points).fold(0.0, f64::max);
    }

    /// Notes the least length over which the forces of some laws vary.
    pub(crate) fn note_force_length(&mut self, physics: &Physics<'_>, force_laws: &[usize], time: f64) {
        let now = physics.snapshot(time, &self.movings);
        (self.force_length, self.field_length) = (f64::INFINITY, f64::INFINITY);
        for law in force_laws.iter().map(|&law| &physics.force_laws[law]) {
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

    pub(crate) fn widen_force_ranges(&mut self) {
        for ([least, largest], &force) in self.force_ranges.iter_mut().zip(&self.forces) {
            (*least, *largest) = (least.min(force), largest.max(force));
        }
    }

    fn add_force_law(&mut self, physics: &Physics<'_>, law: usize, time: f64, power: Option<&mut f64>) {
        let now = physics.snapshot(time, &self.movings);
        let law = &physics.force_laws[law];
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
