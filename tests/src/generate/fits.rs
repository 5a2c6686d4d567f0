//! Bodies that fit exactly, struck by others: a block between two walls, a plug in a slot, a box in a corner, a disc in
//! a groove.

use crate::random::Random;
use serde_json::{Value, json};

fn block(width: f64, height: f64) -> Value {
    json!({ "block": { "width": width, "height": height } })
}

fn fixed(name: &str, shape: Value, position: [f64; 2], angle: f64) -> Value {
    json!({ "name": name, "fixed": true, "shape": shape, "position": position, "angle": angle })
}

/// The scene of a seed, whose law and elasticity are given: nothing but the body that fits is struck.
#[must_use]
pub fn struck_fit_of_seed(seed: u64, law: &str, elasticity: f64) -> Value {
    let mut random = Random::new(seed ^ 0xf17_0000);
    let two_digits = |value: f64| (100.0 * value).round() / 100.0;
    let width = two_digits(random.between(0.2, 1.5)).max(0.2);
    let height = two_digits(random.between(0.2, 1.5)).max(0.2);
    let radius = two_digits(random.between(0.05, 0.2)).max(0.05);
    let kind = random.below(4);
    let off = match random.below(4) {
        0 => 0.0,
        1 => two_digits(random.between(-0.4, 0.4)) * width,
        _ => random.between(-0.45, 0.45) * width,
    };
    let speed = two_digits(random.between(0.3, 5.0));
    let tilt = if random.chance(0.5) { 0.0 } else { random.between(-0.5, 0.5) };
    let mut bodies = Vec::new();
    let mut shape = block(width, height);
    let walls = |bodies: &mut Vec<Value>| {
        for (name, side) in [("left", -1.0), ("right", 1.0)] {
            bodies.push(fixed(name, block(1.0, height), [side * (0.5 * width + 0.5), 0.0], 0.0));
        }
    };
    match kind {
        0 => walls(&mut bodies),
        1 => {
            walls(&mut bodies);
            bodies.push(fixed("bottom", block(width, 1.0), [0.0, -0.5 * height - 0.5], 0.0));
        }
        2 => {
            bodies.push(fixed("left", block(1.0, height), [-0.5 * width - 0.5, 0.0], 0.0));
            bodies.push(fixed("bottom", block(8.0, 1.0), [0.0, -0.5 * height - 0.5], 0.0));
        }
        _ => {
            let half = random.between(0.2, 1.3);
            // The sides of the groove lean by `half` from the vertical; the disc touches both.
            shape = json!({ "disc": { "radius": 0.5 * width } });
            for (name, side) in [("left", -1.0f64), ("right", 1.0)] {
                let normal = [-side * half.cos(), half.sin()];
                let center = normal.map(|n| -(0.5 * width + 0.5) * n);
                bodies.push(fixed(name, block(1.0, 1.2 * width), center, -side * half));
            }
        }
    }
    bodies.push(json!({
        "name": "fit", "shape": shape, "position": [0.0, 0.0], "elasticity": elasticity,
        "mass": random.one_of(&[1.0, 4.0, 0.1, 30.0]),
    }));
    let top = if kind == 3 { (0.25 * width * width - off * off).max(0.0).sqrt() } else { 0.5 * height };
    let room = random.between(0.1, 0.5);
    let start = [off + room * f64::tan(tilt) * f64::from(kind != 3), top + radius + room];
    bodies.push(json!({
        "name": "striker", "shape": { "disc": { "radius": radius } }, "mass": random.one_of(&[1.0, 0.2, 9.0]),
        "position": start, "elasticity": elasticity,
        "velocity": [-speed * tilt.sin(), -speed * tilt.cos()],
    }));
    json!({
        "format": "halfgap-scene-1", "title": format!("struck fit {seed}"),
        "run": { "duration": 1.5 * (room + radius) / speed, "impact_law": law },
        "body": bodies,
    })
}

/// The struck fit of a seed with a play [m] of a size between 1e-14 and 1e-3 between its walls, at a tolerance of its own.
#[must_use]
pub fn tight_fit_of_seed(seed: u64, law: &str, elasticity: f64) -> Value {
    let mut random = Random::new(seed ^ 0x7196_4000);
    let mut scene = struck_fit_of_seed(seed, law, elasticity);
    let play = 10f64.powf(random.between(-14.0, -3.0));
    scene["run"]["tolerance"] = json!(random.one_of(&[1e-4, 1e-6, 1e-8, 1e-10]));
    for body in scene["body"].as_array_mut().into_iter().flatten() {
        let side = match body["name"].as_str() {
            Some("left") => -0.5,
            Some("right") => 0.5,
            _ => continue,
        };
        let place = body["position"][0].as_f64().unwrap_or_default();
        body["position"][0] = json!(place + side * play);
    }
    scene
}
