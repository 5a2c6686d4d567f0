//! A scene gives the same bits again, in another process, recorded or not; and nearly the same numbers with its bodies
//! in another order.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyState, Event, Record, RunPlan, RunReport, World, run, unwatched};
use halfgap_tests::data;
use halfgap_tests::generate::scene_of_seed;
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;

/// Reference scenes of many kinds: impacts, resting contacts, connectors, force laws, chaos.
const SCENES: [&str; 10] = [
    "apps__chain",
    "apps__mutual_attract",
    "apps__roller_cardioid",
    "circle_straight__concave_ball_block_contact",
    "exact__ball_bounce",
    "exact__double_pendulum",
    "multiple_collision__test3_0_hybrid",
    "rope__double_rope_spin_test",
    "straight_straight__hexagon_1",
    "straight_straight__six_blocks_1",
];
/// Environment variable that makes this program, run by itself, print the hashes alone.
const ONLY_HASHES: &str = "HALFGAP_PRINT_HASHES";
/// Longest run [s].
const LONGEST: f64 = 3.0;

fn scene(name: &str) -> Scene {
    let text = std::fs::read_to_string(data(&format!("scenes/{name}.json"))).expect("a reference scene");
    parse(&text)
}

fn parse(json: &str) -> Scene {
    let mut scene = Scene::parse(json, SceneFormat::Json).expect("a fine scene");
    let duration = scene.run.duration.min(LONGEST);
    scene.set_duration(duration, "duration").expect("a fine duration");
    scene
}

fn run_of(scene: &Scene, record: Record) -> (World, RunReport) {
    let mut world = World::from_scene(scene).expect("a world that can be built");
    let report = run(&mut world, &RunPlan::of_scene(scene, record), &mut unwatched);
    (world, report)
}

/// A hash of everything in a recording: numbers are written so that they read back as the same bits.
///
/// FNV-1a: G. Fowler, L. C. Noll, K.-P. Vo, as in RFC 9923.
fn hash_of(scene: &Scene) -> u64 {
    let (_, report) = run_of(scene, Record::Everything);
    let mut text = Vec::new();
    report.recording.write_json(&mut text).expect("memory can be written to");
    let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    text.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

fn hashes() -> String {
    SCENES.map(|name| format!("{name} {:016x}\n", hash_of(&scene(name)))).concat()
}

fn states(world: &World) -> Vec<BodyState> {
    world.bodies().map(|body| world.state(body)).collect()
}

#[test]
fn twice_in_one_process_gives_the_same_bits() {
    assert_eq!(hashes(), hashes());
}

#[test]
fn two_processes_give_the_same_bits() {
    if std::env::var_os(ONLY_HASHES).is_some() {
        println!("{}", hashes());
        return;
    }
    let other = || {
        let program = std::env::current_exe().expect("this program has a path");
        let mut command = Command::new(program);
        command
            .args(["--exact", "determinism::two_processes_give_the_same_bits", "--nocapture"])
            .env(ONLY_HASHES, "1");
        String::from_utf8(command.output().expect("it runs").stdout).expect("it writes text")
    };
    let (first, second, own) = (other(), other(), hashes());
    for line in own.lines() {
        assert!(first.contains(line) && second.contains(line), "{line} is not in\n{first}\n{second}");
    }
}

#[test]
fn recording_changes_no_bit() {
    for name in SCENES {
        let mut scene = scene(name);
        let (all, ends) = (run_of(&scene, Record::Everything), run_of(&scene, Record::Ends));
        assert_eq!(states(&all.0), states(&ends.0), "{name}");
        scene.run.output_step = Some(scene.run.duration / 7.3);
        let (rare, _) = run_of(&scene, Record::Everything);
        assert_eq!(states(&all.0), states(&rare), "{name}: with other output times");
    }
}

#[test]
fn generated_scenes_give_the_same_bits_again() {
    for seed in [2, 4, 6, 8, 9, 11, 13, 16, 17, 21] {
        let scene = parse(&scene_of_seed(seed).to_string());
        assert_eq!(hash_of(&scene), hash_of(&scene), "seed {seed}");
    }
}

/// All events of a scene, as text, and the states of its bodies at the end: by one world, or by a new copy of it after
/// each event.
fn told(scene: &Scene, is_copied: bool) -> (Vec<String>, Vec<BodyState>) {
    let mut world = World::from_scene(scene).expect("a world that can be built");
    let mut events = Vec::new();
    loop {
        let mut stop = |event: &Event| {
            events.push(format!("{event:?}"));
            ControlFlow::Break(())
        };
        match world.advance_while(scene.run.start_time + scene.run.duration, &mut stop) {
            Ok(ControlFlow::Break(())) if is_copied => world = world.clone(),
            Ok(ControlFlow::Break(())) => {}
            Ok(ControlFlow::Continue(())) => return (events, states(&world)),
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn a_copy_goes_on_as_its_original() {
    let names = ["straight_straight__six_blocks_1", "exact__newtons_cradle", "apps__chain"];
    let heaps = [2, 4, 6, 8, 9, 11].map(|seed| parse(&scene_of_seed(seed).to_string()));
    for scene in names.into_iter().map(scene).chain(heaps) {
        let ((events, ends), (of_copies, ends_of_copies)) = (told(&scene, false), told(&scene, true));
        assert!(events == of_copies, "{}: events differ", scene.title);
        assert_eq!(ends, ends_of_copies, "{}", scene.title);
    }
}

/// The scene with its bodies in the opposite order.
fn turned(json: &str) -> Scene {
    let mut value: Value = serde_json::from_str(json).expect("JSON");
    let bodies = value["body"].as_array_mut().expect("bodies are a list");
    assert!(bodies.len() > 1, "an order needs two");
    bodies.reverse();
    parse(&value.to_string())
}

/// Compares a scene with its bodies in both orders: every body is where it was, within a multiple of the tolerance [m
/// or rad].
fn compare_turned(name: &str, tolerances: f64) {
    let text = std::fs::read_to_string(data(&format!("scenes/{name}.json"))).expect("a reference scene");
    let (one, other) = (parse(&text), turned(&text));
    let ((one_world, report), (other_world, _)) = (run_of(&one, Record::Ends), run_of(&other, Record::Ends));
    assert_eq!(report.error, None, "{name}");
    let mut largest: f64 = 0.0;
    for body in one_world.bodies() {
        let twin = other_world.find(one_world.name(body)).expect("the same bodies");
        let (a, b) = (one_world.state(body), other_world.state(twin));
        largest = largest.max(a.position.distance(b.position)).max((a.angle - b.angle).abs());
    }
    println!("{name}: {largest:e} at tolerance {:e}", one.run.tolerance_or_default());
    assert!(largest <= tolerances * one.run.tolerance_or_default(), "{name}: {largest:e}");
}

#[test]
fn the_order_of_bodies_does_not_matter() {
    let names = [
        "apps__mutual_attract",
        "circle_straight__ball_block_collide",
        "exact__double_pendulum",
        "exact__newtons_cradle",
        "exact__two_discs_e1",
        "multiple_collision__test1_0_hybrid",
        "rope__double_rope_spin_test",
    ];
    for name in names {
        compare_turned(name, 100.0);
    }
}

#[test]
fn the_scenes_to_look_at_give_the_same_bits_again() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    for name in ["bead_on_a_rail", "capsules_in_a_round_room", "four_bar", "newtons_cradle"] {
        let mut scene = Scene::read(folder.join(format!("{name}.toml"))).expect("a scene to look at");
        scene.set_duration(LONGEST, "duration").expect("a fine duration");
        assert_eq!(hash_of(&scene), hash_of(&scene), "{name}");
    }
}
