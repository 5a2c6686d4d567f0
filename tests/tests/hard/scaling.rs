//! Units do not matter: a scene in other units of length, time and mass runs alike.
//!
//! By powers of two every operation scales exactly (short of overflow), and so do the bits of the result; any absolute
//! threshold in the code shows. By powers of ten results agree to rounding.

use super::within;
use halfgap::force::Spring;
use halfgap::geometry::DVec2;
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Surface, World,
    WorldBuilder, WorldSettings,
};
use halfgap_tests::mechanism::{block, disc};
use std::sync::Arc;

/// Units that stand for 1 m, 1 s and 1 kg.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

const ONE: Units = Units { length: 1.0, time: 1.0, mass: 1.0 };

impl Units {
    fn place(&self, x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y) * self.length
    }

    fn state(&self, (x, y): (f64, f64), angle: f64, (vx, vy): (f64, f64), spin: f64) -> BodyState {
        BodyState {
            position: self.place(x, y),
            angle,
            velocity: DVec2::new(vx, vy) * (self.length / self.time),
            angular_velocity: spin / self.time,
        }
    }

    fn gravity(&self) -> DVec2 {
        DVec2::new(0.0, -10.0) * (self.length / (self.time * self.time))
    }
}

type Build = fn(&Units) -> World;

fn floor(builder: &mut WorldBuilder, units: &Units) {
    builder.add(BodySpec::fixed("floor", block(20.0 * units.length, units.length), units.place(0.0, -0.5)));
}

fn add(builder: &mut WorldBuilder, units: &Units, spec: BodySpec, elasticity: f64) -> BodyId {
    let body = builder.add(BodySpec { elasticity, ..spec });
    builder.add_gravity(body, units.gravity());
    body
}

/// Two discs and a block bounce about on a floor.
fn bouncing(units: &Units) -> World {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    floor(&mut builder, units);
    let l = units.length;
    let one =
        BodySpec::movable("one", disc(0.5 * l), units.mass, units.state((0.0, 2.0), 0.0, (0.5, 0.0), 0.0));
    let two = BodySpec::movable(
        "two",
        disc(0.25 * l),
        0.5 * units.mass,
        units.state((0.25, 3.5), 0.0, (0.0, -1.0), 0.0),
    );
    let three = BodySpec::movable(
        "three",
        block(1.5 * l, 0.5 * l),
        units.mass,
        units.state((2.5, 1.5), 0.3, (-0.5, 0.0), 0.5),
    );
    for (spec, elasticity) in [(one, 0.75), (two, 0.75), (three, 0.5)] {
        add(&mut builder, units, spec, elasticity);
    }
    builder.build().expect("a fine world")
}

/// A pendulum with a spring to the world.
fn swinging(units: &Units) -> World {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let bar = block(units.length, 0.125 * units.length);
    let spec = BodySpec::movable("bar", bar, units.mass, units.state((0.5, 0.0), 0.0, (0.0, 0.0), 0.0));
    let body = add(&mut builder, units, spec, 1.0);
    let anchor = |body, x: f64, y: f64| Anchor { body, point: units.place(x, y) };
    let pin = ConnectorKind::Pin { a: anchor(BodyId::WORLD, 0.0, 0.0), b: anchor(body, -0.5, 0.0) };
    builder.add_connector(ConnectorSpec::new(Connector::new(pin, 0.0).expect("a fine pin")));
    let stiffness = 8.0 * units.mass / (units.time * units.time);
    let ends = [anchor(BodyId::WORLD, 2.0, 1.0), anchor(body, 0.5, 0.0)];
    builder.add_force(Arc::new(Spring::new("spring", ends, units.length, stiffness)));
    builder.build().expect("a fine world")
}

/// A block that slides and comes to rest, and a disc that slides on it.
fn resting(units: &Units) -> World {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    floor(&mut builder, units);
    let l = units.length;
    let lower = BodySpec::movable(
        "lower",
        block(3.0 * l, l),
        units.mass,
        units.state((0.0, 1.0), 0.125, (0.25, 0.0), 0.0),
    );
    let upper =
        BodySpec::movable("upper", disc(0.5 * l), units.mass, units.state((0.5, 3.0), 0.0, (0.0, 0.0), 0.0));
    for spec in [lower, upper] {
        add(&mut builder, units, spec, 0.0);
    }
    builder.build().expect("a fine world")
}

/// A disc that slips, then rolls, and a block that lands on its corner, both on a belt.
fn rough(units: &Units) -> World {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let surface = |run| Surface {
        friction: 0.25,
        static_friction: 0.5,
        velocity: run * units.length / units.time,
        ..Surface::SMOOTH
    };
    let l = units.length;
    let ground = BodySpec::fixed("floor", block(20.0 * l, l), units.place(0.0, -0.5));
    builder.add(BodySpec { surface: surface(-0.5), ..ground });
    let one =
        BodySpec::movable("one", disc(0.5 * l), units.mass, units.state((0.0, 0.5), 0.0, (2.0, 0.0), 0.0));
    let two = BodySpec::movable(
        "two",
        block(l, 0.5 * l),
        units.mass,
        units.state((4.0, 0.75), 0.25, (-1.0, 0.0), 0.5),
    );
    for (spec, elasticity) in [(one, 0.0), (two, 0.25)] {
        add(&mut builder, units, BodySpec { surface: surface(0.0), ..spec }, elasticity);
    }
    builder.build().expect("a fine world")
}

/// States after a time, in the units of the scene of unit scale.
fn after(build: Build, units: &Units, time: f64) -> Vec<BodyState> {
    let mut world = build(units);
    world.advance_to(time * units.time, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
    let speed = units.length / units.time;
    let plain = |state: BodyState| BodyState {
        position: state.position / units.length,
        angle: state.angle,
        velocity: state.velocity / speed,
        angular_velocity: state.angular_velocity * units.time,
    };
    world.bodies().map(|body| plain(world.state(body))).collect()
}

fn units_by(factor: f64) -> [(&'static str, Units); 3] {
    [
        ("length", Units { length: factor, ..ONE }),
        ("time", Units { time: factor, ..ONE }),
        ("mass", Units { mass: factor, ..ONE }),
    ]
}

#[track_caller]
fn same_bits(what: &str, build: Build, time: f64) {
    let expected = after(build, &ONE, time);
    for power in [20, -20] {
        for (unit, units) in units_by(2f64.powi(power)) {
            let found = after(build, &units, time);
            let same = found == expected;
            println!("REACHED | {what}, {unit} by 2^{power} | same bits | {same}");
            assert_eq!(found, expected, "{what}: {unit} by 2^{power}");
        }
    }
}

#[track_caller]
fn same_to_rounding(what: &str, build: Build, time: f64, allowed: f64) {
    let expected = after(build, &ONE, time);
    for factor in [1e6, 1e-6] {
        for (unit, units) in units_by(factor) {
            let found = after(build, &units, time);
            let off = found
                .iter()
                .zip(&expected)
                .map(|(a, b)| a.position.distance(b.position) + (a.angle - b.angle).abs());
            within(&format!("{what}, {unit} by {factor:.0e} [m, rad]"), off.fold(0.0, f64::max), allowed);
        }
    }
}

#[test]
fn bouncing_bodies_scale_bit_for_bit_by_powers_of_two() {
    same_bits("bouncing bodies", bouncing, 2.0);
}

#[test]
fn a_pendulum_with_a_spring_scales_bit_for_bit_by_powers_of_two() {
    same_bits("pendulum with a spring", swinging, 5.0);
}

#[test]
fn resting_bodies_scale_bit_for_bit_by_powers_of_two() {
    same_bits("bodies that come to rest", resting, 3.0);
}

#[test]
fn bouncing_bodies_scale_to_rounding_by_powers_of_ten() {
    same_to_rounding("bouncing bodies", bouncing, 1.5, 1e-9);
}

#[test]
fn a_pendulum_with_a_spring_scales_to_rounding_by_powers_of_ten() {
    same_to_rounding("pendulum with a spring", swinging, 5.0, 1e-10);
}

#[test]
fn resting_bodies_scale_to_rounding_by_powers_of_ten() {
    same_to_rounding("bodies that come to rest", resting, 3.0, 1e-9);
}

#[test]
fn rough_bodies_scale_bit_for_bit_by_powers_of_two() {
    same_bits("rough bodies on a belt", rough, 3.0);
}

#[test]
fn rough_bodies_scale_to_rounding_by_powers_of_ten() {
    same_to_rounding("rough bodies on a belt", rough, 3.0, 1e-9);
}
