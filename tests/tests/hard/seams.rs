//! Seams between surfaces that are nearly level with each other: bodies that slide over them go on. Two contacts whose
//! normals hardly differ would hold a body altogether if both were stopped.

use super::within;
use halfgap::geometry::{DVec2, EdgeSpec, Shape};
use halfgap::{
    Anchor, BodySpec, BodyState, ConnectorKind, RailPath, ToleranceOverrides, WorldBuilder, WorldSettings,
};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc};
use std::f64::consts::PI;
use std::sync::Arc;

/// Place along [m] and height [m] of a corner of a floor of tiles.
type Corner = (f64, f64);

/// Adds tiles 0.2 m thick whose upper sides join the corners.
fn tiles(shop: &mut Workshop, corners: &[Corner]) {
    for (index, pair) in corners.windows(2).enumerate() {
        let [from, to] = [pair[0], pair[1]].map(|(x, y)| DVec2::new(x, y));
        let along = to - from;
        let middle = 0.5 * (from + to) - 0.1 * along.normalize().perp();
        let name = format!("tile {index}");
        let mut tile = BodySpec::fixed(&name, block(along.length(), 0.2), middle);
        tile.state.angle = along.to_angle();
        shop.builder.add(tile);
    }
}

fn sliding(position: DVec2, speed: f64) -> BodyState {
    BodyState { position, velocity: DVec2::new(speed, 0.0), ..BodyState::default() }
}

#[test]
fn a_disc_slides_over_the_seam_of_two_tiles_that_hardly_differ_in_slope() {
    // A hollow of this angle closes at the speed times the angle, and takes the square of that from the energy.
    for tolerance in [1e-6, 1e-8, 1e-10] {
        for angle in [1e-9, 1.8e-7, 1e-6, 1e-5, -1e-6, 1e-4] {
            for speed in [0.1, 1.0, 5.0] {
                let mut shop = Workshop::new(tolerance);
                tiles(&mut shop, &[(-4.0, 0.0), (0.0, 0.0), (4.0, 4.0 * angle)]);
                let ball = shop.body("ball", disc(0.1), 1.0, sliding(DVec2::new(-0.5 * speed, 0.1), speed));
                let mut world = shop.build();
                advance(&mut world, 0.75);
                let reached = world.state(ball).velocity.x;
                let slowed = GRAVITY * angle * 0.25 + speed * angle * angle;
                assert!(
                    (reached - speed + slowed).abs() < 1e-3 * angle.abs() + 1e-9,
                    "{angle} rad, {speed} m/s: {reached} m/s"
                );
            }
        }
    }
}

#[test]
fn a_ramp_of_tiles_with_rounded_places_is_as_fast_as_a_smooth_one() {
    let slope = 0.0314;
    for digits in [5, 6, 7] {
        let unit = 10_f64.powi(digits);
        let corners = [-0.12345, 0.53127, 1.37951, 2.11683, 2.90219, 3.31777];
        let corners = corners.map(|x| (x, (-slope * x * unit).round() / unit));
        let mut shop = Workshop::new(1e-8);
        tiles(&mut shop, &corners);
        // On the first tile, above the origin.
        let [first, second] = [corners[0], corners[1]].map(|(x, y)| DVec2::new(x, y));
        let start = first + (second - first) * (-first.x / (second.x - first.x));
        let center = start + 0.1 * (second - first).normalize().perp();
        let ball = shop.body("ball", disc(0.1), 1.0, at_rest(center.x, center.y));
        let mut world = shop.build();
        advance(&mut world, 4.0);
        let reached = world.state(ball).position.x - center.x;
        let expected = 0.5 * GRAVITY * slope / (1.0 + slope * slope) * 16.0;
        // The corners are off by half a unit of their last digit, slopes by up to that over a fifth of a metre.
        let bound = 0.5 * GRAVITY * 16.0 * (0.5 / unit) / 0.2;
        within(&format!("ramp of tiles of {digits} digits: place [m]"), reached - expected, bound);
        // A seam costs no more than the square of the closing speed, which is the angle times about a metre a second.
        within(&format!("ramp of tiles of {digits} digits: captures [J]"), world.ledger().captures, 1e-9);
    }
}

#[test]
fn a_disc_slides_from_a_table_to_a_crate_of_the_same_height() {
    for tolerance in [1e-7, 1e-8, 1e-9, 1e-10] {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(6.0, 0.2), DVec2::new(0.0, -0.1));
        shop.fixed("table", block(0.8, 0.2), DVec2::new(-0.4, 0.1));
        shop.body("crate", block(0.8, 0.2), 20.0, at_rest(0.4, 0.1));
        let ball = shop.body("ball", disc(0.1), 0.3, sliding(DVec2::new(-0.4, 0.3), 0.5));
        let mut world = shop.build();
        advance(&mut world, 1.0);
        let lost = 0.5 - world.state(ball).velocity.x;
        within(&format!("disc from table to crate, tolerance {tolerance:e}: speed"), lost, 10.0 * tolerance);
    }
}

#[test]
fn a_block_slides_over_crates_that_stand_side_by_side() {
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(6.0, 0.2), DVec2::new(0.0, -0.1));
        for (name, x) in [("first", -0.4), ("second", 0.4)] {
            shop.dull(name, block(0.8, 0.2), 5.0, at_rest(x, 0.1));
        }
        let slider = shop.dull("block", block(0.4, 0.2), 1.0, sliding(DVec2::new(-0.4, 0.3), 0.6));
        let mut world = shop.build();
        advance(&mut world, 1.0);
        let lost = 0.6 - world.state(slider).velocity.x;
        // Crates that turn by the gaps between them leave steps of that size.
        within(&format!("block over two crates, tolerance {tolerance:e}: speed"), lost, 1e-3);
    }
}

/// A block slides from a fixed table onto carts beside it, all as high as the table: each cart stands its gap above
/// the floor, as the block does above the table, so that the block's corner arrives at the height of theirs.
#[test]
fn a_block_slides_from_a_table_onto_carts_of_the_same_height() {
    for (tolerance, way, room) in [(1e-6, 1.0, 0.0), (1e-8, -1.0, 0.0), (1e-8, 1.0, 0.1), (1e-10, -1.0, 0.1)]
    {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
        shop.fixed("table", block(2.0, 1.0), DVec2::new(-way, 0.5));
        let carts = [1.0, 3.0]
            .map(|x| shop.body(&format!("cart {x}"), block(2.0, 1.0), 4.0, at_rest(way * (x + room), 0.5)));
        let slider = shop.body("block", block(0.4, 0.2), 1.0, sliding(DVec2::new(-0.8 * way, 1.1), way));
        let mut world = shop.build();
        advance(&mut world, 4.0);
        let what = format!("block from table to carts {room} m away, tolerance {tolerance:e}: speed [m/s]");
        within(&what, world.state(slider).velocity.x - way, tolerance);
        for cart in carts {
            within(&format!("{what} of a cart"), world.state(cart).velocity.x, tolerance);
        }
    }
}

/// Two blocks lie side by side, a third across both. It hops within the height that counts as contact, and touches
/// both by corners whose normals hardly differ: stopping all of these contacts would stop the block.
#[test]
fn a_block_that_hops_a_little_goes_on_to_slide_over_two_that_hardly_differ_in_slope() {
    for angle in [8e-5, -8e-5, 1e-5, -1e-3] {
        let block = |name: &str, state: &str| {
            format!(
                "[[body]]\nname = \"{name}\"\nmass = 1.0\nshape = {{ block = {{ width = 3.0, height = 1.0 }} }}\n{state}\n"
            )
        };
        let lower = |x: f64, angle: f64| {
            format!("position = [{x}, 0.505]\nangle = {angle:e}\nvelocity = [0.03, 0.0]")
        };
        let scene = [
            "format = \"halfgap-scene-1\"\ntitle = \"sliding across\"\n\
             force = [{ gravity = { acceleration = [0.0, -3.0] } }]\n\
             run = { duration = 1.0, target_gap = 0.005, accuracy = 0.003, velocity_tol = 0.5 }\n\
             [[body]]\nname = \"floor\"\nfixed = true\nshape = { block = { width = 20.0, height = 1.0 } }\n\
             position = [0.0, -0.5]\n"
                .to_owned(),
            block("left", &lower(-1.505, angle)),
            block("right", &lower(1.505, -angle)),
            block("top", "position = [0.2, 1.51]\nvelocity = [-0.05, 0.0015]"),
        ];
        let mut world = halfgap_tests::world_of(&scene.concat());
        advance(&mut world, 1.0);
        for (name, speed) in [("left", 0.03), ("right", 0.03), ("top", -0.05)] {
            let body = world.find(name).expect("it is there");
            let changed = world.state(body).velocity.x - speed;
            // In a second, half of the weight of the upper block changes the speed by 1.5 m/s times the slope on which
            // it lies.
            within(
                &format!("{name} block, {angle} rad: change of speed [m/s]"),
                changed,
                1e-6 + 1.5 * f64::abs(angle),
            );
        }
    }
}

/// State after 2 s of a block of 0.5 m that slides over the seam of two tiles, the second of which is higher by a step
/// [m]; its lower corners start at different heights [m] of a wide target zone.
fn slid_askew(gap: f64, slow: f64, [rear, front]: [f64; 2], speed: f64, step: f64) -> BodyState {
    let overrides =
        ToleranceOverrides { target_gap: Some(gap), accuracy: Some(0.6 * gap), velocity_tol: Some(slow) };
    let mut shop = Workshop::new(1e-8);
    shop.builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
    let [left, right] = [("left", -2.0, 0.0), ("right", 2.0, step)].map(|(name, x, y)| {
        let tile = BodySpec::fixed(name, block(4.0, 1.0), DVec2::new(x, y - 0.5));
        shop.builder.add(BodySpec { elasticity: 0.0, ..tile })
    });
    shop.builder.let_pass(left, right);
    let angle = ((front - rear) / 0.5).atan();
    let middle = DVec2::new(-0.6, 0.5 * (rear + front)) + 0.1 * DVec2::from_angle(angle).perp();
    let slider = shop.dull("block", block(0.5, 0.2), 1.0, BodyState { angle, ..sliding(middle, speed) });
    let mut world = shop.build();
    advance(&mut world, 2.0);
    world.state(slider)
}

/// In this zone a block at rest may lie at an angle of up to a hundredth. Neither the side nor the corner of the next
/// tile is in its way, and contacts whose normals differ by that angle do not hold it together.
#[test]
fn a_block_askew_in_a_wide_zone_slides_over_the_seam_of_level_tiles() {
    let heights = [0.45, 0.6, 0.8, 1.0, 1.2, 1.5];
    let (mut runs, mut worst) = (0, 0.0f64);
    for (gap, slow) in [(5e-3, 0.5), (5e-3, 0.1), (2e-3, 0.1)] {
        for [rear, front] in heights.into_iter().flat_map(|rear| heights.map(|front| [rear, front])) {
            for speed in [0.4, 1.0] {
                let slid = slid_askew(gap, slow, [rear * gap, front * gap], speed, 0.0);
                runs += 1;
                worst = worst.max((1.0 - slid.velocity.x / speed).abs());
            }
        }
    }
    assert_eq!(runs, 216);
    // A block that falls with one corner by the height of the zone turns, and its corner is hit at that angle.
    within("block askew over a seam, 216 runs: part of its speed", worst, 0.25);
}

/// A step counts as one where it leaves the block less room than contacts have; where the block is above it, it does
/// not.
#[test]
fn a_block_askew_in_a_wide_zone_is_stopped_by_a_step() {
    let speed = |heights: [f64; 2], step: f64| slid_askew(5e-3, 0.1, heights, 1.0, step).velocity.x;
    for step in [1.5e-3, 2e-3, 4e-3] {
        let stopped = speed([3.8e-3, 2.8e-3], step);
        assert!(stopped < 0.0, "step of {step} m: {stopped} m/s");
    }
    let passed = speed([4.5e-3, 5.5e-3], 3e-3);
    assert!(passed > 0.98, "{passed} m/s");
}

/// Beside a wide zone the edges of these outlines are short: each is about as high as the next, at whatever angle, and
/// still they meet.
#[test]
fn outlines_of_short_edges_meet_at_their_corners() {
    let overrides =
        ToleranceOverrides { target_gap: Some(5e-3), accuracy: Some(3e-3), velocity_tol: Some(0.5) };
    for (sides, radius) in [(24, 0.1), (48, 0.1), (96, 0.2)] {
        for index in 0..20 {
            let outline = || Shape::regular_polygon(sides, radius).expect("a fine radius");
            let mut shop = Workshop::weightless(1e-8);
            shop.builder = WorldBuilder::new(WorldSettings { overrides, ..WorldSettings::default() });
            let off = radius * (f64::from(index) / 10.0 - 0.95);
            shop.body("first", outline(), 1.0, BodyState { angle: 0.1, ..at_rest(0.0, 0.0) });
            let second = sliding(DVec2::new(2.0 * radius + 0.1, off), -1.0);
            shop.body("second", outline(), 1.0, BodyState { angle: 0.3, ..second });
            let mut world = shop.build();
            advance(&mut world, 0.5 + 4.0 * radius);
            let nearest = world.statistics().smallest_gap.expect("they meet");
            assert!(nearest > 1e-3, "{sides} sides, {off} m off: {nearest} m");
        }
    }
}

/// A track of two straights of 3 m and two half circles of 1 m, each cut into `cuts` edges.
fn cut_stadium(cuts: u32) -> RailPath {
    let start = DVec2::new(-1.5, -1.0);
    let (mut at, mut direction) = (start, DVec2::X);
    let mut edges = Vec::new();
    for _ in 0..2 {
        for _ in 0..cuts {
            at += 3.0 / f64::from(cuts) * direction;
            edges.push(EdgeSpec::Line { to: at });
        }
        let center = at + direction.perp();
        for cut in 1..=cuts {
            let to = center + DVec2::from_angle(PI * f64::from(cut) / f64::from(cuts)).rotate(at - center);
            edges.push(EdgeSpec::Arc { to, center, clockwise: false });
        }
        (at, direction) = (center + direction.perp(), -direction);
    }
    RailPath::from_edges(start, &edges).expect("a fine track")
}

#[test]
fn a_bead_goes_round_a_track_whose_straights_and_arcs_are_cut() {
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        let mut worst = 0.0f64;
        for cuts in [1, 2, 3, 7] {
            let mut shop = Workshop::weightless(tolerance);
            let bead = shop.body("bead", disc(0.1), 1.0, sliding(DVec2::new(-1.0, -1.0), 2.0));
            let a = Anchor { body: bead, point: DVec2::ZERO };
            shop.connect(ConnectorKind::Rail { a, path: Arc::new(cut_stadium(cuts)) }, 0.0);
            let mut world = shop.build();
            // Twice round and a metre further, at 2 m/s.
            advance(&mut world, 0.5 * (2.0 * (6.0 + 2.0 * PI) + 1.0));
            worst = worst.max((world.state(bead).position - DVec2::new(0.0, -1.0)).length());
        }
        within(
            &format!("bead round a cut track at {tolerance:e}: place, by the tolerance [m]"),
            worst / tolerance,
            1.0,
        );
    }
}

#[test]
fn a_bead_comes_onto_a_rail_from_before_its_first_edge() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let edges = [
            EdgeSpec::Line { to: DVec2::new(1.0, 0.0) },
            EdgeSpec::Arc { to: DVec2::new(1.0, 2.0), center: DVec2::new(1.0, 1.0), clockwise: false },
            EdgeSpec::Line { to: DVec2::new(0.0, 2.0) },
        ];
        let path = RailPath::from_edges(DVec2::ZERO, &edges).expect("a fine rail");
        let mut shop = Workshop::weightless(tolerance);
        let bead = shop.body("bead", disc(0.1), 1.0, sliding(DVec2::new(-1.0, 0.0), 1.0));
        let a = Anchor { body: bead, point: DVec2::ZERO };
        shop.connect(ConnectorKind::Rail { a, path: Arc::new(path) }, 0.0);
        let mut world = shop.build();
        // And beyond its last one.
        advance(&mut world, 2.0 + PI + 2.0);
        let off = (world.state(bead).position - DVec2::new(-1.0, 2.0)).length();
        within(
            &format!("bead from before a rail at {tolerance:e}: place, by the tolerance [m]"),
            off / tolerance,
            1.0,
        );
    }
}
