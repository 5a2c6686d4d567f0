//! A spring and a damper between the angles of two bodies.

use super::{ForceLaw, Snapshot, Wrenches};
use halfgap_collision::BodyId;

/// A torsion spring: a torque of stiffness (angle - rest angle) [N m] that turns two bodies towards a rest angle, where the angle is
/// that of the second body less that of the first, whole turns counted.
///
/// It has the potential stiffness (angle - rest angle)^2/2 [J].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct TorsionSpring {
    name: String,
    ends: [BodyId; 2],
    rest_angle: f64,
    stiffness: f64,
    bodies: Vec<BodyId>,
}

impl TorsionSpring {
    /// Makes the spring of a rest angle [rad] and a stiffness [N m] between two bodies, of which one may be [`BodyId::WORLD`], with a
    /// name for messages.
    #[must_use]
    pub fn new(name: impl Into<String>, ends: [BodyId; 2], rest_angle: f64, stiffness: f64) -> Self {
        Self { name: name.into(), ends, rest_angle, stiffness, bodies: movable(ends) }
    }

    /// Angle of the second body less that of the first, less the rest angle [rad].
    fn twist(&self, now: &Snapshot<'_>) -> f64 {
        let [a, b] = self.ends.map(|body| now.body(body).angle);
        b - a - self.rest_angle
    }
}

impl ForceLaw for TorsionSpring {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let torque = self.stiffness * self.twist(now);
        wrenches.add_torque(self.ends[0], torque);
        wrenches.add_torque(self.ends[1], -torque);
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let twist = self.twist(now);
        Some(0.5 * self.stiffness * twist * twist)
    }
}

/// A torsion damper: a torque of damping times the difference of the angular velocities of two bodies [N m], against it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct TorsionDamper {
    name: String,
    ends: [BodyId; 2],
    damping: f64,
    bodies: Vec<BodyId>,
}

impl TorsionDamper {
    /// Makes the damper of a damping [N m s] between two bodies, of which one may be [`BodyId::WORLD`], with a name for messages and
    /// the ledger.
    #[must_use]
    pub fn new(name: impl Into<String>, ends: [BodyId; 2], damping: f64) -> Self {
        Self { name: name.into(), ends, damping, bodies: movable(ends) }
    }
}

impl ForceLaw for TorsionDamper {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let [a, b] = self.ends.map(|body| now.body(body).angular_velocity);
        let torque = self.damping * (b - a);
        wrenches.add_torque(self.ends[0], torque);
        wrenches.add_torque(self.ends[1], -torque);
    }
}

fn movable(ends: [BodyId; 2]) -> Vec<BodyId> {
    ends.into_iter().filter(|body| !body.is_world()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{power, states, wrenches};
    use super::*;

    #[test]
    fn torques_are_minus_the_gradient_of_the_potential_and_opposite() {
        let law = TorsionSpring::new("spring", [BodyId(0), BodyId(1)], 0.3, 4.0);
        let [a, b, _] = wrenches(&law, &states());
        // The second body lies at -2 rad, the first at 0.4 rad.
        assert!((b.torque - 4.0 * 2.7).abs() < 1e-14 && a.torque == -b.torque, "{} {}", a.torque, b.torque);
        let moving = |states: &[halfgap_collision::BodyState; 3]| states.map(|state| (&state).into());
        let energy = |angle: f64| {
            let mut states = states();
            states[1].angle += angle;
            law.potential(&Snapshot::new(0.0, &moving(&states))).expect("it has one")
        };
        let slope = (energy(1e-4) - energy(-1e-4)) / 2e-4;
        assert!((slope + b.torque).abs() < 1e-7, "{slope}");
        let world = TorsionSpring::new("", [BodyId::WORLD, BodyId(1)], 0.3, 4.0);
        assert_eq!(world.bodies(), [BodyId(1)]);
        assert!((wrenches(&world, &states())[1].torque - 4.0 * 2.3).abs() < 1e-14);
    }

    #[test]
    fn a_damper_takes_energy_by_the_square_of_the_speed() {
        let law = TorsionDamper::new("damper", [BodyId(0), BodyId(1)], 0.5);
        // Angular velocities -1.3 and 0.8 rad/s.
        assert!((power(&law, &states()) + 0.5 * 2.1 * 2.1).abs() < 1e-14);
        let [a, b, _] = wrenches(&law, &states());
        assert!((b.torque + 0.5 * 2.1).abs() < 1e-15 && a.torque == -b.torque);
    }
}
