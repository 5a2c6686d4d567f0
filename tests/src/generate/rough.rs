//! Generated scenes whose surfaces have friction, and stacks of blocks that are pushed.

use super::scene_of_seed;
use crate::random::Random;
use serde_json::{Value, json};

/// Largest coefficients of friction, of scenes and of stacks.
const ROUGHEST: f64 = 3.0;
const ROUGHEST_STACK: f64 = 1.5;
/// Largest rolling resistance.
const MOST_ROLLING: f64 = 1.0;
/// Blocks of a stack.
const BLOCKS: usize = 3;

/// The scene of a seed with friction on most of its bodies, on some of them static friction above it, tangential elasticity and
/// surfaces that run.
#[must_use]
pub fn rough_of_seed(seed: u64) -> Value {
    let mut scene = scene_of_seed(seed);
    let mut random = Random::new(seed ^ 0x0f71_c710);
    let roughest = ROUGHEST * random.unit() * random.unit();
    let sticks = if random.chance(0.3) { random.between(1.0, 2.0) } else { 1.0 };
    let gives_back = random.chance(0.1);
    let runs = random.chance(0.1);
    for body in scene["body"].as_array_mut().into_iter().flatten() {
        let friction = if random.chance(0.8) { random.between(0.0, roughest) } else { 0.0 };
        body["friction"] = json!(friction);
        if sticks > 1.0 {
            body["static_friction"] = json!(friction * sticks);
        }
        if gives_back {
            body["tangential_elasticity"] = json!(random.unit());
        }
        if runs && random.chance(0.3) {
            body["surface_velocity"] = json!(random.between(-1.0, 1.0));
        }
    }
    scene["run"]["restitution"] = json!(random.one_of(&["energetic", "energetic", "poisson"]));
    scene
}

/// The rough scene of a seed with rolling resistance on half of its bodies, of which some have no friction.
#[must_use]
pub fn rolling_of_seed(seed: u64) -> Value {
    let mut scene = rough_of_seed(seed);
    let mut random = Random::new(seed ^ 0x0011_0e57);
    let most = MOST_ROLLING * random.unit() * random.unit();
    for body in scene["body"].as_array_mut().into_iter().flatten() {
        if random.chance(0.5) {
            body["rolling_resistance"] = json!(random.between(0.0, most));
        }
    }
    scene
}

/// The stack of a seed: three blocks of all slendernesses on a floor, which slide on each other from the start.
#[must_use]
pub fn pushed_stack_of_seed(seed: u64) -> Value {
    let mut random = Random::new(seed ^ 0x9a17_1e7e);
    let friction = ROUGHEST_STACK * random.unit();
    let slenderness = random.power_of_ten(-0.7, 0.5);
    let mut bodies = vec![json!({
        "name": "floor", "fixed": true, "shape": { "block": { "width": 400.0, "height": 1.0 } },
        "position": [0.0, -0.5], "friction": friction, "elasticity": 0.0,
    })];
    let mut top = 0.0;
    for index in 0..BLOCKS {
        let height = slenderness * random.between(0.5, 1.5);
        bodies.push(json!({
            "name": format!("block {index}"), "shape": { "block": { "width": 1.0, "height": height } },
            "position": [random.between(-0.2, 0.2), top + 0.5 * height], "velocity": [random.between(-2.0, 2.0), 0.0],
            "mass": random.power_of_ten(-0.5, 0.5), "friction": friction, "elasticity": 0.0,
        }));
        top += height;
    }
    json!({
        "format": "halfgap-scene-1", "title": format!("pushed stack {seed}"),
        "run": { "duration": 3.0, "tolerance": if seed.is_multiple_of(3) { 1e-6 } else { 1e-8 } },
        "body": bodies, "force": [{ "gravity": { "acceleration": [0.0, -9.81] } }],
    })
}
