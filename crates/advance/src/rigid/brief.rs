//! How the steps of a group are made: by the method that is asked for, or, in place of the default one, by the method of
//! order 5, which has half as many stages. That serves where a higher order gains nothing: between events that come fast
//! one after another, and over the kinks of a spline.

use super::group::Group;
use super::rows::RowSource;
use super::system::RigidSystem;
use crate::ode::Method;
use crate::time::Time;

/// A group whose bodies' last lasted less than a step by this factor is expected to be brief, too.
const BRIEF: f64 = 4.0;

/// A brief step is at least this part of a full one: to be cut short later costs less than to go on too often.
const BRIEFEST: f64 = 1.0 / 32.0;

/// A group stays brief while its steps may grow by this factor.
const BRIEF_GROWTH: f64 = 1.9;

/// What the next group of a body may learn from its last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Past {
    /// Step [s] that was right.
    step: Option<f64>,
    /// How long [s] the group lasted.
    lasted: f64,
}

impl Past {
    /// Of a group that ends now.
    pub(crate) fn of(group: &Group, now: Time) -> Self {
        let step = if group.is_brief { group.full_step } else { group.next_step };
        Self { step, lasted: now.since(group.made) }
    }
}

impl Group {
    /// True if its steps are made by the method of fewer stages.
    pub(crate) fn has_few_stages(&self) -> bool {
        self.is_brief || self.has_kinks
    }

    /// Goes back to the method that is asked for, if brief steps are held up by their errors.
    pub(crate) fn end_brief(&mut self, method: Method) {
        let grows = self.accepted.is_some_and(|step| method.step_factor(step.error) >= BRIEF_GROWTH);
        if self.is_brief && !grows {
            self.is_brief = false;
            self.next_step = self.full_step;
            self.accepted = None;
        }
    }
}

impl RigidSystem {
    /// Chooses the first step of a group, and whether its steps have few stages, by what its bodies did last.
    pub(crate) fn foresee(&self, group: &mut Group) {
        let pasts = group.bodies.iter().map(|body| self.groups.past_of[body.index()]);
        group.next_step = pasts.clone().filter_map(|past| past.step).min_by(f64::total_cmp);
        if self.settings.method != Method::default() {
            return;
        }
        group.has_kinks = group.rows.iter().any(|row| match row.source {
            RowSource::Connector(id, _) => self.connector(id).path().is_some_and(|path| path.is_spline()),
            RowSource::Contact(_) => false,
        });
        let soon = BRIEF * pasts.map(|past| past.lasted).fold(0.0, f64::max);
        if let Some(step) = group.next_step.filter(|&step| !group.has_kinks && BRIEF * soon < step) {
            group.is_brief = true;
            (group.next_step, group.full_step) = (Some(soon.max(BRIEFEST * step)), Some(step));
        }
    }
}
