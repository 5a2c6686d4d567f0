//! The energy of a group: of a state, what a projection changes of it, and what a step loses.

use super::dynamics::{Dynamics, body_state};
use super::extending::Tools;
use super::law::Snapshot;
use super::segment::StepControl;
use halfgap_collision::BodyId;

/// Energy that a step may lose or make, in local errors of the kinetic energy, and in roundings of all of it. Where rows all
/// but depend on each other, or near a centre of attraction, what is rounding elsewhere does work, and no error estimate
/// tells.
const LOST_ERRORS: f64 = 1e2;
const LOST_ROUNDINGS: f64 = 1e3;

impl Dynamics<'_> {
    /// Projects the end onto the held rows and notes what energy that took.
    pub(crate) fn end_on_rows(&mut self, tools: &Tools<'_>) {
        let settings = tools.settings;
        self.group.projected = 0.0;
        let needs_none = self.group.rows.is_empty() || self.group.tree.holds_all();
        if needs_none || !(settings.projection || settings.joint_small_impacts) {
            return;
        }
        let before = self.end_energy();
        if settings.projection {
            self.project_end(&settings.steps);
        } else {
            self.fit_joint_velocities();
        }
        self.group.projected = self.end_energy() - before;
    }

    fn end_energy(&mut self) -> f64 {
        let end = std::mem::take(&mut self.group.end_state);
        let energy = self.energy(&end);
        self.group.end_state = end;
        energy
    }

    /// Energy that the last step has lost or made, in units of what it may; 0 where errors of steps are all there is.
    pub(crate) fn lost_energy(&mut self, control: &StepControl) -> f64 {
        let holds = !self.group.rows.is_empty() && !self.group.tree.holds_all();
        if !holds && self.group.force_length >= control.length {
            return 0.0;
        }
        let start = std::mem::take(&mut self.group.state);
        let (before, moving) = (self.energy(&start), self.kinetic_energy(&start));
        self.group.state = start;
        let after = self.end_energy() - self.group.projected;
        let works: f64 = self.group.end_state[2 * self.group.velocities()..].iter().sum();
        let lost = (after - before - works).abs();
        if lost == 0.0 {
            return 0.0;
        }
        let masses = self.group.bodies.iter().map(|&body| self.mass(body));
        let usual = control.speed * control.speed * masses.sum::<f64>();
        let moving = usual + moving + self.kinetic_energy(&self.group.end_state);
        let rounding = f64::EPSILON * (before.abs() + after.abs());
        lost / (LOST_ERRORS * control.local_error * moving + LOST_ROUNDINGS * rounding)
    }

    /// Energy [J] of the group's bodies in a state, as far as it has a potential.
    fn energy(&mut self, state: &[f64]) -> f64 {
        let count = self.group.bodies.len();
        let mut energy = self.kinetic_energy(state);
        for (place, &body) in self.group.bodies.iter().enumerate() {
            let pull = self.physics.mechanism.flyers[body.index()].law().acceleration;
            energy -= self.mass(body) * pull.dot(body_state(state, count, place).position);
        }
        if self.group.laws.is_empty() {
            return energy;
        }
        self.stage.load(&self.group.bodies, state);
        let now = Snapshot::new(self.start.seconds(), &self.stage.movings);
        let laws = self.group.laws.iter().map(|&law| &self.physics.laws[law]);
        energy + laws.filter_map(|law| law.potential(&now)).sum::<f64>()
    }

    fn kinetic_energy(&self, state: &[f64]) -> f64 {
        let count = self.group.bodies.len();
        let of_body = |(place, &body): (usize, &BodyId)| {
            let inertia = self.physics.mechanism.flyers[body.index()].body();
            let state = body_state(state, count, place);
            0.5 * state.velocity.length_squared() / inertia.inverse_mass
                + 0.5 * state.angular_velocity * state.angular_velocity / inertia.inverse_moment
        };
        self.group.bodies.iter().enumerate().map(of_body).sum()
    }

    /// Mass [kg] of a body.
    pub(crate) fn mass(&self, body: BodyId) -> f64 {
        self.physics.mechanism.flyers[body.index()].body().inverse_mass.recip()
    }
}
