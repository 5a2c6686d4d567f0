//! Prints how long the frames of scenes take that are advanced at 60 Hz, as a page that shows them does.
//!
//! ```text
//! cargo run --profile dist -p halfgap-tests --example frames -- tests/data/faults/pile100.toml
//! ```

use halfgap::World;
use halfgap::scene::Scene;
use std::time::Instant;

/// Frames in a second of a run.
const RATE: f64 = 60.0;

fn main() {
    for path in std::env::args().skip(1) {
        let scene = Scene::read(&path).expect("a fine scene");
        let mut world = World::from_scene(&scene).expect("a fine scene");
        let (mut all, mut longest, mut frames) = (0.0, (0.0, 0.0), 0);
        let mut time = scene.run.start_time;
        let end = time + scene.run.duration;
        while time < end {
            frames += 1;
            time = (scene.run.start_time + f64::from(frames) / RATE).min(end);
            let begun = Instant::now();
            world.advance_to(time, &mut |_| ()).expect("it can go on");
            let took = 1e3 * begun.elapsed().as_secs_f64();
            all += took;
            if took > longest.0 {
                longest = (took, time);
            }
        }
        let statistics = world.statistics();
        let (impacts, steps) = (statistics.impacts, statistics.region_steps);
        println!(
            "{path}: {frames} frames in {all:.0} ms, the longest {:.1} ms before {:.3} s; {impacts} impacts, {:.4} ms for each, {steps} region steps",
            longest.0,
            longest.1,
            all / impacts.max(1) as f64,
        );
    }
}
