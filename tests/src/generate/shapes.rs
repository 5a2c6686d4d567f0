//! Shapes of all kinds.

use crate::random::Random;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// A shape, a centre of mass within it, and the radius [m] of a circle about that centre that holds all of it.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    pub(super) shape: Value,
    pub(super) center: [f64; 2],
    pub(super) radius: f64,
}

/// A shape that fits into a circle of about the given size [m].
pub(super) fn shape(random: &mut Random, size: f64) -> Outline {
    let (shape, radius) = match random.below(11) {
        0..3 => (json!({ "disc": { "radius": size } }), size),
        3..5 => block(random, size),
        5 => rounded(random, size),
        6 => polygon(random, size),
        7 => needle(random, size),
        8 => ring(random, size),
        9 => notched(random, size),
        _ => half_disc(random, size),
    };
    let off = if random.chance(0.2) { 0.2 * size } else { 0.0 };
    let center = [off * random.between(-1.0, 1.0), off * random.between(-1.0, 1.0)];
    Outline { shape, center, radius: radius + center[0].hypot(center[1]) }
}

fn block(random: &mut Random, size: f64) -> (Value, f64) {
    let slim = if random.chance(0.2) { random.power_of_ten(-2.0, 0.0) } else { random.between(0.3, 1.0) };
    let (width, height) = (1.6 * size, 1.6 * size * slim);
    (json!({ "block": { "width": width, "height": height } }), 0.5 * width.hypot(height))
}

fn rounded(random: &mut Random, size: f64) -> (Value, f64) {
    let (width, height) = (1.6 * size, 1.6 * size * random.between(0.2, 1.0));
    let radius = 0.5 * height * random.one_of(&[0.1, 0.5, 1.0]);
    let shape = json!({ "rounded_block": { "width": width, "height": height, "radius": radius } });
    (shape, 0.5 * width.hypot(height))
}

/// A star or a convex polygon about the origin.
fn polygon(random: &mut Random, size: f64) -> (Value, f64) {
    let count = 3 + random.below(8);
    let dented = random.chance(0.4);
    let vertex = |index: usize| {
        let angle = TAU * index as f64 / count as f64;
        let far = if dented && index % 2 == 1 { size * random.between(0.3, 0.9) } else { size };
        [far * angle.cos(), far * angle.sin()]
    };
    (json!({ "polygon": { "vertices": (0..count).map(vertex).collect::<Vec<_>>() } }), size)
}

/// A triangle with a sharp corner.
fn needle(random: &mut Random, size: f64) -> (Value, f64) {
    let half = size * random.between(0.01, 0.2);
    (json!({ "polygon": { "vertices": [[size, 0.0], [-0.9 * size, half], [-0.9 * size, -half]] } }), size)
}

fn ring(random: &mut Random, size: f64) -> (Value, f64) {
    (json!({ "ring": { "outer": size, "inner": size * random.between(0.2, 0.95) } }), size)
}

/// A block with a round bite out of its top.
fn notched(random: &mut Random, size: f64) -> (Value, f64) {
    let (x, y) = (0.8 * size, 0.6 * size);
    let r = size * random.between(0.1, 0.55);
    let edges = json!([
        { "line": [x, -y] }, { "line": [x, y] }, { "line": [r, y] },
        { "arc": { "to": [-r, y], "center": [0.0, y], "clockwise": true } },
        { "line": [-x, y] }, { "line": [-x, -y] },
    ]);
    (json!({ "outline": { "paths": [{ "start": [-x, -y], "edges": edges }] } }), size)
}

/// Half a disc, which may have a round hole.
fn half_disc(random: &mut Random, size: f64) -> (Value, f64) {
    let half = json!({ "start": [size, 0.0], "edges": [
        { "arc": { "to": [-size, 0.0], "center": [0.0, 0.0] } }, { "line": [size, 0.0] },
    ] });
    let mut paths = vec![half];
    if random.chance(0.5) {
        let start = [0.2 * size, 0.5 * size];
        paths.push(json!({ "start": start, "edges": [
            { "arc": { "to": start, "center": [0.0, 0.5 * size] } },
        ] }));
    }
    (json!({ "outline": { "paths": paths } }), size)
}
