//! Thresholds by which rest and depth are judged.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::shares::{LARGE, NEGLIGIBLE, ROUNDED, TINY};
use halfgap_collision::{BodyId, Collision, Tolerances};

impl Assembly {
    /// Largest rate [m/s] at which a row counts as neither closing nor opening.
    pub(crate) fn rest_speed(&self) -> f64 {
        self.settings.rest_speed
    }

    /// Largest slip speed [m/s] that is rounding, or rest.
    pub(crate) fn slip_rest(&self) -> f64 {
        self.rest_speed().max(ROUNDED * self.settings.steps.speed)
    }

    /// Largest rate [m/s] at which a touching contact counts as resting at the start: with it, a contact leaves the
    /// target zone more slowly than forces can be resolved. Bodies that have come to rest elsewhere may come with that
    /// much.
    pub(crate) fn start_rest(&self) -> f64 {
        let Tolerances { accuracy, velocity_tol, .. } = self.settings.tolerances;
        (accuracy / self.settings.resolution_time).min(velocity_tol).max(self.rest_speed())
    }

    /// Largest rate [m/s] at which one contact counts as resting at the start. A contact that slides faster than
    /// `start_rest` has not come to rest, and would be stopped where normals differ: for it this is the rest speed.
    pub(crate) fn start_rest_of(&self, record: &Collision) -> f64 {
        let rest = self.start_rest();
        if record.motion.lateral_velocity.abs() <= rest { rest } else { self.rest_speed() }
    }

    /// Rate [m/s] up to which a row is at rest in an accumulation. Contacts that are pressed, but of which rounding lets now
    /// the one, now the other open, would go on for ever; at this rate none leaves the target zone before the accumulation is
    /// over.
    pub(crate) fn accumulation_rest(&self) -> f64 {
        let Tolerances { accuracy, velocity_tol, .. } = self.settings.tolerances;
        let slow = (NEGLIGIBLE * accuracy / self.settings.resolution_time).min(LARGE * velocity_tol);
        slow.max(self.rest_speed())
    }

    /// Distance [m] by which a contact without force may sink before it fires again.
    pub(crate) fn sink(&self) -> f64 {
        self.settings.tolerances.sink()
    }

    /// Gap [m] at which a contact without force fires again, by its present gap [m].
    pub(crate) fn refire_gap(&self, gap: f64) -> f64 {
        (gap - self.sink()).min(self.settings.tolerances.target_gap)
    }

    /// True if the target zone between two bodies is so wide relative to them that their place in it can be seen.
    pub(crate) fn is_zone_seen(&self, bodies: [BodyId; 2]) -> bool {
        self.settings.tolerances.accuracy > TINY * self.largest_reach(bodies)
    }

    /// The acceleration of the scene [m/s^2]; zero if only contacts and connectors exert forces.
    pub(crate) fn acceleration(&self) -> f64 {
        if self.is_forceless {
            0.0
        } else {
            self.settings.tolerances.velocity_tol / self.settings.resolution_time
        }
    }
}
