//! Worlds that are saved and loaded: they go on with the same bits, and nothing else passes for one.
//!
//! Scenes of all kinds are in `saving` of the tests across layers.

use glam::DVec2;
use halfgap::force::{
    ConstantForce, CoordinateDamper, CoordinateSpring, Dashpot, ForceFrame, ForceLaw, MutualGravity,
    PointForce, PointPush, Push, RotatingForce, Snapshot, Spring, Turning, Varied, Vary, Wrenches,
};
use halfgap::geometry::Shape;
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Coordinate, Event,
    Integrator, Intervention, LoadError, RunError, SaveError, ToleranceOverrides, World, WorldBuilder,
    WorldSettings,
};
use proptest::prelude::*;
use std::sync::{Arc, LazyLock};

const GRAVITY: DVec2 = DVec2::new(0.0, -10.0);

fn loaded(world: &World) -> World {
    World::load(&world.save().expect("its laws are the crate's")).expect("the bytes are sound")
}

fn anchor(body: BodyId, x: f64, y: f64) -> Anchor {
    Anchor { body, point: DVec2::new(x, y) }
}

fn disc(builder: &mut WorldBuilder, name: &str, x: f64, y: f64) -> BodyId {
    let state = BodyState { position: DVec2::new(x, y), ..BodyState::default() };
    let shape = Shape::disc(0.5).expect("a fine radius");
    builder.add(BodySpec { elasticity: 0.6, ..BodySpec::movable(name, shape, 1.0, state) })
}

/// Discs over a floor: two lie on each other, one falls, one hangs on a rod, and each force law of the crate pulls.
fn menagerie() -> (World, [BodyId; 4]) {
    let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(5.0), ..WorldSettings::default() });
    builder.add_gravity_to_all(GRAVITY);
    let floor = Shape::block(20.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let [low, high] = [("low", 0.5), ("high", 1.5)].map(|(name, y)| disc(&mut builder, name, 0.0, y));
    let [falling, bob] =
        [("falling", 3.0, 4.0), ("bob", -5.0, 5.0)].map(|(name, x, y)| disc(&mut builder, name, x, y));
    let [a, b] = [anchor(BodyId::WORLD, -7.0, 5.0), anchor(bob, 0.0, 0.0)];
    let rod = Connector::new(ConnectorKind::Rod { a, b, length: 2.0 }, 0.0).expect("a fine rod");
    builder.add_connector(ConnectorSpec::new(rod));
    let ends = [anchor(falling, 0.2, 0.0), anchor(BodyId::WORLD, 3.0, 6.0)];
    builder.add_force(Arc::new(Spring::new("spring", ends, 1.0, 3.0)));
    builder.add_force(Arc::new(Dashpot::new("dashpot", ends, 0.1)));
    let turning = Turning { magnitude: 0.2, rate: 3.0, ..Turning::default() };
    builder.add_force(Arc::new(RotatingForce::new("rotor", anchor(bob, 0.0, 0.1), turning)));
    builder.add_force(Arc::new(MutualGravity::new("pull", 0.1, &[(falling, 1.0), (bob, 1.0)], &[])));
    builder.add_force(push(high, 0.01));
    builder.add_force(Arc::new(CoordinateSpring::new(
        "wound",
        Coordinate::angle(BodyId::WORLD, bob),
        0.3,
        0.2,
    )));
    builder.add_force(Arc::new(CoordinateDamper::new("eddies", Coordinate::angle(falling, bob), 0.01)));
    let nudge = PointPush { point: DVec2::new(0.0, 0.1), force: DVec2::X, ..PointPush::default() };
    let vary = Vary::table(vec![0.2, 0.7, 1.1], vec![0.0, 0.1, -0.1]).expect("a fine table");
    let nudge = PointForce::new("nudge", falling, nudge);
    builder.add_force(Arc::new(Varied::new(Arc::new(nudge), vary)));
    (builder.build().expect("it can be built"), [low, high, falling, bob])
}

fn push(body: BodyId, force: f64) -> Arc<dyn ForceLaw> {
    let push =
        Push { frame: ForceFrame::Body, point: DVec2::ZERO, force: DVec2::new(0.0, force), torque: 0.0 };
    Arc::new(ConstantForce::new("push", body, push))
}

/// Everything that a world tells, with all digits.
fn told(world: &World) -> String {
    let states: Vec<_> = world.bodies().map(|body| (world.name(body), world.state(body))).collect();
    let names: Vec<_> = world.forces().map(|law| law.name()).collect();
    let (ledger, forces) = (world.ledger(), world.contact_forces());
    let rest = (world.connectors(), world.warnings(), world.tolerances(), world.start_correction());
    format!("{} {states:?} {names:?} {ledger:?} {forces:?} {:?} {rest:?}", world.time(), world.statistics())
}

/// Advances, and returns what was told on the way and of the end.
fn advanced(world: &mut World, time: f64) -> String {
    let mut events = Vec::new();
    let outcome = world.advance_to(time, &mut |event| events.push(event.clone()));
    format!("{outcome:?} {events:?} {}", told(world))
}

/// An action on a world, and what it told.
type Action = fn(&mut World, [BodyId; 4]) -> String;

/// What callers do to a living world.
const ACTIONS: [Action; 6] = [
    |world, _| advanced(world, world.time() + 0.4),
    |world, [_, high, ..]| {
        let mut events = Vec::new();
        let impulse =
            Intervention::Impulse { body: high, impulse: DVec2::new(0.3, -1.0), point: DVec2::new(0.0, 1.6) };
        let outcome = world.intervene(&[impulse], &mut |event: &Event| events.push(event.clone()));
        format!("{outcome:?} {events:?}")
    },
    |world, [low, ..]| format!("{:?}", world.add_force(push(low, 3.0), &mut |_| ())),
    |world, _| format!("{:?}", world.advance_for(world.time() + 1.0, 7, &mut |_| ())),
    |world, [.., falling, _]| {
        let faster = Intervention::Velocity { body: falling, velocity: DVec2::X, angular_velocity: 2.0 };
        format!("{:?}", world.intervene(&[faster], &mut |_| ()))
    },
    |world, _| advanced(world, world.time() + 0.6),
];

#[test]
fn a_world_goes_on_after_whatever_was_done_to_it() {
    let (mut world, bodies) = menagerie();
    let mut twin = loaded(&world);
    for round in 0..3 {
        for (place, action) in ACTIONS.into_iter().enumerate() {
            let name = || format!("round {round}, action {place}");
            assert_eq!(action(&mut twin, bodies), action(&mut world, bodies), "{}", name());
            assert_eq!(told(&twin), told(&world), "{}", name());
            twin = loaded(&twin);
        }
    }
    assert!(world.statistics().impacts > 3 && !world.contact_forces().is_empty());
}

#[test]
fn a_law_keeps_its_id_and_its_work() {
    let (mut world, [low, ..]) = menagerie();
    let id = world.add_force(push(low, 20.0), &mut |_| ()).expect("a fine force");
    world.advance_to(0.5, &mut |_| ()).expect("it flies");
    let mut twin = loaded(&world);
    for world in [&mut world, &mut twin] {
        world.remove_force(id, &mut |_| ()).expect("it is there");
        world.advance_to(1.0, &mut |_| ()).expect("it falls");
    }
    assert_eq!((told(&twin), twin.forces().count()), (told(&world), 8));
    let mut again = loaded(&twin);
    assert_eq!(again.remove_force(id, &mut |_| ()), Ok(()), "it was removed before");
    assert_eq!(told(&again), told(&world));
}

#[test]
fn the_first_impact_is_told_by_who_advances_first() {
    let overrides =
        ToleranceOverrides { target_gap: Some(5e-3), accuracy: Some(3e-3), velocity_tol: Some(0.5) };
    let mut builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
    builder.add_gravity_to_all(GRAVITY);
    let floor = Shape::block(4.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let state = BodyState {
        position: DVec2::new(0.0, 0.505),
        velocity: DVec2::new(0.0, -0.3),
        ..BodyState::default()
    };
    builder.add(BodySpec::movable("ball", Shape::disc(0.5).expect("a fine radius"), 2.0, state));
    let world = builder.build().expect("it closes slowly at the start");
    assert_eq!(world.statistics().impacts, 1, "it is resolved, but not told");
    let mut twins = [world.clone(), loaded(&world)];
    let [own, other] = twins.each_mut().map(|world| advanced(world, 0.1));
    assert!(own.contains("Impact(Impact { time: 0.0"), "{own}");
    assert_eq!(own, other);
}

#[test]
fn a_failed_world_fails_again() {
    let settings =
        WorldSettings { integrator: Integrator::Euler, time_step: Some(0.025), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let ball = disc(&mut builder, "ball", 1.0, 0.0);
    let ends = [anchor(BodyId::WORLD, 0.0, 2.0), anchor(ball, 0.0, 0.0)];
    builder.add_force(Arc::new(Spring::new("spring", ends, 0.5, 1e6)));
    let mut world = builder.build().expect("it swings");
    let failed = world.advance_to(100.0, &mut |_| ());
    assert!(matches!(failed, Err(RunError::RanAway { .. })), "{failed:?}");
    let mut twin = loaded(&world);
    assert_eq!((twin.advance_to(100.0, &mut |_| ()), told(&twin)), (failed, told(&world)));
}

/// A law that this crate does not have.
#[derive(Debug)]
struct Wind([BodyId; 1]);

impl ForceLaw for Wind {
    fn name(&self) -> &str {
        "wind"
    }
    fn bodies(&self) -> &[BodyId] {
        &self.0
    }
    fn apply(&self, _: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        wrenches.add_force(self.0[0], DVec2::X, DVec2::ZERO);
    }
}

#[test]
fn a_law_of_ones_own_is_refused_by_its_name() {
    let error = SaveError::OwnLaw { law: "wind".to_owned() };
    let message = "the force law \"wind\" is not one of halfgap's: a world with it cannot be saved";
    assert_eq!(error.to_string(), message);
    let refusal = Err(error);
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let ball = disc(&mut builder, "ball", 0.0, 0.0);
    builder.add_force(Arc::new(Wind([ball])));
    assert_eq!(builder.build().expect("it flies").save(), refusal);

    let (mut world, [low, ..]) = menagerie();
    let id = world.add_force(Arc::new(Wind([low])), &mut |_| ()).expect("a fine force");
    assert_eq!(world.save(), refusal);
    world.remove_force(id, &mut |_| ()).expect("it is there");
    assert_eq!(world.save(), refusal, "its work is still in the books, under its name");
}

#[test]
fn bytes_that_are_no_world_are_refused() {
    let refused = |bytes: &[u8]| World::load(bytes).expect_err("no world").to_string();
    for none in [&b""[..], b"halfgap", b"halfgap\r\n\0", b"halfgap\r\n\0\xff0.1.0", &[0; 1000]] {
        assert_eq!(refused(none), "these bytes are no saved world");
    }
    let bytes = &*BYTES;
    let (all, one_more) = (bytes.len(), [&bytes[..], b"."].concat());
    assert_eq!(refused(&one_more), format!("a saved world of {all} bytes has {}", all + 1));
    assert_eq!(refused(&bytes[..all - 1]), format!("a saved world of {all} bytes has {}", all - 1));
    let mut damaged = bytes.clone();
    damaged[all / 2] ^= 4;
    assert_eq!(World::load(&damaged).err(), Some(LoadError::Damaged));
}

/// A world as bytes.
static BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let (mut world, _) = menagerie();
    world.advance_to(1.3, &mut |_| ()).expect("it goes on");
    world.save().expect("its laws are the crate's")
});

proptest! {
    #[test]
    fn damage_is_seen(place in any::<prop::sample::Index>(), flip in 1..=u8::MAX, end in any::<prop::sample::Index>()) {
        let mut bytes = BYTES.clone();
        bytes[place.index(BYTES.len())] ^= flip;
        prop_assert!(World::load(&bytes).is_err());
        prop_assert!(World::load(&BYTES[..end.index(BYTES.len())]).is_err());
    }
}
