//! Reference scenes with other numbers: places, speeds, masses, laws. They have features of scenes built by hand:
//! flush blocks, symmetric heaps, chains, gears, rails.

use super::all_laws;
use crate::random::Random;
use crate::{reference_scene_file, reference_scene_names};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Largest number of bodies of a scene that is varied.
const MOST_BODIES: usize = 30;
/// Longest run [s].
const LONGEST: f64 = 8.0;
/// Largest shift [m] and turn [rad] of a body.
const SHIFTS: [f64; 6] = [0.0, 1e-9, 1e-6, 1e-3, 1e-2, 0.1];

/// The variation of a seed.
///
/// # Panics
/// If the reference scenes cannot be read.
#[must_use]
pub fn variation_of_seed(seed: u64) -> Value {
    let mut random = Random::new(seed);
    let names = reference_scene_names();
    let mut scene = loop {
        let scene = reference_scene_file(&names[random.below(names.len())]);
        if scene["body"].as_array().is_some_and(|bodies| bodies.len() <= MOST_BODIES) {
            break scene;
        }
    };
    scene["title"] = json!(format!("variation {seed} of {}", scene["title"].as_str().unwrap_or_default()));
    if let Some(scene) = scene.as_object_mut() {
        scene.remove("expected");
    }
    vary_run(&mut random, &mut scene["run"]);
    vary_bodies(&mut random, &mut scene);
    vary_forces(&mut random, &mut scene);
    scene
}

fn vary_run(random: &mut Random, run: &mut Value) {
    let duration = run["duration"].as_f64().unwrap_or(LONGEST);
    run["duration"] = json!(duration.min(LONGEST));
    if random.chance(0.5) {
        run["impact_law"] = json!(random.one_of(all_laws()));
    }
    if random.chance(0.1) {
        run["seed"] = json!(random.below(1000));
    }
    if random.chance(0.1) {
        run["integrator"] = json!("dormand_prince5");
    }
    if random.chance(0.5) {
        run["tolerance"] = json!(random.power_of_ten(-11.0, -3.0));
    }
    let Some(run) = run.as_object_mut() else { return };
    match random.below(4) {
        0 => ["target_gap", "accuracy", "velocity_tol"].iter().for_each(|name| drop(run.remove(*name))),
        1 => {
            let gap = random.power_of_ten(-7.0, -2.0);
            run.insert("target_gap".to_owned(), json!(gap));
            run.insert("accuracy".to_owned(), json!(gap * random.between(0.1, 0.9)));
        }
        _ => (),
    }
    if random.chance(0.2) {
        run.insert("velocity_tol".to_owned(), json!(random.power_of_ten(-4.0, 0.0)));
    }
}

fn vary_bodies(random: &mut Random, scene: &mut Value) {
    let tied = tied_bodies(scene);
    let shift = random.one_of(&SHIFTS);
    let speed = if random.chance(0.5) { random.power_of_ten(-3.0, 1.0) } else { 0.0 };
    let heavier = match random.below(10) {
        0 => 4.0,
        1..4 => 1.0,
        _ => 0.0,
    };
    let elasticity = match random.below(4) {
        0 => Some((0.0, 0.0)),
        1 => Some((1.0, 1.0)),
        2 => Some((0.0, 1.0)),
        _ => None,
    };
    for body in scene["body"].as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
        body.remove("friction");
        if let Some((least, most)) = elasticity {
            body.insert("elasticity".to_owned(), json!(random.between(least, most)));
        }
        if body.get("fixed").is_some_and(|fixed| fixed == true) {
            continue;
        }
        if !body.get("name").and_then(Value::as_str).is_some_and(|name| tied.contains(name)) {
            add(random, body, "position", shift);
            add(random, body, "angle", shift);
        }
        add(random, body, "velocity", speed);
        add(random, body, "angular_velocity", speed);
        let factor = random.power_of_ten(-heavier, heavier);
        for name in ["mass", "moment", "density"] {
            if let Some(number) = body.get(name).and_then(Value::as_f64) {
                body.insert(name.to_owned(), json!(number * factor));
            }
        }
    }
}

/// Names of bodies that connectors hold where they are.
fn tied_bodies(scene: &Value) -> BTreeSet<String> {
    let connectors = scene["connector"].as_array().into_iter().flatten().filter_map(Value::as_object);
    let ties = connectors.flat_map(Map::values);
    let ends = ties.flat_map(|tie| ["a", "b"].map(|end| tie[end]["body"].as_str().map(str::to_owned)));
    ends.flatten().collect()
}

/// Adds up to an amount, in either direction, to a number or to both numbers of a vector; an absent number is 0.
fn add(random: &mut Random, body: &mut Map<String, Value>, name: &str, amount: f64) {
    let mut plus = |number: Option<f64>| number.unwrap_or(0.0) + amount * random.between(-1.0, 1.0);
    let is_vector = ["position", "velocity"].contains(&name);
    let value = if is_vector {
        let old = body.get(name).cloned().unwrap_or(json!([0.0, 0.0]));
        json!([plus(old[0].as_f64()), plus(old[1].as_f64())])
    } else {
        json!(plus(body.get(name).and_then(Value::as_f64)))
    };
    body.insert(name.to_owned(), value);
}

fn vary_forces(random: &mut Random, scene: &mut Value) {
    let change = random.chance(0.3);
    for force in scene["force"].as_array_mut().into_iter().flatten() {
        let (turn, factor) = (random.between(-1.5, 1.5), random.power_of_ten(-1.0, 1.0));
        if !change {
            continue;
        }
        if let Some(acceleration) = force.pointer_mut("/gravity/acceleration") {
            let ([x, y], (sin, cos)) = (pair(acceleration), turn.sin_cos());
            *acceleration = json!([factor * (cos * x - sin * y), factor * (sin * x + cos * y)]);
        }
        if let Some(strength) = force.pointer_mut("/mutual_gravity/strength") {
            *strength = json!(factor * strength.as_f64().unwrap_or(1.0));
        }
    }
    if random.chance(0.1)
        && let Some(forces) = scene["force"].as_array_mut()
    {
        let size = random.power_of_ten(-3.0, 1.0);
        forces.push(json!({ "damping": { "linear": size, "angular": size } }));
    }
}

fn pair(vector: &Value) -> [f64; 2] {
    [0, 1].map(|axis| vector[axis].as_f64().unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::tests::how_many_can_be_built;

    #[test]
    fn variations_are_legal_and_most_can_be_built() {
        let built = how_many_can_be_built(200, variation_of_seed);
        assert!(built > 150, "{built} of 200");
    }
}
