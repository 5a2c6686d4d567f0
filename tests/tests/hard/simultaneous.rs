//! Several events at one moment.

use super::{impacts, within};
use halfgap::geometry::DVec2;
use halfgap::{BodyId, BodyState, ImpactLaw, ToleranceOverrides, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, thrown};
use halfgap_tests::world_of;

/// A block falls with a tilt, so that one corner is higher than the other by a length [m]. Returns the number of rows
/// of its first impact, and its spin [rad/s] after it.
fn land_tilted(higher: f64) -> (usize, f64) {
    let mut shop = Workshop::new(1e-8);
    let overrides = ToleranceOverrides { target_gap: Some(1e-6), ..ToleranceOverrides::default() };
    shop.builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -0.5));
    let state = BodyState { angle: 0.5 * higher, ..at_rest(0.0, 1.5) };
    let body = shop.body("block", block(2.0, 1.0), 1.0, state);
    let mut world = shop.build();
    let mut first = None;
    world
        .advance_to(0.5, &mut |event| {
            first = first
                .or(event.impact().map(|impact| (impact.rows.len(), impact.states[0].1.angular_velocity)));
        })
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(world.state(body).position.y > 0.5);
    first.expect("it has landed")
}

#[test]
fn corners_within_the_target_zone_land_at_once_and_others_one_after_the_other() {
    // The zone is 0.6 of the target gap high.
    for higher in [0.1e-6, 0.4e-6, 0.55e-6] {
        let (rows, spin) = land_tilted(higher);
        assert_eq!(rows, 2, "{higher} m");
        within(&format!("block with a corner higher by {higher:e} m: spin [rad/s]"), spin, 1e-12);
    }
    let (rows, spin) = land_tilted(0.7e-6);
    assert!(rows == 1 && spin.abs() > 1.0, "{rows} rows, {spin} rad/s");
}

#[test]
fn a_block_that_lands_flat_on_two_corners_does_not_turn() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let body = shop.settler("block", block(2.0, 1.0), 1.0, at_rest(0.3, 1.75), 0.5);
    let mut world = shop.build();
    // The block falls 1.25 m in 0.5 s, and after half of that time it has risen again to a quarter of that height.
    assert_eq!(impacts(&mut world, 0.75), 1);
    let state = world.state(body);
    within("block flat on two corners: turned [rad]", state.angle, 1e-15);
    within("block flat on two corners: spin [rad/s]", state.angular_velocity, 1e-14);
    within("block flat on two corners: height [m]", state.position.y - (0.5 + 0.25 * 1.25), 1e-9);
    advance(&mut world, 10.0);
    let state = world.state(body);
    within("block flat on two corners, at rest: turned [rad]", state.angle, 1e-12);
    within("block flat on two corners, at rest: moved aside [m]", state.position.x - 0.3, 1e-11);
}

fn world_with(law: ImpactLaw) -> WorldBuilder {
    WorldBuilder::new(WorldSettings { impact_law: law, ..WorldSettings::default() })
}

fn add(builder: &mut WorldBuilder, name: &str, x: f64, y: f64, speed: f64) -> BodyId {
    let state = thrown(x, y, DVec2::new(speed, 0.0));
    builder.add(halfgap::BodySpec::movable(name, disc(0.5), 1.0, state))
}

#[test]
fn three_discs_at_once_share_as_the_books_say() {
    // The middle disc meets two that touch, at 30 degrees to its way. Struck at once: it turns back with a fifth of
    // its speed, and each of the two leaves along its normal with 2 sqrt(3)/5 of it (momentum and energy).
    let mut builder = world_with(ImpactLaw::Simultaneous);
    let gap = 1e-10;
    let striker = add(&mut builder, "striker", -3.0, 0.0, 1.0);
    let half = 0.5 + 0.25 * gap;
    let pair = [add(&mut builder, "upper", 0.0, half, 0.0), add(&mut builder, "lower", 0.0, -half, 0.0)];
    let mut world = builder.build().expect("a fine world");
    assert_eq!(impacts(&mut world, 4.0), 1);
    within("three discs at once: striker [m/s]", world.state(striker).velocity.x + 0.2, 1e-9);
    within("three discs at once: striker aside [m/s]", world.state(striker).velocity.y, 1e-14);
    let along = DVec2::from_angle(std::f64::consts::FRAC_PI_6) * (2.0 * 3f64.sqrt() / 5.0);
    within("three discs at once: upper [m/s]", (world.state(pair[0]).velocity - along).length(), 1e-9);
    let mirrored = world.state(pair[0]).velocity - world.state(pair[1]).velocity * DVec2::new(1.0, -1.0);
    within("three discs at once: asymmetry [m/s]", mirrored.length(), 1e-14);
}

/// Strikers and resting discs in a row, all a target gap apart: speeds after the impact.
fn cradle(strikers: usize, resting: usize) -> Vec<f64> {
    let mut builder = world_with(ImpactLaw::Hybrid);
    let pitch = 1.0 + 0.5e-10;
    let bodies: Vec<BodyId> = (0..strikers + resting)
        .map(|index| {
            let moving = index < strikers;
            let x = index as f64 * pitch - if moving { 1.0 } else { 0.0 };
            add(&mut builder, &format!("disc{index}"), x, 0.0, if moving { 1.0 } else { 0.0 })
        })
        .collect();
    let mut world = builder.build().expect("a fine world");
    advance(&mut world, 1.5);
    bodies.iter().map(|&body| world.state(body).velocity.x).collect()
}

#[test]
fn as_many_discs_leave_a_cradle_as_strike_it() {
    for (strikers, resting) in [(1, 4), (2, 3), (3, 2), (3, 5)] {
        let speeds = cradle(strikers, resting);
        let off = speeds
            .iter()
            .enumerate()
            .map(|(index, speed)| (speed - if index >= resting { 1.0 } else { 0.0 }).abs());
        let what = format!("cradle, {strikers} strike {resting}: speeds [m/s]");
        within(&what, off.fold(0.0, f64::max), 1e-13);
    }
}

#[test]
fn the_last_of_twenty_discs_leaves_with_the_speed_of_the_first() {
    let speeds = cradle(1, 19);
    within("20 discs in a row: the last [m/s]", speeds[19] - 1.0, 1e-13);
    within(
        "20 discs in a row: the others [m/s]",
        speeds[..19].iter().map(|v| v.abs()).fold(0.0, f64::max),
        1e-13,
    );
}

#[test]
fn a_symmetric_fall_into_a_wedge_stays_symmetric() {
    // Two slopes of 45 degrees; a disc falls on both at once without bounce and rests in the wedge.
    let mut shop = Workshop::new(1e-8);
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let mut spec = halfgap::BodySpec::fixed(name, block(10.0, 1.0), DVec2::new(3.0 * side, 3.0));
        spec.state.angle = side * std::f64::consts::FRAC_PI_4;
        shop.builder.add(spec);
    }
    let ball = shop.dull("ball", disc(0.5), 2.0, at_rest(0.0, 4.0));
    let mut world = shop.build();
    advance(&mut world, 5.0);
    within("disc in a wedge: off the middle [m]", world.state(ball).position.x, 1e-12);
    within("disc in a wedge: velocity [m/s]", world.state(ball).velocity.length(), 1e-12);
    let forces = world.contact_forces();
    assert_eq!(forces.len(), 2);
    let each = 2.0 * GRAVITY / 2f64.sqrt();
    let off = forces.iter().map(|row| (row.force - each).abs()).fold(0.0, f64::max);
    within("disc in a wedge: forces [N]", off, 1e-11);
}

#[test]
fn elastic_discs_that_follow_each_other_within_the_zone_of_a_wall_lose_nothing() {
    // The first disc comes back from the wall, is sent there again by the second before it has left the zone, and
    // comes back once more.
    for tolerance in [1e-2, 1e-3, 1e-6, 1e-8, 1e-10] {
        for law in [ImpactLaw::Hybrid, ImpactLaw::Simultaneous] {
            let gap = 1.5e-3 * tolerance;
            let overrides = ToleranceOverrides { target_gap: Some(gap), ..ToleranceOverrides::default() };
            let settings =
                WorldSettings { tolerance, impact_law: law, overrides, ..WorldSettings::default() };
            let mut shop = Workshop::weightless(tolerance);
            shop.builder = WorldBuilder::new(settings);
            shop.fixed("wall", block(1.0, 6.0), DVec2::new(0.5, 0.0));
            let speed = DVec2::new(3.0, 0.0);
            let first = shop.body("first", disc(0.15), 1.0, thrown(-0.35, 0.0, speed));
            let second = shop.body("second", disc(0.15), 1.0, thrown(-0.65 - 2.0 * gap, 0.0, speed));
            let mut world = shop.build();
            assert_eq!(impacts(&mut world, 0.2), 3);
            for body in [first, second] {
                let name = format!("disc behind another within the zone of a wall, at {tolerance:e}: speed");
                within(&name, world.state(body).velocity.x / -3.0 - 1.0, 1e-12);
            }
        }
    }
}

/// A ring about a disc that goes round a circular rail meets a ceiling at a height [m], once the disc rests in the
/// ring. Returns the velocity of the ring [m/s] after 3 s. The ring's centre of mass is off its middle.
fn ring_at_ceiling(height: f64, tolerance: f64) -> DVec2 {
    let at = "position = [0.74, 1.1]\nvelocity = [0.19, 0.93]\nelasticity = 0.5";
    let mut world = world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\n\
         [run]\nduration = 3.0\nimpact_law = \"simultaneous\"\ntolerance = {tolerance:e}\n\
         [[body]]\nname = \"ceiling\"\nshape = {{ block = {{ width = 5.0, height = 1.0 }} }}\nfixed = true\n\
         position = [0.0, {}]\n\
         [[body]]\nname = \"ring\"\nshape = {{ ring = {{ outer = 0.25, inner = 0.12 }} }}\nmass = 0.7\n{at}\n\
         angle = 1.66\ncenter_of_mass = [0.0082, -0.0154]\nangular_velocity = -0.14\n\
         [[body]]\nname = \"inner\"\nshape = {{ disc = {{ radius = 0.036 }} }}\nmass = 0.5\n{at}\n\
         [[connector]]\n\
         rail = {{ a = {{ body = \"inner\", point = [0.0, 0.0] }}, closed = true, path = {{ start = [0.74, 1.1], \
         edges = [{{ arc = {{ to = [0.74, 1.1], center = [1.26, 1.78] }} }}] }} }}\n",
        height + 0.5
    ));
    advance(&mut world, 3.0);
    let ring = world.find("ring").expect("the ring");
    world.state(ring).velocity
}

#[test]
fn bodies_pressed_together_are_struck_together_whatever_their_steps_err_by() {
    // Dense output makes active contacts close and open faster than the speed that counts as rest.
    let mut worst = 0.0f64;
    for height in [1.75, 1.8, 1.85, 1.9, 1.95] {
        let exact = ring_at_ceiling(height, 1e-11);
        for tolerance in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
            worst = worst.max((ring_at_ceiling(height, tolerance) - exact).length() / tolerance);
        }
    }
    within("ring with a disc in it at a ceiling: velocity, by the tolerance [m/s]", worst, 1.0);
}

/// A bob hangs on a dull rope from the end of a bar on a pin; the rope is taut as both swing, and an elastic ball
/// falls on the bob at a speed [m/s].
fn bob_on_dull_rope(speed: f64, tolerance: f64) -> World {
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\n\
         [run]\nduration = 0.4\nimpact_law = \"simultaneous\"\ntolerance = {tolerance:e}\n\
         [[body]]\nname = \"bar\"\nshape = {{ block = {{ width = 0.05, height = 1.0 }} }}\nmass = 1.45\nangle = 0.03\n\
         position = [0.01499775010124783, -0.49977501687449377]\nelasticity = 1.0\n\
         [[body]]\nname = \"bob\"\nshape = {{ disc = {{ radius = 0.1 }} }}\nmass = 0.94\nelasticity = 1.0\n\
         position = [-0.18338135786799306, -1.8016537156006334]\npasses_through = [\"bar\"]\n\
         [[body]]\nname = \"ball\"\nshape = {{ disc = {{ radius = 0.1 }} }}\nmass = 1.69\nelasticity = 1.0\n\
         position = [-0.18338135786799306, -1.2316537156006335]\nvelocity = [0, -{speed}]\npasses_through = [\"bar\"]\n\
         [[connector]]\n\
         pin = {{ a = {{ body = \"world\", point = [0, 0] }}, b = {{ body = \"bar\", point = [0, 0.5] }} }}\n\
         [[connector]]\n\
         rope = {{ a = {{ body = \"bar\", point = [0, -0.5] }}, b = {{ body = \"bob\", point = [0, 0] }}, \
         length = 0.83, elasticity = 0 }}\n\
         [[force]]\ngravity = {{ acceleration = [0, -9.81] }}\n"
    ))
}

#[test]
fn a_rope_that_holds_is_struck_with_what_it_holds_whatever_its_steps_err_by() {
    // Dense output lengthens the rope faster than the speed that counts as rest: the rope is active all the same, and
    // passes the blow on.
    let mut worst = 0.0f64;
    for speed in [2.0, 2.3, 2.69, 3.0, 3.4] {
        for tolerance in [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-8] {
            let mut world = bob_on_dull_rope(speed, tolerance);
            assert_eq!(impacts(&mut world, 0.4), 1, "{speed} m/s, {tolerance:e}");
            worst = worst.max(world.ledger().impacts.abs() / tolerance);
        }
    }
    within("ball on a bob that hangs from a rope: energy lost, by the tolerance [J]", worst, 1e-2);
}
