//! Scales of a group's steps: its length, its speed, its rounding, and the errors that are just acceptable.

use crate::ode::{Method, Stepper};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Stepping;
use crate::rigid::group::tools::Tools;
use crate::rigid::settings::StepControl;
use crate::rigid::shares::{HALF_ZONE, LARGE, MINOR, WAY_OF_A_STEP};
use glam::DVec2;
use halfgap_collision::BodyId;

/// Fraction of `accuracy` by which rounding may move a body along a step.
pub(crate) const ROUNDING_SHARE: f64 = 1.0 / 8.0;
/// Fraction of [`StepControl::speed`] above which a group moves: the squares of lower speeds underflow.
const STANDSTILL: f64 = 1e-140;
/// Energy that rounding of positions may add in a step, as a multiple of `local_error` times the square of the scene's
/// speed: with more, no choice of steps conserves energy.
const UNRESOLVED: f64 = 1e4;

impl Dynamics<'_> {
    /// Tells the stepper the error that each component may have.
    pub(super) fn scale_errors(&mut self, tools: &mut Tools<'_>) {
        self.set_scales(&tools.settings.steps, tools.scales);
        tools.stepper.set_scales(tools.scales);
    }

    /// The longest step [s] over which rounding does not matter: rounding of accelerations, which grows with the square
    /// of the step and which the error estimate does not see in a group at rest, and rounding of the positions at its
    /// end.
    pub(super) fn longest_sound_step(&self) -> f64 {
        let allowed = ROUNDING_SHARE * self.physics.mechanism.tolerances.accuracy / f64::EPSILON;
        let of_places = allowed / self.top_speed(&self.group.state);
        (2.0 * allowed / self.group.free_acceleration).sqrt().min(of_places)
    }

    /// The longest step [s] over which forces of laws are not passed over unseen. Of bodies that contacts hold still, no
    /// error tells that a force comes and goes: they move by no more than a fraction of the length over which forces vary.
    /// Free bodies do so where a law names one body, and depends on its place; forces between bodies act from afar, and
    /// errors tell of them. A motion that all bodies share does not count where the laws act between them alone.
    pub(super) fn longest_lawful_step(&self) -> f64 {
        let Group { bodies, force_laws, rows, state, force_length, field_length, .. } = &*self.group;
        let is_free = rows.iter().all(|row| row.bilateral);
        let way = if is_free { *field_length } else { WAY_OF_A_STEP * force_length };
        if way.is_infinite() {
            return f64::INFINITY;
        }
        let mut named = force_laws.iter().flat_map(|&law| self.physics.force_laws[law].bodies());
        let is_between = field_length.is_infinite() && named.all(|body| bodies.binary_search(body).is_ok());
        let common = if is_between {
            let velocities = (0..bodies.len()).map(|place| body_state(state, bodies.len(), place).velocity);
            velocities.sum::<DVec2>() / bodies.len() as f64
        } else {
            DVec2::ZERO
        };
        way / self.speeds(state, common).fold(0.0, f64::max)
    }

    /// Distance [m] from a body's centre of mass to its farthest point.
    pub(crate) fn reach(&self, body: BodyId) -> f64 {
        self.physics.mechanism.trajectories[body.index()].reach()
    }

    /// True unless rounding of positions, where forces vary over a short length, changes the energy by more than the
    /// tolerance allows.
    pub(super) fn is_resolved(&self, control: &StepControl) -> bool {
        if self.group.force_length >= control.length || control.speed == 0.0 {
            return true;
        }
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        let gap = self.physics.mechanism.tolerances.target_gap;
        // Over fewer gaps, those of the contacts would decide on the forces.
        if any_contact && self.group.force_length <= LARGE * gap {
            return false;
        }
        let rounding = self.rounding() * self.group.free_acceleration;
        rounding <= UNRESOLVED * control.local_error * control.speed * control.speed
    }

    /// Rounding [m] of the positions of the group's bodies.
    pub(crate) fn rounding(&self) -> f64 {
        self.rounding_in(&self.group.state)
    }

    /// Rounding [m] of the positions in a state of the group.
    pub(crate) fn rounding_in(&self, state: &[f64]) -> f64 {
        let positions = state[..self.group.velocities()].chunks_exact(3);
        f64::EPSILON * positions.flat_map(|q| [q[0].abs(), q[1].abs()]).fold(0.0, f64::max)
    }

    /// Factor, at most 1, by which acceptable errors are less where forces vary over a shorter length than
    /// [`StepControl::length`], as near a centre of attraction. Bodies are much faster there than before and after: an
    /// error that is small beside that speed is large beside the others. Under an inverse-square pull this factor keeps
    /// the relative error of the energy.
    fn depth_share(&self, control: &StepControl) -> f64 {
        (self.group.force_length / control.length).min(1.0)
    }

    /// The length [m] to which errors of position are relative: that over which forces vary, if it is less
    /// than asked for.
    fn length(&self, control: &StepControl) -> f64 {
        control.length.min(self.group.force_length)
    }

    /// A speed [m/s] of the group: that of its fastest point now, or that which applied forces would give it over its
    /// length, if more. Forces that active rows cancel count too, so that a group at rest may err by more than rounding.
    pub(crate) fn speed(&self, control: &StepControl) -> f64 {
        self.speed_in(&self.group.state, control)
    }

    /// A speed [m/s] of the group in a state, as [`Self::speed`] defines it.
    pub(crate) fn speed_in(&self, state: &[f64], control: &StepControl) -> f64 {
        let forced = (self.group.free_acceleration * self.length(control)).sqrt();
        let speed = forced.max(self.top_speed(state)).max(self.moved_speed(control));
        if speed > STANDSTILL * control.speed { speed } else { control.speed }
    }

    /// Speed [m/s] of the fastest point of the group in a state.
    pub(super) fn top_speed(&self, state: &[f64]) -> f64 {
        self.speeds(state, DVec2::ZERO).fold(0.0, f64::max)
    }

    /// Speed [m/s] of the bodies that are moved beside the group, of their fastest point or as they gather it over the length of the
    /// group: what is at rest takes it from them.
    fn moved_speed(&self, control: &StepControl) -> f64 {
        let speeds = self.group.moved.iter().map(|body| {
            let trajectory = &self.physics.mechanism.trajectories[body.index()];
            let moving = trajectory.moving_at(self.start);
            let speed = [moving.velocity.x, moving.velocity.y, moving.angular_velocity];
            let gathered = trajectory.prescribed_acceleration(self.start);
            let gathered = [gathered.linear.x, gathered.linear.y, gathered.angular];
            let gathered = (trajectory.fastest_point(gathered) * self.length(control)).sqrt();
            trajectory.fastest_point(speed).max(gathered)
        });
        speeds.fold(0.0, f64::max)
    }

    /// True if a body of the group moves no faster than a contact closes that counts as slow.
    pub(super) fn any_rests(&self, state: &[f64]) -> bool {
        let slow = self.physics.mechanism.tolerances.velocity_tol;
        self.speeds(state, DVec2::ZERO).any(|speed| speed <= slow)
    }

    /// Speed [m/s] of the fastest point of each body of the group in a state, less a velocity [m/s] that all share.
    fn speeds(&self, state: &[f64], common: DVec2) -> impl Iterator<Item = f64> {
        let count = self.group.bodies.len();
        self.group.bodies.iter().enumerate().map(move |(place, &body)| {
            let at = 3 * (count + place);
            self.physics.mechanism.trajectories[body.index()].fastest_point([
                state[at] - common.x,
                state[at + 1] - common.y,
                state[at + 2],
            ])
        })
    }

    /// Error of a velocity [m/s] that is just acceptable.
    pub(crate) fn velocity_scale(&self, control: &StepControl) -> f64 {
        control.local_error * self.speed(control)
    }

    /// Length [s] of a first step: the time in which the group goes its length, less for small tolerances.
    pub(super) fn first_step(&self, control: &StepControl) -> f64 {
        let speed = self.speed(control);
        let time = if speed > 0.0 { self.length(control) / speed } else { 1.0 };
        time * libm::pow(control.local_error, 1.0 / f64::from(Method::default().order()))
    }

    /// Error [J] of a work that is just acceptable: the error of the energy that acceptable errors of velocities make.
    /// Works mostly err by far less; but where the motion is simple, as under a constant force, they alone err at all. Of
    /// bodies that have all but come to rest under steep forces, rounding makes velocities, and those make works.
    pub(super) fn work_scale(&self, control: &StepControl) -> f64 {
        let masses = || self.group.bodies.iter().map(|&body| self.mass(body));
        let speed = self.speed(control);
        let rounding = self.rounding();
        let rough = masses().enumerate().map(|(place, mass)| {
            let velocity = self.group.rough_velocity(place, rounding);
            mass * velocity * velocity
        });
        (control.local_error * speed * speed * masses().sum::<f64>()).max(rough.sum())
    }

    /// Error norm of the works, which are the components from `first` on, each relative to `scale` [J]; 0 for no scale,
    /// which is that of a group that does not move.
    pub(super) fn work_error(&self, stepper: &Stepper, first: usize, scale: f64) -> f64 {
        if scale.is_nan() || scale <= 0.0 {
            return 0.0;
        }
        let error_of = |work: usize| stepper.error_norm_from(first + work, &[scale]);
        (0..self.group.works.len()).map(error_of).fold(0.0, f64::max)
    }

    /// Writes the errors of positions and velocities that are just acceptable, one for each component.
    fn set_scales(&self, control: &StepControl, scales: &mut Vec<f64>) {
        let (length, speed) = (self.length(control), self.speed(control));
        // What friction and damping take adds up over a run, and so do errors of it. Implicit steps, of a lower order, would be many more.
        let adds_up = self.group.loses_energy() && self.group.stepping() != Stepping::Stiff;
        let share = self.depth_share(control) * if adds_up { MINOR } else { 1.0 };
        let least = self.least_errors(share, speed);
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        let clearance = any_contact.then_some(HALF_ZONE * self.physics.mechanism.tolerances.accuracy);
        // A group without motion and forces has no scale, and no error.
        let or_infinite = |scale: f64| if scale > 0.0 { scale } else { f64::INFINITY };
        scales.clear();
        let linear = [(length, least[0]), (speed, least[1])].map(|(size, least)| {
            let linear = or_infinite(control.local_error * size * share);
            clearance.map_or(linear, |clearance| linear.min(clearance * size / length)).max(least)
        });
        let rounding = self.rounding();
        if self.group.tree.is_used() {
            let places = 0..self.group.bodies.len();
            let roughest = places.map(|place| self.group.rough_velocity(place, rounding)).fold(0.0, f64::max);
            return self.scale_tree([linear[0], linear[1].max(roughest)], scales);
        }
        for (linear, is_velocity) in linear.into_iter().zip([false, true]) {
            for (place, &body) in self.group.bodies.iter().enumerate() {
                let rough = if is_velocity { self.group.rough_velocity(place, rounding) } else { 0.0 };
                let linear = linear.max(rough);
                scales.extend([linear, linear, linear / self.reach(body)]);
            }
        }
    }

    /// Errors of positions [m] and velocities [m/s] that rounding of positions alone makes, where the group is fast
    /// because forces are steep; no step could err by less. `rough_velocity` tells of other rounding of velocities,
    /// body by body.
    fn least_errors(&self, share: f64, speed: f64) -> [f64; 2] {
        let rounding = self.rounding();
        let steep = if share < 1.0 { self.group.free_acceleration / speed } else { 0.0 };
        [rounding, rounding * steep]
    }
}
