//! Rest: bodies that lose their bounce stay where they are, at no cost.

use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, rest_time, thrown};
use halfgap_tests::{on_floor, world_of};

#[test]
fn a_resting_contact_forms_where_a_ball_without_bounce_lands() {
    let mut world =
        world_of(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.75]\nelasticity = 0.0"));
    let rest = rest_time(&mut world, 10.0);
    assert!((rest - 0.5).abs() < 1e-8, "at rest at {rest} s");
    assert_eq!(world.statistics().impacts, 1);
    let forces = world.contact_forces();
    assert!(forces.len() == 1 && (forces[0].force - 10.0).abs() < 1e-12, "{forces:?}");
}

#[test]
fn a_body_that_starts_at_rest_on_the_floor_stays_there() {
    for shape in ["disc = { radius = 0.5 }", "block = { width = 2.0, height = 1.0 }"] {
        let mut world = world_of(&on_floor(&format!("shape = {{ {shape} }}\nposition = [0.0, 0.5]")));
        let body = world.find("body").expect("it is there");
        let before = world.state(body);
        world.advance_to(1e3, &mut |_| {}).unwrap_or_else(|error| panic!("{shape}: {error}"));
        // Nothing holds it along the floor: an angle of one rounding error is a slope.
        let moved = world.state(body).position - before.position;
        assert!(moved.y.abs() < 1e-13 && moved.x.abs() < 1e-9, "{shape}: moved by {moved}");
        assert!(world.state(body).angle.abs() < 1e-12, "{shape}: turned by {}", world.state(body).angle);
        let weight: f64 = world.contact_forces().iter().map(|row| row.force).sum();
        assert!((weight - 10.0).abs() < 1e-11, "{shape}: {weight} N");
    }
}

#[test]
fn a_bouncing_ball_rests_when_the_geometric_series_ends() {
    for (elasticity, rest) in [(0.5, 1.5), (0.9, 9.5), (0.98, 49.5)] {
        let body = format!(
            "shape = {{ disc = {{ radius = 0.5 }} }}\nposition = [0.0, 1.75]\nelasticity = {elasticity}"
        );
        let mut world = world_of(&on_floor(&body));
        // A drop of 0.5 s, then bounces of 1, e, e^2, ... s.
        let last = rest_time(&mut world, 60.0);
        let speed = world.tolerances().velocity_tol;
        assert!(
            (last - rest).abs() < 10.0 * speed / (1.0 - elasticity),
            "e = {elasticity}: at {last} s, not {rest} s"
        );
        assert!(world.statistics().impacts > 10, "{} impacts", world.statistics().impacts);
        let ledger = world.ledger();
        assert!(ledger.integration_error().abs() < 1e-12 * ledger.start, "{ledger:?}");
        assert!((ledger.impacts + ledger.captures + 12.5).abs() < 1e-6, "{ledger:?}");
    }
}

/// Number of impacts within 0.2 s of an elastic ball that starts a given number of target gaps above the place where
/// it bounces, and the energy [J] that it loses meanwhile, in units of its weight times the target gap.
fn bounces_from(gaps: f64) -> (u64, f64) {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
    let mut state = at_rest(0.0, 0.5);
    let ball = shop.settler("ball", disc(0.5), 1.0, state, 1.0);
    let gap = shop.build().tolerances().target_gap;
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
    state.position.y += (1.0 + gaps) * gap;
    shop.settler("ball", disc(0.5), 1.0, state, 1.0);
    let mut world = shop.build();
    let weight = GRAVITY * world.inertia(ball).map_or(0.0, |inertia| inertia.mass);
    advance(&mut world, 0.2);
    let ledger = world.ledger();
    (world.statistics().impacts, -(ledger.impacts + ledger.captures) / (weight * gap))
}

#[test]
fn an_elastic_ball_that_bounces_as_high_as_the_gap_comes_to_rest_in_the_end() {
    let (impacts, lost) = bounces_from(5.0);
    assert!((1000..1100).contains(&impacts), "{impacts} impacts");
    assert!((lost - 5.0).abs() < 0.1, "{lost} gaps");
    // 20 gaps of 5e-11 m: 2.9e-5 s from one impact to the next.
    let (impacts, lost) = bounces_from(20.0);
    assert!((6900..7100).contains(&impacts), "{impacts} impacts");
    assert!(lost.abs() < 1e-3, "{lost} gaps");
}

#[test]
fn sliding_blocks_take_few_steps_and_meet_the_wall_or_the_edge_in_their_way() {
    // At 30 m/s a block slides along a floor of 200 m, against a wall at its end, and another over its edge.
    /// Bound far below the hundreds of steps that half a block a step would take.
    const MOST_STEPS: u64 = 60;
    for with_wall in [true, false] {
        let mut shop = Workshop::new(1e-8);
        shop.fixed("floor", block(200.0, 1.0), DVec2::new(0.0, -0.5));
        if with_wall {
            shop.fixed("wall", block(1.0, 5.0), DVec2::new(90.0, 2.5));
        }
        let slider = shop.dull("slider", block(1.0, 0.5), 1.0, thrown(-90.0, 0.25, DVec2::new(30.0, 0.0)));
        let rider = shop.dull("rider", block(0.5, 0.5), 1.0, thrown(-90.0, 0.75, DVec2::new(30.0, 0.0)));
        let mut world = shop.build();
        advance(&mut world, 5.0);
        let gap = world.tolerances().target_gap;
        assert!((world.state(slider).position.x - 60.0).abs() < 1e-10);
        assert!(
            (world.state(rider).position - world.state(slider).position).distance(DVec2::new(0.0, 0.5))
                < 2.0 * gap
        );
        let steps = world.statistics().steps;
        assert!(steps < MOST_STEPS, "{steps} steps");
        advance(&mut world, 6.5);
        let (slider, rider) = (world.state(slider).position, world.state(rider).position);
        if with_wall {
            assert!((slider.x - 89.0).abs() < 2.0 * gap, "it stops at the wall: {slider:?}");
            assert!((rider.x - 89.25).abs() < 2.0 * gap, "so does what it carries: {rider:?}");
        } else {
            assert!(
                slider.y < 0.25 - 1e-3 && rider.y < 0.75 - 1e-3,
                "they tip over the edge: {slider:?}, {rider:?}"
            );
        }
    }
}

/// Number of steps in 10 s of a body on a floor, drawn to and fro by a spring that lets it swing by 2 m, and its error
/// [m] in the end.
fn swing_on_floor(shape: &str, tolerance: f64) -> (u64, f64) {
    let mut world = world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\n[run]\nduration = 10.0\ntolerance = {tolerance:e}\n\
         [[force]]\ngravity = {{ acceleration = [0.0, -9.81] }}\n\
         [[force]]\nspring = {{ a = {{ body = \"world\", point = [0.0, 0.1] }}, b = {{ body = \"body\", point = [0.0, 0.0] }}, \
         rest_length = 0.0, stiffness = 10.0 }}\n\
         [[body]]\nname = \"floor\"\nfixed = true\nshape = {{ block = {{ width = 20.0, height = 1.0 }} }}\n\
         position = [0.0, -0.5]\n\
         [[body]]\nname = \"body\"\nmass = 1.0\nelasticity = 0.0\nshape = {{ {shape} }}\nposition = [2.0, 0.1]\n"
    ));
    let body = world.find("body").expect("it is there");
    advance(&mut world, 10.0);
    let expected = 2.0 * (10.0 * 10f64.sqrt()).cos();
    (world.statistics().steps, (world.state(body).position.x - expected).abs())
}

#[test]
fn a_block_slides_to_and_fro_in_about_as_many_steps_as_a_disc() {
    for tolerance in [1e-3, 1e-6, 1e-8] {
        let (of_disc, off_disc) = swing_on_floor("disc = { radius = 0.1 }", tolerance);
        let (of_block, off_block) = swing_on_floor("block = { width = 0.2, height = 0.2 }", tolerance);
        println!("{tolerance:e}: {of_disc} steps and {off_disc:e} m, {of_block} steps and {off_block:e} m");
        assert!(off_disc < tolerance && off_block < tolerance, "{off_disc} m, {off_block} m");
        assert!(of_block < 2 * of_disc, "{of_block} steps, {of_disc} of the disc");
    }
}

#[test]
fn a_pair_in_contact_takes_no_more_steps_for_falling_together() {
    let steps = |gravity: f64, velocity: &str| {
        let at = "position = [0.0, 0.0]\nelasticity = 0.0";
        let mut world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\n[run]\nduration = 8.0\ntolerance = 1e-6\n\
             [[force]]\ngravity = {{ acceleration = [0.0, {gravity}] }}\n\
             [[body]]\nname = \"ring\"\nmass = 1.0\nshape = {{ ring = {{ outer = 1.1, inner = 1.0 }} }}\n{at}\n\
             velocity = {velocity}\n\
             [[body]]\nname = \"disc\"\nmass = 0.5\nshape = {{ disc = {{ radius = 0.2 }} }}\n\
             position = [0.0, -0.8]\nelasticity = 0.0\nvelocity = [2.0, 0.0]\n"
        ));
        advance(&mut world, 8.0);
        world.statistics().steps
    };
    let (at_rest, falling) = (steps(0.0, "[-1.0, 0.0]"), steps(-9.81, "[-1.0, 0.0]"));
    assert!(falling < 2 * at_rest, "{falling} steps, {at_rest} without falling");
}
