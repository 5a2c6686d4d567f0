//! Stacks of blocks whose masses differ by many orders.

use crate::random::Random;
use serde_json::{Value, json};

/// Kinds of stacks: of equal blocks that do not bounce, of equal ones that do, of blocks of all sizes, and the same dropped from a
/// little height.
const KINDS: u64 = 4;

/// The stack of a seed, at rest on a floor but for the kind that drops, for 20 s.
#[must_use]
pub fn mixed_stack_of_seed(seed: u64) -> Value {
    let mut random = Random::new(seed ^ 0x57ac_0000);
    let kind = seed % KINDS;
    let mut bodies = vec![json!({
        "name": "floor", "fixed": true, "shape": { "block": { "width": 60.0, "height": 1.0 } }, "position": [0.0, -0.5],
    })];
    let mut top = 0.0;
    for index in 0..2 + random.below(5) {
        let [width, height] =
            if kind < 2 { [1.0, 0.5] } else { [random.between(0.8, 1.2), random.between(0.2, 0.8)] };
        if kind == KINDS - 1 {
            top += 10f64.powf(random.between(-9.0, -3.0));
        }
        bodies.push(json!({
            "name": format!("block {index}"), "shape": { "block": { "width": width, "height": height } },
            "position": [random.between(-0.05, 0.05), top + 0.5 * height],
            "mass": 10f64.powf(random.between(-3.0, 3.5)), "elasticity": if kind == 1 { 0.3 } else { 0.0 },
        }));
        top += height;
    }
    json!({
        "format": "halfgap-scene-1", "title": format!("mixed stack {seed}"),
        "run": { "duration": 20.0, "tolerance": if seed.is_multiple_of(3) { 1e-6 } else { 1e-8 } },
        "body": bodies, "force": [{ "gravity": { "acceleration": [0.0, -9.81] } }],
    })
}
