//! The energy of a group in a state, its change by a projection, and its loss in a step.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::tools::Tools;
use crate::rigid::settings::StepControl;
use crate::rigid::shares::{HUGE, MAJOR};
use halfgap_collision::BodyId;

/// Energy [J] of a group's bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energy {
    /// Kinetic and potential energy; forces without a potential do not count.
    total: f64,
    /// Kinetic energy.
    kinetic: f64,
}

impl Dynamics<'_> {
    /// Projects the end onto the active rows and notes the change of energy. Returns the energy at the end, if it was
    /// projected.
    pub(crate) fn end_on_rows(&mut self, tools: &Tools<'_>) -> Option<Energy> {
        let settings = tools.settings;
        self.group.projected = 0.0;
        let needs_none = self.group.rows.is_empty() || self.group.tree.holds_all();
        if needs_none || !(settings.projection || settings.joint_small_impacts) {
            return None;
        }
        let before = self.end_energy();
        if settings.projection {
            self.project_end(&settings.steps);
        } else {
            self.fit_joint_velocities();
        }
        let after = self.end_energy();
        self.group.projected = after.total - before.total;
        Some(after)
    }

    fn end_energy(&mut self) -> Energy {
        let end = std::mem::take(&mut self.group.end_state);
        let energy = self.energy(&end, self.group.span);
        self.group.end_state = end;
        energy
    }

    /// Energy that the last step has lost or gained, as a multiple [-] of what it may; 0 where the error estimate shows
    /// all errors. `end` is the energy at its end, if it is known.
    pub(crate) fn lost_energy(&mut self, control: &StepControl, end: Option<Energy>) -> f64 {
        let holds = !self.group.rows.is_empty() && !self.group.tree.holds_all();
        if !holds && self.group.force_length >= control.length {
            return 0.0;
        }
        let start = std::mem::take(&mut self.group.state);
        let before = self.energy(&start, 0.0);
        self.group.state = start;
        let end = end.unwrap_or_else(|| self.end_energy());
        let after = end.total - self.group.projected;
        let works: f64 = self.group.end_state[2 * self.group.velocities()..].iter().sum();
        let lost = (after - before.total - works).abs();
        if lost == 0.0 {
            return 0.0;
        }
        let masses = self.group.bodies.iter().map(|&body| self.mass(body));
        let usual = control.speed * control.speed * masses.sum::<f64>();
        let moving = usual + before.kinetic + end.kinetic;
        let rounding = f64::EPSILON * (before.total.abs() + after.abs());
        // Where rows nearly depend on each other, or near a centre of attraction, errors that are rounding elsewhere do
        // work, and no error estimate shows it.
        lost / (MAJOR * control.local_error * moving + HUGE * rounding)
    }

    /// Energy of the group's bodies in a state, with what is moved at an offset [s] of the segment.
    fn energy(&mut self, state: &[f64], offset: f64) -> Energy {
        let count = self.group.bodies.len();
        let kinetic = self.kinetic_energy(state);
        let mut total = kinetic;
        for (place, &body) in self.group.bodies.iter().enumerate() {
            let pull = self.physics.mechanism.trajectories[body.index()].free_motion().acceleration;
            total -= self.mass(body) * pull.dot(body_state(state, count, place).position);
        }
        if self.group.force_laws.is_empty() {
            return Energy { total, kinetic };
        }
        self.stage.load(&self.group.bodies, state);
        self.place_moved(offset);
        let now = self.physics.snapshot(self.start.seconds(), &self.stage.movings);
        let force_laws = self.group.force_laws.iter().map(|&law| &self.physics.force_laws[law]);
        total += force_laws.filter_map(|law| law.potential(&now)).sum::<f64>();
        Energy { total, kinetic }
    }

    fn kinetic_energy(&self, state: &[f64]) -> f64 {
        let count = self.group.bodies.len();
        let bodies =
            self.group.bodies.iter().map(|body| self.physics.mechanism.trajectories[body.index()].body());
        bodies.enumerate().map(|(place, body)| body.kinetic_energy(&body_state(state, count, place))).sum()
    }

    /// Mass [kg] of a body.
    pub(crate) fn mass(&self, body: BodyId) -> f64 {
        self.physics.mechanism.trajectories[body.index()].body().inverse_mass.recip()
    }
}
