//! What a page needs of a world that lives: force laws that come and go, advances in small portions, and looks at points
//! and along rays.

use glam::DVec2;
use halfgap::force::{Anchor, ConstantForce, ForceFrame, ForceLaw, Push, Snapshot, Spring, Wrenches};
use halfgap::geometry::{Ray, Shape};
use halfgap::{
    BodyId, BodySpec, BodyState, Event, Intervention, RunError, World, WorldBuilder, WorldSettings,
};
use std::sync::Arc;

const GRAVITY: DVec2 = DVec2::new(0.0, -10.0);

/// Three blocks of 1 kg and 1 m that rest on each other on a floor at y = 0.
fn stack() -> (World, Vec<BodyId>) {
    let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(5.0), ..WorldSettings::default() });
    builder.add_gravity_to_all(GRAVITY);
    let floor = Shape::block(20.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let blocks = (0..3).map(|index| {
        let position = DVec2::new(0.0, 0.5 + f64::from(index));
        let state = BodyState { position, ..BodyState::default() };
        let shape = Shape::block(1.0, 1.0).expect("a fine size");
        let spec = BodySpec::movable(&format!("block {index}"), shape, 1.0, state);
        builder.add(BodySpec { elasticity: 0.3, ..spec })
    });
    let blocks = blocks.collect();
    (builder.build().expect("it stands"), blocks)
}

fn push(body: BodyId, force: DVec2) -> Arc<dyn ForceLaw> {
    Arc::new(ConstantForce::new(
        "hand",
        body,
        Push { frame: ForceFrame::World, point: DVec2::ZERO, force, torque: 0.0 },
    ))
}

/// A force through the centre of mass, wherever that is.
#[derive(Debug)]
struct Lift([BodyId; 1], DVec2);

impl ForceLaw for Lift {
    fn name(&self) -> &str {
        "lift"
    }
    fn bodies(&self) -> &[BodyId] {
        &self.0
    }
    fn apply(&self, _: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        wrenches.add_force(self.0[0], self.1, DVec2::ZERO);
    }
}

#[test]
fn a_force_lifts_a_block_off_its_stack_and_lets_it_fall_again() {
    let (mut world, blocks) = stack();
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    let mut ended = 0;
    let mut count = |event: &Event| ended += usize::from(matches!(event, Event::ContactEnds(_)));
    let lift = world.add_force(Arc::new(Lift([blocks[2]], DVec2::new(0.0, 14.0))), &mut count);
    let lift = lift.expect("it can be lifted");
    assert!(ended > 0, "its contacts end at once");
    world.advance_to(2.0, &mut |_| ()).expect("it rises");
    let state = world.state(blocks[2]);
    assert!((state.position.y - 4.5).abs() < 1e-8 && (state.velocity.y - 4.0).abs() < 1e-9, "{state:?}");
    assert!((world.ledger().force_laws[0].work - 28.0).abs() < 1e-7, "the force has gone 2 m");

    world.remove_force(lift, &mut |_| ()).expect("it can be let go");
    assert_eq!(world.forces().count(), 0);
    world.advance_to(2.4, &mut |_| ()).expect("it flies");
    let state = world.state(blocks[2]);
    assert!(
        (state.position.y - (4.5 + 1.6 - 0.8)).abs() < 1e-8 && state.velocity.y.abs() < 1e-9,
        "{state:?}"
    );
    world.advance_to(10.0, &mut |_| ()).expect("it falls and rests");
    let ledger = world.ledger();
    assert!((world.state(blocks[2]).position.y - 2.5).abs() < 1e-6);
    assert!((ledger.force_laws[0].work - 28.0).abs() < 1e-7, "work that was done stays in the books");
    assert!(ledger.integration_error().abs() < 1e-7, "{ledger:?}");
}

#[test]
fn a_force_that_is_too_weak_only_lightens_what_lies_below() {
    let (mut world, blocks) = stack();
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    let on_floor = |world: &World| {
        let forces = world.contact_forces();
        forces.iter().filter(|row| row.bodies.contains(&BodyId(0))).map(|row| row.force).sum::<f64>()
    };
    assert!((on_floor(&world) - 30.0).abs() < 1e-9);
    let lift = world.add_force(Arc::new(Lift([blocks[2]], DVec2::new(0.0, 4.0))), &mut |_| ());
    assert!((on_floor(&world) - 26.0).abs() < 1e-9);
    world.advance_to(2.0, &mut |_| ()).expect("it rests");
    assert!((on_floor(&world) - 26.0).abs() < 1e-9);
    world.remove_force(lift.expect("it can be added"), &mut |_| ()).expect("it can be removed");
    assert!((on_floor(&world) - 30.0).abs() < 1e-9);
    assert_eq!(world.state(blocks[2]).velocity, DVec2::ZERO);
}

#[test]
fn a_spring_ties_two_bodies_that_flew_alone() {
    let settings = WorldSettings { usual_speed: Some(1.0), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let discs = [-2.0, 2.0].map(|x| {
        let state = BodyState { position: DVec2::new(x, 0.0), ..BodyState::default() };
        builder.add(BodySpec::movable(&format!("disc at {x}"), Shape::disc(0.1).expect("fine"), 1.0, state))
    });
    let mut world = builder.build().expect("two discs");
    world.advance_to(1.0, &mut |_| ()).expect("they rest");
    let ends = discs.map(|body| Anchor { body, point: DVec2::ZERO });
    let spring = Arc::new(Spring::new("tie", ends, 3.0, 2.0));
    let id = world.add_force(spring.clone(), &mut |_| ()).expect("it can be tied");
    assert!((world.ledger().interventions - 1.0).abs() < 1e-15, "the spring is 1 m too long");
    world.advance_to(2.0, &mut |_| ()).expect("they swing");
    // The reduced mass is 1/2 kg: the length swings about 3 m at 2 rad/s.
    let length = world.state(discs[0]).position.distance(world.state(discs[1]).position);
    assert!((length - (3.0 + 2f64.cos())).abs() < 1e-9, "{length}");
    assert!((world.energy().total() - 1.0).abs() < 1e-7);
    world.remove_force(id, &mut |_| ()).expect("it can be cut");
    world.remove_force(id, &mut |_| ()).expect("nothing is left to do");
    let ledger = world.ledger();
    let kinetic = 2f64.sin().powi(2);
    assert!((ledger.interventions - kinetic).abs() < 1e-7, "{ledger:?}");
    assert!((world.energy().total() - kinetic).abs() < 1e-7, "the potential is gone with the spring");
    // A law that comes again has another id.
    assert_ne!(world.add_force(spring, &mut |_| ()).expect("it can be tied again"), id);
    assert_eq!(world.forces().count(), 1);
}

#[test]
fn a_law_of_the_builder_can_be_removed() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let disc =
        builder.add(BodySpec::movable("disc", Shape::disc(0.1).expect("fine"), 2.0, BodyState::default()));
    let hand = builder.add_force(push(disc, DVec2::new(6.0, 0.0)));
    let mut world = builder.build().expect("one disc");
    world.advance_to(1.0, &mut |_| ()).expect("it is pushed");
    world.remove_force(hand, &mut |_| ()).expect("it can be removed");
    world.advance_to(2.0, &mut |_| ()).expect("it flies");
    assert!((world.state(disc).position.x - 4.5).abs() < 1e-9);
}

#[test]
fn laws_that_cannot_be_are_refused_and_change_nothing() {
    let (mut world, blocks) = stack();
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    let before = blocks.iter().map(|&block| world.state(block)).collect::<Vec<_>>();
    let mut message = |law: Arc<dyn ForceLaw>| match world.add_force(law, &mut |_| ()) {
        Err(error @ RunError::BadForce { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let missing = message(Arc::new(Lift([BodyId(9)], DVec2::X)));
    assert_eq!(missing, "force law \"lift\" names body 9, but there are 4 bodies");
    let bad = message(Arc::new(Lift([blocks[0]], DVec2::new(f64::NAN, 0.0))));
    assert!(bad.contains("lift") && bad.contains("block 0"), "{bad}");
    let strong = message(Arc::new(Lift([blocks[0]], DVec2::new(1e200, 0.0))));
    assert!(strong.contains("lift") && strong.contains("block 0"), "{strong}");

    /// Acts on a body that it does not name.
    #[derive(Debug)]
    struct Sly(BodyId);
    impl ForceLaw for Sly {
        fn name(&self) -> &str {
            "sly"
        }
        fn bodies(&self) -> &[BodyId] {
            &[]
        }
        fn apply(&self, _: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
            wrenches.add_force(self.0, DVec2::X, DVec2::ZERO);
        }
    }
    let sly = message(Arc::new(Sly(blocks[1])));
    assert!(sly.contains("sly") && sly.contains("block 1"), "{sly}");

    let (_, other) = {
        let (mut other, blocks) = stack();
        let id = other.add_force(push(blocks[0], DVec2::X), &mut |_| ()).expect("a fine force");
        (other, id)
    };
    assert_eq!(world.remove_force(other, &mut |_| ()), Err(RunError::NoSuchForce));
    assert_eq!(blocks.iter().map(|&block| world.state(block)).collect::<Vec<_>>(), before);
    assert_eq!(world.forces().count(), 0);
}

/// The stack after a blow to its lowest block.
fn struck_stack() -> (World, Vec<BodyId>) {
    let (mut world, blocks) = stack();
    let velocity = DVec2::new(0.3, 4.0);
    let blow = Intervention::Velocity { body: blocks[0], velocity, angular_velocity: 0.4 };
    world.intervene(&[blow], &mut |_| ()).expect("it can be struck");
    (world, blocks)
}

#[test]
fn an_advance_in_portions_gives_the_same_bits_and_the_same_events() {
    let (mut whole, blocks) = struck_stack();
    let mut expected = Vec::new();
    whole.advance_to(3.0, &mut |event| expected.push(event.clone())).expect("it falls");
    assert!(expected.len() > 20, "{}", expected.len());
    for budget in [1, 2, 7, 1000] {
        let (mut world, _) = struck_stack();
        let (mut events, mut calls, mut last) = (Vec::new(), 0_u64, world.time());
        loop {
            calls += 1;
            let mut note = |event: &Event| events.push(event.clone());
            let is_done = world.advance_for(3.0, budget, &mut note).expect("it falls").is_continue();
            assert!(world.time() >= last, "time goes on");
            last = world.time();
            if is_done {
                break;
            }
        }
        assert_eq!(world.time(), 3.0);
        assert_eq!(events, expected, "budget {budget}");
        assert!(calls * budget > expected.len() as u64 / 4, "a call handles no more than its budget");
        assert!(budget > 1 || calls > whole.statistics().impacts, "one event a call");
        for &block in &blocks {
            assert_eq!(world.state(block), whole.state(block), "budget {budget}");
        }
    }
    let (mut world, _) = struck_stack();
    assert!(world.advance_for(3.0, 0, &mut |_| ()).expect("nothing is done").is_break());
    assert_eq!(world.time(), 0.0);
}

#[test]
fn points_and_rays_meet_the_bodies_where_they_are_now() {
    let (mut world, blocks) = stack();
    let found = |world: &World, x: f64, y: f64| world.bodies_at(DVec2::new(x, y)).collect::<Vec<_>>();
    assert_eq!(found(&world, 0.2, 1.4), [blocks[1]]);
    assert_eq!(found(&world, 0.6, 1.4), []);
    assert_eq!(found(&world, 3.0, -0.3), [BodyId(0)]);
    assert_eq!(found(&world, f64::NAN, 0.0), []);

    let down = Ray { origin: DVec2::new(0.25, 9.0), direction: DVec2::new(0.0, -2.0) };
    let hit = world.cast_ray(&down, f64::INFINITY).expect("the stack is below");
    assert_eq!(hit.body, blocks[2]);
    assert!((hit.distance - 6.0).abs() < 1e-9 && (hit.normal - DVec2::Y).length() < 1e-12, "{hit:?}");
    assert!((hit.point - DVec2::new(0.25, 3.0)).length() < 1e-9, "{hit:?}");
    assert_eq!(world.cast_ray(&down, 5.9), None);
    // From inside the ray leaves the block through its upper side, which lies before that of the block above.
    let up = Ray { origin: DVec2::new(0.1, 1.5), direction: DVec2::Y };
    let hit = world.cast_ray(&up, f64::INFINITY).expect("it leaves the block");
    assert!(hit.body == blocks[1] && (hit.distance - 0.5).abs() < 1e-6 && hit.normal.y > 0.0, "{hit:?}");
    assert_eq!(world.cast_ray(&Ray { origin: DVec2::ZERO, direction: DVec2::ZERO }, 1.0), None);

    let away =
        Intervention::Velocity { body: blocks[2], velocity: DVec2::new(5.0, 0.0), angular_velocity: 0.0 };
    world.intervene(&[away], &mut |_| ()).expect("it can be pushed away");
    world.advance_to(1.0, &mut |_| ()).expect("it has gone");
    assert_eq!(world.cast_ray(&down, f64::INFINITY).map(|hit| hit.body), Some(blocks[1]));
}

#[test]
fn gravity_on_all_acts_as_gravity_on_each() {
    let fall = |together: bool| {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        if together {
            builder.add_gravity_to_all(GRAVITY);
        }
        builder.add(BodySpec::fixed("floor", Shape::block(9.0, 1.0).expect("fine"), DVec2::new(0.0, -0.5)));
        let state = BodyState { position: DVec2::new(0.1, 2.0), ..BodyState::default() };
        let disc = builder.add(BodySpec::movable("disc", Shape::disc(0.5).expect("fine"), 1.0, state));
        if !together {
            builder.add_gravity(disc, GRAVITY);
        }
        let mut world = builder.build().expect("one disc");
        assert!(world.warnings().is_empty(), "{:?}", world.warnings());
        world.advance_to(1.0, &mut |_| ()).expect("it bounces");
        (world.state(disc), world.energy())
    };
    assert_eq!(fall(true), fall(false));
}
