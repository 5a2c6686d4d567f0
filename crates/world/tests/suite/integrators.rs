//! Steps of the methods without error estimate have the length that the settings give.

use glam::DVec2;
use halfgap::geometry::Shape;
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Integrator, World,
    WorldBuilder, WorldSettings,
};

/// A disc on a rod of 1 m, let go level.
fn pendulum(integrator: Integrator, time_step: f64) -> World {
    let settings = WorldSettings { integrator, time_step: Some(time_step), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let state = BodyState { position: DVec2::new(1.0, 0.0), ..BodyState::default() };
    let bob = builder.add(BodySpec::movable("bob", Shape::disc(0.1).expect("a fine radius"), 1.0, state));
    builder.add_gravity(bob, DVec2::new(0.0, -10.0));
    let [a, b] = [BodyId::WORLD, bob].map(|body| Anchor { body, point: DVec2::ZERO });
    let rod = Connector::new(ConnectorKind::Rod { a, b, length: 1.0 }, 0.0).expect("a fine rod");
    builder.add_connector(ConnectorSpec::new(rod));
    builder.build().expect("it hangs")
}

#[test]
fn a_fixed_step_is_as_long_as_it_is_said_to_be() {
    for integrator in [Integrator::Euler, Integrator::ModifiedEuler, Integrator::Rk4] {
        for (time_step, steps) in [(0.1, 20), (0.05, 40), (0.01, 200), (0.001, 2000)] {
            let mut world = pendulum(integrator, time_step);
            world.advance_to(2.0, &mut |_| ()).expect("it swings");
            // Sums of steps are rounded: a step may begin just before the end.
            let made = world.statistics().steps;
            assert!((steps..=steps + 2).contains(&made), "{integrator:?}, {time_step} s: {made} steps");
        }
    }
}

#[test]
fn errors_fall_with_the_order_of_the_method() {
    let reference = {
        let mut world = pendulum(Integrator::Dop853, 0.1);
        world.advance_to(1.0, &mut |_| ()).expect("it swings");
        world.state(BodyId(0)).position
    };
    for (integrator, order) in [(Integrator::ModifiedEuler, 2), (Integrator::Rk4, 4)] {
        let error = |time_step| {
            let mut world = pendulum(integrator, time_step);
            world.advance_to(1.0, &mut |_| ()).expect("it swings");
            world.state(BodyId(0)).position.distance(reference)
        };
        let found = (error(0.02) / error(0.01)).log2();
        assert!((found - f64::from(order)).abs() < 0.4, "{integrator:?}: order {found}");
    }
}
