//! Shapes for the property tests, awkward ones on purpose.

use halfgap_geometry::{DVec2, Edge, EdgeSpec, PathSpec, Pose, Shape};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A closed path around `center` with `radii.len()` corners, whose edges bulge as given.
fn star(center: DVec2, radii: &[f64], bulges: &[f64], phase: f64) -> PathSpec {
    let count = radii.len() as f64;
    let corner = |index: usize| {
        let angle = phase + TAU * index as f64 / count;
        center + DVec2::new(angle.cos(), angle.sin()) * radii[index % radii.len()]
    };
    let edges = (0..radii.len())
        .map(|index| {
            let to = if index + 1 == radii.len() { corner(0) } else { corner(index + 1) };
            EdgeSpec::Bulge { to, bulge: bulges[index % bulges.len()] }
        })
        .collect();
    PathSpec { start: corner(0), edges }
}

fn any_bulge() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => Just(0.0),
        3 => -0.9..0.9,
        1 => prop::sample::select(vec![1.0, -1.0, 1e-5, -1e-5, 0.414_213_562_373_095_03]),
        1 => -1e-3..1e-3,
    ]
}

fn any_star() -> impl Strategy<Value = PathSpec> {
    (3usize..9).prop_flat_map(|count| {
        let radii = prop::collection::vec(prop_oneof![Just(1.0), 0.4..2.0], count);
        let bulges = prop::collection::vec(any_bulge(), count);
        (radii, bulges, 0.0..TAU).prop_map(|(radii, bulges, phase)| star(DVec2::ZERO, &radii, &bulges, phase))
    })
}

fn moved(spec: &PathSpec, scale: f64, shift: DVec2) -> PathSpec {
    map_spec(spec, &|point| point * scale + shift, false)
}

/// The path with every point moved; `mirrored` if the map turns left into right.
pub(crate) fn map_spec(spec: &PathSpec, map: &impl Fn(DVec2) -> DVec2, mirrored: bool) -> PathSpec {
    let edge = |edge: &EdgeSpec| match *edge {
        EdgeSpec::Line { to } => EdgeSpec::Line { to: map(to) },
        EdgeSpec::Arc { to, center, clockwise } => {
            EdgeSpec::Arc { to: map(to), center: map(center), clockwise: clockwise != mirrored }
        }
        EdgeSpec::Bulge { to, bulge } => {
            EdgeSpec::Bulge { to: map(to), bulge: if mirrored { -bulge } else { bulge } }
        }
    };
    PathSpec { start: map(spec.start), edges: spec.edges.iter().map(edge).collect() }
}

/// The specification that makes the shape again.
pub(crate) fn specs_of(shape: &Shape) -> Vec<PathSpec> {
    let edge = |edge: &Edge| match edge {
        Edge::Line(line) => EdgeSpec::Line { to: line.to() },
        Edge::Arc(arc) => EdgeSpec::Arc { to: arc.to(), center: arc.center(), clockwise: !arc.is_convex() },
    };
    let paths = shape.paths().iter().map(|path| path.edges());
    paths.map(|edges| PathSpec { start: edges[0].from(), edges: edges.iter().map(edge).collect() }).collect()
}

/// Stars with smaller ones in or beside them; those that cross are replaced by simpler ones.
fn outline_shape() -> impl Strategy<Value = Shape> {
    let second = (any_star(), 0.05..0.4, -2.5..2.5, -2.5..2.5);
    (any_star(), prop::option::of(second)).prop_filter_map("crosses itself", |(outer, second)| {
        if let Some((other, scale, x, y)) = second {
            let other = moved(&other, scale, DVec2::new(x, y) * 0.5);
            if let Ok(shape) = Shape::from_paths(&[outer.clone(), other]) {
                return Some(shape);
            }
        }
        Shape::from_paths(&[outer]).ok()
    })
}

fn ready_made() -> impl Strategy<Value = Shape> {
    let size = || prop_oneof![Just(1.0), 0.05..3.0];
    let ok = |shape: Result<Shape, _>| shape.expect("a fine shape");
    prop_oneof![
        size().prop_map(move |r| ok(Shape::disc(r))),
        (size(), size()).prop_map(move |(w, h)| ok(Shape::block(w, h))),
        (size(), size(), 0.01..1.0).prop_map(move |(w, h, part)| ok(Shape::rounded_block(
            w,
            h,
            part * w.min(h) / 2.0
        ))),
        (size(), size()).prop_map(move |(l, r)| ok(Shape::capsule(l, r))),
        (size(), 0.01..0.99).prop_map(move |(r, part)| ok(Shape::ring(r, r * part))),
        (3usize..12, size()).prop_map(move |(sides, r)| ok(Shape::regular_polygon(sides, r))),
        (size(), prop_oneof![Just(PI), Just(TAU), Just(PI / 2.0), 0.1..6.2])
            .prop_map(move |(r, sweep)| ok(Shape::sector(r, sweep))),
        (size(), size(), 0.1..0.9, 0.1..0.9).prop_map(move |(w, h, p, q)| {
            let radius = p * w.min(h) / 2.0;
            ok(Shape::slotted_block(w, h, q * (w - 2.0 * radius), radius))
        }),
    ]
}

/// A moon: two arcs through the same two points, with sharp horns.
fn moon() -> impl Strategy<Value = Shape> {
    (-0.9..2.0, 0.05..0.5).prop_map(|(bulge, less): (f64, f64)| {
        let edges = vec![
            EdgeSpec::Bulge { to: DVec2::X, bulge },
            EdgeSpec::Bulge { to: DVec2::NEG_X, bulge: -(bulge - less) },
        ];
        Shape::from_paths(&[PathSpec { start: DVec2::NEG_X, edges }]).expect("a fine moon")
    })
}

/// Any shape of a size of about 1 m, whose middle need not be its origin.
pub(crate) fn any_shape() -> impl Strategy<Value = Shape> {
    let shift = prop_oneof![2 => Just(DVec2::ZERO), 1 => any_vector(1.0)];
    (prop_oneof![4 => outline_shape(), 3 => ready_made(), 1 => moon()], shift)
        .prop_map(|(shape, shift)| shape.translated(shift))
}

/// Any vector of at most the given size in either coordinate.
pub(crate) fn any_vector(size: f64) -> impl Strategy<Value = DVec2> {
    (-size..size, -size..size).prop_map(|(x, y)| DVec2::new(x, y))
}

/// Angles, with more right ones than chance gives.
pub(crate) fn any_angle() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(vec![0.0, PI / 2.0, PI, -PI / 2.0, PI / 4.0]), -PI..PI,]
}

/// A pose within a few metres of the origin.
pub(crate) fn any_pose() -> impl Strategy<Value = Pose> {
    let position = prop_oneof![3 => any_vector(4.0), 1 => (-3i8..3, -3i8..3).prop_map(|(x, y)| {
        DVec2::new(f64::from(x), f64::from(y))
    })];
    (position, any_angle()).prop_map(|(position, angle)| Pose::new(position, angle))
}
