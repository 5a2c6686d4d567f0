#![allow(missing_docs)]
use halfgap::geometry::Shape;
use halfgap_benches::{advance_impacts, gas};
fn main() {
    for n in [100, 1000, 10000] {
    let mut w = gas(n, 1.0, 0.0, |_| Shape::disc(0.35).unwrap());
    advance_impacts(&mut w, 5 * n as u64);
    let t = std::time::Instant::now();
    let k = advance_impacts(&mut w, 300_000);
    println!("{n} discs: {:.0} impacts/s", k as f64 / t.elapsed().as_secs_f64());
    }
}
