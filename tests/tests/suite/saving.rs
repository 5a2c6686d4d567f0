//! A world that was saved and loaded goes on with the same bits, whatever it was doing.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{Event, World};
use halfgap_tests::generate::{
    coarse_of_seed, impulses_of_seed, rolling_of_seed, scene_of_seed, variation_of_seed,
};
use halfgap_tests::{reference_scene, reference_scene_names};
use serde_json::Value;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// Longest run [s].
const LONGEST: f64 = 4.0;
/// Events, with those that are not reported, after which a run ends: some generated scenes have no end of them.
const MOST_EVENTS: u64 = 20_000;
/// Generated scenes of each kind.
const SEEDS: u64 = 30;

/// What becomes of a world between two advances: itself, or what is loaded from its bytes.
type Between = fn(World) -> World;

fn same(world: World) -> World {
    world
}

fn loaded(world: World) -> World {
    let bytes = world.save().expect("all laws of scenes are the crate's");
    let loaded = World::load(&bytes).expect("they are sound");
    assert!(loaded.save().expect("as before") == bytes, "a loaded world is saved as the same bytes");
    loaded
}

/// Advances a world to the end in portions of ever more events, so that it stops in the midst of all that it does, and
/// returns everything that can be told of it. Numbers are written with all the digits that tell them apart.
fn all_told(scene: &Scene, between: Between) -> Result<String, String> {
    let mut world = World::from_scene(scene).map_err(|error| error.to_string())?;
    let end = scene.run.start_time + scene.run.duration.min(LONGEST);
    let mut told = String::new();
    let (mut budget, mut events) = (1, 0);
    while events < MOST_EVENTS {
        world = between(world);
        let mut on_event = |event: &Event| writeln!(told, "{event:?}").expect("memory can be written to");
        let outcome = world.advance_for(end, budget, &mut on_event);
        write_state(&mut told, &world);
        match outcome {
            Ok(ControlFlow::Break(())) => {}
            // An error is repeated by each further try: that of the loaded world, too.
            outcome => {
                world = between(world);
                let again = world.advance_to(end, &mut |event| panic!("all is told: {event:?}"));
                writeln!(told, "{outcome:?} {again:?} {:?}", world.findings(1.0)).expect("as above");
                break;
            }
        }
        events += budget;
        budget += 1 + budget / 2;
    }
    Ok(told)
}

fn write_state(told: &mut String, world: &World) {
    for body in world.bodies() {
        writeln!(told, "{:?}", world.state(body)).expect("memory can be written to");
    }
    let (statistics, ledger, forces) = (world.statistics(), world.ledger(), world.contact_forces());
    let written = writeln!(told, "{} {statistics:?} {ledger:?} {forces:?}", world.time());
    written.and_then(|()| writeln!(told, "{:?}", world.warnings())).expect("as above");
}

/// Names the first line in which a loaded world differs from the one that was saved.
fn compare(name: &str, scene: &Scene) {
    let (told, of_loaded) = (all_told(scene, same), all_told(scene, loaded));
    match (&told, &of_loaded) {
        (Ok(told), Ok(of_loaded)) => {
            let lines = told.lines().zip(of_loaded.lines()).enumerate();
            if let Some((line, (own, other))) = lines.into_iter().find(|(_, (own, other))| own != other) {
                panic!("{name}, line {line}:\n{own}\n{other}");
            }
            assert_eq!(told.len(), of_loaded.len(), "{name}");
        }
        _ => assert_eq!(told, of_loaded, "{name}"),
    }
}

fn parse(json: &Value) -> Scene {
    Scene::parse(&json.to_string(), SceneFormat::Json).expect("a generated scene can be read")
}

#[test]
fn the_scenes_of_the_repository_go_on() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut names: Vec<_> = std::fs::read_dir(folder).expect("they are there").flatten().collect();
    names.sort_by_key(std::fs::DirEntry::path);
    assert!(names.len() >= 15, "{} scenes", names.len());
    for entry in names {
        let scene = Scene::read(entry.path()).expect("a fine scene");
        compare(&entry.file_name().to_string_lossy(), &scene);
    }
}

#[test]
fn the_reference_scenes_go_on() {
    for name in reference_scene_names() {
        compare(&name, &reference_scene(&name));
    }
}

#[test]
fn generated_scenes_go_on() {
    for seed in 1..=SEEDS {
        compare(&format!("ordinary {seed}"), &parse(&scene_of_seed(seed)));
        compare(&format!("coarse {seed}"), &parse(&coarse_of_seed(seed)));
        compare(&format!("impulses {seed}"), &parse(&impulses_of_seed(seed)));
        compare(&format!("varied {seed}"), &parse(&variation_of_seed(seed)));
        compare(&format!("rolling {seed}"), &parse(&rolling_of_seed(seed)));
    }
}
