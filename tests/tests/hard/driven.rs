//! Bodies that force laws alone move, press or bring to rest: contacts ended by force laws, pairs that drift far away,
//! springs that have settled.

use super::within;
use halfgap::{BodyId, Event};
use halfgap_tests::world_of;
use std::f64::consts::TAU;

/// Times [s] at which the contacts of a scene end, up to its end.
fn releases(text: &str, duration: f64) -> Vec<f64> {
    let mut times = Vec::new();
    let mut note = |event: &Event| {
        times.extend(matches!(event, Event::ContactEnds(_)).then(|| event.time()));
    };
    world_of(text).advance_to(duration, &mut note).unwrap_or_else(|error| panic!("{error}"));
    times
}

/// A disc in an upright guide on a floor, which weighs 9.81 N a kilogram; `rest` says what else acts on it.
fn guided_disc(mass: f64, (duration, tolerance): (f64, f64), rest: &str) -> String {
    format!(
        r#"
        format = "halfgap-scene-1"
        title = "t"
        run = {{ duration = {duration:?}, tolerance = {tolerance:e} }}
        [[body]]
        name = "floor"
        fixed = true
        shape = {{ block = {{ width = 20.0, height = 1.0 }} }}
        position = [0.0, -0.5]
        [[body]]
        name = "disc"
        shape = {{ disc = {{ radius = 0.1 }} }}
        mass = {mass:e}
        elasticity = 0.0
        position = [0.0, 0.1]
        [[connector]]
        slot = {{ a = {{ body = "world", point = [0.0, 0.0] }}, b = {{ body = "disc", point = [0.0, 0.0] }}, normal = [1.0, 0.0] }}
        [[force]]
        gravity = {{ acceleration = [0.0, -9.81], bodies = ["disc"] }}
        {rest}
        "#
    )
}

/// A guided disc of 1 kg that a turning force lifts now and then.
fn lifted_disc(magnitude: f64, rate: f64, phase: f64, run: (f64, f64)) -> String {
    let force = format!("magnitude = {magnitude:?}, rate = {rate:?}, phase = {phase:?}");
    guided_disc(
        1.0,
        run,
        &format!("[[force]]\nrotating = {{ body = \"disc\", point = [0.0, 0.0], {force} }}"),
    )
}

/// The time [s] nearest to another at which the force on a guided disc comes to lift it: the floor presses with
/// N = 9.81 - M sin(phase + rate t).
fn lift_near(time: f64, magnitude: f64, rate: f64, phase: f64) -> f64 {
    let lifts = (9.81f64 / magnitude).asin();
    let turn = ((phase + rate * time - lifts) / TAU).round();
    (lifts + turn * TAU - phase) / rate
}

#[test]
fn a_disc_in_a_guide_leaves_its_floor_when_a_turning_force_lifts_it() {
    // It stands wholly still until then, so that no error of its steps tells how the force turns.
    let (mut worst, mut count) = (0.0f64, 0);
    for (magnitude, rate, phase) in [(12.0, 10.0, -0.35), (11.0, 8.5, -2.85)] {
        for tolerance in [1e-3, 1e-5, 1e-7, 1.1e-8, 1e-8, 9e-9, 4e-9, 1e-9, 1e-10] {
            for time in releases(&lifted_disc(magnitude, rate, phase, (1.5, tolerance)), 1.5) {
                worst = worst.max((time - lift_near(time, magnitude, rate, phase)).abs());
                count += 1;
            }
        }
    }
    // Three turns of the first and two of the second lift it in that time, at each of nine tolerances.
    assert_eq!(count, 45);
    within("a turning force lifts a disc: release [s]", worst, 1e-8);
}

#[test]
fn a_force_that_turns_fast_lifts_a_disc_in_its_first_turn() {
    // Thousands of turns would fit into the first steps.
    let mut worst = 0.0f64;
    for (share, rate, phase) in
        [(1.3, 14531.9, 2.549), (3.0, 30505.0, 0.2344), (1.01, 371.76, 2.4827), (1.3, 740.74, 2.4795)]
    {
        let magnitude = share * 9.81;
        for tolerance in [1e-4, 4.5e-7, 1e-8, 9.7e-9, 1e-10] {
            let turns = 30.0 * TAU / rate;
            let times = releases(&lifted_disc(magnitude, rate, phase, (turns, tolerance)), turns);
            let first = *times.first().unwrap_or_else(|| panic!("it is lifted: {rate} rad/s at {tolerance}"));
            // The first lift after the start.
            let near = lift_near(0.0, magnitude, rate, phase);
            let expected = if near < 0.0 { near + TAU / rate } else { near };
            worst = worst.max((first - expected).abs() * rate);
        }
    }
    within("a fast force lifts a disc: release, angle [rad]", worst, 1e-6);
}

#[test]
fn a_light_disc_leaves_its_floor_as_a_planet_flies_over_it() {
    // It stands still while the planet comes from far away, and is pulled for a moment only: the floor presses with
    // N = m (9.81 - s h / r^3), where h is the height of the planet's path above the disc and r its distance.
    let (height, speed, mass) = (1.5f64, 40.0f64, 1e-7f64);
    let strength = 3.0 * 9.81 * height * height;
    let expected = {
        let lifts = (strength * height / 9.81).cbrt();
        1.0 - (lifts * lifts - height * height).sqrt() / speed
    };
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        let planet = format!(
            "[[body]]\nname = \"planet\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\n\
             position = [{:?}, {:?}]\nvelocity = [{speed:?}, 0.0]\n\
             [[force]]\nmutual_gravity = {{ strength = {strength:?} }}",
            -speed,
            0.1 + height
        );
        let text = guided_disc(mass, (2.0, tolerance), &planet);
        let times = releases(&text, 1.5);
        let first = *times.first().unwrap_or_else(|| panic!("it is lifted, at {tolerance}"));
        within(&format!("a planet lifts a disc at {tolerance:e}: release [s]"), first - expected, 1e-6);
    }
}

/// A disc and a block that a spring with a dashpot presses together, both at a speed [m/s].
fn pressed_pair(speed: f64, tolerance: f64) -> String {
    let body = |name: &str, shape: &str, rest: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {shape}\nvelocity = [{speed:?}, 0.0]\nelasticity = 0.5\n{rest}\n"
        )
    };
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 300.0, tolerance = {tolerance:e} }}\n{}{}\
         [[force]]\nspring = {{ a = {{ body = \"disc\", point = [0.0, 0.0] }}, b = {{ body = \"block\", point = [0.0, 0.0] }}, rest_length = 0.1, stiffness = 50.0, damping = 1.0 }}\n",
        body("disc", "{ disc = { radius = 0.2 } }", "mass = 1.0"),
        body(
            "block",
            "{ block = { width = 0.4, height = 0.3 } }",
            "mass = 2.0\nposition = [0.6, 0.02]\nangle = 0.1"
        )
    )
}

#[test]
fn a_pair_that_drifts_away_rests_on_each_other_as_one_that_stays() {
    let apart = |speed: f64, tolerance: f64| {
        let mut world = world_of(&pressed_pair(speed, tolerance));
        world.advance_to(300.0, &mut |_| {}).unwrap_or_else(|error| panic!("{speed} m/s: {error}"));
        (world.state(BodyId(1)).position - world.state(BodyId(0)).position).length()
    };
    for tolerance in [1e-8, 1e-10] {
        let at_rest = apart(0.0, tolerance);
        for speed in [3.0, 1000.0] {
            let what = format!("a pair pressed together goes {:.0e} m: its distance [m]", speed * 300.0);
            within(&what, apart(speed, tolerance) - at_rest, 3e-7);
        }
    }
}

#[test]
fn a_long_planned_run_changes_its_first_second_by_no_more_than_the_tolerance() {
    // Two free discs meet after a second: with e = 0.5 and equal masses the one at 1 m/s leaves 0.25 and 0.75 m/s. In
    // a million seconds they would fall 5e12 m.
    for duration in [2.0, 1e3, 1e6] {
        let text = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = {duration:?} }}\n\
             [[body]]\nname = \"a\"\nshape = {{ disc = {{ radius = 0.2 }} }}\nmass = 1.0\nelasticity = 0.5\nvelocity = [1.0, 0.0]\n\
             [[body]]\nname = \"b\"\nshape = {{ disc = {{ radius = 0.3 }} }}\nmass = 1.0\nelasticity = 0.5\nposition = [1.5, 0.0]\n\
             [[force]]\ngravity = {{ acceleration = [0.0, -9.81] }}\n"
        );
        let mut world = world_of(&text);
        world.advance_to(2.0, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
        let error = (world.state(BodyId(0)).position.x - 1.25).abs();
        let error = error.max((world.state(BodyId(1)).position.x - 2.25).abs());
        within(&format!("free discs of a run of {duration:.0e} s meet: place [m]"), error, 1e-8);
    }
}

/// Number of steps of a scene.
fn steps(text: &str, duration: f64) -> u64 {
    let mut world = world_of(text);
    world.advance_to(duration, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
    world.statistics().steps
}

/// A mass on a damped spring, which stands still after some 100 s.
fn settling(duration: f64, tolerance: f64) -> String {
    format!(
        r#"
        format = "halfgap-scene-1"
        title = "t"
        run = {{ duration = {duration:?}, tolerance = {tolerance:e} }}
        [[body]]
        name = "disc"
        shape = {{ disc = {{ radius = 0.1 }} }}
        mass = 1.0
        position = [0.0, -1.3]
        [[force]]
        spring = {{ a = {{ body = "world", point = [0.0, 0.0] }}, b = {{ body = "disc", point = [0.0, 0.0] }}, rest_length = 1.0, stiffness = 30.0, damping = 0.5 }}
        [[force]]
        gravity = {{ acceleration = [0.0, -9.81] }}
        "#
    )
}

#[test]
fn bodies_that_attract_each_other_take_no_more_steps_for_going_along_fast() {
    let pair = |speed: f64| {
        let body = |name: &str, rest: &str| {
            format!("[[body]]\nname = \"{name}\"\nvelocity = [{speed:?}, 0.0]\nelasticity = 0.5\n{rest}\n")
        };
        format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 20.0 }}\n{}{}\
             [[force]]\nmutual_gravity = {{ strength = 0.5 }}\n",
            body("disc", "mass = 1.0\nshape = { disc = { radius = 0.2 } }"),
            body(
                "block",
                "mass = 2.0\nshape = { block = { width = 0.4, height = 0.3 } }\nposition = [0.6, 0.02]\nangle = 0.1"
            ),
        )
    };
    for speed in [0.0, 10.0, 1e4] {
        let steps = steps(&pair(speed), 20.0);
        within(&format!("a pair attracts each other at {speed:.0e} m/s, 20 s: steps"), steps as f64, 3000.0);
    }
}

#[test]
fn a_mass_that_has_settled_on_a_damped_spring_takes_long_steps() {
    // The swing dies away within 100 s. After that the work of the dashpot is the rounding of velocities that are
    // themselves rounding.
    for tolerance in [1e-6, 1e-8, 1e-9, 1e-11] {
        let steps = steps(&settling(1e4, tolerance), 1e4);
        within("a mass settles on a damped spring, 1e4 s: steps", steps as f64, 20_000.0);
    }
}

#[test]
fn looks_at_a_mass_that_settles_change_no_bit_of_it() {
    // The probe of the steepness of forces takes another direction each time, which no look may change.
    let end = |looks: u32| {
        let mut world = world_of(&settling(200.0, 1e-7));
        for look in 1..=looks {
            let time = 200.0 * f64::from(look) / f64::from(looks);
            world.advance_to(time, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
            let _ = world.state(BodyId(0));
        }
        (world.statistics().steps, format!("{:?}", world.state(BodyId(0))))
    };
    let once = end(1);
    for looks in [2, 8, 1000] {
        assert_eq!(end(looks), once, "{looks} looks");
    }
}

#[test]
fn a_chain_of_stiff_springs_that_creeps_takes_long_steps() {
    // A light body is held between strong springs, whose tension makes rounding across the chain count; rounding there
    // does not show how long a step may be.
    for (tolerance, most) in [(1e-6, 3_000.0), (1e-8, 9_000.0), (1e-10, 27_000.0)] {
        let body = |name: &str, place: [f64; 2], velocity: [f64; 2], mass: f64| {
            format!(
                "[[body]]\nname = \"{name}\"\nshape = {{ disc = {{ radius = 0.1 }} }}\nposition = {place:?}\n\
                 velocity = {velocity:?}\nmass = {mass:?}\n"
            )
        };
        let spring = |a: &str, b: &str, stiffness: f64, damping: f64| {
            format!(
                "[[force]]\nspring = {{ a = {{ body = \"{a}\", point = [0.0, 0.0] }}, b = {{ body = \"{b}\", point = [0.0, 0.0] }}, rest_length = 10.0, \
                 stiffness = {stiffness:?}, damping = {damping:?} }}\n"
            )
        };
        let text = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\n\
             run = {{ duration = 1000.0, collisions = false, tolerance = {tolerance:e} }}\n{}{}{}{}{}{}\
             [[force]]\ndamping = {{ linear = 0.016, angular = 0.0 }}\n",
            body("a", [10.389, 2.104], [-0.041, -0.0083], 0.002),
            body("b", [20.221, 4.095], [-0.977, -0.198], 0.95),
            body("c", [30.275, 6.131], [-0.389, -0.0787], 0.0173),
            spring("world", "a", 0.75, 262.0),
            spring("a", "b", 2519.0, 0.005),
            spring("b", "c", 1.4, 20.5),
        );
        let steps = steps(&text, 1000.0);
        within(
            &format!("a chain of stiff springs creeps at {tolerance:e}, 1000 s: steps"),
            steps as f64,
            most,
        );
    }
}
