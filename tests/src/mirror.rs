//! Scenes seen in a mirror: x becomes -x, so that angles and turning quantities change their sign, too.

use serde_json::{Map, Value, json};
use std::f64::consts::PI;

/// Numbers that change their sign together with x.
const TURNING: [&str; 5] = ["angle", "angular_velocity", "torque", "rate", "surface_velocity"];

/// A scene, as its file holds it, seen in a mirror.
#[must_use]
pub fn mirrored(scene: &Value) -> Value {
    let mut scene = scene.clone();
    turn_over(&mut scene);
    scene
}

fn turn_over(value: &mut Value) {
    match value {
        Value::Object(fields) => turn_over_fields(fields),
        Value::Array(items) => match items.as_mut_slice() {
            [Value::Number(x), Value::Number(_)] => items[0] = json!(-x.as_f64().unwrap_or_default()),
            items => items.iter_mut().for_each(turn_over),
        },
        _ => {}
    }
}

fn turn_over_fields(fields: &mut Map<String, Value>) {
    for (name, value) in fields.iter_mut() {
        match (value.as_f64(), name.as_str()) {
            (Some(number), name) if TURNING.contains(&name) => *value = json!(-number),
            _ => turn_over(value),
        }
    }
    if let Some(Value::Object(arc)) = fields.get_mut("arc") {
        let is_clockwise = arc.get("clockwise").and_then(Value::as_bool).unwrap_or(false);
        arc.insert("clockwise".to_owned(), json!(!is_clockwise));
    }
    if let Some(Value::Object(rotating)) = fields.get_mut("rotating") {
        let phase = rotating.get("phase").and_then(Value::as_f64).unwrap_or(0.0);
        rotating.insert("phase".to_owned(), json!(PI - phase));
    }
}
