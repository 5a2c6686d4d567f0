//! Cost of gaps and queries.

use criterion::{Criterion, criterion_group, criterion_main};
use halfgap_geometry::{
    Arc, DVec2, DirectionRange, EdgeSpec, Feature, GapSample, Line, LineFeature, PathSpec, Pose, Ray,
    RoundFeature, Shape,
};
use std::f64::consts::TAU;
use std::hint::black_box;

fn arc(radius: f64, clockwise: bool) -> Feature {
    let sweep = if clockwise { -2.0 } else { 2.0 };
    let arc = Arc::new(DVec2::new(0.1, 0.2), radius, 0.3, sweep).expect("a fine arc");
    let radius = if clockwise { -radius } else { radius };
    Feature::Round(RoundFeature { center: arc.center(), radius, range: arc.directions() })
}

fn vertex() -> Feature {
    let range = DirectionRange::between(DVec2::X, DVec2::Y, TAU / 4.0);
    Feature::Round(RoundFeature { center: DVec2::new(0.5, 0.5), radius: 0.0, range })
}

fn line() -> Feature {
    let line = Line::new(DVec2::new(-1.0, 0.5), DVec2::new(1.0, 0.5)).expect("a fine line");
    let (normal, direction) = (line.normal(), line.direction());
    let start = direction.dot(line.from());
    let offset = normal.dot(line.from());
    Feature::Line(LineFeature { normal, direction, offset, start, end: start + line.length() })
}

/// A wheel with round teeth of four edges each.
fn gear(teeth: u32) -> Shape {
    let pitch = TAU / f64::from(teeth);
    let at = |r: f64, angle: f64| DVec2::new(angle.cos(), angle.sin()) * r;
    let top = 1.0 + pitch;
    let mut edges = Vec::new();
    for tooth in 0..teeth {
        let start = f64::from(tooth) * pitch;
        edges.push(EdgeSpec::Line { to: at(top, start + 0.1 * pitch) });
        edges.push(EdgeSpec::Bulge { to: at(top, start + 0.4 * pitch), bulge: 0.4 });
        edges.push(EdgeSpec::Line { to: at(1.0, start + 0.5 * pitch) });
        edges.push(EdgeSpec::Bulge { to: at(1.0, start + pitch), bulge: 0.1 });
    }
    Shape::from_paths(&[PathSpec { start: at(1.0, 0.0), edges }]).expect("a fine gear")
}

fn poses() -> (Pose, Pose) {
    (Pose::new(DVec2::new(2.9, 0.3), 0.4), Pose::new(DVec2::new(-0.1, 0.2), -0.7))
}

fn gaps(criterion: &mut Criterion) {
    let (pose_a, pose_b) = poses();
    let pairs = [
        ("outer", arc(0.5, false), arc(0.7, false)),
        ("vertex", vertex(), arc(0.7, false)),
        ("inner", arc(0.5, false), arc(5.0, true)),
        ("arc_line", arc(0.5, false), line()),
        ("vertex_line", vertex(), line()),
    ];
    for (name, a, b) in pairs {
        criterion.bench_function(&format!("geometry/gap/{name}"), |bench| {
            bench.iter(|| GapSample::measure(black_box(&a), &pose_a, black_box(&b), black_box(&pose_b)));
        });
    }
}

fn queries(criterion: &mut Criterion) {
    let (pose_a, pose_b) = poses();
    for (size, teeth) in [(20, 5), (500, 125)] {
        let shape = gear(teeth);
        criterion.bench_function(&format!("geometry/distance/gears/{size}"), |bench| {
            bench.iter(|| shape.distance(black_box(&pose_a), &shape, black_box(&pose_b)));
        });
        let ray = Ray { origin: DVec2::new(-3.0, 0.2), direction: DVec2::new(0.96, 0.28) };
        criterion.bench_function(&format!("geometry/ray/gear/{size}"), |bench| {
            bench.iter(|| shape.cast_ray(black_box(&ray), f64::INFINITY));
        });
        let point = DVec2::new(0.8, 0.9);
        criterion.bench_function(&format!("geometry/nearest/gear/{size}"), |bench| {
            bench.iter(|| shape.nearest(black_box(point)));
        });
        criterion.bench_function(&format!("geometry/contains/gear/{size}"), |bench| {
            bench.iter(|| shape.contains(black_box(point)));
        });
        criterion.bench_function(&format!("geometry/bounds/gear/{size}"), |bench| {
            bench.iter(|| shape.bounds_at(black_box(&pose_a)));
        });
        criterion.bench_function(&format!("geometry/build/gear/{size}"), |bench| {
            bench.iter(|| gear(black_box(teeth)));
        });
    }
}

criterion_group!(benches, gaps, queries);
criterion_main!(benches);
