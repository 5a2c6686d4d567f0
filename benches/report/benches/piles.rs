//! Runs the piles with friction with every engine and prints a table.
//!
//! `cargo bench -p halfgap-report --bench piles -- [--only NAME]... [--engine PART] [--passes N]`

use halfgap_report::engines::Engine;
use halfgap_report::engines::box2d::{Box2d, Contacts};
use halfgap_report::engines::halfgap::Halfgap;
use halfgap_report::engines::moved::Drives;
use halfgap_report::engines::rapier::{Joints, Rapier, Tuning};
use halfgap_report::pile_runs::{PileRun, run};
use halfgap_report::scenes::piles;

fn engines() -> Vec<Box<dyn Engine>> {
    let halfgap = |hertz: f64, tolerance: f64| -> Box<dyn Engine> {
        Box::new(Halfgap { tolerance, step: Some(1.0 / hertz) })
    };
    vec![
        Box::new(Box2d {
            steps_per_check: 1,
            substeps: 4,
            segments: 48,
            scale: 1.0,
            contacts: Contacts::Soft,
            soft_joints: false,
            drives: Drives::Motor,
        }),
        Box::new(Rapier {
            steps_per_check: 1,
            iterations: 4,
            segments: 48,
            tuning: Tuning::Stock,
            joints: Joints::Impulse,
            drives: Drives::Motor,
        }),
        halfgap(60.0, 0.3),
        halfgap(60.0, 1e-1),
        halfgap(60.0, 3e-2),
        halfgap(60.0, 1e-2),
        halfgap(120.0, 1e-2),
        halfgap(240.0, 1e-2),
    ]
}

fn main() {
    let (mut only, mut engine, mut passes) = (Vec::new(), None, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--only" => only.extend(words.next()),
            "--engine" => engine = words.next(),
            "--passes" => passes = words.next().and_then(|count| count.parse().ok()).unwrap_or(1),
            // Arguments that cargo adds.
            "--bench" => {}
            other => panic!("unknown option {other}"),
        }
    }
    println!(
        "| scene | engine | settings | ms per simulated s | longest frame [ms] | overlap [mm] | gain in a frame [mm of height] | creep [mm/s] | drift [mm] |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for scene in piles::rough(|name| only.is_empty() || only.iter().any(|part| name.contains(part.as_str())))
    {
        for candidate in engines() {
            let label = format!("{} {}", candidate.name(), candidate.settings());
            if engine.as_ref().is_some_and(|part| !label.contains(part.as_str())) {
                continue;
            }
            let runs: Vec<_> = (0..passes).map(|_| run(candidate.as_ref(), &scene)).collect();
            let best =
                runs.into_iter().flatten().min_by(|a, b| a.wall_per_second.total_cmp(&b.wall_per_second));
            let name = (candidate.name(), candidate.settings());
            match best {
                Some(PileRun { wall_per_second, longest_frame, deepest, gain, creep, drift }) => println!(
                    "| {} | {} | {} | {:.1} | {:.2} | {:.2} | {:.2e} | {:.3} | {:.1} |",
                    scene.name,
                    name.0,
                    name.1,
                    1e3 * wall_per_second,
                    1e3 * longest_frame,
                    1e3 * deepest,
                    1e3 * gain,
                    1e3 * creep,
                    1e3 * drift
                ),
                None => println!("| {} | {} | {} | failed |", scene.name, name.0, name.1),
            }
        }
    }
}
