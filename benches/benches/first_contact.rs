//! Cost of finding the first contact of two moving bodies.

use criterion::{Criterion, criterion_group, criterion_main};
use halfgap_collision::{BodyState, Flight, MovingShape, Search, SearchSettings, Tolerances, first_contact};
use halfgap_geometry::{DVec2, Shape};
use std::hint::black_box;

/// Motions in which body a flies at body b from 5 m away at 2 m/s.
fn flights(spin: f64, miss: f64) -> [Flight; 2] {
    let thrown = BodyState {
        position: DVec2::new(-5.0, miss),
        angle: 0.3,
        velocity: DVec2::new(2.0, 0.0),
        angular_velocity: spin,
    };
    let target = BodyState { angular_velocity: -0.7 * spin, ..BodyState::default() };
    [thrown, target].map(|state| Flight::new(state, DVec2::ZERO, 0.0, 0.0))
}

fn search(shapes: [&Shape; 2], flights: &[Flight; 2]) -> Search {
    let tolerances = Tolerances { target_gap: 1e-9, accuracy: 6e-10, velocity_tol: 1e-8 };
    let side = |index: usize| MovingShape { shape: shapes[index], motion: &flights[index], offset: 0.0 };
    first_contact(&side(0), &side(1), 5.0, &tolerances, &SearchSettings::default())
}

fn first_contacts(criterion: &mut Criterion) {
    let polygon = Shape::regular_polygon(20, 1.0).expect("a fine polygon");
    let rounded = Shape::rounded_block(1.6, 1.0, 0.3).expect("a fine block");
    let disc = Shape::disc(1.0).expect("a fine disc");
    let cases = [
        ("discs", [&disc, &disc], 1.0, 0.3),
        ("polygons_of_20/hit", [&polygon, &polygon], 1.0, 0.3),
        ("polygons_of_20/miss", [&polygon, &polygon], 1.0, 2.1),
        ("polygons_of_20/no_spin", [&polygon, &polygon], 0.0, 0.3),
        ("polygons_of_20/fast_spin", [&polygon, &polygon], 100.0, 0.3),
        ("rounded_blocks/hit", [&rounded, &rounded], 1.0, 0.3),
    ];
    let mut group = criterion.benchmark_group("collision/first_contact");
    for (name, shapes, spin, miss) in cases {
        let flights = flights(spin, miss);
        group.bench_function(name, |bencher| bencher.iter(|| search(black_box(shapes), black_box(&flights))));
    }
    group.finish();
}

criterion_group!(benches, first_contacts);
criterion_main!(benches);
