//! Interventions of callers while a world runs, and stops at events that they choose.

use glam::DVec2;
use halfgap::geometry::Shape;
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Event, Intervention,
    RunError, World, WorldBuilder, WorldSettings,
};
use std::ops::ControlFlow;

const GRAVITY: f64 = 10.0;

/// Discs of 1 kg and 0.5 m that rest on each other on a floor at y = 0, with an elasticity.
fn tower(count: usize, elasticity: f64) -> (World, Vec<BodyId>) {
    let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(5.0), ..WorldSettings::default() });
    let floor = Shape::block(10.0, 1.0).expect("a fine size");
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let discs = (0..count).map(|index| {
        let position = DVec2::new(0.0, 0.5 + index as f64);
        let state = BodyState { position, ..BodyState::default() };
        let shape = Shape::disc(0.5).expect("a fine radius");
        let spec = BodySpec { elasticity, ..BodySpec::movable(&format!("disc {index}"), shape, 1.0, state) };
        let disc = builder.add(spec);
        builder.add_gravity(disc, DVec2::new(0.0, -GRAVITY));
        disc
    });
    let discs = discs.collect();
    (builder.build().expect("it stands"), discs)
}

/// Two rods of 1 m and 1 kg, the first hung at the origin, the second at its end, both pointing down.
fn double_pendulum() -> (World, [BodyId; 2]) {
    let mut builder = WorldBuilder::new(WorldSettings { tolerance: 1e-11, ..WorldSettings::default() });
    let [upper, lower] = [0, 1].map(|index: usize| {
        let position = DVec2::new(0.0, -0.5 - index as f64);
        let state = BodyState { position, ..BodyState::default() };
        let shape = Shape::block(0.1, 1.0).expect("a fine size");
        let rod = builder.add(BodySpec::movable(["upper", "lower"][index], shape, 1.0, state));
        builder.add_gravity(rod, DVec2::new(0.0, -GRAVITY));
        rod
    });
    let top = DVec2::new(0.0, 0.5);
    let end = |body: BodyId, point: DVec2| Anchor { body, point };
    let pins = [[end(BodyId::WORLD, DVec2::ZERO), end(upper, top)], [end(upper, -top), end(lower, top)]];
    for [a, b] in pins {
        let pin = Connector::new(ConnectorKind::Pin { a, b }, 0.0).expect("a fine pin");
        builder.add_connector(ConnectorSpec::new(pin));
    }
    (builder.build().expect("it hangs"), [upper, lower])
}

fn upwards(body: BodyId, speed: f64) -> Intervention {
    Intervention::Velocity { body, velocity: DVec2::new(0.0, speed), angular_velocity: 0.0 }
}

#[test]
fn a_resting_disc_is_thrown() {
    let (mut world, discs) = tower(1, 0.5);
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    let mut ended = 0;
    let mut count = |event: &Event| ended += u32::from(matches!(event, Event::ContactEnds(_)));
    world.intervene(&[upwards(discs[0], 4.0)], &mut count).expect("it can be thrown");
    assert_eq!(ended, 1);
    world.advance_to(1.5, &mut |_| ()).expect("it flies");
    let height = world.state(discs[0]).position.y - 0.5;
    assert!((height - (4.0 * 0.5 - 0.5 * GRAVITY * 0.25)).abs() < 1e-8, "{height}");
    let ledger = world.ledger();
    assert!((ledger.interventions - 8.0).abs() < 1e-12);
    assert!(ledger.integration_error().abs() < 1e-12, "{ledger:?}");
}

#[test]
fn a_disc_pushed_into_its_floor_bounces_by_the_impact_law() {
    let (mut world, discs) = tower(1, 0.5);
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    let mut impulses = Vec::new();
    let mut note = |event: &Event| impulses.extend(event.impact().map(|impact| impact.rows[0].impulse));
    world.intervene(&[upwards(discs[0], -2.0)], &mut note).expect("it bounces");
    assert!((world.state(discs[0]).velocity.y - 1.0).abs() < 1e-12);
    assert!((impulses[0] - 3.0).abs() < 1e-12, "{impulses:?}");
    assert!((world.ledger().impacts + 1.5).abs() < 1e-12);
}

#[test]
fn an_impulse_goes_through_all_that_touches() {
    let (mut world, discs) = tower(4, 0.0);
    world.advance_to(1.0, &mut |_| ()).expect("it stands");
    let (impulse, point) = (DVec2::new(0.0, 4.0), DVec2::new(0.0, 0.2));
    world
        .intervene(&[Intervention::Impulse { body: discs[0], impulse, point }], &mut |_| ())
        .expect("it rises");
    for &disc in &discs {
        // All discs go up together.
        assert!((world.state(disc).velocity.y - 1.0).abs() < 1e-9, "{:?}", world.state(disc));
    }
}

#[test]
fn a_blow_on_a_pendulum_turns_all_of_it() {
    let (mut world, [upper, lower]) = double_pendulum();
    world.advance_to(0.5, &mut |_| ()).expect("it hangs still");
    // The blow is at the end of the lower rod: impulse equations of two pinned rods.
    let blow =
        Intervention::Impulse { body: lower, impulse: DVec2::new(7.0, 0.0), point: DVec2::new(0.0, -2.0) };
    world.intervene(&[blow], &mut |_| ()).expect("it swings");
    let spins = [upper, lower].map(|rod| world.state(rod).angular_velocity);
    // (m + 1) w1 + w2/2 = P and w1/2 + m w2 = P, where m is the moment of a rod about its end.
    let moment = 0.25 + (1.0 + 0.1 * 0.1) / 12.0;
    let determinant = (moment + 1.0) * moment - 0.25;
    let expected = [7.0 * (moment - 0.5) / determinant, 7.0 * (moment + 0.5) / determinant];
    assert!((spins[0] - expected[0]).abs() < 1e-9 && (spins[1] - expected[1]).abs() < 1e-9, "{spins:?}");
    world.advance_to(3.0, &mut |_| ()).expect("it swings");
    assert!(world.ledger().integration_error().abs() < 1e-8, "{:?}", world.ledger());
}

#[test]
fn a_motion_that_is_turned_round_goes_back() {
    let (mut world, [upper, lower]) = double_pendulum();
    let blow = Intervention::AngularImpulse { body: upper, impulse: 3.0 };
    world.intervene(&[blow], &mut |_| ()).expect("it swings");
    let start = [upper, lower].map(|rod| world.state(rod));
    world.advance_to(1.0, &mut |_| ()).expect("it swings");
    let back = [upper, lower].map(|body| {
        let state = world.state(body);
        Intervention::Velocity { body, velocity: -state.velocity, angular_velocity: -state.angular_velocity }
    });
    world.intervene(&back, &mut |_| ()).expect("all at once they fit together");
    world.advance_to(2.0, &mut |_| ()).expect("it swings back");
    for (body, start) in [upper, lower].into_iter().zip(start) {
        let end = world.state(body);
        assert!(end.position.distance(start.position) < 1e-9, "{end:?} {start:?}");
        assert!((end.angular_velocity + start.angular_velocity).abs() < 1e-8);
    }
}

#[test]
fn many_interventions_at_one_time_are_no_accumulation() {
    let (mut world, discs) = tower(1, 1.0);
    for _ in 0..10_000 {
        world.intervene(&[upwards(discs[0], -2.0)], &mut |_| ()).expect("it bounces");
    }
    assert!((world.state(discs[0]).velocity.y - 2.0).abs() < 1e-12, "it is as elastic as the first time");
}

#[test]
fn interventions_in_one_call_follow_each_other() {
    let (mut world, discs) = tower(1, 1.0);
    let (body, point) = (discs[0], DVec2::new(0.0, 0.5));
    let again = Intervention::Impulse { body, impulse: DVec2::new(0.0, 1.0), point };
    world.intervene(&[again, upwards(body, 2.0), again], &mut |_| ()).expect("it flies");
    assert!((world.state(body).velocity.y - 3.0).abs() < 1e-12);
}

#[test]
fn an_impossible_intervention_is_refused_and_nothing_is_done() {
    let (mut world, discs) = tower(1, 1.0);
    let before = format!("{:?}", world.state(discs[0]));
    let floor = world.find("floor").expect("it is there");
    let mut refused = |bad: Intervention| {
        let both = [upwards(discs[0], 1.0), bad];
        world.intervene(&both, &mut |_| ()).expect_err("it is bad").to_string()
    };
    assert_eq!(refused(upwards(floor, 1.0)), "body \"floor\" is fixed: nothing moves it");
    assert_eq!(refused(upwards(BodyId(7), 1.0)), "there is no body 7 in this world");
    for speed in [f64::NAN, f64::INFINITY, 1e61] {
        let expected =
            "an intervention on body \"disc 0\" must be finite, and change its velocities by 1e60 at most";
        assert_eq!(refused(upwards(discs[0], speed)), expected);
    }
    assert_eq!(format!("{:?}", world.state(discs[0])), before);
}

#[test]
fn nothing_else_is_touched() {
    let (mut alone, discs) = tower(3, 0.3);
    let flying = |world: &mut World| {
        world.intervene(&[upwards(discs[2], 3.0)], &mut |_| ()).expect("it flies");
        world.advance_to(0.1, &mut |_| ()).expect("it flies");
    };
    flying(&mut alone);
    let mut struck = alone.clone();
    struck.intervene(&[upwards(discs[2], 1.0)], &mut |_| ()).expect("it flies");
    for world in [&mut alone, &mut struck] {
        world.advance_to(0.2, &mut |_| ()).expect("it flies");
    }
    for &disc in &discs[..2] {
        assert_eq!(alone.state(disc), struck.state(disc));
    }
    assert_ne!(alone.state(discs[2]), struck.state(discs[2]));
}

/// A disc that has just been thrown up at 4 m/s from a floor, on which it bounces with an elasticity of 0.8.
fn bouncing() -> (World, BodyId) {
    let (mut world, discs) = tower(1, 0.8);
    world.intervene(&[upwards(discs[0], 4.0)], &mut |_| ()).expect("it flies");
    (world, discs[0])
}

#[test]
fn an_advance_stops_where_it_is_told_to_and_goes_on_as_if_it_had_not() {
    let (mut through, disc) = bouncing();
    let mut stopping = through.clone();
    let (mut impacts, mut stops) = (0, Vec::new());
    through
        .advance_to(2.0, &mut |event| impacts += usize::from(event.impact().is_some()))
        .expect("it bounces");
    let stop_at_impact = &mut |event: &Event| match event.impact() {
        Some(_) => ControlFlow::Break(()),
        None => ControlFlow::Continue(()),
    };
    while stopping.advance_while(2.0, stop_at_impact).expect("it bounces").is_break() {
        stops.push(stopping.time());
        assert!((stopping.state(disc).position.y - 0.5).abs() < 1e-7, "it is on the floor");
    }
    assert_eq!(stops.len(), impacts);
    assert!((stops[0] - 0.8).abs() < 1e-7 && (stops[1] - 0.8 * 1.8).abs() < 1e-7, "{stops:?}");
    assert_eq!((stopping.time(), stopping.state(disc)), (2.0, through.state(disc)));
}

#[test]
fn a_caller_that_stops_at_an_event_can_act_there() {
    let (mut world, disc) = bouncing();
    let stop = &mut |_: &Event| ControlFlow::Break(());
    assert!(world.advance_while(2.0, stop).expect("it bounces").is_break());
    world.intervene(&[upwards(disc, 4.0)], &mut |_| ()).expect("it is hit back");
    assert!(world.advance_while(2.0, stop).expect("it bounces").is_break());
    assert!((world.time() - 1.6).abs() < 1e-7);
}

#[test]
fn a_disc_struck_where_contacts_carry_impulses_only_bounces_and_comes_to_rest() {
    let settings = WorldSettings { contacts: false, usual_speed: Some(5.0), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let [floor, disc] = [Shape::block(10.0, 1.0), Shape::disc(0.5)].map(|shape| shape.expect("a fine size"));
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let state = BodyState { position: DVec2::new(0.0, 0.5), ..BodyState::default() };
    let disc = builder.add(BodySpec { elasticity: 0.5, ..BodySpec::movable("disc", disc, 1.0, state) });
    builder.add_gravity(disc, DVec2::new(0.0, -GRAVITY));
    let mut world = builder.build().expect("it stands");
    world.advance_to(1.0, &mut |_| ()).expect("it rests");
    world.intervene(&[upwards(disc, -2.0)], &mut |_| ()).expect("it bounces");
    assert!((world.state(disc).velocity.y - 1.0).abs() < 1e-3, "{:?}", world.state(disc));
    world.advance_to(3.0, &mut |_| ()).expect("it rests again");
    assert!((world.state(disc).position.y - 0.5).abs() < 1e-3, "{:?}", world.state(disc));
}

/// A bar of 1 kg that is pinned to the background off its centre, and turns at a rate [rad/s].
fn door(rate: f64) -> (World, BodyId) {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let hinge = DVec2::new(-0.5, 0.03);
    let arm = DVec2::from_angle(0.3).rotate(hinge);
    let state = BodyState {
        position: DVec2::new(0.3, 0.7),
        angle: 0.3,
        velocity: -rate * arm.perp(),
        angular_velocity: rate,
    };
    let bar = Shape::block(1.0, 0.2).expect("a fine size");
    let bar = builder.add(BodySpec::movable("door", bar, 1.0, state));
    let a = builder.anchor(bar, hinge);
    let b = Anchor { body: BodyId::WORLD, point: state.position + arm };
    let pin = Connector::new(ConnectorKind::Pin { a, b }, 0.0).expect("a fine pin");
    builder.add_connector(ConnectorSpec::new(pin));
    (builder.build().expect("it hangs together"), bar)
}

#[test]
fn a_door_held_by_interventions_for_long_is_held() {
    let (mut world, bar) = door(1.0);
    let hold = Intervention::Velocity { body: bar, velocity: DVec2::ZERO, angular_velocity: 0.0 };
    for frame in 1..=3000 {
        world.advance_to(f64::from(frame) / 60.0, &mut |_| ()).expect("it stands");
        world.intervene(&[hold], &mut |_| ()).expect("it is held");
        let state = world.state(bar);
        assert_eq!((state.velocity, state.angular_velocity), (DVec2::ZERO, 0.0), "frame {frame}");
    }
}

#[test]
fn a_door_that_hardly_moves_is_no_trouble() {
    for rate in [1e-30, 1e-60, 1e-120, 1e-300, 1e-314, f64::MIN_POSITIVE * f64::EPSILON] {
        let (mut world, bar) = door(rate);
        world.advance_to(10.0, &mut |_| ()).unwrap_or_else(|error| panic!("{rate} rad/s: {error}"));
        assert!(world.state(bar).angular_velocity <= rate, "{rate} rad/s: {:?}", world.state(bar));
        assert_eq!(world.findings(1.0), []);
    }
}

/// A plank on a block that juts out over another block, which is slid in and stopped there: all of 1 kg. Each part is
/// a given number of gaps above the one that it stands on; `states` replaces the places and speeds.
fn plank(gaps: f64, states: Option<&[BodyState]>) -> (World, Vec<BodyId>) {
    let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(2.0), ..WorldSettings::default() });
    let block = |width: f64, height: f64| Shape::block(width, height).expect("a fine size");
    builder.add(BodySpec::fixed("floor", block(40.0, 1.0), DVec2::new(0.0, -0.5)));
    let parts = [
        ("support", block(2.0, 1.0), DVec2::new(0.0, 0.5 + gaps), 0.0),
        ("plank", block(4.0, 0.5), DVec2::new(0.0, 1.25 + 2.0 * gaps), 0.0),
        ("slider", block(1.0, 1.0), DVec2::new(5.0, 0.5 + gaps), -2.0),
    ];
    let bodies = parts.into_iter().enumerate().map(|(index, (name, shape, position, speed))| {
        let start = BodyState { position, velocity: DVec2::new(speed, 0.0), ..BodyState::default() };
        let state = states.map_or(start, |states| states[index]);
        let body = builder.add(BodySpec { elasticity: 0.5, ..BodySpec::movable(name, shape, 1.0, state) });
        builder.add_gravity(body, DVec2::new(0.0, -GRAVITY));
        body
    });
    let bodies = bodies.collect();
    (builder.build().expect("it stands"), bodies)
}

#[test]
fn a_body_driven_into_another_group_takes_it_along() {
    let gap = plank(0.0, None).0.tolerances().target_gap;
    for gaps in [1.0, 1.2, 1.4, 1.5] {
        let (mut world, bodies) = plank(gaps * gap, None);
        let slider = bodies[2];
        world.advance_to(1.6, &mut |_| ()).expect("it slides in");
        world.intervene(&[upwards(slider, 0.0)], &mut |_| ()).expect("it is stopped");
        world.advance_to(2.0, &mut |_| ()).expect("it stands");
        world.intervene(&[upwards(slider, 0.5)], &mut |_| ()).expect("it lifts the plank");
        let states: Vec<_> = bodies.iter().map(|&body| world.state(body)).collect();
        assert!(states[1].angular_velocity > 0.1, "{gaps}: {states:?}");
        let (mut fresh, _) = plank(0.0, Some(&states));
        world.advance_to(2.1, &mut |_| ()).expect("it turns over");
        fresh.advance_to(0.1, &mut |_| ()).expect("so does one that is made like that");
        for &body in &bodies {
            let off = world.state(body).position.distance(fresh.state(body).position);
            assert!(off < 1e-7, "{gaps}: {} is off by {off} m", world.name(body));
        }
        assert!(world.ledger().integration_error().abs() < 1e-7, "{gaps}: {:?}", world.ledger());
    }
}

#[test]
fn a_block_pushed_in_a_world_at_rest_comes_to_rest_on_the_block_it_meets() {
    // Seen from above: height [m], angle [rad] and mass [kg] of two blocks; velocity [m/s] across and spin [rad/s] of
    // the first.
    let cases = [
        ([(-0.0031, -0.9055, 1.2996), (-0.1980, 0.0256, 1.1553)], (-0.1982, 0.8662)),
        ([(-0.3179, -0.0742, 0.9418), (-0.1198, -0.0241, 1.2524)], (0.1671, 0.8994)),
        ([(0.4893, 0.0297, 1.1142), (0.5888, -0.6630, 0.8477)], (-0.1443, -0.9137)),
        ([(-0.0383, 0.5502, 1.0110), (0.0889, -0.1383, 1.2516)], (-0.1242, 0.8823)),
    ];
    for (blocks, (across, spin)) in cases {
        let mut builder = WorldBuilder::new(WorldSettings::default());
        let mut bodies = Vec::new();
        for (index, (height, angle, mass)) in blocks.into_iter().enumerate() {
            let position = DVec2::new(2.0 * index as f64, height);
            let state = BodyState { position, angle, ..BodyState::default() };
            let block = Shape::block(1.0, 0.5).expect("a fine size");
            let spec = BodySpec::movable(["first", "second"][index], block, mass, state);
            bodies.push(builder.add(BodySpec { elasticity: 0.0, ..spec }));
        }
        let mut world = builder.build().expect("it is at rest");
        assert!(world.tolerances().velocity_tol > 0.0);
        let throw = Intervention::Velocity {
            body: bodies[0],
            velocity: DVec2::new(1.0, across),
            angular_velocity: spin,
        };
        world.intervene(&[throw], &mut |_| ()).expect("it sets out");
        let (mut blows, mut least) = (0, f64::INFINITY);
        let mut note = |event: &Event| {
            for row in event.impact().iter().flat_map(|impact| &impact.rows) {
                blows += 1;
                least = row.gap.min(least);
            }
        };
        world.advance_to(5.0, &mut note).expect("they go on together");
        assert!(blows < 10 && least > 0.0, "{blows} blows, the lowest gap {least} m");
    }
}

#[test]
fn a_block_pressed_down_gently_for_long_stays_where_it_is() {
    let settings = WorldSettings { tolerance: 1e-2, duration: Some(10.0), ..WorldSettings::default() };
    let mut builder = WorldBuilder::new(settings);
    let [floor, block] =
        [Shape::block(10.0, 1.0), Shape::block(1.0, 0.5)].map(|shape| shape.expect("a fine size"));
    builder.add(BodySpec::fixed("floor", floor, DVec2::new(0.0, -0.5)));
    let state = BodyState { position: DVec2::new(0.0, 0.25), ..BodyState::default() };
    let block = builder.add(BodySpec { elasticity: 0.0, ..BodySpec::movable("block", block, 1.0, state) });
    builder.add_gravity(block, DVec2::new(0.0, -GRAVITY));
    let mut world = builder.build().expect("it stands");
    let press = 0.99 * world.tolerances().velocity_tol;
    for frame in 1..=600 {
        world.advance_to(f64::from(frame) / 60.0, &mut |_| ()).expect("it lies there");
        let point = world.state(block).position;
        let impulse = DVec2::new(0.0, -press);
        let push = Intervention::Impulse { body: block, impulse, point };
        world.intervene(&[push], &mut |_| ()).expect("it is pressed");
    }
    assert_eq!(world.findings(1.0), []);
}

#[test]
fn a_caller_that_has_asked_for_too_long_a_time_may_ask_for_less() {
    let (mut world, _) = double_pendulum();
    let start = Intervention::Velocity { body: BodyId(0), velocity: DVec2::X, angular_velocity: 2.0 };
    world.intervene(&[start], &mut |_| ()).expect("it swings");
    let outcome = world.advance_to(1e12, &mut |_| ());
    assert!(matches!(outcome, Err(RunError::Crawls { .. })), "{outcome:?}");
    let reached = world.time();
    world.advance_to(reached + 1.0, &mut |_| ()).expect("nothing is wrong with it");
    assert_eq!(world.time(), reached + 1.0);
}

#[test]
fn a_disc_damped_in_flight_loses_no_work_by_interventions() {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let state = BodyState { velocity: DVec2::new(1.0, 1.0), ..BodyState::default() };
    let disc = Shape::disc(0.5).expect("a fine radius");
    let disc = builder.add(BodySpec::movable("disc", disc, 1.0, state));
    builder.add_gravity(disc, DVec2::new(0.0, -GRAVITY));
    builder.add_damping(disc, 0.5, 0.02);
    let mut world = builder.build().expect("it flies");
    for frame in 1..=60 {
        world.advance_to(f64::from(frame) / 60.0, &mut |_| ()).expect("it flies on");
        let BodyState { velocity, angular_velocity, .. } = world.state(disc);
        let velocity = if frame == 30 { velocity + DVec2::X } else { velocity };
        let same = Intervention::Velocity { body: disc, velocity, angular_velocity };
        world.intervene(&[same], &mut |_| ()).expect("nothing else changes");
    }
    assert!(world.ledger().integration_error().abs() < 1e-9, "{:?}", world.ledger());
}
