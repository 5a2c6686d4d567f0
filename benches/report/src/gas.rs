//! Impacts per second: free discs and rounded polygons in a box, from hundreds to thousands.

use halfgap::World;
use halfgap::geometry::Shape;
use halfgap_benches::{advance_impacts, gas};
use std::fmt::Write;
use std::time::Instant;

/// Discs in the box.
const COUNTS: [usize; 5] = [100, 316, 1000, 3162, 10_000];
/// Rounded polygons in the box.
const POLYGONS: usize = 50;
/// Impacts per body before anything is measured, so that the grid of the start is forgotten.
const FORGETTING: u64 = 10;
/// Impacts of one measurement.
const IMPACTS: u64 = 20_000;
/// Measurements, of which the fastest counts.
const REPEATS: usize = 7;

/// Cost of one gas.
#[derive(Clone, Debug)]
pub struct GasRow {
    /// Shape of the bodies.
    pub shape: &'static str,
    /// Number of bodies.
    pub count: usize,
    /// Time per impact [s].
    pub per_impact: f64,
}

/// Measures all gases in a number of passes; of each gas the least time counts.
///
/// # Panics
/// A gas stops: a fault of the engine.
#[must_use]
pub fn measure(passes: usize) -> Vec<GasRow> {
    let mut rows = measure_once();
    for _ in 1..passes {
        for (row, again) in rows.iter_mut().zip(measure_once()) {
            row.per_impact = row.per_impact.min(again.per_impact);
        }
    }
    rows
}

fn measure_once() -> Vec<GasRow> {
    let disc = || Shape::disc(0.35).expect("a fine disc");
    let block = || Shape::rounded_block(0.6, 0.4, 0.1).expect("a fine block");
    let discs = COUNTS.map(|count| row("discs", count, gas(count, 1.0, 0.0, |_| disc())));
    let polygons = row("rounded polygons", POLYGONS, gas(POLYGONS, 1.0, 2.0, |_| block()));
    discs.into_iter().chain([polygons]).collect()
}

fn row(shape: &'static str, count: usize, mut world: World) -> GasRow {
    advance_impacts(&mut world, FORGETTING * count as u64);
    let mut per_impact = f64::INFINITY;
    for _ in 0..REPEATS {
        let started = Instant::now();
        let impacts = advance_impacts(&mut world, IMPACTS);
        per_impact = per_impact.min(started.elapsed().as_secs_f64() / impacts as f64);
    }
    GasRow { shape, count, per_impact }
}

/// The table in Markdown; cost over log N shows whether it grows faster than that.
#[must_use]
pub fn table(rows: &[GasRow]) -> String {
    let mut text = String::from(
        "| bodies | number | impacts per second | us per impact | us per impact / log10(number) |\n|---|---|---|---|---|\n",
    );
    for row in rows {
        let microseconds = 1e6 * row.per_impact;
        let _ = writeln!(
            text,
            "| {} | {} | {:.0} | {microseconds:.2} | {:.2} |",
            row.shape,
            row.count,
            1.0 / row.per_impact,
            microseconds / (row.count as f64).log10()
        );
    }
    text
}
