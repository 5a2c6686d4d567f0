//! Gravity between all bodies of a list.

use super::{ForceLaw, Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::BodyId;

/// Attraction of G m1 m2/r^2 [N] between the centres of mass of every two bodies, at least one of which is movable.
///
/// One law holds for all of them: every body pulls every other, so they share their steps anyway. It has the potential
/// -sum G m1 m2/r [J]. Two centres at one point, where neither force nor potential exists, do not attract each other.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct MutualGravity {
    name: String,
    /// G [m^3/(kg s^2)].
    strength: f64,
    /// The movable bodies first.
    bodies: Vec<BodyId>,
    /// Mass of each [kg].
    masses: Vec<f64>,
    movable: usize,
}

impl MutualGravity {
    /// Makes the law of a strength G [m^3/(kg s^2)] between movable and fixed bodies, each with its mass [kg], with a
    /// name for messages.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        strength: f64,
        movable: &[(BodyId, f64)],
        fixed: &[(BodyId, f64)],
    ) -> Self {
        let (bodies, masses) = movable.iter().chain(fixed).copied().unzip();
        Self { name: name.into(), strength, bodies, masses, movable: movable.len() }
    }

    /// Calls `visit` for each pair of bodies, with their places in the list, the offset from the first to the second
    /// [m], and G m1 m2 [N m^2]; pairs at one point are left out.
    fn visit_pairs(&self, now: &Snapshot<'_>, mut visit: impl FnMut([usize; 2], DVec2, f64)) {
        for i in 0..self.movable {
            let position = now.body(self.bodies[i]).pose.position;
            for j in i + 1..self.bodies.len() {
                let offset = now.body(self.bodies[j]).pose.position - position;
                if offset != DVec2::ZERO {
                    visit([i, j], offset, self.strength * self.masses[i] * self.masses[j]);
                }
            }
        }
    }
}

impl ForceLaw for MutualGravity {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        self.visit_pairs(now, |[i, j], offset, strength| {
            let square = offset.length_squared();
            let force = offset * (strength / (square * square.sqrt()));
            wrenches.add_force(self.bodies[i], force, DVec2::ZERO);
            wrenches.add_force(self.bodies[j], -force, DVec2::ZERO);
        });
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let mut sum = 0.0;
        self.visit_pairs(now, |_, offset, strength| sum -= strength / offset.length());
        Some(sum)
    }

    fn length(&self, now: &Snapshot<'_>) -> Option<f64> {
        let mut least = f64::INFINITY;
        self.visit_pairs(now, |_, offset, _| least = least.min(offset.length_squared()));
        Some(least.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{Pushed, assert_gradient, assert_pushes_cancel, states, wrenches};
    use super::*;

    fn law() -> MutualGravity {
        let movable = [(BodyId(0), 2.0), (BodyId(1), 3.0)];
        MutualGravity::new("gravity", 1.5, &movable, &[(BodyId(2), 50.0)])
    }

    #[test]
    fn forces_are_minus_the_gradient_of_the_potential() {
        assert_gradient(&law(), &states());
    }

    #[test]
    fn forces_and_torques_cancel() {
        assert_pushes_cancel(&law(), &states());
    }

    #[test]
    fn the_pull_is_the_inverse_square() {
        let mut states = states();
        states[0].position = DVec2::new(1.0, 1.0);
        states[1].position = DVec2::new(4.0, 5.0);
        let only_two = MutualGravity::new("", 1.5, &[(BodyId(0), 2.0), (BodyId(1), 3.0)], &[]);
        let Pushed { force, torque, .. } = wrenches(&only_two, &states)[0];
        assert!((force - DVec2::new(0.6, 0.8) * (9.0 / 25.0)).length() < 1e-15 && torque == 0.0);
    }

    #[test]
    fn the_pull_varies_over_the_least_distance() {
        let mut states = states();
        states[0].position = DVec2::new(1.0, 1.0);
        states[1].position = DVec2::new(1.3, 1.4);
        states[2].position = DVec2::new(10.0, 10.0);
        let least = law().length(&Snapshot::new(0.0, &states.map(|state| (&state).into())));
        assert!(least.is_some_and(|least| (least - 0.5).abs() < 1e-15), "{least:?}");
    }

    #[test]
    fn fixed_bodies_do_not_attract_each_other() {
        let law = MutualGravity::new("", 1.0, &[], &[(BodyId(0), 1.0), (BodyId(1), 1.0)]);
        assert_eq!(law.potential(&Snapshot::new(0.0, &states().map(|state| (&state).into()))), Some(0.0));
    }

    #[test]
    fn bodies_at_one_point_do_not_attract_each_other() {
        let mut states = states();
        states[1].position = states[0].position;
        let sums = wrenches(&law(), &states);
        assert!(sums.iter().all(|sum| sum.force.is_finite()));
        // Only the third body attracts.
        let third = MutualGravity::new("", 1.5, &[(BodyId(0), 2.0)], &[(BodyId(2), 50.0)]);
        assert_eq!(sums[0], wrenches(&third, &states)[0]);
    }
}
