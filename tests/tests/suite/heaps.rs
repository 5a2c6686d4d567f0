//! Heaps: many bodies come to rest on each other, in impacts that each concern most of them.

use halfgap::geometry::DVec2;
use halfgap::scene::Scene;
use halfgap::{BodyState, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, at_rest, block, disc};
use halfgap_tests::random::Random;
use std::ops::ControlFlow;

const RADIUS: f64 = 0.25;
const ELASTICITY: f64 = 0.2;
const ACROSS: usize = 10;
/// Distance of two discs of a row [m].
const APART: f64 = 2.2 * RADIUS;

/// Rows of discs above the floor of a box, every second row a little to the left, the others to the right.
fn falling_discs(count: usize, tolerance: f64) -> World {
    let mut shop = Workshop::new(tolerance);
    let width = APART * ACROSS as f64;
    shop.fixed("floor", block(width + 4.0, 1.0), DVec2::new(0.5 * width, -0.5));
    shop.fixed("left", block(1.0, 30.0), DVec2::new(-0.5, 15.0));
    shop.fixed("right", block(1.0, 30.0), DVec2::new(width + 0.5, 15.0));
    for index in 0..count {
        let (column, row) = ((index % ACROSS) as f64, index / ACROSS);
        let aside = if row % 2 == 0 { -0.01 } else { 0.01 };
        let position = DVec2::new((column + 0.5) * APART + aside, (row as f64 + 0.5) * 2.4 * RADIUS);
        let state = BodyState { position, ..BodyState::default() };
        shop.settler(&format!("disc {index}"), disc(RADIUS), 1.0, state, ELASTICITY);
    }
    shop.build()
}

/// Least gap [m] of any two discs, and of any disc and a wall or the floor.
fn least_gap(world: &World) -> f64 {
    let width = APART * ACROSS as f64;
    let discs = world.bodies().filter(|&body| world.name(body).starts_with("disc"));
    let places: Vec<DVec2> = discs.map(|body| world.state(body).position).collect();
    let mut least = f64::INFINITY;
    for (index, place) in places.iter().enumerate() {
        least = least.min(place.x - RADIUS).min(width - RADIUS - place.x).min(place.y - RADIUS);
        for other in &places[..index] {
            least = least.min(place.distance(*other) - 2.0 * RADIUS);
        }
    }
    least
}

#[test]
fn a_hundred_discs_pile_up_without_harm() {
    let mut world = falling_discs(100, 1e-2);
    let start = world.energy().total();
    for piece in 1..=10 {
        world.advance_to(0.08 * f64::from(piece), &mut |_| {}).expect("they fall");
        assert!(least_gap(&world) > 0.0, "an overlap of {} m", -least_gap(&world));
    }
    let (ledger, statistics) = (world.ledger(), world.statistics());
    println!("{statistics:?} {ledger:?} of {start} J");
    assert!(statistics.impacts > 500, "{statistics:?}");
    // The energy changes by projections and steps are small beside the energy that the impacts take.
    let lost = -(ledger.impacts + ledger.captures);
    assert!(lost > 0.1 * start, "{ledger:?}");
    assert!(ledger.projections.abs() + ledger.integration_error().abs() < 1e-6 * start, "{ledger:?}");
}

#[test]
fn discs_that_nearly_fill_their_box_are_held_by_few_of_their_contacts() {
    /// Columns and rows of discs that are packed as close as they go, but for this much [m].
    const COLUMNS: u32 = 8;
    const ROWS: u32 = 5;
    const LOOSE: f64 = 1e-7;
    const TOLERANCE: f64 = 1e-3;
    /// Number of events by which they have settled.
    const MOST_REPORTS: u32 = 100_000;
    // More than a hundred contacts, of which the bodies need two a disc; others fall on top.
    let gap = 1e-2 * TOLERANCE * RADIUS;
    let apart = 2.0 * RADIUS + gap;
    let wall = f64::from(COLUMNS - 1) * apart + 2.0 * (RADIUS + gap);
    for seed in 0..30 {
        let mut random = Random::new(seed);
        let mut shop = Workshop::new(TOLERANCE);
        shop.fixed("floor", block(wall + 4.0, 1.0), DVec2::new(0.5 * wall, -0.5));
        shop.fixed("left", block(1.0, 30.0), DVec2::new(-0.5, 15.0));
        shop.fixed("right", block(1.0, 30.0), DVec2::new(wall + 0.5, 15.0));
        let mut add = |x: f64, y: f64| {
            let place = at_rest(x + RADIUS + gap, y + RADIUS + gap);
            shop.settler(&format!("disc at {x}, {y}"), disc(RADIUS), 1.0, place, ELASTICITY);
        };
        let height = 0.75f64.sqrt() * apart;
        for row in 0..ROWS {
            for column in 0..COLUMNS - row % 2 {
                let x = (f64::from(column) + 0.5 * f64::from(row % 2)) * apart;
                let [right, up] = [0, 1].map(|_| random.between(-LOOSE, LOOSE));
                add(x + right, f64::from(row) * height + up);
            }
        }
        for column in 0..COLUMNS / 2 {
            let x = (2.0 * f64::from(column) + random.between(0.1, 0.9)) * apart;
            add(x, f64::from(ROWS - 1) * height + apart + random.between(0.05, 0.25));
        }
        let mut world = shop.build();
        let mut reports = 0;
        let outcome = world.advance_while(0.5, &mut |_| {
            reports += 1;
            if reports < MOST_REPORTS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        let end = outcome.unwrap_or_else(|error| panic!("{seed}: {error}"));
        assert!(end.is_continue(), "{seed}: {:?} at {} s", world.statistics(), world.time());
    }
}

#[test]
fn a_disc_between_two_that_is_nearly_in_line_with_them_rests() {
    /// Height [m] of the middle disc's centre above those of the others, and offset of the left wall, in target gaps.
    const RISE: f64 = 1e-3;
    const OFF: f64 = 0.4;
    let mut shop = Workshop::new(1e-6);
    let radius = 0.5f64;
    // At the gap of two discs that touch, the contacts of the left wall are the farthest from closed.
    let gap = 1e-2 * 1e-6 * radius;
    let across = ((2.0 * radius + gap).powi(2) - RISE * RISE).sqrt();
    let wall = across + radius + 0.5;
    shop.fixed("floor", block(8.0, 1.0), DVec2::new(0.0, -0.5));
    shop.fixed("left", block(1.0, 4.0), DVec2::new(-wall - (1.0 + OFF) * gap, 2.0));
    shop.fixed("right", block(1.0, 4.0), DVec2::new(wall + gap, 2.0));
    for (name, x, y) in [("a", -across, 0.0), ("b", 0.0, RISE), ("c", across, 0.0)] {
        shop.dull(name, disc(radius), 1.0, at_rest(x, y + radius + gap));
    }
    let mut world = shop.build();
    assert_eq!(world.tolerances().target_gap, gap);
    let middle = world.find("b").expect("it is there");
    let before = world.state(middle).position;
    world.advance_to(1.0, &mut |event| panic!("{event:?}")).expect("nothing moves");
    assert!(world.state(middle).position.distance(before) < gap);
    let largest = world.contact_forces().iter().fold(0.0f64, |most, row| most.max(row.force));
    let expected = 0.5 * GRAVITY * (2.0 * radius) / RISE;
    assert!((largest / expected - 1.0).abs() < 1e-3, "{largest} N, {expected} N");
}

/// `scenes/heap_of_discs.toml`, each disc nudged by up to a millimetre.
fn nudged_heap(seed: u32) -> World {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/heap_of_discs.toml");
    let mut scene = Scene::read(path).expect("the scene is there");
    for (index, body) in (0..).zip(scene.bodies.iter_mut().filter(|body| !body.fixed)) {
        let phase = f64::from(25 * seed + index);
        let position = body.position.get_or_insert_default();
        position.x += 1e-3 * (7.3 * phase).sin();
        position.y += 1e-3 * (9.1 * phase).sin();
    }
    World::from_scene(&scene).expect("a world that can be built")
}

#[test]
fn no_contact_pulls_where_six_discs_fit_from_wall_to_wall() {
    // Their arch is flat: it presses the walls with hundreds of times the weight of a disc. How hard it presses is
    // left open by the contacts, which are one more than can be told apart.
    for seed in [1, 4, 13, 16, 42] {
        let mut world = nudged_heap(seed);
        let mut least = 0.0f64;
        for piece in 1..=250 {
            world.advance_to(0.01 * f64::from(piece), &mut |_| {}).expect("they fall");
            least = world.contact_forces().iter().fold(least, |least, contact| least.min(contact.force));
        }
        println!("heap nudged by {seed}: {least} N");
        assert!(least > -1e-6, "seed {seed}: {least} N");
    }
}

/// Rows of blocks of 1 m and 1 kg on a floor, each on the two below, with 0.1 m between neighbours.
fn pyramid(rows: u32, tolerance: f64) -> World {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("floor", block(60.0, 1.0), DVec2::new(0.0, -0.5));
    for row in 0..rows {
        for column in 0..rows - row {
            let x = (f64::from(column) - 0.5 * f64::from(rows - row - 1)) * 1.1;
            let state = at_rest(x, 0.5 + f64::from(row));
            shop.dull(&format!("block {row} {column}"), block(1.0, 1.0), 1.0, state);
        }
    }
    shop.build()
}

#[test]
fn no_contact_of_a_pyramid_pulls_at_the_start() {
    // More of its contacts carry a force than can be told apart.
    for rows in [9, 10, 13] {
        for tolerance in [1e-3, 1e-6] {
            let mut world = pyramid(rows, tolerance);
            let forces = world.contact_forces();
            let least = forces.iter().fold(f64::INFINITY, |least, contact| least.min(contact.force));
            assert!(least > 0.0, "{rows} rows at {tolerance:e}: {least} N");
            let floor = forces
                .iter()
                .filter(|contact| contact.point.is_some_and(|point| point.y < 0.5))
                .map(|contact| contact.force);
            let weight = GRAVITY * f64::from(rows * (rows + 1) / 2);
            assert!((floor.sum::<f64>() / weight - 1.0).abs() < 1e-9);
            world.advance_to(0.1, &mut |event| panic!("{rows} rows: {event:?}")).expect("it rests");
        }
    }
}

#[test]
fn a_heap_of_discs_that_rests_keeps_the_contacts_it_began_with() {
    // Discs of many masses, close-packed from wall to wall, that lean a little to the right: half of the contacts may
    // go, and the rest pulls before long if the wrong half went.
    for (across, [square, once, modulus]) in [(11, [11, 29, 101]), (12, [5, 41, 67]), (13, [31, 17, 83])] {
        let mut shop = Workshop::weightless(1e-6);
        let width = f64::from(across);
        shop.fixed("floor", block(width + 4.0, 1.0), DVec2::new(0.0, -0.5));
        shop.fixed("left", block(1.0, 60.0), DVec2::new(-0.5 * (width + 1.0), 30.0));
        shop.fixed("right", block(1.0, 60.0), DVec2::new(0.5 * (width + 1.0), 30.0));
        let mut index = 0;
        for row in 0..across {
            let count = across - row % 2;
            for column in 0..count {
                let x = f64::from(column) - 0.5 * f64::from(count - 1);
                let state = at_rest(x, 0.5 + f64::from(row) * f64::sqrt(0.75));
                let mass = 0.1 + 0.1 * f64::from((square * index * index + once * index) % modulus);
                let body = shop.dull(&format!("disc {index}"), disc(0.5), mass, state);
                shop.builder.add_gravity(body, DVec2::new(0.01, -GRAVITY));
                index += 1;
            }
        }
        let mut world = shop.build();
        world.advance_to(1.0, &mut |event| panic!("{across} across: {event:?}")).expect("it rests");
        // It took hundreds or thousands of evaluations with other contacts, which were let go and caught again.
        assert!(world.statistics().evaluations < 100, "{across} across: {:?}", world.statistics());
    }
}
