//! Rest is cheap: a body that stands still takes few steps, and does not move.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{BodyId, BodyState, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc};
use halfgap_tests::reference_scene;

/// Largest distance [m] or angle [rad] by which a body has moved.
fn moved(world: &World, start: &[BodyState]) -> f64 {
    let of = |(body, start): (BodyId, &BodyState)| {
        let state = world.state(body);
        (state.position - start.position).length().max((state.angle - start.angle).abs())
    };
    world.bodies().zip(start).map(of).fold(0.0, f64::max)
}

/// Lets a world rest for a hundred seconds, and returns the largest motion met.
fn rest(world: &mut World) -> f64 {
    let start: Vec<BodyState> = world.bodies().map(|body| world.state(body)).collect();
    let mut most = 0.0f64;
    for piece in 1..=100 {
        advance(world, f64::from(piece));
        most = most.max(moved(world, &start));
    }
    println!("moved {most:e}, {:?}", world.statistics());
    most
}

fn stack(count: usize, elasticity: f64) -> World {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -0.5));
    for index in 0..count {
        let state = at_rest(0.0, 0.25 + 0.5 * index as f64);
        let name = format!("block {index}");
        if elasticity > 0.0 {
            shop.body(&name, block(1.0, 0.5), 1.0, state);
        } else {
            shop.dull(&name, block(1.0, 0.5), 1.0, state);
        }
    }
    shop.build()
}

#[test]
fn a_stack_of_ten_rests_for_a_hundred_seconds_in_less_than_two_hundred_steps() {
    for elasticity in [0.0, 1.0] {
        let mut world = stack(10, elasticity);
        let most = rest(&mut world);
        assert!(most < 1e-9, "elasticity {elasticity}: moved by {most}");
        assert!(world.statistics().steps < 200, "{:?}", world.statistics());
        assert_eq!(world.statistics().impacts, 0, "elasticity {elasticity}");
        // The lowest block carries all ten, by its two ends.
        let floor = world.find("floor").expect("it is there");
        let on_floor =
            world.contact_forces().iter().filter(|row| row.bodies[1] == floor).map(|row| row.force).sum();
        let weight: f64 = on_floor;
        assert!((weight - 10.0 * GRAVITY).abs() < 1e-9, "{weight} N");
    }
}

/// A wall of bricks of 1 m with joints of a width [m]; each brick stands on two, and every row has one brick less than
/// the one below.
fn wall(joint: f64, tolerance: f64) -> World {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let pitch = 1.0 + joint;
    for row in 0..5 {
        for column in 0..5 - row {
            let (column_at, row_at) = (f64::from(column), f64::from(row));
            let state = at_rest(pitch * (column_at + 0.5 * row_at), 0.25 + 0.5 * row_at);
            shop.dull(&format!("{row} {column}"), block(1.0, 0.5), 1.0, state);
        }
    }
    shop.build()
}

#[test]
fn a_wall_of_bricks_rests() {
    // Without joints bricks stand on two corners that are only a target gap apart.
    for (joint, tolerance) in [(0.01, 1e-8), (0.0, 1e-4), (0.0, 1e-6), (0.0, 1e-8), (0.0, 1e-10)] {
        let mut world = wall(joint, tolerance);
        let most = rest(&mut world);
        assert!(most < 1e-9, "joints of {joint} m at {tolerance:e}: moved by {most}");
        assert!(world.statistics().steps < 400, "{:?}", world.statistics());
    }
}

#[test]
fn discs_rest_in_a_round_bowl_where_they_hold_each_other() {
    // Three discs in a bowl, the outer two leaning on the middle one, each on the bowl: all forces are positive.
    let bowl = Shape::ring(4.0, 3.0).expect("a fine ring");
    let mut shop = Workshop::new(1e-8);
    shop.fixed("bowl", bowl, DVec2::ZERO);
    let reach = 3.0 - 0.5;
    let turn = 2.0 * (0.5f64 / reach).asin();
    for (name, angle) in [("left", -turn), ("middle", 0.0), ("right", turn)] {
        let place = DVec2::from_angle(angle - std::f64::consts::FRAC_PI_2) * reach;
        shop.dull(name, disc(0.5), 1.0, at_rest(place.x, place.y));
    }
    let mut world = shop.build();
    let most = rest(&mut world);
    assert!(most < 1e-8, "moved by {most}");
    assert_eq!(world.contact_forces().len(), 5, "{:?}", world.contact_forces());
    let weight: DVec2 = world
        .contact_forces()
        .iter()
        .filter(|row| row.bodies.iter().any(|&body| world.is_fixed(body)))
        .map(
            |row| {
                if world.is_fixed(row.bodies[0]) { -row.force * row.normal } else { row.force * row.normal }
            },
        )
        .sum();
    assert!((weight - DVec2::new(0.0, 3.0 * GRAVITY)).length() < 1e-7, "{weight} N");
}

#[test]
fn a_block_that_lands_askew_comes_to_rest_flat() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let state = BodyState { angle: 0.3, ..at_rest(0.0, 1.5) };
    let body = shop.dull("block", block(2.0, 1.0), 1.0, state);
    let mut world = shop.build();
    advance(&mut world, 5.0);
    let state = world.state(body);
    assert!(state.angle.abs() < 1e-9, "it lies at {} rad", state.angle);
    assert!((state.position.y - 0.5 - world.tolerances().target_gap).abs() < 1e-9, "{}", state.position);
    assert!(state.angular_velocity.abs() < 1e-12 && state.velocity.y.abs() < 1e-12, "{state:?}");
    assert_eq!(world.contact_forces().len(), 2);
    let ledger = world.ledger();
    assert!(ledger.integration_error().abs() < 1e-7 * ledger.start, "{ledger:?}");
}

#[test]
fn a_block_that_bounces_and_rocks_comes_to_rest_flat() {
    for elasticity in ["0.3", "0.5", "0.8"] {
        let scene = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"rocks\"\nrun = {{ duration = 60.0 }}\n\
             force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]\n\
             [[body]]\nname = \"floor\"\nfixed = true\nshape = {{ block = {{ width = 60.0, height = 1.0 }} }}\n\
             position = [0.0, -0.5]\n\
             [[body]]\nname = \"block\"\nmass = 1.0\nshape = {{ block = {{ width = 2.0, height = 1.0 }} }}\n\
             position = [0.0, 1.5]\nangle = 0.3\nelasticity = {elasticity}\n"
        );
        let mut world = halfgap_tests::world_of(&scene);
        let body = world.find("block").expect("it is there");
        advance(&mut world, 60.0);
        let state = world.state(body);
        let upright = (state.angle / std::f64::consts::PI).round() * std::f64::consts::PI;
        assert!((state.angle - upright).abs() < 1e-8, "e = {elasticity}: it lies at {} rad", state.angle);
        assert!(state.angular_velocity.abs() < 1e-9, "e = {elasticity}: {state:?}");
        assert_eq!(world.contact_forces().len(), 2, "e = {elasticity}");
        println!("e = {elasticity}: {:?}", world.statistics());
    }
}

/// Eight blocks that attract each other gather in a heap. An impact anywhere makes contacts everywhere open a little;
/// contacts that the others press back at once count as held. Nothing holds a block that slides along another.
#[test]
fn a_heap_settles_in_few_impacts_and_goes_on_to_slide() {
    const STARTS: u32 = 16;
    let mut sliding = 0;
    for start in 0..STARTS {
        let mut scene = reference_scene("apps__pile_attract");
        let mut movable = scene.bodies.iter_mut().filter(|body| !body.fixed);
        movable.next().expect("there are eight").velocity.x += 1e-3 * f64::from(start);
        let mut world = World::from_scene(&scene).expect("a reference scene");
        world.advance_to(6.0, &mut |_| {}).expect("it goes on");
        // There were fourteen hundred to nineteen hundred when each contact had to be caught again.
        let impacts = world.statistics().impacts;
        assert!((50..500).contains(&impacts), "{impacts} impacts");
        // Of 26 J; how much of it still slides is a matter of chance: 2e-4 J to 0.4 J from places a nanometre apart.
        let kinetic = world.energy().kinetic;
        assert!((1e-5..1.0).contains(&kinetic), "{kinetic} J");
        sliding += u32::from(kinetic > 1e-2);
    }
    assert!(sliding >= STARTS / 2, "{sliding} of {STARTS} slide on");
}
