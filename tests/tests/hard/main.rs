//! Hard cases, one module for each theme: every test is named for its claim and derives its expected values.
//!
//! `docs/stability.md` lists the errors reached: run with `-- --nocapture --test-threads 1` to see the numbers.

mod blows;
mod branches;
mod cams;
mod chains;
mod changes;
mod corners;
mod dead_points;
mod dips;
mod driven;
mod events;
mod extremes;
mod faults;
mod folds;
mod frictions;
mod grazing;
mod held;
mod ledger;
mod linkages;
mod narrow;
mod rattling;
mod reversal;
mod ropes;
mod run_off;
mod scaling;
mod seams;
mod simultaneous;
mod stiff;
mod unsolvable;
mod zones;

/// Prints the error of a quantity, and fails if it exceeds the allowed one.
#[track_caller]
fn within(what: &str, error: f64, allowed: f64) {
    println!("REACHED | {what} | {allowed:.0e} | {error:.1e}");
    assert!(error.abs() <= allowed, "{what}: {error:e}, {allowed:e} allowed");
}

/// Distance [m] below its start, at a time [s], of a ball that falls from rest and bounces without loss at a depth
/// [m].
fn bounced(depth: f64, time: f64) -> f64 {
    let period = 2.0 * (2.0 * depth / halfgap_tests::mechanism::GRAVITY).sqrt();
    let since_top = time - (time / period).round() * period;
    0.5 * halfgap_tests::mechanism::GRAVITY * since_top * since_top
}

/// Counts the impacts up to a time [s].
#[track_caller]
fn impacts(world: &mut halfgap::World, until: f64) -> usize {
    let mut count = 0;
    world
        .advance_to(until, &mut |event| count += usize::from(event.impact().is_some()))
        .unwrap_or_else(|error| panic!("{error}"));
    count
}
