//! Runs generated blows, drops onto seams and strikes on bodies that fit exactly or with a little play, and lists those that go wrong.
//!
//! ```text
//! cargo run --release -p halfgap-tests --example blows -- 10000 1     # so many drops and fits, from a seed on
//! cargo run --release -p halfgap-tests --example blows -- drop 4711   # prints the scene of a seed
//! cargo run --release -p halfgap-tests --example blows -- fit 4711
//! cargo run --release -p halfgap-tests --example blows -- tight 4711  # one with a little play
//! ```

use halfgap_tests::blows::{check_drop, check_fit, check_tight};
use halfgap_tests::generate::{all_laws, drop_of_seed, struck_fit_of_seed, tight_fit_of_seed};
use std::time::Instant;

/// Tolerances at which each drop is run.
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// Elasticities with which each fit is struck.
const ELASTICITIES: [f64; 4] = [1.0, 0.7, 0.3, 0.0];
/// Number of failures listed.
const LISTED: usize = 40;
/// Drops for each fit.
const DROPS_PER_FIT: u64 = 5;
/// Time [s] from which a run is slow.
const SLOW: f64 = 2.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize| arguments.get(place).and_then(|text| text.parse::<u64>().ok());
    match arguments.first().map(String::as_str) {
        Some("drop") => println!("{:#}", drop_of_seed(number(1).unwrap_or(1)).scene),
        Some("fit") => println!("{:#}", struck_fit_of_seed(number(1).unwrap_or(1), "hybrid", 1.0)),
        Some("tight") => println!("{:#}", tight_fit_of_seed(number(1).unwrap_or(1), "hybrid", 1.0)),
        _ => count(number(0).unwrap_or(1000), number(1).unwrap_or(1)),
    }
}

fn count(drops: u64, first: u64) {
    let mut wrong = Vec::new();
    let started = Instant::now();
    for seed in first..first + drops {
        for tolerance in TOLERANCES {
            if let Err(why) = check_drop(seed, tolerance) {
                wrong.push(format!("drop {seed} at {tolerance:e}: {why}"));
            }
        }
    }
    println!(
        "{drops} drops at {} tolerances: {} wrong, {:.1?}",
        TOLERANCES.len(),
        wrong.len(),
        started.elapsed()
    );
    wrong.iter().take(LISTED).for_each(|line| println!("{line}"));
    wrong.clear();
    let (fits, started) = (drops / DROPS_PER_FIT, Instant::now());
    for seed in first..first + fits {
        for &law in all_laws() {
            for elasticity in ELASTICITIES {
                if let Err(why) = check_fit(seed, law, elasticity) {
                    wrong.push(format!("fit {seed} by {law} of {elasticity}: {why}"));
                }
            }
        }
    }
    println!(
        "{fits} fits by six laws and four elasticities: {} wrong, {:.1?}",
        wrong.len(),
        started.elapsed()
    );
    wrong.iter().take(LISTED).for_each(|line| println!("{line}"));
    wrong.clear();
    let (mut longest, mut slow) = (0.0f64, 0);
    for seed in first..first + fits {
        for &law in all_laws() {
            for elasticity in ELASTICITIES {
                let started = Instant::now();
                let outcome = check_tight(seed, law, elasticity);
                let took = started.elapsed().as_secs_f64();
                longest = longest.max(took);
                slow += u32::from(took > SLOW);
                if let Err(why) = outcome {
                    wrong.push(format!("tight {seed} by {law} of {elasticity}: {why}"));
                }
            }
        }
    }
    println!(
        "{fits} tight fits likewise: {} wrong, {slow} took more than {SLOW} s, the longest {longest:.2} s",
        wrong.len()
    );
    wrong.iter().take(LISTED).for_each(|line| println!("{line}"));
}
