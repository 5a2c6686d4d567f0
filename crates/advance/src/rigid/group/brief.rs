//! The method of a group's steps: the one asked for or, in place of the default one, the method of order 5, which has
//! half as many stages. It serves where a higher order gains little: between events that follow each other fast (brief
//! steps), and over the kinks of a spline with many points. Implicit steps are in `stiff`.

use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::{BRIEF_METHOD, Stepping};
use crate::rigid::group::stiffness::Stiffness;
use crate::time::Time;

/// Least length of a brief step, as a fraction of a full one: to cut a step short costs less than to make very many.
pub(crate) const BRIEFEST: f64 = 1.0 / 32.0;

/// Factor by which a full step is shortened if an event is expected to cut it: its error is then so small that it can
/// be cut by its dense output, and need not be repeated up to the event.
pub(crate) const CUT_SHARE: f64 = 0.6;

/// A group stays brief while the errors of its steps allow them to grow by this factor.
const BRIEF_GROWTH: f64 = 1.9;

/// Experience with the last group of a body, from which its next group starts.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Past {
    /// Length [s] of the next step that was proposed, by the method asked for.
    pub(super) step: Option<f64>,
    /// Time [s] for which the group lasted.
    pub(super) lasted: f64,
    pub(super) stiffness: Stiffness,
}

impl Past {
    /// The experience with a group that ends now.
    pub(crate) fn of(group: &Group, now: Time) -> Self {
        let step = if group.is_brief { group.full_step } else { group.next_step };
        let (lasted, stiffness) = (now.since(group.made), group.stiffness);
        Self { step, lasted, stiffness }
    }
}

impl Group {
    /// The stepper by which its steps are made.
    pub(crate) fn stepping(&self) -> Stepping {
        if self.is_brief {
            Stepping::Brief
        } else if self.stiffness.is_stiff && !self.is_determined() {
            Stepping::Stiff
        } else if self.has_kinks {
            Stepping::Brief
        } else {
            Stepping::Asked
        }
    }

    /// Returns to the method asked for, if errors or the fastest rate of the group hold brief steps up.
    pub(crate) fn end_brief(&mut self) {
        if !self.is_brief {
            return;
        }
        let grows = self.accepted.is_some_and(|step| BRIEF_METHOD.step_factor(step.error) >= BRIEF_GROWTH);
        let is_allowed = self.next_step.is_none_or(|step| self.stiffness.allows(step));
        if !(grows && is_allowed) {
            self.is_brief = false;
            self.next_step = self.full_step;
            self.accepted = None;
        }
    }
}

impl Past {}
