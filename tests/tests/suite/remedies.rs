//! Remedies for rare cases are counted, and can be switched off.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{Remedy, RemedySet, World, WorldBuilder};

/// A ball that bounces, lower and lower, on a floor.
const BALL: &str = r#"
    format = "halfgap-scene-1"
    title = "Ball"
    run = { duration = 4.0 }

    [[body]]
    name = "floor"
    fixed = true
    shape = { block = { width = 4.0, height = 1.0 } }
    position = [0.0, -0.5]

    [[body]]
    name = "ball"
    shape = { disc = { radius = 0.5 } }
    position = [0.0, 1.0]
    mass = 1.0
    elasticity = 0.5

    [[force]]
    gravity = { acceleration = [0.0, -10.0] }
"#;

fn ball(without: RemedySet) -> World {
    let scene = Scene::parse(BALL, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
    let mut builder = WorldBuilder::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"));
    builder.settings_mut().without = without;
    let mut world = builder.build().unwrap_or_else(|error| panic!("{error}"));
    world.advance_to(4.0, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
    world
}

#[test]
fn a_remedy_that_acts_is_counted_and_one_that_is_off_does_not_act() {
    let remedies = ball(RemedySet::NONE).statistics().remedies;
    let acted: Vec<_> = remedies.acted().collect();
    assert!(remedies.of(Remedy::TriggerGaps) > 0, "the ball lies on the floor: {acted:?}");
    for (remedy, _) in acted {
        let found = ball(RemedySet::NONE.with(remedy)).statistics().remedies;
        assert_eq!(found.of(remedy), 0, "{}", remedy.name());
    }
}

#[test]
fn every_remedy_has_a_name_of_its_own_and_a_line_in_the_table() {
    let table = include_str!("../../../docs/lab/remedies.md");
    let mut names: Vec<_> = Remedy::ALL.map(Remedy::name).to_vec();
    for name in &names {
        assert!(table.contains(&format!("| `{name}` |")), "{name} is missing in docs/lab/remedies.md");
    }
    assert_eq!(table.matches("\n| `").count(), names.len(), "the table has remedies that are no more");
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Remedy::ALL.len());
}
