//! What a drive costs: a four-bar, a slider-crank and a Geneva drive, each with a free crank and with a driven one.
//!
//! `cargo bench -p halfgap-benches --bench driven [-- FILTER]` measures both of each pair from start to end, stepping only.
//! They are one scene file: the free one starts with a turning crank, and the driven crank has the mean rate of the free one,
//! so that both make the same turns in the same time. Springs are left out, for no free crank turns all round against the
//! gas of the slider-crank. Then it prints a table in Markdown with the ratio of the least times,
//! over tolerances, from runs that take turns.

use criterion::{Criterion, criterion_group, criterion_main};
use halfgap::World;
use halfgap::scene::{ConnectorData, DriveData, Scene, Vector};
use std::f64::consts::TAU;
use std::path::Path;
use std::time::{Duration, Instant};

/// The scene files, with the crank's body and the index of its pin.
const MECHANISMS: [(&str, &str, usize); 3] =
    [("four_bar", "crank", 0), ("driven_slider_crank", "crank", 0), ("geneva_drive", "crank", 1)];
/// The driven one is to take at most this much of the free one's time.
const GOAL: f64 = 1.2;
/// Tolerances of the table; criterion's runs have that of the file.
const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-8, 1e-10];
/// Repeats of each run of the table.
const REPEATS: usize = 41;

/// A free mechanism and the same with a driven crank.
struct Pair {
    name: &'static str,
    free: Scene,
    driven: Scene,
    /// Turns of both cranks.
    turns: f64,
}

impl Pair {
    fn read(name: &'static str, crank: &str, pin: usize) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        let mut free = Scene::read(folder.join(format!("{name}.toml"))).expect("a scene can be read");
        drive(&mut free, pin, None);
        for connector in &mut free.connectors {
            if let ConnectorData::Slider(slider) = &mut connector.data {
                slider.spring = None;
            }
        }
        let at_start = |scene: &Scene| {
            let body = scene.bodies.iter().find(|body| body.name == crank).expect("it has a crank");
            (body.angle, body.angular_velocity)
        };
        let (from, start_rate) = at_start(&free);
        let mut world = World::from_scene(&free).expect("its world can be built");
        let body = world.bodies().find(|&body| world.name(body) == crank).expect("it has a crank");
        world.advance_to(free.run.end_time(), &mut |_| {}).expect("it runs");
        let rate = (world.state(body).angle - from) / free.run.end_time();
        // All velocities of a mechanism with one freedom go with the rate of its crank.
        let mut driven = free.clone();
        for body in &mut driven.bodies {
            let factor = rate / start_rate;
            body.velocity = Vector { x: factor * body.velocity.x, y: factor * body.velocity.y };
            body.angular_velocity *= factor;
        }
        drive(&mut driven, pin, Some(DriveData::Speed(rate)));
        let turns = (rate * free.run.end_time() / TAU).abs();
        Self { name, free, driven, turns }
    }
}

fn drive(scene: &mut Scene, pin: usize, drive: Option<DriveData>) {
    let ConnectorData::Pin(pin) = &mut scene.connectors[pin].data else { panic!("cranks have pins") };
    pin.drive = drive;
}

/// Runs a world to a time; returns how long that took.
fn run(mut world: World, end: f64) -> (Duration, World) {
    let started = Instant::now();
    world.advance_to(end, &mut |_| {}).expect("it runs");
    (started.elapsed(), world)
}

fn print_table(pairs: &[Pair]) {
    println!(
        "\n| mechanism | turns | tolerance | free [ms] | driven [ms] | ratio | steps | evaluations | at most {GOAL} |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for pair in pairs {
        for tolerance in TOLERANCES {
            let worlds = [&pair.free, &pair.driven].map(|scene| {
                let mut scene = scene.clone();
                scene.run.tolerance = Some(tolerance);
                World::from_scene(&scene).expect("its world can be built")
            });
            let end = pair.free.run.end_time();
            let mut least = [f64::INFINITY; 2];
            let mut counts = [(0, 0); 2];
            for _ in 0..REPEATS {
                for (index, world) in worlds.iter().enumerate() {
                    let (taken, world) = run(world.clone(), end);
                    least[index] = least[index].min(1e3 * taken.as_secs_f64());
                    counts[index] = (world.statistics().steps, world.statistics().evaluations);
                }
            }
            let ([free, driven], ratio) = (least, least[1] / least[0]);
            let [(free_steps, free_evaluations), (steps, evaluations)] = counts;
            let verdict = if ratio <= GOAL { "yes" } else { "no" };
            println!(
                "| {} | {:.2} | {tolerance:e} | {free:.3} | {driven:.3} | {ratio:.2} | {free_steps}, {steps} | \
                 {free_evaluations}, {evaluations} | {verdict} |",
                pair.name, pair.turns
            );
        }
    }
}

fn driven(criterion: &mut Criterion) {
    let pairs = MECHANISMS.map(|(name, crank, pin)| Pair::read(name, crank, pin));
    let mut group = criterion.benchmark_group("driven");
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(300));
    for pair in &pairs {
        for (kind, scene) in [("free", &pair.free), ("driven", &pair.driven)] {
            let world = World::from_scene(scene).expect("its world can be built");
            let end = scene.run.end_time();
            group.bench_function(format!("{}/{kind}", pair.name), |bencher| {
                bencher.iter_custom(|count| (0..count).map(|_| run(world.clone(), end).0).sum());
            });
        }
    }
    group.finish();
    print_table(&pairs);
}

criterion_group!(benches, driven);
criterion_main!(benches);
