//! What acts on the free coordinate of a joint, gears, and connectors that contradict each other.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyId, ConnectorId, Intervention, World};
use halfgap_tests::world_of;
use std::f64::consts::TAU;

const HEAD: &str = "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 200.0 }\n";
const GRAVITY: &str = "[[force]]\ngravity = { acceleration = [0.0, -9.81] }\n";

/// An arm of 1 m and 1 kg on a pin at the origin, on which something acts.
fn arm(on_pin: &str) -> String {
    format!(
        "[[body]]\nname = \"arm\"\nshape = {{ block = {{ width = 1.0, height = 0.1 }} }}\nmass = 1.0\nposition = [0.5, 0.0]\n\
         [[connector]]\npin = {{ a = {{ body = \"world\", point = [0.0, 0.0] }}, b = {{ body = \"arm\", point = [-0.5, 0.0] }}{on_pin} }}\n"
    )
}

fn wheels(gears: &str) -> String {
    let mut text = HEAD.to_owned();
    for (name, x, spin) in [("a", 0.0, 100.0), ("b", 3.35, -42.553_191_489_361_7)] {
        text += &format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ disc = {{ radius = 1.0 }} }}\nmass = 1.0\nposition = [{x}, 0.0]\n\
             angular_velocity = {spin}\n\
             [[connector]]\npin = {{ a = {{ body = \"world\", point = [{x}, 0.0] }}, b = {{ body = \"{name}\", point = [0.0, 0.0] }} }}\n"
        );
    }
    text + gears
}

fn advance(world: &mut World, time: f64) {
    world.advance_to(time, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_gear_keeps_its_ratio_over_thousands_of_turns() {
    let mut world = world_of(&wheels("[[connector]]\ngear = { a = \"a\", b = \"b\", ratio = -2.35 }\n"));
    advance(&mut world, 200.0);
    let [a, b] = [0, 1].map(|body| world.state(BodyId(body)).angle);
    assert!(a > 3000.0 * TAU, "{a}");
    assert!((a + 2.35 * b).abs() <= 1e-12 * a, "{a} {b}");
}

#[test]
fn a_motor_holds_its_speed_while_the_load_allows() {
    let mut world = world_of(&(HEAD.to_owned() + &arm(", motor = { speed = 2.0, max = 20.0 }") + GRAVITY));
    for second in 1..=100 {
        advance(&mut world, f64::from(second));
        let spin = world.state(BodyId(0)).angular_velocity;
        assert!((spin - 2.0).abs() <= 1e-12, "{second} s: {spin}");
    }
    let ledger = world.ledger();
    assert!(ledger.integration_error().abs() < 1e-6, "{ledger:?}");
}

#[test]
fn a_driven_coordinate_is_where_its_law_tells_and_what_that_takes_is_booked() {
    let oscillate = ", drive = { oscillate = { amplitude = 1.2, frequency = 0.7, phase = 0.3 } }";
    let mut world = world_of(&(HEAD.to_owned() + &arm(oscillate) + GRAVITY));
    let mut most = 0.0f64;
    for tenth in 1..=300 {
        let time = 0.1 * f64::from(tenth);
        advance(&mut world, time);
        let (phase, state) = (TAU * 0.7 * time + 0.3, world.state(BodyId(0)));
        let told = 1.2 * (phase.sin() - 0.3f64.sin());
        assert!((state.angle - told).abs() <= 1e-14, "{time} s: {} for {told}", state.angle);
        most = most.max(world.ledger().drives.abs());
        let rate = 1.2 * TAU * 0.7 * phase.cos();
        assert!((state.angular_velocity - rate).abs() <= 1e-13, "{time} s");
    }
    // At the end, after whole periods, the drive has done no work in all.
    let ledger = world.ledger();
    assert!(most > 1.0 && ledger.integration_error().abs() < 1e-6, "{most} J, {ledger:?}");
}

#[test]
fn a_drive_is_not_stopped_by_an_impact_and_its_blow_is_booked() {
    let disc = "[[body]]\nname = \"disc\"\nshape = { disc = { radius = 0.1 } }\nmass = 2.0\nposition = [0.8, 0.6]\n\
                velocity = [0.0, -1.0]\nelasticity = 0.7\n";
    let mut world = world_of(&(HEAD.to_owned() + &arm(", drive = { speed = 0.5 }") + disc));
    advance(&mut world, 0.6);
    let ledger = world.ledger();
    assert!(world.statistics().impacts > 0 && ledger.drives != 0.0, "{ledger:?}");
    assert!((world.state(BodyId(0)).angle - 0.3).abs() < 1e-13);
    assert!(ledger.integration_error().abs() < 1e-8, "{ledger:?}");
}

/// A crank of 0.3 m on a pin at the origin, a coupler of 1 m on it, and a rocker of 0.9 m on a pin at (0.8, 0), with
/// something on the pins of the crank and of the rocker. The crank can turn all round, the rocker cannot.
fn four_bar(on_crank: &str, on_rocker: &str) -> String {
    // The circles of 1 m about (0.3, 0) and of 0.9 m about (0.8, 0) meet here.
    let joint = [0.74, (1.0f64 - 0.44 * 0.44).sqrt()];
    let bar = |name: &str, passes: [&str; 2], from: [f64; 2], to: [f64; 2]| {
        let along = [to[0] - from[0], to[1] - from[1]];
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ block = {{ width = {}, height = 0.05 }} }}\nmass = 1.0\n\
             position = [{}, {}]\nangle = {}\npasses_through = {passes:?}\n",
            along[0].hypot(along[1]),
            from[0] + along[0] / 2.0,
            from[1] + along[1] / 2.0,
            along[1].atan2(along[0]),
        )
    };
    let point = |body: &str, x: f64| format!("{{ body = \"{body}\", point = [{x}, 0.0] }}");
    let pin =
        |a: String, b: String, on_it: &str| format!("[[connector]]\npin = {{ a = {a}, b = {b}{on_it} }}\n");
    bar("crank", ["coupler", "rocker"], [0.0, 0.0], [0.3, 0.0])
        + &bar("coupler", ["crank", "rocker"], [0.3, 0.0], joint)
        + &bar("rocker", ["crank", "coupler"], [0.8, 0.0], joint)
        + &pin(point("world", 0.0), point("crank", -0.15), on_crank)
        + &pin(point("crank", 0.15), point("coupler", -0.5), "")
        + &pin(point("coupler", 0.5), point("rocker", 0.45), "")
        + &pin(point("world", 0.8), point("rocker", -0.45), on_rocker)
}

#[test]
fn a_driven_linkage_is_exactly_driven_at_outputs_between_steps() {
    let drive = ", drive = { oscillate = { amplitude = 2.0, frequency = 0.31 } }";
    let mut world = world_of(&(HEAD.to_owned() + &four_bar(drive, "") + GRAVITY));
    for tenth in 1..=200 {
        let time = 0.1 * f64::from(tenth);
        advance(&mut world, time);
        let (phase, state) = (TAU * 0.31 * time, world.state(BodyId(0)));
        assert!((state.angle - 2.0 * phase.sin()).abs() <= 1e-14, "{time} s: {}", state.angle);
        assert!((state.angular_velocity - 2.0 * TAU * 0.31 * phase.cos()).abs() <= 1e-13, "{time} s");
        // The pins hold where the dense output would be off, too.
        assert!(world.statistics().largest_connector_error < Some(1e-10));
    }
}

/// An arm that a drive swings, and a lever on a pin of its own that lies on it, now flush, now on the arm's corner.
fn lever_on_a_driven_arm() -> World {
    let drive = ", drive = { oscillate = { amplitude = 0.4, frequency = 0.5 } }";
    let lever = "[[body]]\nname = \"lever\"\nshape = { block = { width = 1.6, height = 0.1 } }\nmass = 2.0\nposition = [1.6, 0.1]\n\
                 elasticity = 0.0\n[[connector]]\npin = { a = { body = \"world\", point = [2.4, 0.1] }, b = { body = \"lever\", point = [0.8, 0.0] } }\n";
    world_of(&(HEAD.to_owned() + &arm(drive) + lever + GRAVITY))
}

#[test]
fn a_driven_body_in_contact_is_where_its_law_tells_and_its_forces_accelerate_it() {
    let (mut world, arm) = (lever_on_a_driven_arm(), BodyId(0));
    let mut contacts = 0;
    for step in 1..=300 {
        let time = 0.037 * f64::from(step);
        advance(&mut world, time);
        let (speed, state) = (TAU * 0.5, world.state(arm));
        let (sin, cos) = (speed * time).sin_cos();
        assert!((state.angle - 0.4 * sin).abs() <= 1e-14, "{time} s: {}", state.angle);
        assert!((state.angular_velocity - 0.4 * speed * cos).abs() <= 1e-13, "{time} s");
        // Newton and Euler: the pin, the drive, gravity and the lever together do what the law asks for.
        let (mut force, mut torque) = ([0.0, -9.81], 0.0);
        for told in world.contact_forces() {
            let Some(side) = told.bodies.iter().position(|&body| body == arm) else { continue };
            let sign = if side == 0 { 1.0 } else { -1.0 };
            torque += sign * told.torque.unwrap_or(0.0);
            let along = sign * told.force * told.normal;
            force = [force[0] + along.x, force[1] + along.y];
            torque += told.point.map_or(0.0, |point| (point - state.position).perp_dot(along));
            contacts += u32::from(told.connector.is_none());
        }
        let (spin, turn) = (state.angular_velocity, -0.4 * speed * speed * sin);
        let (sin, cos) = (0.5 * state.angle.sin(), 0.5 * state.angle.cos());
        let asked = [-spin * spin * cos - turn * sin, -spin * spin * sin + turn * cos];
        for (force, asked) in force.into_iter().zip(asked) {
            assert!((force - asked).abs() < 1e-7, "{time} s: {force} N for {asked}");
        }
        let asked = turn * (1.0 + 0.01) / 12.0;
        assert!((torque - asked).abs() < 1e-7, "{time} s: {torque} N m for {asked}");
    }
    let ledger = world.ledger();
    assert!(contacts > 100, "they touch most of the time: {contacts}");
    assert!(ledger.drives.abs() > 0.01 && ledger.integration_error().abs() < 1e-6, "{ledger:?}");
}

#[test]
fn a_driven_body_in_contact_goes_on_with_the_same_bits_once_it_is_loaded() {
    let (mut world, mut loaded) = (lever_on_a_driven_arm(), lever_on_a_driven_arm());
    for step in 1..=60 {
        let time = 0.053 * f64::from(step);
        let bytes = loaded.save().expect("its laws are the crate's");
        loaded = World::load(&bytes).expect("they are sound");
        for world in [&mut world, &mut loaded] {
            advance(world, time);
        }
        let told = |world: &World| format!("{:?} {:?}", world.ledger(), world.contact_forces());
        assert_eq!(told(&world), told(&loaded), "{time} s");
        assert_eq!(world.save(), loaded.save(), "{time} s");
    }
}

#[test]
fn a_limit_counts_turns_that_were_taken_out_of_angles() {
    // The group starts anew in its third turn, and then counts from there.
    let spinning = arm(", limits = { upper = 25.0 }, friction_torque = 0.01").replace(
        "position = [0.5, 0.0]\n",
        "position = [0.5, 0.0]\nangular_velocity = 10.0\nvelocity = [0.0, 5.0]\n",
    );
    let mut world = world_of(&(HEAD.to_owned() + &spinning));
    advance(&mut world, 1.5);
    assert!(world.state(BodyId(0)).angle > 2.0 * TAU);
    let push = Intervention::AngularImpulse { body: BodyId(0), impulse: -0.1 };
    world.intervene(&[push], &mut |_| ()).expect("it may be slowed down");
    advance(&mut world, 4.0);
    let state = world.state(BodyId(0));
    assert!((state.angle - 25.0).abs() < 1e-7 && state.angular_velocity.abs() < 1e-9, "{state:?}");
}

#[test]
fn what_a_drive_or_a_pulley_cannot_do_is_told_by_name() {
    // Driven by its rocker, a linkage comes to where crank and coupler are in line.
    let linkage = four_bar("", ", drive = { speed = 1.0 }").replace(
        "[[connector]]\npin = { a = { body = \"world\", point = [0.8",
        "[[connector]]\nname = \"hinge\"\npin = { a = { body = \"world\", point = [0.8",
    );
    let rope = "[[body]]\nname = \"light\"\nshape = { disc = { radius = 0.1 } }\nmass = 1.0\nposition = [0.0, -0.5]\n\
                [[body]]\nname = \"heavy\"\nshape = { disc = { radius = 0.1 } }\nmass = 2.0\nposition = [1.0, -0.5]\n\
                [[connector]]\nname = \"rope\"\npulley = { a = { body = \"light\", point = [0.0, 0.0] }, \
                b = { body = \"heavy\", point = [0.0, 0.0] }, wheel_a = [0.0, 0.0], wheel_b = [1.0, 0.0], length = 1.0 }\n";
    let mut told = String::new();
    for text in [linkage, rope.to_owned() + GRAVITY] {
        let mut world = world_of(&(HEAD.to_owned() + &text));
        let error = world.advance_to(100.0, &mut |_| ()).expect_err("it cannot go on");
        told += &format!("{error}\n");
    }
    insta::assert_snapshot!(told, @r#"
    at 0.6630115 s connector "hinge" (drive of "world" and "rocker") comes to a dead point of the linkage, beyond which it cannot move it; let it turn less far, or use a motor, whose `max` lets it stop
    at 0.5530013 s connector "rope" (pulley of "light" and "heavy") has run out: "light" is at the wheel; end the run before, or stop "light" short of it
    "#);
}

#[test]
fn a_limit_gives_back_a_share_of_the_speed() {
    let spinning = arm(", limits = { upper = 0.4, elasticity = 0.5 }").replace(
        "position = [0.5, 0.0]\n",
        "position = [0.5, 0.0]\nangular_velocity = 2.0\nvelocity = [0.0, 1.0]\n",
    );
    let mut world = world_of(&(HEAD.to_owned() + &spinning));
    advance(&mut world, 0.3);
    let state = world.state(BodyId(0));
    assert!((state.angle - 0.3).abs() < 1e-9 && (state.angular_velocity + 1.0).abs() < 1e-9, "{state:?}");
}

#[test]
fn a_torque_has_no_point() {
    let weld = "[[connector]]\nweld = { a = { body = \"world\", point = [0.0, 0.0] }, b = { body = \"arm\", point = [-0.5, 0.0] } }\n";
    let body = arm("").split("[[connector]]").next().expect("the body comes first").to_owned();
    let mut world = world_of(&(HEAD.to_owned() + &body + weld + GRAVITY));
    advance(&mut world, 1.0);
    let told: Vec<_> = world.contact_forces().iter().map(|row| (row.point.is_some(), row.torque)).collect();
    let [(true, None), (true, None), (false, Some(torque))] = told[..] else { panic!("{told:?}") };
    // The weld carries the weight of 9.81 N at 0.5 m: body a is the world.
    assert!((torque + 0.5 * 9.81).abs() < 1e-9, "{torque}");
}

#[test]
fn connectors_that_contradict_each_other_are_refused_with_both_names() {
    let driven = |first: &str, second: &str| {
        let second = arm(second).split_once("[[connector]]").expect("it has a connector").1.to_owned();
        format!("{HEAD}{}[[connector]]{second}", arm(first))
    };
    let gear = |ratio: &str| format!("[[connector]]\ngear = {{ a = \"a\", b = \"b\", ratio = {ratio} }}\n");
    let weld = "[[connector]]\nweld = { a = { body = \"world\", point = [0.0, 0.0] }, b = { body = \"arm\", point = [-0.5, 0.0] } }\n";
    let mut told = String::new();
    for text in [
        driven(", drive = { speed = 2.0 }", ", drive = { speed = 1.0 }"),
        wheels(&(gear("-2.35") + &gear("-2.0"))),
        HEAD.to_owned() + &arm(", drive = { speed = 2.0 }") + weld,
        HEAD.to_owned() + &arm(", limits = { lower = 2.0, upper = 1.0 }"),
        HEAD.to_owned() + &arm(", motor = { speed = 2.0 }"),
        HEAD.to_owned() + &arm(", motor = { speed = 2.0, max = inf }"),
        HEAD.to_owned() + &arm(", drive = { speed = 2.0 }, friction_torque = 1.0"),
    ] {
        let made =
            Scene::parse(&text, SceneFormat::Toml).and_then(|scene| World::from_scene(&scene).map(|_| ()));
        let error = made.expect_err(&text).to_string();
        told += error.lines().next().unwrap_or_default();
        told += "\n";
    }
    insta::assert_snapshot!(told, @r#"
    connector[1].pin: connector 0 (pin of "world" and "arm") and connector 1 (pin of "world" and "arm") contradict each other: no motion satisfies both
    connector[3].gear: connector 2 (gear of "a" and "b") and connector 3 (gear of "a" and "b") contradict each other: no motion satisfies both
    connector[0].pin.drive: connector 0 (drive of "world" and "arm") comes apart at 1 m/s at the start, and no velocities fit all connectors; without connector 1 (weld of "world" and "arm") some would
    line 10: connector[0].pin.limits: `lower` must not be above `upper`, got 2 and 1
    line 10: connector[0].pin.motor: missing field `max`
    line 10: connector[0].pin.motor.max: must be finite; a motor that holds its speed whatever it takes is a `drive`
    line 10: connector[0].pin.friction_torque: has no effect on a coordinate that is driven: give either this or `drive`
    "#);
}

#[test]
fn a_pulley_whose_ends_bounce_lower_than_its_zone_comes_to_hold_them() {
    // Damping slows the lighter end more than the rope lets it: each bounce is lower than the one before, and soon
    // lower than the search can tell.
    let mut world = world_of(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 0.5, tolerance = 1e-10 }\n\
         force = [{ damping = { angular = 0.125, linear = 0.5 } }]\n\
         [[body]]\nname = \"left\"\nshape = { disc = { radius = 0.2 } }\nmass = 1.33\n\
         position = [-0.5, -4.263]\nvelocity = [0.0, -0.5537]\n\
         [[body]]\nname = \"right\"\nshape = { disc = { radius = 0.2 } }\nmass = 0.34\n\
         position = [0.5, -4.988]\nvelocity = [0.0, -0.4218]\n\
         [[connector]]\npulley = { a = { body = \"left\", point = [0.0, 0.0] }, \
         b = { body = \"right\", point = [0.0, 0.0] }, wheel_a = [-0.5, 0.0], wheel_b = [0.5, 0.0], \
         ratio = 1.29, length = 10.69752, elasticity = 0.033 }\n",
    );
    advance(&mut world, 0.5);
    let (error, impacts) = (world.connector_error(ConnectorId(0)), world.statistics().impacts);
    assert!(error < 1e-12, "{error} m");
    assert!(impacts < 10, "{impacts} impacts");
}
