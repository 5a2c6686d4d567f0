//! A group's next segment: a step that keeps to the active rows, projected, with the event that ends it early.
//!
//! The excess of a step is the largest of its errors beside the error estimate, each as a multiple of what is allowed:
//! the distance of its dense output from the active rows, the oscillation of the dense output, the energy it has lost.

use crate::ode::StiffnessEstimate;
use crate::rigid::group::attempt::StepFailure;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::tools::Tools;
use crate::rigid::shares::{ROUNDS, SEVERAL, WORTHWHILE};

/// Number of shorter steps that are tried if a step has an excess above 1.
const SHORTENINGS: u32 = 2;
/// Number of shorter steps that are tried as long as the excess is above [`SEVERAL`].
const DEEP_SHORTENINGS: u32 = 5;

impl Dynamics<'_> {
    /// Extends the group by a step whose dense output, if it is asked for, does not oscillate. Near a bifurcation point
    /// of a loop the step keeps to its rows and its energy, too.
    pub(crate) fn extend_unwatched(
        &mut self,
        tools: &mut Tools<'_>,
    ) -> Result<Option<StiffnessEstimate>, StepFailure> {
        let mut tries = 0;
        loop {
            let energy = self.extend(tools)?;
            let told = self.tell_stiffness(tools);
            let mut excess = told.map_or(0.0, |told| told.dense_error);
            if self.group.kept.nears_singular() {
                let at_end = self.stage.gap_error;
                self.make_dense(tools.stepper);
                self.stage.gap_error = at_end;
                let off = self.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
                excess = excess.max(off).max(self.lost_energy(&tools.settings.steps, energy));
            }
            if excess <= self.group.kept.allowance() || tries >= DEEP_SHORTENINGS {
                return Ok(told);
            }
            self.limit_next_step(tools.stepper.method().step_factor(excess));
            tries += 1;
        }
    }

    /// Makes the dense output of the last step, and notes the errors of the active gaps along it.
    pub(crate) fn complete(&mut self, tools: &mut Tools<'_>) {
        self.make_dense(tools.stepper);
        self.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
    }

    /// Extends the group by a step that keeps its energy, and whose dense output keeps to the active rows and does not
    /// oscillate: shorter steps are tried until one does. Returns the stiffness, if it was estimated.
    pub(crate) fn extend_on_rows(
        &mut self,
        tools: &mut Tools<'_>,
    ) -> Result<Option<StiffnessEstimate>, StepFailure> {
        let steps = tools.settings.steps;
        let is_free = !tools.settings.projection || !tools.stepper.method().is_adaptive();
        let (mut proposed, mut before) = (None, f64::INFINITY);
        let mut tries = 0;
        loop {
            let energy = self.extend(tools)?;
            self.make_dense(tools.stepper);
            let excess = self.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
            let proposed = *proposed.get_or_insert(self.group.next_step);
            let told = self.tell_stiffness(tools);
            if is_free {
                return Ok(told);
            }
            let swing = told.map_or(0.0, |told| told.dense_error);
            let excess = excess.max(swing).max(self.lost_energy(&steps, energy));
            let most = if excess < WORTHWHILE * before { ROUNDS } else { DEEP_SHORTENINGS };
            let is_worthwhile = excess > SEVERAL && tries < most;
            before = excess;
            if tries >= SHORTENINGS && excess > 1.0 && !is_worthwhile {
                // An error that shorter steps do not reduce is rounding, or comes from rows that contradict each other.
                self.group.next_step = proposed;
                return Ok(told);
            }
            self.limit_next_step(tools.stepper.method().step_factor(excess));
            if excess <= self.group.kept.allowance() {
                return Ok(told);
            }
            tries += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::shares::MINOR;
    use crate::rigid::test_scene::{FINE, rooms_of};
    use crate::time::Time;
    use glam::DVec2;
    use halfgap_collision::{Anchor, Body, BodyId, BodyState, Connector, ConnectorKind};
    use halfgap_geometry::Shape;

    /// A disc at the end of a rod of 1 m, which moves at 2 m/s.
    fn pendulum() -> Rooms {
        disc_on_rods(&[DVec2::ZERO])
    }

    /// A disc, moving at 2 m/s, on rods that end at several points.
    fn disc_on_rods(ends: &[DVec2]) -> Rooms {
        turning_disc_on_rods(ends, 2.0, 0.0)
    }

    /// A disc, moving at 2 m/s, on rods, with a spin [rad/s] that decays at a rate [1/s].
    fn turning_disc_on_rods(ends: &[DVec2], spin: f64, angular_rate: f64) -> Rooms {
        let disc = Shape::disc(0.5).expect("a fine radius");
        let body = Body { shape: disc, inverse_mass: 1.0, inverse_moment: 8.0, elasticity: 1.0 };
        let free_motion =
            FreeMotion { acceleration: DVec2::new(0.0, -10.0), angular_rate, ..FreeMotion::default() };
        let (position, velocity) = (DVec2::new(1.0, 0.0), DVec2::new(0.0, 2.0));
        let state = BodyState { position, velocity, angular_velocity: spin, ..BodyState::default() };
        let b = Anchor { body: BodyId(0), point: DVec2::ZERO };
        let rods = ends.iter().map(|&point| {
            let a = Anchor { body: BodyId::WORLD, point };
            let rod = ConnectorKind::Rod { a, b, length: point.distance(position) };
            Connector::new(rod, 0.0).expect("a fine rod")
        });
        let (bodies, connectors) = (vec![BodyPart::new(body, free_motion, state)], rods.collect());
        let parts = RigidParts { bodies, connectors, ..RigidParts::default() };
        rooms_of(parts, FINE, Time::ZERO)
    }

    #[test]
    fn the_energy_that_a_projection_takes_is_noted_once() {
        let mut rooms = pendulum();
        let mut group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        let taken = with_group(
            &rooms.assembly,
            &rooms.connectors,
            &mut rooms.groups,
            &mut group,
            |dynamics, tools| {
                dynamics.group.end_state[1] -= 0.1;
                [0, 1].map(|_| {
                    dynamics.end_on_rows(tools);
                    dynamics.group.projected
                })
            },
        );
        // A second projection finds the end on the rows.
        assert!(taken[0].abs() > 1e-4 && taken[1].abs() < 1e-9, "{taken:?}");
    }

    #[test]
    fn rows_that_all_but_depend_on_each_other_do_not_throw_their_bodies_about() {
        // Angle between the rods [rad].
        let angle: f64 = 1e-5;
        // Error of the second rod's length [m].
        let error: f64 = 1e-7;
        // Largest distance [m] by which the disc may move for that error.
        let way: f64 = 1e-5;
        let mut rooms = disc_on_rods(&[DVec2::ZERO, DVec2::new(0.0, angle)]);
        let mut group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        let moved = with_group(
            &rooms.assembly,
            &rooms.connectors,
            &mut rooms.groups,
            &mut group,
            |dynamics, tools| {
                dynamics.group.rows[1].gap += error;
                let before = dynamics.group.end_state.clone();
                dynamics.end_on_rows(tools);
                (dynamics.group.end_state[1] - before[1]).abs()
            },
        );
        // Correcting the lengths of both rods would take a centimetre across them.
        assert!(moved < way, "{moved} m");
    }

    #[test]
    fn a_shift_of_the_end_of_a_short_step_is_no_velocity() {
        let mut rooms = pendulum();
        let mut group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        group.next_step = Some(1e-9);
        let velocity = with_group(
            &rooms.assembly,
            &rooms.connectors,
            &mut rooms.groups,
            &mut group,
            |dynamics, tools| {
                dynamics.extend(tools).expect("it falls");
                // A projection might move the end by this distance: over this step it would be 1 m/s.
                dynamics.group.end_state[1] += 1e-9;
                dynamics.evaluate_end();
                dynamics.make_dense(tools.stepper);
                dynamics.end_by_dense(0.5e-9);
                dynamics.group.end_state[4]
            },
        );
        assert!((velocity - 2.0).abs() < 1e-7, "{velocity} m/s");
    }

    #[test]
    fn a_motion_that_swings_between_the_ends_of_a_step_makes_it_shorter() {
        // Rate [1/s] at which the spin decays.
        let rate: f64 = 1e6;
        // Product of that rate and the length of a step whose error estimate does not show the decay.
        let untold: f64 = 5.75;
        // Ten times the allowed error, which is less as damping takes energy: the disc moves at 2 m/s and has a radius of 0.5 m.
        let spin = 10.0 * MINOR * FINE.steps.local_error * 2.0 / 0.5;
        let mut rooms = turning_disc_on_rods(&[DVec2::ZERO], spin, rate);
        let mut group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        group.next_step = Some(untold / rate);
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            dynamics.extend(tools).expect("it decays");
            assert_eq!(dynamics.group.span, untold / rate);
            dynamics.group.next_step = Some(untold / rate);
            dynamics.extend_on_rows(tools).expect("it decays");
        });
        assert!(group.span < 0.8 * untold / rate, "{} s", group.span);
    }

    #[test]
    fn energy_that_a_step_loses_counts() {
        let mut rooms = pendulum();
        let mut group = rooms.groups.take(BodyId(0)).expect("it is in a group");
        let [kept, lost] = with_group(
            &rooms.assembly,
            &rooms.connectors,
            &mut rooms.groups,
            &mut group,
            |dynamics, tools| {
                let energy = dynamics.extend(tools).expect("it swings");
                let kept = dynamics.lost_energy(&tools.settings.steps, energy);
                // A loss like the work of rows that nearly depend on each other.
                dynamics.group.end_state[4] *= 1.0 - 1e-6;
                [kept, dynamics.lost_energy(&tools.settings.steps, None)]
            },
        );
        assert!(kept < 1.0 && lost > 1.0, "{kept}, {lost}");
    }
}
