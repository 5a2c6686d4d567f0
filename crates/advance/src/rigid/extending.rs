//! A group's next segment as it is used: a step that keeps to the held rows, projected, with what ends it early.

use super::dynamics::Dynamics;
use super::segment::StepFailure;
use super::system::RigidSettings;
use crate::ode::Stepper;

/// Cap on the shorter steps tried for one that keeps to its rows.
const MOST_SHORTENINGS: usize = 2;

/// What a group's stepping uses beside its dynamics.
pub(crate) struct Tools<'a> {
    pub(crate) stepper: &'a mut Stepper,
    pub(crate) scales: &'a mut Vec<f64>,
    pub(crate) settings: &'a RigidSettings,
}

impl Dynamics<'_> {
    /// Extends the group by a step, with what ends it early.
    pub(crate) fn extend_watched(&mut self, tools: &mut Tools<'_>) -> Result<(), StepFailure> {
        if !self.group.is_unwatched {
            self.extend_on_rows(tools)?;
            self.note_stiffness(tools);
            self.group.event = self.find_event();
            return Ok(());
        }
        self.extend(tools.stepper, &tools.settings.steps, tools.scales)?;
        self.end_on_rows(tools);
        self.evaluate_end();
        self.note_stiffness(tools);
        self.follow_rails();
        self.limit_next_step(tools.stepper.method().step_factor(0.0));
        (self.group.event, self.group.largest_error) = (None, self.stage.gap_error);
        Ok(())
    }

    /// Makes the dense output of the last step.
    pub(crate) fn complete(&mut self, tools: &mut Tools<'_>) {
        self.make_dense(tools.stepper);
        self.inner_excess(tools.settings.tolerances.accuracy);
    }

    /// Extends the group by a step whose dense output keeps to the held rows, too: shorter ones are tried until it does.
    fn extend_on_rows(&mut self, tools: &mut Tools<'_>) -> Result<(), StepFailure> {
        let steps = tools.settings.steps;
        let is_free = !tools.settings.projection || !tools.stepper.method().is_adaptive();
        let mut proposed = None;
        for tries in 0.. {
            self.extend(tools.stepper, &steps, tools.scales)?;
            self.end_on_rows(tools);
            self.evaluate_end();
            self.follow_rails();
            self.make_dense(tools.stepper);
            let excess = self.inner_excess(tools.settings.tolerances.accuracy);
            let proposed = *proposed.get_or_insert(self.group.next_step);
            if is_free {
                break;
            }
            if tries == MOST_SHORTENINGS && excess > 1.0 {
                // What shorter steps do not mend is rounding, or rows that contradict each other.
                self.group.next_step = proposed;
                break;
            }
            self.limit_next_step(tools.stepper.method().step_factor(excess));
            if excess <= 1.0 {
                break;
            }
        }
        Ok(())
    }

    /// Projects the end onto the held rows and notes what energy that took.
    pub(crate) fn end_on_rows(&mut self, tools: &Tools<'_>) {
        let settings = tools.settings;
        self.group.projected = 0.0;
        if self.group.rows.is_empty() || !(settings.projection || settings.joint_small_impacts) {
            return;
        }
        let before = self.end_energy();
        if settings.projection {
            self.project_end(settings.steps.length);
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
}
