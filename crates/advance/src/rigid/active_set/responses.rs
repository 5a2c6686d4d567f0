//! What the forces of the last solve do to the bodies of a region.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::for_each_push;
use crate::rigid::region::touching::Region;
use halfgap_collision::BodyId;
use halfgap_contact::InverseInertia;

impl Settling {
    /// Adds the accelerations M^-1 J^T f that the forces of the last solve, those of `records`, give the region's
    /// bodies.
    pub(crate) fn add_responses(
        &self,
        region: &Region,
        records: &[usize],
        inertia: impl Fn(BodyId) -> InverseInertia,
        sums: &mut [[f64; 3]],
    ) {
        let mut push = |sides: [BodyId; 2], j: &[f64; 6], force: f64| {
            for (side, body) in sides.into_iter().enumerate() {
                let Some(place) = region.place(body) else { continue };
                let InverseInertia { inverse_mass, inverse_moment } = inertia(body);
                for (k, weight) in [inverse_mass, inverse_mass, inverse_moment].into_iter().enumerate() {
                    sums[place][k] += weight * j[3 * side + k] * force;
                }
            }
        };
        for (&index, &force) in records.iter().zip(&self.solution.force) {
            let record = &region.records()[index];
            push(record.bodies(), &record.motion.kinematics.jacobian, force);
        }
        for_each_push(self, |place, j, force| push(region.records()[records[place]].bodies(), j, force));
        for pull in &self.pulls {
            let force = pull.number.and_then(|number| self.solution.force.get(number));
            if let Some(&force) = force {
                push(pull.bodies, &pull.row.kinematics.jacobian, force);
            }
        }
        for (&index, &force) in records.iter().zip(&self.solution.force) {
            if let Some((body, j)) = region.records()[index].parties.third
                && let Some(place) = region.place(body)
            {
                sums[place][2] += inertia(body).inverse_moment * j * force;
            }
        }
    }
}
