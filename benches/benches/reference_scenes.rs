//! Cost of the scenes of the reference engine, beside their cost in that engine.
//!
//! `cargo bench -p halfgap-benches --bench reference_scenes [-- FILTER]` measures each scene from start to
//! end, stepping only: without parsing and set-up. Then it prints a table in Markdown, with the time of the
//! reference engine beside ours and which of them are a twentieth of it or less.

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use halfgap::World;
use halfgap::scene::Scene;
use std::path::Path;
use std::time::{Duration, Instant};

/// Scenes and the time [ms] that myPhysicsLab engine2D (commit 4b0bb8e, TypeScript on node 20) takes for them
/// on a virtual machine with two cores: the median of several runs, good to a factor of 2.
const REFERENCE_MS: [(&str, f64); 78] = [
    ("apps__billiards_offset", 35.6),
    ("apps__cart_pendulum", 43.5),
    ("apps__chain", 694.0),
    ("apps__curved_test", 562.0),
    ("apps__gears", 988.0),
    ("apps__impulse", 37.2),
    ("apps__multiple_collision", 18.9),
    ("apps__mutual_attract", 36.2),
    ("apps__pile", 326.0),
    ("apps__pile_attract", 398.0),
    ("apps__roller_cardioid", 38.1),
    ("apps__roller_loop", 42.5),
    ("apps__roller_oval", 22.2),
    ("circle_circle__ball_ball_contact", 12.0),
    ("circle_circle__concave_circle_and_ball", 15.4),
    ("circle_straight__ball_block_attract", 24.2),
    ("circle_straight__ball_block_collide", 1.34),
    ("circle_straight__ball_block_contact", 5.63),
    ("circle_straight__concave_ball_block_collide", 148.0),
    ("circle_straight__concave_ball_block_contact", 98.7),
    ("circle_straight__elastic_balls", 56.2),
    ("do_nothing__do_nothing_grinder_test1", 738.0),
    ("extra__pile_20_random_blocks", 30_800.0),
    ("extra__two_blocks_2_joints", 20.9),
    ("extra__two_blocks_3_joints", 21.3),
    ("extra__two_blocks_4_joints", 33.1),
    ("joint__pendulum_1_joint_1", 9.35),
    ("joint__pendulum_1_joint_2", 5.83),
    ("joint__pendulum_2_joints_1", 20.4),
    ("miscellany__chain", 278.0),
    ("miscellany__damping_standard", 0.963),
    ("miscellany__three_body_spin_test3A", 366.0),
    ("multiple_collision__one_hits_two_in_box", 13.6),
    ("multiple_collision__test1_0_hybrid", 0.539),
    ("multiple_collision__test1_1_serial_grouped_lastpass", 0.46),
    ("multiple_collision__test2_0_simultaneous_balls_true", 3.21),
    ("multiple_collision__test2_1_hybrid_balls_false", 4.05),
    ("multiple_collision__test2_1_hybrid_balls_true", 3.05),
    ("multiple_collision__test3_0_hybrid", 0.475),
    ("multiple_collision__test3_0_simultaneous", 0.501),
    ("multiple_collision__test3_1_serial_grouped_lastpass", 0.454),
    ("multiple_collision__test4_0_hybrid", 0.764),
    ("multiple_collision__test4_0_simultaneous", 0.71),
    ("multiple_collision__test5_0_hybrid_balls_false", 6.66),
    ("multiple_collision__test5_0_serial_grouped_lastpass_balls_true", 6.06),
    ("multiple_collision__test5_0_simultaneous_balls_false", 7.74),
    ("multiple_collision__test5_0_simultaneous_balls_true", 5.3),
    ("multiple_collision__test6_1_hybrid", 0.342),
    ("multiple_collision__test7_0_simultaneous", 1.31),
    ("multiple_collision__test7_1_hybrid", 1.77),
    ("multiple_collision__test7_2_serial_grouped_lastpass", 1.29),
    ("multiple_collision__test8_1", 1.65),
    ("multiple_collision__test8_2", 2.17),
    ("multiple_collision__test8_3", 7.26),
    ("multiple_collision__two_in_box", 7.42),
    ("pile__connected_blocks_pile_test", 1_810.0),
    ("rope__double_rod_spin_test", 9.84),
    ("rope__double_rope_spin_test", 18.8),
    ("rope__pendulum_rope_bounce_test", 7.54),
    ("rope__pendulum_rope_test_2", 29.1),
    ("speed__ball_vs_circle_0", 15.3),
    ("speed__ball_vs_wall_0", 15.7),
    ("speed__ball_vs_wall_1", 25.9),
    ("straight_straight__block_block_contact_1", 17.2),
    ("straight_straight__block_block_contact_2", 53.5),
    ("straight_straight__block_block_contact_2b", 445.0),
    ("straight_straight__corner_collision", 0.809),
    ("straight_straight__hexagon_1", 28.5),
    ("straight_straight__oblique_corner_collision", 0.695),
    ("straight_straight__one_block1", 1.81),
    ("straight_straight__six_blocks_1", 163.0),
    ("straight_straight__six_blocks_10", 1_500.0),
    ("straight_straight__six_blocks_11", 206.0),
    ("straight_straight__six_blocks_4", 1_370.0),
    ("straight_straight__six_blocks_7", 216.0),
    ("straight_straight__six_blocks_8", 154.0),
    ("straight_straight__six_blocks_settle", 616.0),
    ("straight_straight__six_blocks_settle2", 952.0),
];

/// Largest time of a scene, as a fraction of the reference's time.
const GOAL: f64 = 1.0 / 20.0;

/// Timing of one scene.
struct Timing {
    name: &'static str,
    reference_ms: f64,
    /// Times of whole runs [ms].
    runs: Vec<f64>,
    /// Reason why a run stopped before its end, if it did.
    stopped: Option<String>,
}

impl Timing {
    fn median_ms(&mut self) -> f64 {
        self.runs.sort_by(f64::total_cmp);
        self.runs[self.runs.len() / 2]
    }
}

fn read(name: &str) -> (World, f64) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/scenes");
    let scene = Scene::read(folder.join(format!("{name}.json"))).expect("a reference scene can be read");
    let world = World::from_scene(&scene).expect("its world can be built");
    (world, scene.run.end_time())
}

/// Measures one scene; `None` if it is filtered out.
fn measure(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &'static str,
    reference_ms: f64,
) -> Option<Timing> {
    let (world, end) = read(name);
    let mut timing = Timing { name, reference_ms, runs: Vec::new(), stopped: None };
    group.bench_function(name, |bencher| {
        bencher.iter_custom(|iterations| {
            let mut total = Duration::ZERO;
            for _ in 0..iterations {
                let mut world = world.clone();
                let started = Instant::now();
                let result = world.advance_to(end, &mut |_| {});
                let taken = started.elapsed();
                total += taken;
                timing.runs.push(1e3 * taken.as_secs_f64());
                timing.stopped = result.err().map(|error| error.to_string());
            }
            total
        });
    });
    (!timing.runs.is_empty()).then_some(timing)
}

fn print_table(timings: &mut [Timing]) {
    println!("\n| scene | ours [ms] | reference [ms] | times as fast |\n|---|---|---|---|");
    let mut missed = Vec::new();
    for timing in timings.iter_mut() {
        let ours = timing.median_ms();
        let name = timing.name;
        let ratio = timing.reference_ms / ours;
        let note = if timing.stopped.is_some() { " (stopped early)" } else { "" };
        println!("| {name}{note} | {ours:.3} | {} | {ratio:.0} |", timing.reference_ms);
        if ours > GOAL * timing.reference_ms {
            missed.push(name);
        }
        if let Some(why) = &timing.stopped {
            eprintln!("{name} stopped early: {why}");
        }
    }
    let met = timings.len() - missed.len();
    println!(
        "\n{met} of {} take at most a twentieth of the reference's time; more: {missed:?}",
        timings.len()
    );
}

fn reference_scenes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("reference");
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(200));
    let scenes = REFERENCE_MS.iter();
    let mut timings: Vec<_> =
        scenes.filter_map(|&(name, reference)| measure(&mut group, name, reference)).collect();
    group.finish();
    print_table(&mut timings);
}

criterion_group!(benches, reference_scenes);
criterion_main!(benches);
