//! Damping between two points, along the line between them.

use super::anchor::{Between, bodies_of};
use super::{ForceLaw, Snapshot, Wrenches};
use halfgap_collision::{Anchor, BodyId};

/// A dashpot between two points: a force of -damping times the rate of their distance [N], along the line between them.
///
/// Where the points coincide the line has no direction, and the dashpot exerts no force.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Dashpot {
    name: String,
    ends: [Anchor; 2],
    damping: f64,
    bodies: Vec<BodyId>,
}

impl Dashpot {
    /// Makes the dashpot of a damping [N s/m] between two points, with a name for messages and the ledger.
    #[must_use]
    pub fn new(name: impl Into<String>, ends: [Anchor; 2], damping: f64) -> Self {
        Self { name: name.into(), ends, damping, bodies: bodies_of(&ends) }
    }
}

impl ForceLaw for Dashpot {
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
            let rate = direction.dot(between.a.velocity - between.b.velocity);
            between.pull(&self.ends, -self.damping * rate * direction, wrenches);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{assert_pushes_cancel, power, states, wrenches};
    use super::*;
    use glam::DVec2;

    fn ends() -> [Anchor; 2] {
        [
            Anchor { body: BodyId(0), point: DVec2::new(0.3, -0.2) },
            Anchor { body: BodyId(1), point: DVec2::new(-0.1, 0.7) },
        ]
    }

    #[test]
    fn forces_and_torques_cancel() {
        assert_pushes_cancel(&Dashpot::new("", ends(), 2.0), &states());
    }

    #[test]
    fn it_takes_damping_times_the_square_of_the_rate() {
        let states = states();
        let length = |time: f64| {
            let moved = states.map(|mut state| {
                state.position += time * state.velocity;
                state.angle += time * state.angular_velocity;
                (&state).into()
            });
            Between::of(&ends(), &Snapshot::new(0.0, &moved)).length
        };
        const STEP: f64 = 1e-5;
        let rate = (length(STEP) - length(-STEP)) / (2.0 * STEP);
        let power = power(&Dashpot::new("", ends(), 2.0), &states);
        assert!((power + 2.0 * rate * rate).abs() < 1e-8 * rate * rate, "{power} W at {rate} m/s");
    }

    #[test]
    fn only_the_rate_of_the_length_is_damped() {
        let mut states = states();
        let center = |body| Anchor { body, point: DVec2::ZERO };
        let law = Dashpot::new("", [center(BodyId(0)), center(BodyId(1))], 2.0);
        states[0].position = DVec2::new(1.0, 0.0);
        states[1].position = DVec2::ZERO;
        states[0].velocity = DVec2::new(0.0, 5.0);
        states[1].velocity = DVec2::ZERO;
        assert_eq!(wrenches(&law, &states)[0].force, DVec2::ZERO);
        states[1].position = states[0].position;
        assert_eq!(wrenches(&law, &states)[0].force, DVec2::ZERO, "without a length");
    }
}
