//! Gaps of rows as a group starts: lifted ones that contradict others, and idle ones that a projection has moved.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use crate::rigid::remedies::Remedy;

impl Dynamics<'_> {
    /// Lowers the least gaps of contacts that are touched without force to where the end of the segment has them: the
    /// projection onto the held rows may have moved their bodies, and a contact that starts below its least gap is not
    /// seen to sink.
    pub(crate) fn lower_idle(&mut self) {
        let Group { bodies, end_state, idle, .. } = &mut *self.group;
        if idle.is_empty() {
            return;
        }
        self.stage.load(bodies, end_state);
        let mechanism = &self.physics.mechanism;
        for row in idle {
            let gap = mechanism.gap(row, &self.stage.movings);
            let lower = gap - mechanism.tolerances.sink();
            if lower < row.gap && self.physics.remedies.act(Remedy::IdleLowered) {
                row.set_gap(lower);
            }
        }
    }

    /// Sets the held gaps of contacts to their present ones if lifting some has not brought them to their gaps: where
    /// rows contradict each other, each step would be thrown off anew.
    pub(crate) fn leave_lifted(&mut self) {
        let Group { bodies, end_state, rows, .. } = &mut *self.group;
        if !rows.iter().any(|row| row.is_lifted) {
            return;
        }
        self.stage.load(bodies, end_state);
        let mechanism = &self.physics.mechanism;
        for row in rows.iter_mut().filter(|row| !row.bilateral) {
            let gap = mechanism.gap(row, &self.stage.movings);
            if (gap - row.gap).abs() > mechanism.tolerances.sink()
                && self.physics.remedies.act(Remedy::LiftedLeft)
            {
                row.set_gap(gap);
            }
        }
    }
}
