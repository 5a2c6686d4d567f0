//! Impacts of many rows, at one moment or nearly so.

use halfgap::Event;
use halfgap_tests::world_of;

/// Three discs that meet a fourth between them at one moment.
fn three_at_once(law: &str) -> String {
    let discs: String = [(-0.6, 0.0), (0.6, 0.0), (0.0, -0.6)]
        .iter()
        .enumerate()
        .map(|(index, (x, y))| {
            let (vx, vy) = (-x, -y);
            format!(
                "[[body]]\nname = \"disc {index}\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.1 }} }}\n\
                 position = [{x}, {y}]\nvelocity = [{vx}, {vy}]\n"
            )
        })
        .collect();
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\n[run]\nduration = 2.0\nimpact_law = \"{law}\"\n\
         [[body]]\nname = \"middle\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.1 }} }}\n{discs}"
    )
}

#[test]
fn three_discs_meet_a_fourth_at_once_and_keep_momentum_and_energy() {
    for law in ["simultaneous", "hybrid"] {
        let mut world = world_of(&three_at_once(law));
        let energy = world.energy().total();
        let mut rows = Vec::new();
        world
            .advance_to(2.0, &mut |event| rows.extend(event.impact().map(|impact| impact.rows.len())))
            .unwrap_or_else(|error| panic!("{law}: {error}"));
        assert_eq!(rows[0], 3, "{law}: {rows:?}");
        let momentum: halfgap::geometry::DVec2 = world.bodies().map(|body| world.state(body).velocity).sum();
        assert!(momentum.x.abs() < 1e-12 && (momentum.y - 0.6).abs() < 1e-12, "{law}: {momentum}");
        assert!((world.energy().total() / energy - 1.0).abs() < 1e-12, "{law}");
        // Elastic at all rows at once: the two from the sides turn back, the third stops, the middle moves on
        // as it came.
        let velocity = |name: &str| world.state(world.find(name).expect("it is there")).velocity;
        assert!((velocity("disc 0").x + 0.6).abs() < 1e-12, "{law}: {}", velocity("disc 0"));
        assert!((velocity("disc 1").x - 0.6).abs() < 1e-12, "{law}: {}", velocity("disc 1"));
        assert!((velocity("middle").y - 0.6).abs() < 1e-12, "{law}: {}", velocity("middle"));
    }
}

#[test]
fn a_lid_that_is_let_go_on_its_pin_is_hit_when_it_falls_shut_and_not_before() {
    for tolerance in [1e-5, 1e-8, 1e-9, 1e-10] {
        let mut world = world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A lid on a box"
run = {{ duration = 2.0, tolerance = {tolerance:e} }}
force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]
body = [
    {{ name = "box", shape = {{ block = {{ width = 1.0, height = 1.0 }} }}, position = [0.0, -0.5], fixed = true }},
    {{ name = "lid", shape = {{ block = {{ width = 1.0, height = 0.1 }} }}, position = [-0.271922396306325, 0.44775060769735525], angle = 1.0, mass = 1.0, elasticity = 0.7 }},
]
connector = [{{ pin = {{ a = {{ body = "box", point = [-0.5, 0.5] }}, b = {{ body = "lid", point = [-0.5, -0.05] }}, collide = true }} }}]
"#
        ));
        let mut first = None;
        let mut note = |event: &Event| {
            if let Event::Impact(impact) = event {
                first.get_or_insert(impact.time);
            }
        };
        world.advance_to(1.0, &mut note).expect("it falls shut");
        // The expected time comes from energy and quadrature.
        let first = first.expect("it falls shut");
        assert!((first - 0.490205).abs() < 1e-4, "{tolerance}: {first} s");
    }
}
