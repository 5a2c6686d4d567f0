//! Impacts of many rows, at one moment or nearly so.

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
