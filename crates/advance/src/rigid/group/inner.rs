//! Errors of active rows between the ends of a step, where dense output is less exact.

use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::settings::StepControl;
use crate::rigid::shares::HALF_ZONE;

impl Dynamics<'_> {
    /// Largest error of active rows between the ends of the segment, where dense output is less exact, as a multiple of
    /// the allowed one: for contacts such that nothing overlaps and none is missed, for connectors by the error that
    /// steps may make. Notes the largest error of a connector and the least gap of a contact.
    pub(crate) fn inner_excess(&mut self, accuracy: f64, steps: &StepControl) -> f64 {
        (self.group.largest_error, self.group.least_gap) = (0.0, None);
        let (least, most) = (HALF_ZONE * accuracy, INNER_ERRORS * steps.local_error * steps.length);
        let mut excess = 0.0f64;
        if self.group.rows.is_empty() {
            return excess;
        }
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        for &part in if any_contact { &INNER[..] } else { &INNER[..1] } {
            self.put_at(part * self.group.span);
            for row in self.group.rows.iter().filter(|row| matches!(row.source, RowSource::Contact(_))) {
                let gap = self.physics.mechanism.gap(row, &self.stage.movings);
                excess = excess.max((gap - row.gap).abs() / least);
                self.group.least_gap = Some(self.group.least_gap.map_or(gap, |least| least.min(gap)));
            }
            self.group.largest_error = self.group.largest_error.max(self.connector_error());
        }
        excess.max(self.group.largest_error / most.max(least))
    }
}

/// Error of a connector within a step that is allowed, as a multiple of the error of a step: dense output errs some
/// tens of times more than the ends of steps, and much more where connectors determine angles poorly.
const INNER_ERRORS: f64 = 50.0;

/// Places in a step, as fractions of it, at which the errors of contacts are read; those of connectors are read at the
/// first. Errors often change sign in the middle: there are two more.
const INNER: [f64; 3] = [0.5, 0.3, 0.7];
