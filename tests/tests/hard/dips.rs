//! Events that last for a moment within one long step: a stop that a bead just reaches, a joint or an end that is
//! passed by little before the motion turns back.

use super::{impacts, within};
use halfgap::World;
use halfgap_tests::mechanism::{advance, connector_error};
use halfgap_tests::world_of;

const GRAVITY: f64 = 10.0;
/// Distances [m] by which the motions would go beyond a stop, joint or end if nothing kept them from it.
const DEPTHS: [f64; 3] = [1e-2, 1e-4, 1e-6];

/// A bead that is thrown straight up a rail, with a stop 0.5 m above: without the stop it would turn back `depth` [m]
/// beyond.
fn thrown_to_a_stop(depth: f64) -> World {
    let speed = (2.0 * GRAVITY * (0.5 + depth)).sqrt();
    let rail = "a = { body = \"bead\", point = [0.0, 0.0] }, path = { start = [0.0, -1.0], edges = [{ line = [0.0, 9.0] }] }";
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 1.0 }}\n\
         force = [{{ gravity = {{ acceleration = [0.0, {}] }} }}]\n\
         [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.01 }} }}\nmass = 1.0\nvelocity = [0.0, {speed}]\n\
         [[connector]]\nrail = {{ {rail} }}\n\
         [[connector]]\nrail_stop = {{ {rail}, at = 1.5, upper = true }}\n",
        -GRAVITY
    ))
}

#[test]
fn a_bead_that_just_reaches_its_stop_is_turned_back_by_it() {
    for depth in DEPTHS {
        // The bead reaches the stop at the speed that it would have lost beyond it.
        let [thrown, left] = [0.5 + depth, depth].map(|height| (2.0 * GRAVITY * height).sqrt());
        let back = 2.0 * (thrown - left) / GRAVITY;
        let mut world = thrown_to_a_stop(depth);
        assert_eq!(impacts(&mut world, back), 1, "it would go {depth} m beyond its stop");
        let bead = world.find("bead").expect("the bead");
        within(&format!("bead {depth:e} m beyond: place [m]"), world.state(bead).position.y, 1e-9);
    }
}

/// A bead on a level rail that continues as the top of a hill of radius 0.1 m, under a force away from the hill: it
/// would turn back `depth` [m] beyond the joint if the rail stayed level.
fn thrown_to_a_joint(depth: f64) -> World {
    let speed = -(2.0 * (0.5 + depth)).sqrt();
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 2.0 }}\n\
         force = [{{ gravity = {{ acceleration = [1.0, {}] }} }}]\n\
         [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.01 }} }}\nmass = 1.0\nposition = [0.5, 0.0]\nvelocity = [{speed}, 0.0]\n\
         [[connector]]\nrail = {{ a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ start = [-0.1, -0.1], edges = [\
         {{ arc = {{ to = [0.0, 0.0], center = [0.0, -0.1], clockwise = true }} }}, {{ line = [9.0, 0.0] }}] }} }}\n",
        -GRAVITY
    ))
}

#[test]
fn a_bead_that_is_just_past_a_joint_goes_on_over_the_hill_or_turns_back() {
    // The highest point of the potential on the hill is equivalent to 0.005 m of level rail beyond the joint.
    let barrier = 0.1 * ((1.0 + GRAVITY * GRAVITY).sqrt() - GRAVITY);
    for (depth, goes_over) in [(1.2 * barrier, true), (0.8 * barrier, false), (1e-4, false), (1e-5, false)] {
        let mut world = thrown_to_a_joint(depth);
        let bead = world.find("bead").expect("the bead");
        // The time at which it would turn back if the rail were level.
        advance(&mut world, (2.0 * (0.5 + depth)).sqrt());
        within(&format!("bead {depth:e} m past a joint: place [m]"), connector_error(&world), 1e-12);
        advance(&mut world, 1.3);
        let state = world.state(bead);
        assert_eq!(state.position.x < 0.0, goes_over, "{depth} m: {state:?}");
        let energy = 0.5 * state.velocity.length_squared() - state.position.x + GRAVITY * state.position.y;
        within(&format!("bead {depth:e} m past a joint: energy [J]"), energy - depth, 1e-9);
        assert_eq!(world.statistics().impacts, 0, "the joint is smooth");
    }
}

#[test]
fn a_disc_sinks_over_the_end_of_a_block_that_turns_back_at_once() {
    let radius: f64 = 0.15;
    for depth in [1e-2f64, 1e-4] {
        // The block's end starts 0.5 m to the side of the disc, slides away from under it, and is pulled back.
        let speed = -(2.0 * 3.0 * (0.5 + depth)).sqrt();
        let slot = |height: f64| {
            format!(
                "[[connector]]\nslot = {{ a = {{ body = \"world\", point = [0.0, 0.0] }}, b = {{ body = \"disc\", point = [0.0, {height}] }}, normal = [1.0, 0.0] }}\n"
            )
        };
        let mut world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 2.0 }}\n\
             force = [{{ gravity = {{ acceleration = [3.0, {}] }} }}]\n\
             [[body]]\nname = \"floor\"\nfixed = true\nshape = {{ block = {{ width = 20.0, height = 2.0 }} }}\nposition = [0.0, -1.0]\n\
             [[body]]\nname = \"block\"\nelasticity = 0.0\nshape = {{ block = {{ width = 4.0, height = 0.4 }} }}\nmass = 1e6\nposition = [-1.5, 0.2]\nvelocity = [{speed}, 0.0]\n\
             [[body]]\nname = \"disc\"\nelasticity = 0.0\nshape = {{ disc = {{ radius = {radius} }} }}\nmass = 1.0\nposition = [0.0, {}]\n\
             {}{}",
            -GRAVITY,
            0.4 + radius,
            slot(0.0),
            slot(0.1)
        ));
        let disc = world.find("disc").expect("the disc");
        advance(&mut world, -speed / 3.0);
        let sunk = 0.4 + radius - world.state(disc).position.y;
        let expected = radius - (radius * radius - depth * depth).sqrt();
        // The disc has a millionth of the block's mass.
        within(&format!("disc over an end by {depth:e} m: depth [m]"), sunk - expected, 1e-6 * depth);
    }
}
