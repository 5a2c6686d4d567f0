//! Fixed bodies that are moved: what they do to others, and what is booked of it.

use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{
    BodyId, BodyMotion, BodySpec, BodyState, Event, MotionLaw, MotionMoment, MotionSpread, PrescribedMotion,
    World, WorldBuilder, WorldSettings,
};
use std::sync::Arc;

/// World of a run, its bodies, and what else there is.
fn world(run: &str, rest: &str) -> World {
    let text = format!(
        "format = \"halfgap-scene-1\"\ntitle = \"moved\"\nrun = {{ {run} }}\n{rest}\n[[force]]\ngravity = {{ acceleration = [0.0, -9.81] }}"
    );
    let scene = Scene::parse(&text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
    World::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"))
}

/// A floor that is moved, with its top at the start at height 0, and a body on it.
fn on_floor(motion: &str, surface: &str, body: &str) -> World {
    let floor = format!(
        "[[body]]\nname = \"floor\"\nfixed = true\nposition = [0.0, -0.5]\nshape = {{ block = {{ width = 20.0, height = 1.0 }} }}\n{surface}\nmotion = {motion}"
    );
    world(
        "duration = 4.0, tolerance = 1e-9",
        &format!("{floor}\n[[body]]\nname = \"body\"\n{body}\n{surface}"),
    )
}

/// Asserts that what the ledger has accounts for the change of the energy.
fn assert_closed(world: &World, allowed: f64) {
    let ledger = world.ledger();
    assert!(ledger.integration_error().abs() < allowed, "{} J of {ledger:?}", ledger.integration_error());
}

#[test]
fn what_bounces_on_a_floor_that_goes_up_and_down_gets_its_energy_from_it() {
    for elasticity in [1.0, 0.6] {
        let surface = format!("elasticity = {elasticity}");
        let motion = "{ oscillate = { amplitude = [0.0, 0.05], frequency = 1.5 } }";
        let disc = "mass = 2.0\nposition = [0.0, 0.8]\nshape = { disc = { radius = 0.2 } }";
        let mut world = on_floor(motion, &surface, disc);
        let (mut reported, mut impacts) = (0.0, 0);
        world
            .advance_to(2.0, &mut |event| {
                if let Event::Impact(impact) = event {
                    reported += impact.energy_change;
                    impacts += 1;
                }
            })
            .expect("it bounces");
        assert!(impacts >= 2);
        let ledger = world.ledger();
        assert!(ledger.drives.abs() > 0.1, "{ledger:?}");
        // What bounces less comes to rest, and rides.
        let rides = elasticity < 1.0;
        assert!(
            rides || (ledger.drives + ledger.impacts - reported).abs() < 1e-9,
            "{reported} J of {ledger:?}"
        );
        assert!(if elasticity == 1.0 { ledger.impacts.abs() < 1e-9 } else { ledger.impacts < -0.1 });
        assert_closed(&world, 1e-8);
    }
}

#[test]
fn a_block_slips_and_sticks_on_a_floor_that_goes_to_and_fro() {
    let motion = "{ oscillate = { amplitude = [0.2, 0.01], frequency = 0.7 } }";
    let speed = std::f64::consts::TAU * 0.7;
    let block = format!(
        "mass = 1.0\nposition = [0.0, 0.25]\nvelocity = [{:?}, {:?}]\nshape = {{ block = {{ width = 1.0, height = 0.5 }} }}",
        0.2 * speed,
        0.01 * speed
    );
    for (friction, slips) in [(0.2, true), (0.9, false)] {
        let mut world = on_floor(motion, &format!("elasticity = 0.0\nfriction = {friction}"), &block);
        world.advance_to(3.0, &mut |_| ()).expect("it goes along");
        let ledger = world.ledger();
        assert_eq!(ledger.friction < -0.1, slips, "{ledger:?}");
        assert!(ledger.drives.abs() > 0.01);
        assert_closed(&world, 1e-7);
        if !slips {
            let [floor, block] = [0, 1].map(|body| world.state(BodyId(body)));
            let apart = block.position - floor.position;
            assert!((apart - DVec2::new(0.0, 0.75)).length() < 1e-6, "{apart}");
        }
    }
}

#[test]
fn a_disc_is_rolled_by_a_floor_and_its_books_close() {
    let disc = "mass = 1.0\nposition = [0.0, 0.3]\nshape = { disc = { radius = 0.3 } }";
    let motion = "{ table = { times = [0.0, 1.0, 2.0, 4.0], positions = [[0.0, 0.0], [0.5, 0.1], [0.3, -0.1], [0.6, 0.0]] } }";
    for surface in ["friction = 0.8", "friction = 0.8\nrolling_resistance = 0.05"] {
        let mut world = on_floor(motion, &format!("elasticity = 0.0\n{surface}"), disc);
        world.advance_to(2.5, &mut |_| ()).expect("it rolls");
        let (floor, disc) = (world.state(BodyId(0)), world.state(BodyId(1)));
        // Its lowest point goes along with the floor.
        let slip = disc.velocity.x + 0.3 * disc.angular_velocity - floor.velocity.x;
        assert!(slip.abs() < 1e-7, "{slip} m/s");
        assert!(world.ledger().drives.abs() > 1e-3);
        assert_closed(&world, 1e-7);
    }
}

#[test]
fn pins_and_springs_on_a_body_that_is_moved_keep_the_books() {
    let arm = "[[body]]\nname = \"wheel\"\nfixed = true\nshape = { disc = { radius = 0.1 } }\nmotion = { oscillate = { amplitude = [0.1, 0.2], angle = 0.7, frequency = 0.9 } }\n\
               [[body]]\nname = \"rod\"\nmass = 1.0\nposition = [0.5, 0.0]\nshape = { block = { width = 1.0, height = 0.05 } }\npasses_through = [\"wheel\"]\n";
    let pin = "[[connector]]\npin = { a = { body = \"wheel\", point = [0.0, 0.0] }, b = { body = \"rod\", point = [-0.5, 0.0] } }";
    let spring = "[[force]]\nspring = { a = { body = \"wheel\", point = [0.0, 0.05] }, b = { body = \"rod\", point = [0.2, 0.0] }, rest_length = 0.4, stiffness = 8.0, damping = 0.3 }";
    for ties in [pin.to_owned(), spring.to_owned(), format!("{pin}\n{spring}")] {
        let mut world = world("duration = 3.0, tolerance = 1e-10", &format!("{arm}{ties}"));
        world.advance_to(2.0, &mut |_| ()).expect("it swings");
        assert!(world.ledger().drives.abs() > 1e-2, "{ties}: {:?}", world.ledger());
        assert_closed(&world, 1e-8);
    }
}

/// Stays for a second, and then goes up at an acceleration of 2 m/s^2 all at once.
#[derive(Debug)]
struct SetsOut;

impl PrescribedMotion for SetsOut {
    fn at(&self, time: f64) -> MotionMoment {
        let since = (time - 1.0).max(0.0);
        let acceleration = if time < 1.0 { 0.0 } else { 2.0 };
        MotionMoment { value: since * since, rate: 2.0 * since, acceleration }
    }

    fn spread(&self, from: f64, to: f64) -> MotionSpread {
        let [first, last] = [from, to].map(|time| self.at(time));
        MotionSpread { rate: [first.rate, last.rate], acceleration: [first.acceleration, last.acceleration] }
    }

    fn next_kink(&self, after: f64) -> Option<f64> {
        (after < 1.0).then_some(1.0)
    }
}

/// Stays for a second, and goes up from then on at an acceleration that grows by 1 m/s^3.
#[derive(Debug)]
struct Rises;

impl PrescribedMotion for Rises {
    fn at(&self, time: f64) -> MotionMoment {
        let since = (time - 1.0).max(0.0);
        MotionMoment { value: since.powi(3) / 6.0, rate: 0.5 * since * since, acceleration: since }
    }

    fn spread(&self, from: f64, to: f64) -> MotionSpread {
        let [first, last] = [from, to].map(|time| (time - 1.0).max(0.0));
        MotionSpread { rate: [0.5 * first * first, 0.5 * last * last], acceleration: [first, last] }
    }

    fn next_kink(&self, after: f64) -> Option<f64> {
        (after < 1.0).then_some(1.0)
    }
}

/// A lift that moves by a law of one's own, and a ball at rest at a height above it, in a field or none.
fn lift(law: Arc<dyn PrescribedMotion>, height: f64, gravity: f64) -> World {
    let mut builder = WorldBuilder::new(WorldSettings { tolerance: 1e-10, ..WorldSettings::default() });
    let shape = |shape: Result<Shape, _>| shape.expect("a fine size");
    let still = || MotionLaw::Uniform(0.0);
    let motion = BodyMotion { x: still(), y: MotionLaw::Own(law), angle: still() };
    let floor = BodySpec::fixed("lift", shape(Shape::block(4.0, 1.0)), DVec2::new(0.0, -0.5));
    builder.add(BodySpec { motion: Some(motion), elasticity: 0.0, ..floor });
    let state = BodyState { position: DVec2::new(0.0, 0.5 + height), ..BodyState::default() };
    let ball = builder.add(BodySpec::movable("ball", shape(Shape::disc(0.5)), 2.0, state));
    builder.add_gravity(ball, DVec2::new(0.0, -gravity));
    builder.build().expect("a sound world")
}

#[test]
fn a_lift_of_ones_own_law_takes_up_what_it_meets() {
    for (height, gravity) in [(0.0, 9.81), (0.125, 0.0)] {
        let mut world = lift(Arc::new(Rises), height, gravity);
        world.advance_to(3.0, &mut |_| ()).expect("it rises");
        let [lift, ball] = [0, 1].map(|body| world.state(BodyId(body)));
        assert!((lift.position.y + 0.5 - 8.0 / 6.0).abs() < 1e-12 && (lift.velocity.y - 2.0).abs() < 1e-12);
        let apart = ball.position.y - lift.position.y - 1.0;
        assert!(apart.abs() < 1e-9 && (ball.velocity.y - 2.0).abs() < 1e-9, "{height}, {gravity}: {ball:?}");
        let [force] = world.contact_forces()[..] else { panic!("it rides") };
        assert!((force.force - 2.0 * (gravity + 2.0)).abs() < 1e-8, "{} N", force.force);
        let ledger = world.ledger();
        // What the lift does is the energy of the ball, and half of the blow's goes into heat.
        let meets = 0.5 * (6.0 * height).powf(2.0 / 3.0);
        assert!((ledger.impacts + ledger.captures + meets * meets).abs() < 1e-8, "{ledger:?}");
        assert_closed(&world, 1e-8);
    }
}

#[test]
fn a_lift_may_set_out_all_at_once() {
    for gravity in [9.81, 0.0] {
        let mut world = lift(Arc::new(SetsOut), 0.0, gravity);
        world.advance_to(3.0, &mut |_| ()).unwrap_or_else(|error| panic!("{gravity}: {error}"));
        let ball = world.state(BodyId(1));
        assert!((ball.position.y - 4.5).abs() < 1e-9 && (ball.velocity.y - 4.0).abs() < 1e-9, "{ball:?}");
        let [force] = world.contact_forces()[..] else { panic!("it rides") };
        assert!((force.force - 2.0 * (gravity + 2.0)).abs() < 1e-8, "{} N", force.force);
        assert_closed(&world, 1e-8);
    }
}

#[test]
fn by_steps_a_disc_rides_on_a_floor_that_goes_up_and_down() {
    let floor = "[[body]]\nname = \"floor\"\nfixed = true\nposition = [0.0, -0.5]\nelasticity = 0.0\nshape = { block = { width = 20.0, height = 1.0 } }\nmotion = { oscillate = { amplitude = [0.0, 0.05], frequency = 1.0 } }";
    let disc = "[[body]]\nname = \"disc\"\nmass = 1.0\nelasticity = 0.0\nposition = [0.0, 0.2]\nvelocity = [0.0, 0.3]\nshape = { disc = { radius = 0.2 } }";
    let run = "duration = 2.0, strategy = \"steps\", time_step = 0.002";
    let mut world = world(run, &format!("{floor}\n{disc}"));
    for look in 1..=20 {
        world.advance_to(0.1 * f64::from(look), &mut |_| ()).expect("it rides");
        let [floor, disc] = [0, 1].map(|body| world.state(BodyId(body)));
        let swing = (std::f64::consts::TAU * 0.1 * f64::from(look)).sin();
        assert!((floor.position.y + 0.5 - 0.05 * swing).abs() < 1e-4, "{floor:?}");
        assert!((disc.position.y - floor.position.y - 0.7).abs() < 1e-4, "{disc:?}");
    }
}

#[test]
fn motions_that_are_none_are_refused_by_their_field() {
    let refusal = |fixed: &str, motion: &str| {
        let text = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 2.0, start_time = 1.0 }}\n[[body]]\nname = \"a\"\n{fixed}\nshape = {{ disc = {{ radius = 1.0 }} }}\nmotion = {motion}"
        );
        let scene =
            Scene::parse(&text, SceneFormat::Toml).and_then(|scene| World::from_scene(&scene).map(|_| ()));
        scene.expect_err("it is refused").to_string()
    };
    for (motion, why) in [
        ("{}", "body[0].motion: tells no motion"),
        (
            "{ velocity = [1.0, 0.0], table = { times = [0, 1], angles = [0, 1] } }",
            "motion.table: give `velocity` or `table`, not both",
        ),
        (
            "{ oscillate = { amplitude = [1.0, 0.0], frequency = nan } }",
            "motion.oscillate.frequency: must be a finite number",
        ),
        (
            "{ table = { times = [0, 1] } }",
            "motion.table: tells no motion: give `positions`, `angles`, or both",
        ),
        (
            "{ table = { times = [0, 4, 4], angles = [0, 1, 2] } }",
            "motion.table.times: the times of a table must grow: entry 2",
        ),
        (
            "{ table = { times = [0, 4], angles = [0, 1, 2] } }",
            "motion.table.angles: a table needs one value for each time",
        ),
        (
            "{ table = { times = [0, 2.5], angles = [0, 1] } }",
            "motion.table.times: go from 0 s to 2.5 s, but the run from 1 s to 3 s",
        ),
        (
            "{ table = { times = [0, 1, 2, 4], positions = [[0, 0], [1, 0], [2, 0], [3, 0]], periodic = true } }",
            "motion.table.positions: the last value of a periodic table",
        ),
        ("{ speed = 1.0 }", "motion.speed: unknown field"),
    ] {
        let message = refusal("fixed = true", motion);
        assert!(message.contains(why), "{motion}: {message}");
    }
    let free = refusal("mass = 1.0", "{ angular_velocity = 1.0 }");
    assert!(free.contains("body[0].motion: only a fixed body is moved"), "{free}");
}
