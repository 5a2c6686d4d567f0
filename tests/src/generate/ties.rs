//! Connectors and forces between bodies that are already placed.

use super::{Placed, Units};
use crate::random::Random;
use serde_json::{Value, json};

/// An ordinary gravity [m/s^2].
const GRAVITY: f64 = 10.0;

/// An end of a connector or a spring: a body, or the background, and a point on it.
fn end(body: Option<&Placed>, place: [f64; 2]) -> Value {
    match body {
        Some(body) => json!({ "body": body.name, "point": body.to_shape(place) }),
        None => json!({ "body": "world", "point": place }),
    }
}

/// A point of a body, in world coordinates.
fn point_of(random: &mut Random, body: &Placed) -> [f64; 2] {
    let mut offset = || body.radius * random.between(-0.7, 0.7);
    [body.position[0] + offset(), body.position[1] + offset()]
}

pub(super) fn connectors(random: &mut Random, units: &Units, placed: &[Placed]) -> Vec<Value> {
    if placed.is_empty() || random.chance(0.5) {
        return Vec::new();
    }
    let count = 1 + random.below(placed.len().min(6));
    (0..count).map(|_| connector(random, units, placed)).collect()
}

fn connector(random: &mut Random, units: &Units, placed: &[Placed]) -> Value {
    let first = random.below(placed.len());
    let a = &placed[first];
    let second = random.below(placed.len());
    let b = placed.get(second).filter(|_| second != first && random.chance(0.7));
    let at = point_of(random, a);
    match random.below(7) {
        0..3 => json!({ "pin": { "a": end(Some(a), at), "b": end(b, at) } }),
        3 => {
            let frame = random.one_of(&["a", "b", "world"]);
            let normal = [random.between(-1.0, 1.0), random.between(0.1, 1.0)];
            json!({ "slot": { "a": end(Some(a), at), "b": end(b, at), "normal": normal, "normal_frame": frame } })
        }
        4 => long(random, units, (a, at), b, "rod"),
        5 => long(random, units, (a, at), b, "rope"),
        _ => rail(random, units, a, at),
    }
}

/// A rod or a rope, which may be slack.
fn long(
    random: &mut Random,
    units: &Units,
    (a, at): (&Placed, [f64; 2]),
    b: Option<&Placed>,
    kind: &str,
) -> Value {
    let other = match b {
        Some(b) => point_of(random, b),
        None => {
            [at[0] + units.length * random.between(0.5, 3.0), at[1] + units.length * random.between(0.0, 3.0)]
        }
    };
    let apart = (at[0] - other[0]).hypot(at[1] - other[1]).max(1e-3 * units.length);
    let slack = if kind == "rope" && random.chance(0.7) { random.between(1.0, 1.5) } else { 1.0 };
    let mut spec = json!({ "a": end(Some(a), at), "b": end(b, other), "length": apart * slack });
    if random.chance(0.3) {
        spec["elasticity"] = json!(random.unit());
    }
    json!({ kind: spec })
}

/// A rail through a point of a body: a circle, or a spline.
fn rail(random: &mut Random, units: &Units, a: &Placed, at: [f64; 2]) -> Value {
    let size = units.length * random.between(0.5, 2.0);
    let shifted = |x: f64, y: f64| [at[0] + size * x, at[1] + size * y];
    if random.chance(0.5) {
        let path = json!({ "start": at, "edges": [{ "arc": { "to": at, "center": shifted(0.0, 1.0) } }] });
        json!({ "rail": { "a": end(Some(a), at), "path": path, "closed": true } })
    } else {
        let points = [shifted(0.0, 0.0), shifted(1.0, -0.5), shifted(2.0, 0.2), shifted(1.0, 1.5)];
        json!({ "rail": { "a": end(Some(a), at), "path": { "points": points }, "closed": true } })
    }
}

pub(super) fn forces(random: &mut Random, units: &Units, placed: &[Placed], attract: bool) -> Vec<Value> {
    let mut forces = Vec::new();
    let acceleration = units.length / (units.time * units.time);
    if random.chance(0.75) {
        let sideways = if random.chance(0.3) { random.between(-3.0, 3.0) } else { 0.0 };
        forces.push(
            json!({ "gravity": { "acceleration": [sideways * acceleration, -GRAVITY * acceleration] } }),
        );
    }
    if random.chance(0.15) {
        let (linear, angular) = (random.power_of_ten(-2.0, 1.0), random.power_of_ten(-2.0, 1.0));
        let angular = angular * units.length * units.length / units.time;
        forces.push(json!({ "damping": { "linear": linear / units.time, "angular": angular } }));
    }
    if attract && random.chance(0.1) {
        let strength = random.between(-1.0, 3.0) * acceleration * units.length * units.length;
        forces.push(json!({ "mutual_gravity": { "strength": strength } }));
    }
    if let Some(body) = placed.get(random.below(placed.len().max(1))) {
        forces.extend(single(random, units, placed, body));
    }
    forces
}

/// A force on one body.
fn single(random: &mut Random, units: &Units, placed: &[Placed], body: &Placed) -> Option<Value> {
    let place = point_of(random, body);
    let force = body.mass * units.length / (units.time * units.time);
    match random.below(10) {
        0..2 => {
            let other = placed.iter().find(|other| other.name != body.name);
            let far = [place[0] + units.length, place[1] + units.length * random.between(0.0, 2.0)];
            let far = other.map_or(far, |other| other.position);
            Some(json!({ "spring": {
                "a": end(Some(body), place), "b": end(other, far),
                "rest_length": units.length * random.between(0.0, 2.0),
                "stiffness": random.power_of_ten(-1.0, 4.0) * body.mass / (units.time * units.time),
                "damping": if random.chance(0.4) { random.unit() * body.mass / units.time } else { 0.0 },
            } }))
        }
        2 => Some(json!({ "constant": {
            "body": body.name, "point": if random.chance(0.5) { body.to_shape(place) } else { body.center_of_mass },
            "force": [force * random.between(-9.0, 9.0), force * random.between(-9.0, 9.0)], "frame": "body",
            "torque": force * units.length * random.between(-1.0, 1.0),
        } })),
        3 => Some(json!({ "rotating": {
            "body": body.name, "point": body.to_shape(place), "magnitude": force * random.between(0.1, 9.0),
            "rate": random.between(-9.0, 9.0) / units.time, "phase": random.between(0.0, 6.0),
        } })),
        _ => None,
    }
}
