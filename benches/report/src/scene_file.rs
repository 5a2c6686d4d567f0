//! A scene with its known states as JSON, for peers that run in a program of their own. Lengths are in m, times in s,
//! masses in kg, angles in rad; bodies are told by their index, the world by null.

use crate::scene::{Body, Connector, End, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::EdgeSpec;
use serde_json::{Value, json};

/// The scene.
#[must_use]
pub fn json(scene: &Scene) -> Value {
    let check = |check: &crate::scene::Check| {
        let states = check.states.iter().map(|(body, known)| json!({ "body": body, "state": state(known) }));
        json!({ "time": check.time, "states": states.collect::<Vec<_>>() })
    };
    json!({
        "name": scene.name,
        "gravity": point(scene.gravity),
        "collisions": scene.collisions,
        "duration": scene.duration,
        "grid": scene.check_grid,
        "reference_error": scene.reference_error,
        "bodies": scene.bodies.iter().map(body).collect::<Vec<_>>(),
        "connectors": (0..scene.connectors.len()).map(|index| connector(scene, index)).collect::<Vec<_>>(),
        "springs": scene.springs.len(),
        "checks": scene.checks.iter().map(check).collect::<Vec<_>>(),
    })
}

fn point(point: DVec2) -> Value {
    json!([point.x, point.y])
}

fn state(state: &BodyState) -> Value {
    json!({
        "position": point(state.position),
        "angle": state.angle,
        "velocity": point(state.velocity),
        "angular_velocity": state.angular_velocity,
    })
}

fn body(body: &Body) -> Value {
    json!({
        "name": body.name,
        "mass": body.inertia.map(|inertia| inertia.mass),
        "moment": body.inertia.map(|inertia| inertia.moment),
        "elasticity": body.elasticity,
        "friction": body.surface.friction,
        "spin": body.spin,
        "start": state(&body.start),
        "shape": shape(&body.shape),
    })
}

/// Discs, blocks, and outlines of straight lines, with the solid on the left of the walk; other shapes are null.
fn shape(shape: &Shape) -> Value {
    match shape {
        Shape::Disc { radius } => json!({ "disc": radius }),
        Shape::Block { width, height } => json!({ "block": [width, height] }),
        Shape::Outline(paths) if paths.len() == 1 => {
            let corner = |edge: &EdgeSpec| match edge {
                EdgeSpec::Line { to } => Some(point(*to)),
                _ => None,
            };
            let corners: Option<Vec<Value>> = paths[0].edges.iter().map(corner).collect();
            json!({ "lines": corners })
        }
        _ => Value::Null,
    }
}

fn end(end: &End) -> Value {
    json!({ "body": end.body, "point": point(end.point) })
}

fn connector(scene: &Scene, index: usize) -> Value {
    let joint = match &scene.connectors[index] {
        Connector::Pin(a, b) => json!({ "pin": [end(a), end(b)] }),
        Connector::Slider { body, point: through, axis } => {
            json!({ "slider": { "body": body, "point": point(*through), "axis": point(*axis) } })
        }
        Connector::Rod(..) | Connector::Guide { .. } | Connector::Rail { .. } => Value::Null,
    };
    let on_joint = scene.on_joint(index);
    json!({
        "joint": joint,
        "motor": on_joint.motor.map(|motor| json!({ "speed": motor.speed, "most": motor.most })),
        "limits": on_joint.limits,
        "friction": on_joint.friction,
        "rate": on_joint.rate,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    #[test]
    fn a_scene_is_told_with_what_acts_on_its_joints_and_what_is_known_of_it() {
        let scenes = scenes::wanted(|name| name == "lift_to_stop");
        let told = json(&scenes[0]);
        assert_eq!(told["connectors"][0]["motor"]["most"], 19.0);
        assert_eq!(told["connectors"][0]["limits"][1], 1.1);
        assert_eq!(told["checks"].as_array().map(Vec::len), Some(scenes[0].checks.len()));
        assert_eq!(told["bodies"][0]["mass"], 2.0);
    }
}
