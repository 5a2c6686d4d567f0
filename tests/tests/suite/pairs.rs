//! Pairs of bodies that differ from what their bodies say, in events and in steps.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyId, BodyState, World};

const G: f64 = 10.0;

fn scene(run: &str, bodies: &str) -> String {
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"pairs\"\nrun = {{ duration = 100.0, {run} }}\n[[force]]\ngravity = {{ acceleration = [0.0, {:?}] }}\n\
         [[body]]\nname = \"floor\"\nfixed = true\nfriction = 0.5\nshape = {{ block = {{ width = 400.0, height = 1.0 }} }}\n\
         position = [0.0, -0.5]\n{bodies}",
        -G
    )
}

/// A body of 1 kg, which does not bounce.
fn body(name: &str, shape: &str, more: &str) -> String {
    format!("[[body]]\nname = \"{name}\"\nmass = 1.0\nelasticity = 0.0\nshape = {{ {shape} }}\n{more}\n")
}

const BLOCK: &str = "block = { width = 1.0, height = 1.0 }";
const DISC: &str = "disc = { radius = 0.5 }";
const EVENTS: &str = "tolerance = 1e-10";
const STEPS: &str = "strategy = \"steps\", time_step = 1e-3";

/// The states of the bodies after some time.
fn after(time: f64, run: &str, bodies: &str) -> Vec<BodyState> {
    let mut world: World = halfgap_tests::world_of(&scene(run, bodies));
    world.advance_to(time, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
    world.bodies().map(|body: BodyId| world.state(body)).collect()
}

#[test]
fn a_block_slides_by_the_friction_of_its_pair() {
    let moving = "friction = 0.5\nvelocity = [2.0, 0.0]";
    let bodies = body("a", BLOCK, &format!("{moving}\nposition = [0.0, 0.5]"))
        + &body("b", BLOCK, &format!("{moving}\nposition = [10.0, 0.5]"))
        + "[[pair]]\nbodies = [\"b\", \"floor\"]\nfriction = 0.2\n";
    for (run, tolerance) in [(EVENTS, 1e-9), (STEPS, 1e-3)] {
        let states = after(5.0, run, &bodies);
        for (state, expected) in
            [(states[1], 4.0 / (2.0 * 0.5 * G)), (states[2], 10.0 + 4.0 / (2.0 * 0.2 * G))]
        {
            assert!(
                (state.position.x - expected).abs() < tolerance,
                "{run}: {} for {expected}",
                state.position.x
            );
        }
    }
}

#[test]
fn a_block_sticks_by_the_static_friction_of_its_pair_though_bodies_are_smooth() {
    // A push of 3 N against a static friction of 4 N or 2.5 N.
    let push =
        "[[force]]\nconstant = { body = \"a\", point = [0.0, 0.0], force = [3.0, 0.0], frame = \"world\" }\n";
    let with = |sticks: f64| {
        let a = body("a", BLOCK, "position = [0.0, 0.5]");
        format!(
            "{a}{push}[[pair]]\nbodies = [\"floor\", \"a\"]\nfriction = 0.1\nstatic_friction = {sticks:?}\n"
        )
    };
    let states = [0.4, 0.25].map(|sticks| after(1.0, EVENTS, &with(sticks))[1]);
    assert!(states[0].position.x.abs() < 1e-12, "{:?}", states[0]);
    assert!((states[1].position.x - 1.0).abs() < 1e-9, "{:?}", states[1]);
}

#[test]
fn discs_roll_by_the_resistance_of_their_pairs() {
    let rolling = "friction = 0.5\nvelocity = [1.0, 0.0]\nangular_velocity = -2.0\nrolling_resistance = 0.04";
    let bodies = body("a", DISC, &format!("{rolling}\nposition = [0.0, 0.5]"))
        + &body("b", DISC, &format!("{rolling}\nposition = [-10.0, 0.5]"))
        + &body("c", DISC, &format!("{rolling}\nposition = [-20.0, 0.5]"))
        + "[[pair]]\nbodies = [\"a\", \"floor\"]\nrolling_resistance = 0.02\n\
           [[pair]]\nbodies = [\"floor\", \"b\"]\nrolling_resistance = 0.0\n";
    for (run, tolerance) in [(EVENTS, 1e-9), (STEPS, 1e-3)] {
        let states = after(9.0, run, &bodies);
        // They stop after 3/4 v^2/(c g).
        for (state, expected) in
            [(states[1], 0.75 / (0.02 * G)), (states[2], -10.0 + 9.0), (states[3], -20.0 + 0.75 / (0.04 * G))]
        {
            assert!(
                (state.position.x - expected).abs() < tolerance,
                "{run}: {} for {expected}",
                state.position.x
            );
        }
    }
}

#[test]
fn a_ball_bounces_by_the_elasticity_of_its_pair() {
    let bodies = body("a", DISC, "position = [0.0, 1.75]")
        + &body("b", DISC, "position = [10.0, 1.75]")
        + "[[pair]]\nbodies = [\"a\", \"floor\"]\nelasticity = 0.5\n";
    for (run, tolerance) in [(EVENTS, 1e-9), (STEPS, 3e-2)] {
        // It falls for half a second at 10 m/s^2, and rises at 2.5 m/s.
        let states = after(0.75, run, &bodies);
        assert!((states[1].position.y - 0.5 - 0.3125).abs() < tolerance, "{run}: {:?}", states[1]);
        assert!((states[2].position.y - 0.5).abs() < tolerance, "{run}: {:?}", states[2]);
    }
}

#[test]
fn a_ball_spins_back_by_the_tangential_elasticity_of_its_pair() {
    let ball = body("a", DISC, "position = [0.0, 1.75]\nfriction = 5.0\nvelocity = [1.0, 0.0]");
    let bodies = format!(
        "{ball}[[pair]]\nbodies = [\"a\", \"floor\"]\ntangential_elasticity = 0.6\nelasticity = 0.5\n"
    );
    let state = after(0.6, EVENTS, &bodies)[1];
    // The slip of 1 m/s becomes -0.6 m/s by an impulse of 1.6 m/s over 3 per kg.
    let (speed, spin) = (1.0 - 1.6 / 3.0, -1.6 / 3.0 * 0.5 / 0.125);
    assert!(
        (state.velocity.x - speed).abs() < 1e-9 && (state.angular_velocity - spin).abs() < 1e-9,
        "{state:?}"
    );
}

#[test]
fn a_pair_collides_or_does_not_as_it_says() {
    let ball = body("a", DISC, "position = [0.0, 1.75]");
    let passes = format!("{ball}[[pair]]\nbodies = [\"a\", \"floor\"]\ncollide = false\n");
    let meets = format!(
        "{ball}passes_through = [\"floor\"]\n[[pair]]\nbodies = [\"a\", \"floor\"]\ncollide = true\n"
    );
    for run in [EVENTS, STEPS] {
        assert!((after(1.0, run, &passes)[1].position.y + 3.25).abs() < 1e-2, "{run}");
        assert!((after(1.0, run, &meets)[1].position.y - 0.5).abs() < 1e-2, "{run}");
    }
}

#[test]
fn what_is_wrong_with_a_pair_is_named() {
    let refusal = |pair: &str| {
        let bodies = body("a", BLOCK, "friction = 0.5\nposition = [0.0, 0.5]");
        let text = scene("tolerance = 1e-8", &format!("{bodies}[[pair]]\n{pair}\n"));
        let refused = Scene::parse(&text, SceneFormat::Toml).and_then(|scene| World::from_scene(&scene));
        refused.map_or_else(|error| error.to_string(), |_| String::new())
    };
    for (pair, expected) in [
        (
            "bodies = [\"a\", \"flor\"]",
            "pair[0].bodies[1]: there is no body named \"flor\" (did you mean \"floor\"?)",
        ),
        ("bodies = [\"a\", \"a\"]", "pair[0].bodies: a body makes no pair with itself"),
        ("bodies = [\"a\", \"floor\"]\nfriction = -1.0", "pair[0].friction: must not be negative"),
        ("bodies = [\"a\", \"floor\"]\nelasticity = 2.0", "pair[0].elasticity: must"),
        (
            "bodies = [\"a\", \"floor\"]\nstatic_friction = 0.4",
            "pair[0].static_friction: the pair would stick less",
        ),
        (
            "bodies = [\"a\", \"floor\"]\n[[pair]]\nbodies = [\"floor\", \"a\"]",
            "pair[1].bodies: is the pair of pair[0] again",
        ),
        ("bodies = [\"a\", \"floor\"]\ngrip = 1.0", "unknown field `grip`"),
    ] {
        let message = refusal(pair);
        assert!(message.contains(expected), "{pair}: {message}");
    }
    assert_eq!(refusal("bodies = [\"a\", \"floor\"]\nfriction = 0.7"), "");
}
