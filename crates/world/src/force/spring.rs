//! An elastic spring between two points.

use super::anchor::{Between, bodies_of};
use super::{ForceLaw, Snapshot, Wrenches};
use halfgap_collision::{Anchor, BodyId};

/// A spring that pulls its two points together with stiffness (length - rest length) [N], or pushes them apart where it
/// is shorter.
///
/// It has the potential stiffness (length - rest length)^2/2 [J]. Where its points coincide it has no direction and
/// exerts no force; with a rest length of 0 that is the limit from all sides.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Spring {
    name: String,
    ends: [Anchor; 2],
    rest_length: f64,
    stiffness: f64,
    bodies: Vec<BodyId>,
}

impl Spring {
    /// Makes the spring of a rest length [m] and a stiffness [N/m] between two points, with a name for messages.
    #[must_use]
    pub fn new(name: impl Into<String>, ends: [Anchor; 2], rest_length: f64, stiffness: f64) -> Self {
        Self { name: name.into(), ends, rest_length, stiffness, bodies: bodies_of(&ends) }
    }
}

impl ForceLaw for Spring {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn ends(&self) -> Option<[Anchor; 2]> {
        Some(self.ends)
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let between = Between::of(&self.ends, now);
        if let Some(direction) = between.direction() {
            // The first term has no direction to lose: with a rest length of 0 it is smooth through length 0.
            let force = -self.stiffness * (between.offset - self.rest_length * direction);
            between.pull(&self.ends, force, wrenches);
        }
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let stretch = Between::of(&self.ends, now).length - self.rest_length;
        Some(0.5 * self.stiffness * stretch * stretch)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{assert_gradient, assert_pushes_cancel, states, wrenches};
    use super::*;
    use glam::DVec2;

    fn spring(rest_length: f64) -> Spring {
        let a = Anchor { body: BodyId(0), point: DVec2::new(0.3, -0.2) };
        let b = Anchor { body: BodyId(1), point: DVec2::new(-0.1, 0.7) };
        Spring::new("spring", [a, b], rest_length, 4.0)
    }

    #[test]
    fn forces_are_minus_the_gradient_of_the_potential() {
        for rest_length in [0.0, 0.5, 20.0] {
            assert_gradient(&spring(rest_length), &states());
        }
        let to_the_wall = Anchor { body: BodyId::WORLD, point: DVec2::new(3.0, 1.0) };
        let wall = Spring::new("", [to_the_wall, spring(1.0).ends[1]], 1.0, 4.0);
        assert_gradient(&wall, &states());
    }

    #[test]
    fn forces_and_torques_cancel() {
        assert_pushes_cancel(&spring(0.5), &states());
    }

    #[test]
    fn a_stretched_spring_pulls_and_a_compressed_one_pushes() {
        let wall = Anchor { body: BodyId::WORLD, point: DVec2::ZERO };
        let center = Anchor { body: BodyId(0), point: DVec2::ZERO };
        let law = Spring::new("", [center, wall], 2.0, 10.0);
        let mut states = states();
        for (length, force) in [(3.0, -10.0), (1.5, 5.0), (2.0, 0.0)] {
            states[0].position = DVec2::new(length, 0.0);
            assert_eq!(wrenches(&law, &states)[0].force, DVec2::new(force, 0.0));
        }
    }

    #[test]
    fn a_spring_without_length_exerts_no_force() {
        let wall = Anchor { body: BodyId::WORLD, point: DVec2::new(1.0, 2.0) };
        let center = Anchor { body: BodyId(0), point: DVec2::ZERO };
        let mut states = states();
        states[0].position = wall.point;
        for rest_length in [0.0, 2.0] {
            let law = Spring::new("", [center, wall], rest_length, 10.0);
            assert_eq!(wrenches(&law, &states)[0].force, DVec2::ZERO);
        }
    }

    #[test]
    fn it_names_each_body_once_and_never_the_background() {
        let wall = Anchor { body: BodyId::WORLD, point: DVec2::ZERO };
        let center = Anchor { body: BodyId(4), point: DVec2::ZERO };
        assert_eq!(Spring::new("", [center, wall], 0.0, 1.0).bodies(), [BodyId(4)]);
        assert_eq!(Spring::new("", [center, center], 0.0, 1.0).bodies(), [BodyId(4)]);
    }
}
