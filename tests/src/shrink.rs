//! Makes a failing scene smaller: leaves out the parts without which it still fails, and simplifies the rest.

use crate::invariants::{Budget, trial};
use serde_json::{Value, json};

/// Plain values of the numbers of a body.
const PLAIN: [(&str, f64); 4] =
    [("elasticity", 0.0), ("mass", 1.0), ("angle", 0.0), ("angular_velocity", 0.0)];
/// Largest number of tries, each a run.
const TRIES: usize = 300;
/// Shortest duration [s].
const SHORTEST: f64 = 1e-3;

/// The smallest scene found that fails in the same way.
#[must_use]
pub fn shrink(scene: &Value, budget: Budget) -> Value {
    let kind = trial(&scene.to_string(), budget).kind();
    let fails = |candidate: &Value| trial(&candidate.to_string(), budget).kind() == kind;
    let (mut least, mut tries) = (scene.clone(), 0);
    loop {
        let smaller = candidates(&least).into_iter().find(|candidate| {
            tries += 1;
            tries < TRIES && *candidate != least && fails(candidate)
        });
        match smaller {
            Some(smaller) => least = smaller,
            None => return least,
        }
    }
}

/// Scenes with a little less in them, the boldest first.
fn candidates(scene: &Value) -> Vec<Value> {
    let mut all = Vec::new();
    for list in ["force", "connector"] {
        all.extend((0..count(scene, list)).map(|index| without(scene, list, index)));
    }
    all.extend((0..count(scene, "body")).map(|index| without_body(scene, index)));
    for field in ["seed", "impact_law", "start_time", "integrator"] {
        let mut plain = scene.clone();
        if let Some(run) = plain["run"].as_object_mut() {
            run.remove(field);
        }
        all.push(plain);
    }
    for index in 0..count(scene, "body") {
        for (field, value) in PLAIN {
            let mut plain = scene.clone();
            if plain["body"][index].get(field).is_some() {
                plain["body"][index][field] = json!(value);
            }
            all.push(plain);
        }
        let mut still = scene.clone();
        if still["body"][index].get("velocity").is_some() {
            still["body"][index]["velocity"] = json!([0.0, 0.0]);
        }
        all.push(still);
        let mut disc = scene.clone();
        disc["body"][index]["shape"] = json!({ "disc": { "radius": 0.5 } });
        disc["body"][index]["center_of_mass"] = json!([0.0, 0.0]);
        all.push(disc);
    }
    let mut short = scene.clone();
    if let Some(duration) = scene["run"]["duration"].as_f64().filter(|duration| *duration > SHORTEST) {
        short["run"]["duration"] = json!(0.7 * duration);
        all.push(short);
    }
    all
}

fn count(scene: &Value, list: &str) -> usize {
    scene[list].as_array().map_or(0, Vec::len)
}

fn without(scene: &Value, list: &str, index: usize) -> Value {
    let mut less = scene.clone();
    if let Some(items) = less.get_mut(list).and_then(Value::as_array_mut) {
        items.remove(index);
    }
    less
}

/// The scene without a body and without everything that names it.
fn without_body(scene: &Value, index: usize) -> Value {
    let name = scene["body"][index]["name"].to_string();
    let mut less = without(scene, "body", index);
    for list in ["force", "connector"] {
        if let Some(items) = less.get_mut(list).and_then(Value::as_array_mut) {
            items.retain(|item| !item.to_string().contains(&name));
        }
    }
    less
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_goes_with_what_names_it() {
        let scene = json!({
            "body": [{ "name": "a" }, { "name": "b" }],
            "connector": [{ "pin": { "a": { "body": "b" } } }, { "pin": { "a": { "body": "a" } } }],
            "force": [],
        });
        let less = without_body(&scene, 1);
        assert_eq!((count(&less, "body"), count(&less, "connector")), (1, 1));
    }

    #[test]
    fn parts_that_a_refusal_does_not_need_go() {
        let disc = |name: &str, x: f64| json!({ "name": name, "mass": 2.0, "position": [x, 0.0], "shape": { "disc": { "radius": 0.5 } } });
        let scene = json!({
            "format": "halfgap-scene-1", "title": "t", "run": { "duration": 1.0 },
            "body": [disc("a", 0.0), disc("b", 0.3), disc("c", 5.0)],
            "force": [{ "gravity": { "acceleration": [0.0, -1.0] } }],
        });
        let least = shrink(&scene, Budget::default());
        assert_eq!((count(&least, "body"), count(&least, "force")), (2, 0));
    }
}
