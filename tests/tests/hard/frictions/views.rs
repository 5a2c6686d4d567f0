//! Scenes with friction in a mirror and on a sheet that is turned.

use crate::within;
use halfgap::geometry::DVec2;
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyState, World};
use halfgap_tests::mirror::mirrored;
use halfgap_tests::{data, names_in};
use serde_json::{Value, json};

/// The scene turned about the origin by an angle [rad].
fn turned(scene: &Value, angle: f64) -> Value {
    let turn = |value: &mut Value| {
        let [Some(x), Some(y)] = [0, 1].map(|axis| value[axis].as_f64()) else { return };
        let place = DVec2::from_angle(angle).rotate(DVec2::new(x, y));
        *value = json!([place.x, place.y]);
    };
    let mut scene = scene.clone();
    for body in scene["body"].as_array_mut().expect("bodies") {
        for field in ["position", "velocity"] {
            turn(&mut body[field]);
        }
        body["angle"] = json!(body["angle"].as_f64().unwrap_or(0.0) + angle);
        // What was not said is not null.
        body.as_object_mut().expect("a body").retain(|_, value| !value.is_null());
    }
    for force in scene.get_mut("force").and_then(Value::as_array_mut).into_iter().flatten() {
        turn(&mut force["gravity"]["acceleration"]);
    }
    scene
}

/// States at the end of a scene.
fn ran(scene: &Value) -> Vec<BodyState> {
    let scene = Scene::parse(&scene.to_string(), SceneFormat::Json).expect("a fine scene");
    let mut world = World::from_scene(&scene).expect("a fine world");
    world.advance_to(scene.run.duration, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
    world.bodies().map(|body| world.state(body)).collect()
}

#[test]
fn scenes_with_friction_do_the_same_in_a_mirror_and_on_a_sheet_that_is_turned() {
    let angle = 0.7321;
    let (mut in_mirror, mut on_sheet, mut on_sheets) = (0.0f64, 0.0f64, 0);
    for name in names_in("friction") {
        let text = std::fs::read_to_string(data(&format!("friction/{name}.json"))).expect("a scene");
        let scene: Value = serde_json::from_str(&text).expect("it is JSON");
        let here = ran(&scene);
        for (a, b) in here.iter().zip(ran(&mirrored(&scene))) {
            let off =
                (a.position - DVec2::new(-b.position.x, b.position.y)).length() + (a.angle + b.angle).abs();
            assert!(off < 1e-9, "{name} in a mirror: {off:e}");
            in_mirror = in_mirror.max(off);
        }
        let plain =
            scene["force"].as_array().into_iter().flatten().all(|force| force.get("gravity").is_some());
        if !plain || scene.get("connector").is_some() {
            continue;
        }
        on_sheets += 1;
        for (a, b) in here.iter().zip(ran(&turned(&scene, angle))) {
            let back = DVec2::from_angle(-angle).rotate(b.position);
            let off = a.position.distance(back) + (a.angle + angle - b.angle).abs();
            assert!(off < 1e-8, "{name} on a sheet that is turned: {off:e}");
            on_sheet = on_sheet.max(off);
        }
    }
    assert!(on_sheets >= 25, "{on_sheets}");
    within("scenes with friction in a mirror [m, rad]", in_mirror, 1e-9);
    within("scenes with friction turned by 0.7321 rad [m, rad]", on_sheet, 1e-8);
}
