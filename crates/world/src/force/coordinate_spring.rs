//! A spring and a damper on the free coordinate of a joint.

use super::{ForceLaw, Snapshot, Wrenches};
use halfgap_collision::{BodyId, Coordinate, Moving};

/// A spring on a coordinate: a force or torque of stiffness (coordinate - rest) towards the rest.
///
/// It has the potential stiffness (coordinate - rest)^2/2 [J].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct CoordinateSpring {
    name: String,
    coordinate: Coordinate,
    rest: f64,
    stiffness: f64,
    bodies: Vec<BodyId>,
}

impl CoordinateSpring {
    /// Makes the spring of a rest [rad or m] and a stiffness [N m or N/m], with a name for messages.
    #[must_use]
    pub fn new(name: impl Into<String>, coordinate: Coordinate, rest: f64, stiffness: f64) -> Self {
        Self { name: name.into(), coordinate, rest, stiffness, bodies: movable(&coordinate) }
    }

    /// Coordinate beyond the rest [rad or m].
    fn stretch(&self, now: &Snapshot<'_>) -> f64 {
        let [a, b] = self.coordinate.bodies().map(|body| now.body(body));
        self.coordinate.measure([&a, &b]).gap / self.coordinate.scale() - self.rest
    }
}

impl ForceLaw for CoordinateSpring {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        push(&self.coordinate, now, wrenches, |_| -self.stiffness * self.stretch(now));
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let stretch = self.stretch(now);
        Some(0.5 * self.stiffness * stretch * stretch)
    }
}

/// A damper on a coordinate: a force or torque of damping times its rate, against it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct CoordinateDamper {
    name: String,
    coordinate: Coordinate,
    damping: f64,
    bodies: Vec<BodyId>,
}

impl CoordinateDamper {
    /// Makes the damper of a damping [N m s or N s/m], with a name for messages and the ledger.
    #[must_use]
    pub fn new(name: impl Into<String>, coordinate: Coordinate, damping: f64) -> Self {
        Self { name: name.into(), coordinate, damping, bodies: movable(&coordinate) }
    }
}

impl ForceLaw for CoordinateDamper {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        push(&self.coordinate, now, wrenches, |rate| -self.damping * rate);
    }
}

/// Pushes both bodies of a coordinate with the force [N m or N] that its rate [rad/s or m/s] tells.
fn push(
    coordinate: &Coordinate,
    now: &Snapshot<'_>,
    wrenches: &mut Wrenches<'_>,
    force: impl Fn(f64) -> f64,
) {
    let bodies = coordinate.bodies();
    let movings: [Moving; 2] = bodies.map(|body| now.body(body));
    let (row, scale) = (coordinate.measure([&movings[0], &movings[1]]).kinematics, coordinate.scale());
    let along = force(row.rate / scale) / scale;
    for (body, entries) in bodies.into_iter().zip(row.jacobian.as_chunks::<3>().0) {
        let [x, y, turning] = entries.map(|entry| along * entry);
        wrenches.add_force(body, glam::DVec2::new(x, y), glam::DVec2::ZERO);
        wrenches.add_torque(body, turning);
    }
}

fn movable(coordinate: &Coordinate) -> Vec<BodyId> {
    coordinate.bodies().into_iter().filter(|body| !body.is_world()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{power, states, wrenches};
    use super::*;
    use crate::force::Wrench;
    use glam::DVec2;
    use halfgap_collision::{Anchor, BodyState, SlotFrame};

    #[test]
    fn the_force_of_a_spring_is_minus_the_slope_of_its_potential() {
        let coordinate = Coordinate::Along {
            a: Anchor { body: BodyId(0), point: DVec2::new(0.3, -0.2) },
            b: Anchor { body: BodyId(1), point: DVec2::new(-0.1, 0.4) },
            axis: DVec2::new(0.6, 0.8),
            frame: SlotFrame::A,
        };
        let spring = CoordinateSpring::new("spring", coordinate, 0.7, 3.0);
        let state = |x: f64, y: f64, angle: f64| BodyState {
            position: DVec2::new(x, y),
            angle,
            ..BodyState::default()
        };
        let places = [[0.2, 0.1, 0.5], [1.5, 0.9, -0.8]];
        let potential = |places: [[f64; 3]; 2]| {
            let movings = places.map(|[x, y, angle]| Moving::from(&state(x, y, angle)));
            spring.potential(&Snapshot::new(0.0, &movings)).expect("it has a potential")
        };
        let movings = places.map(|[x, y, angle]| Moving::from(&state(x, y, angle)));
        let mut sums = [Wrench::default(); 2];
        spring.apply(&Snapshot::new(0.0, &movings), &mut Wrenches::new(&mut sums));
        for body in 0..2 {
            let told = [sums[body].force.x, sums[body].force.y, sums[body].torque];
            for (axis, told) in told.into_iter().enumerate() {
                let moved = |step: f64| {
                    let mut moved = places;
                    moved[body][axis] += step;
                    potential(moved)
                };
                let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
                assert!((told + slope).abs() < 1e-8, "body {body}, axis {axis}: {told} for {}", -slope);
            }
        }
    }

    #[test]
    fn torques_are_minus_the_gradient_of_the_potential_and_opposite() {
        let law = CoordinateSpring::new("spring", Coordinate::angle(BodyId(0), BodyId(1)), 0.3, 4.0);
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
        let world = CoordinateSpring::new("", Coordinate::angle(BodyId::WORLD, BodyId(1)), 0.3, 4.0);
        assert_eq!(world.bodies(), [BodyId(1)]);
        assert!((wrenches(&world, &states())[1].torque - 4.0 * 2.3).abs() < 1e-14);
    }

    #[test]
    fn a_damper_takes_energy_by_the_square_of_the_speed() {
        let law = CoordinateDamper::new("damper", Coordinate::angle(BodyId(0), BodyId(1)), 0.5);
        // Angular velocities -1.3 and 0.8 rad/s.
        assert!((power(&law, &states()) + 0.5 * 2.1 * 2.1).abs() < 1e-14);
        let [a, b, _] = wrenches(&law, &states());
        assert!((b.torque + 0.5 * 2.1).abs() < 1e-15 && a.torque == -b.torque);
    }
}
