//! Impacts with known answers, through the facade.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{
    BodyId, BodySpec, BodyState, Event, Intervention, ToleranceOverrides, World, WorldBuilder, WorldSettings,
};

fn builder(tolerance: f64) -> WorldBuilder {
    WorldBuilder::new(WorldSettings { tolerance, ..WorldSettings::default() })
}

fn disc(radius: f64) -> Shape {
    Shape::disc(radius).expect("a fine radius")
}

fn block(width: f64, height: f64) -> Shape {
    Shape::block(width, height).expect("fine sides")
}

/// Four walls around the square [0, size]^2.
fn add_box(builder: &mut WorldBuilder, size: f64) {
    let half = 0.5 * size;
    for (name, x, y) in [
        ("floor", half, -0.5),
        ("ceiling", half, size + 0.5),
        ("left", -0.5, half),
        ("right", size + 0.5, half),
    ] {
        let shape = if x == half { block(size + 2.0, 1.0) } else { block(1.0, size) };
        builder.add(BodySpec::fixed(name, shape, DVec2::new(x, y)));
    }
}

fn moving(position: DVec2, velocity: DVec2, angular_velocity: f64) -> BodyState {
    BodyState { position, velocity, angular_velocity, angle: 0.0 }
}

#[test]
fn a_disc_in_a_square_box_is_where_unfolding_says_after_a_thousand_bounces() {
    let (size, radius) = (4.0, 0.25);
    let mut builder = builder(1e-10);
    add_box(&mut builder, size);
    let (start, velocity) = (DVec2::new(1.0, 1.7), DVec2::new(1.234_567, 0.876_543));
    builder.add(BodySpec::movable("ball", disc(radius), 1.0, moving(start, velocity, 0.3)));
    let mut world = builder.build().expect("a fine world");
    let ball = world.find("ball").expect("it was added");
    let energy = world.energy().total();
    let mut bounces = 0;
    let mut time = 0.0;
    while bounces < 1000 {
        time += 10.0;
        world.advance_to(time, &mut |_| bounces += 1).expect("free flight and single impacts");
    }
    let room = size - 2.0 * radius;
    let unfold = |x: f64, v: f64| {
        let travelled = (x - radius + v * time).rem_euclid(2.0 * room);
        radius + if travelled <= room { travelled } else { 2.0 * room - travelled }
    };
    let expected = DVec2::new(unfold(start.x, velocity.x), unfold(start.y, velocity.y));
    let error = (world.state(ball).position - expected).length();
    assert!(error < 1e-9 * size, "off by {error} m after {bounces} bounces");
    assert!((world.energy().total() / energy - 1.0).abs() < 1e-12);
}

#[test]
fn a_ball_dropped_on_a_floor_bounces_as_the_parabolas_say() {
    let mut builder = builder(1e-10);
    let floor =
        BodySpec { elasticity: 0.8, ..BodySpec::fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5)) };
    builder.add(floor);
    let ball = builder.add(BodySpec::movable(
        "ball",
        disc(0.5),
        1.0,
        moving(DVec2::new(0.0, 1.5), DVec2::ZERO, 0.0),
    ));
    builder.add_gravity(ball, DVec2::new(0.0, -9.81));
    let mut world = builder.build().expect("a fine world");
    let mut bounces = 0;
    for (time, height) in
        [(0.25, 1.1934375), (1.0, 0.9680044525260364), (2.0, 0.7607417283270573), (3.6, 0.5078534720754062)]
    {
        world.advance_to(time, &mut |_| bounces += 1).expect("ten bounces");
        assert!((world.state(ball).position.y - height).abs() < 1e-9, "at {time} s");
    }
    assert_eq!(bounces, 10);
    // The first fall takes sqrt(2/g) s, and each bounce e times as long as the one before: (1 + e)/(1 - e) of
    // it in all.
    let rest = (2.0f64 / 9.81).sqrt() * 1.8 / 0.2;
    let mut last = 0.0;
    world.advance_to(10.0, &mut |event| last = event.time()).expect("it comes to rest");
    // Bounces slower than the velocity tolerance are left out; they would have taken this long.
    let unresolved = 2.0 * world.tolerances().velocity_tol / (9.81 * 0.2);
    assert!(unresolved < 1e-5 && (last - rest).abs() < unresolved, "at rest at {last} s, not at {rest} s");
    let state = world.state(ball);
    assert!((state.position.y - 0.5 - world.tolerances().target_gap).abs() < 1e-12, "{state:?}");
    let forces = world.contact_forces();
    assert!(forces.len() == 1 && (forces[0].force - 9.81).abs() < 1e-12, "{forces:?}");
}

#[test]
fn a_block_that_lands_flat_bounces_flat() {
    let mut builder = builder(1e-10);
    builder.add(BodySpec::fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5)));
    let body = builder.add(BodySpec::movable(
        "block",
        block(1.0, 0.6),
        2.0,
        moving(DVec2::new(0.3, 2.0), DVec2::new(0.5, 0.0), 0.0),
    ));
    builder.add_gravity(body, DVec2::new(0.0, -10.0));
    let mut world = builder.build().expect("a fine world");
    let mut rows = Vec::new();
    world
        .advance_to(20.0, &mut |event| rows.extend(event.impact().map(|impact| impact.rows.len())))
        .expect("elastic");
    assert!(rows.len() > 10 && rows.iter().all(|&count| count == 2), "{rows:?}");
    let state = world.state(body);
    assert!(state.angle.abs() < 1e-12 && state.angular_velocity.abs() < 1e-12);
}

fn tumbling(tolerance: f64, shape: &Shape, spin: f64) -> (World, halfgap::BodyId) {
    let mut builder = builder(tolerance);
    add_box(&mut builder, 4.0);
    let state = moving(DVec2::new(1.7, 1.9), DVec2::new(2.3, -1.7), spin);
    let body = builder.add(BodySpec::movable("tumbler", shape.clone(), 1.0, state));
    (builder.build().expect("a fine world"), body)
}

#[test]
fn tumbling_shapes_converge_with_the_tolerance_and_keep_their_energy() {
    let shapes = [
        block(0.8, 0.5),
        Shape::rounded_block(0.9, 0.5, 0.2).expect("a fine block"),
        Shape::polygon(&[DVec2::new(0.0, 0.0), DVec2::new(0.9, 0.1), DVec2::new(0.2, 0.7)])
            .expect("a triangle"),
    ];
    for (index, shape) in shapes.iter().enumerate() {
        let end = |tolerance| {
            let (mut world, body) = tumbling(tolerance, shape, 2.0);
            let energy = world.energy().total();
            let mut impacts = 0;
            world.advance_to(4.0, &mut |_| impacts += 1).expect("single impacts");
            assert!((world.energy().total() / energy - 1.0).abs() < 1e-12);
            assert!(impacts >= 3, "shape {index}: {impacts} impacts");
            world.state(body).position
        };
        let exact = end(1e-13);
        let errors = [1e-6, 1e-8, 1e-10].map(|tolerance| (end(tolerance) - exact).length());
        println!("shape {index}: {errors:?}");
        assert!(errors[0] < 1e-4 && errors[2] < 1e-8, "shape {index}: {errors:?}");
    }
}

#[test]
fn the_background_is_told_of_as_bodies_are() {
    let mut builder = builder(1e-8);
    builder.add(BodySpec::movable("ball", disc(0.5), 1.0, BodyState::default()));
    let world = builder.build().expect("a fine world");
    assert_eq!(world.name(BodyId::WORLD), "world");
    assert_eq!(world.state(BodyId::WORLD), BodyState::default());
    assert!(world.is_fixed(BodyId::WORLD));
    assert_eq!(world.inertia(BodyId::WORLD), None);
}

/// An operation on a world and a body of it, with a listener for events.
type Act = fn(&mut World, BodyId, &mut dyn FnMut(&Event));

/// Contacts that close slowly at the start are stopped before any listener is there: they are told all the same, once.
#[test]
fn an_impact_at_the_start_is_told_first() {
    let overrides =
        ToleranceOverrides { target_gap: Some(5e-3), accuracy: Some(3e-3), velocity_tol: Some(0.5) };
    let mut builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
    builder.add(BodySpec::fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5)));
    let state = moving(DVec2::new(0.0, 0.505), DVec2::new(0.0, -0.3), 0.0);
    let ball = builder.add(BodySpec { elasticity: 0.0, ..BodySpec::movable("ball", disc(0.5), 2.0, state) });
    builder.add_gravity(ball, DVec2::new(0.0, -10.0));
    let world = builder.build().expect("it rests soon");
    let told_by = |act: Act| {
        let (mut world, mut impulses) = (world.clone(), Vec::new());
        let mut note = |event: &Event| {
            if let Event::Impact(impact) = event {
                impulses.push((impact.time, impact.rows[0].impulse));
            }
        };
        act(&mut world, ball, &mut note);
        world.advance_to(2.0, &mut note).expect("it rests");
        impulses
    };
    let first = told_by(|world, _, note| world.advance_to(0.0, note).expect("it is there"));
    assert_eq!(first.len(), 1, "{first:?}");
    assert_eq!(first[0].0, 0.0);
    assert!((first[0].1 - 2.0 * 0.3).abs() < 1e-12, "{first:?}");
    let push: Act = |world, body, note| {
        let up = Intervention::Velocity { body, velocity: DVec2::Y, angular_velocity: 0.0 };
        world.intervene(&[up], note).expect("it may be thrown");
    };
    assert_eq!(told_by(push)[0], first[0]);
}
