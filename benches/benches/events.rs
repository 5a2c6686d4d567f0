//! Impacts per second of free discs and rounded polygons in a box.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use halfgap::geometry::Shape;
use halfgap_benches::{advance_impacts, gas};

/// Impacts of one measured run.
const IMPACTS: u64 = 2_000;

fn discs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("world/discs");
    group.sample_size(20).throughput(Throughput::Elements(IMPACTS));
    for count in [100, 1000] {
        let mut world = gas(count, 1.0, 0.0, |_| Shape::disc(0.35).expect("a fine disc"));
        advance_impacts(&mut world, 20 * count as u64);
        group.bench_function(count.to_string(), |bencher| {
            bencher.iter_batched_ref(
                || world.clone(),
                |world| advance_impacts(world, IMPACTS),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

fn polygons(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("world/rounded_polygons");
    group.sample_size(20).throughput(Throughput::Elements(IMPACTS));
    let mut world = gas(50, 1.0, 2.0, |_| Shape::rounded_block(0.6, 0.4, 0.1).expect("a fine block"));
    advance_impacts(&mut world, 1000);
    group.bench_function("50", |bencher| {
        bencher.iter_batched_ref(
            || world.clone(),
            |world| advance_impacts(world, IMPACTS),
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

criterion_group!(benches, discs, polygons);
criterion_main!(benches);
