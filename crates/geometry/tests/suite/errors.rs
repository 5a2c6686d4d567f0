//! Each way in which a shape can be wrong, and the message that it gets.

use halfgap_geometry::{Arc, ArcError, DVec2, EdgeSpec, Line, LineError, PathSpec, Shape, ShapeError};
use std::f64::consts::TAU;

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn line(x: f64, y: f64) -> EdgeSpec {
    EdgeSpec::Line { to: v(x, y) }
}

fn message(shape: Result<Shape, ShapeError>) -> String {
    shape.expect_err("this shape is wrong").to_string()
}

fn path_message(start: DVec2, edges: Vec<EdgeSpec>) -> String {
    message(Shape::from_paths(&[PathSpec { start, edges }]))
}

fn arc(to: DVec2, center: DVec2) -> EdgeSpec {
    EdgeSpec::Arc { to, center, clockwise: false }
}

#[test]
fn measures_are_named() {
    assert_eq!(message(Shape::disc(-1.0)), "radius must be positive and finite, got -1 m");
    assert_eq!(message(Shape::block(1.0, f64::NAN)), "height must be positive and finite, got NaN m");
    assert_eq!(message(Shape::capsule(0.0, 1.0)), "length must be positive and finite, got 0 m");
    assert_eq!(
        message(Shape::regular_polygon(5, f64::INFINITY)),
        "circumradius must be positive and finite, got inf m"
    );
    assert_eq!(message(Shape::rounded_block(2.0, 1.0, 0.6)), "radius is 0.6 m, but must be at most 0.5 m");
    assert_eq!(message(Shape::ring(1.0, 1.0)), "inner is 1 m, but must be less than 1 m");
    assert_eq!(
        message(Shape::slotted_block(4.0, 1.0, 1.0, 0.5)),
        "slot_radius is 0.5 m, but must be less than 0.5 m"
    );
    assert_eq!(
        message(Shape::slotted_block(4.0, 1.0, 3.5, 0.25)),
        "slot_length is 3.5 m, but must be less than 3.5 m"
    );
    assert_eq!(
        message(Shape::sector(1.0, -0.5)),
        "sweep must be more than 0 and at most 6.283185 rad, got -0.5 rad"
    );
}

#[test]
fn corners_and_paths_must_be_there() {
    assert_eq!(
        message(Shape::polygon(&[v(0.0, 0.0), v(1.0, 0.0)])),
        "a polygon needs at least 3 vertices, got 2"
    );
    assert_eq!(message(Shape::regular_polygon(0, 1.0)), "a polygon needs at least 3 vertices, got 0");
    assert_eq!(message(Shape::from_paths(&[])), "an outline needs at least one path");
    assert_eq!(path_message(DVec2::ZERO, vec![]), "path 0 has no edges");
}

#[test]
fn numbers_must_be_finite() {
    let expected = "path 0, edge 1: coordinates must be finite";
    assert_eq!(
        path_message(DVec2::ZERO, vec![line(1.0, 0.0), line(f64::NAN, 1.0), line(0.0, 0.0)]),
        expected
    );
    let bulge = EdgeSpec::Bulge { to: v(0.0, 1.0), bulge: f64::NAN };
    assert_eq!(path_message(DVec2::ZERO, vec![line(1.0, 0.0), bulge, line(0.0, 0.0)]), expected);
    assert_eq!(
        path_message(v(0.0, f64::INFINITY), vec![line(1.0, 0.0)]),
        "path 0, edge 0: coordinates must be finite"
    );
}

#[test]
fn the_path_with_the_infinite_number_is_blamed() {
    let good = PathSpec::polygon(&[v(0.0, 0.0), v(1.0, 0.0), v(0.0, 1.0)]);
    let bad = PathSpec::polygon(&[v(3.0, 0.0), v(4.0, 0.0), v(3.0, f64::INFINITY)]);
    assert_eq!(message(Shape::from_paths(&[good, bad])), "path 1, edge 1: coordinates must be finite");
}

#[test]
fn an_open_path_says_how_far() {
    assert_eq!(
        path_message(DVec2::ZERO, vec![line(1.0, 0.0), line(1.0, 1.0), line(0.0, 0.25)]),
        "path 0 is open: edge 2 ends 0.25 m away from the start"
    );
}

#[test]
fn coincident_vertices_name_the_edge() {
    assert_eq!(
        message(Shape::polygon(&[v(0.0, 0.0), v(1.0, 0.0), v(1.0, 0.0), v(0.0, 1.0)])),
        "path 0, edge 1: its end points coincide (0 m apart)"
    );
}

#[test]
fn an_arc_radius_off_by_one_percent_says_by_how_much() {
    let corner = arc(v(0.0, 2.02), DVec2::ZERO);
    assert_eq!(
        path_message(DVec2::ZERO, vec![line(2.0, 0.0), corner, line(0.0, 0.0)]),
        "path 0, edge 1: arc radius is 2 m at its start but 2.02 m at its end: off by 0.02 m"
    );
}

#[test]
fn a_major_arc_about_a_misplaced_center_says_how_far() {
    // The radii agree to 1e-7, but about its center the far side of the arc would be elsewhere.
    let error = Arc::between(v(1e-3, 1.0), v(-1e-3, 1.0), v(1e-4, 0.0), true, 1e-6);
    let Err(ArcError::CenterOff { off }) = error else { panic!("the center is 0.1 mm off") };
    assert!((off - 1e-4).abs() < 1e-12, "{off}");
}

#[test]
fn sizes_whose_moments_are_no_numbers_are_refused() {
    for size in [1e-160, 1e80] {
        let error = Shape::block(size, size).expect_err("its moments are no numbers");
        assert!(matches!(error, ShapeError::NoMoments { .. }), "{error}");
    }
    let mass = Shape::disc(1e-70).expect("small, but fine").mass_properties();
    assert!((mass.moment_per_mass / 0.5e-140 - 1.0).abs() < 1e-14, "{mass:?}");
}

#[test]
fn edges_alone_have_their_errors() {
    let text = |error: ArcError| error.to_string();
    let new = |radius, sweep| Arc::new(DVec2::ZERO, radius, 0.0, sweep).expect_err("wrong");
    assert_eq!(text(new(0.0, 1.0)), "arc radius must be positive and finite, got 0 m");
    assert_eq!(text(new(1.0, 0.0)), "arc sweep must be between 0 and a full turn in size, got 0 rad");
    assert_eq!(text(new(1.0, 7.0)), "arc sweep must be between 0 and a full turn in size, got 7 rad");
    let nowhere = Arc::new(DVec2::NAN, 1.0, 0.0, 1.0).expect_err("wrong");
    assert_eq!(text(nowhere), "arc center and end points must be finite, their tolerance a number");
    let loose = Arc::between(v(1.0, 0.0), v(0.0, 3.0), DVec2::ZERO, false, f64::NAN).expect_err("wrong");
    assert_eq!(loose, ArcError::NotFinite);
    let to_nowhere = Line::new(DVec2::ZERO, DVec2::INFINITY).expect_err("wrong");
    assert_eq!(to_nowhere.to_string(), "end points, and the square of their distance, must be finite");
    for far in [v(1e200, 1e200), v(1e308, 0.0)] {
        assert_eq!(Line::new(-far, far), Err(LineError::NotFinite));
    }
    let point = Line::new(v(1.0, 2.0), v(1.0, 2.0)).expect_err("wrong");
    assert_eq!(point.to_string(), "end points coincide at (1, 2) m");
}

#[test]
fn a_self_crossing_path_names_both_edges() {
    assert_eq!(
        message(Shape::polygon(&[v(0.0, 0.0), v(1.0, 1.0), v(1.0, 0.0), v(0.0, 1.0)])),
        "path 0, edge 0 meets path 0, edge 2 at (0.5, 0.5) m"
    );
}

#[test]
fn paths_may_not_cross_touch_or_repeat() {
    let square =
        |x: f64, y: f64| PathSpec::polygon(&[v(x, y), v(x + 1.0, y), v(x + 1.0, y + 1.0), v(x, y + 1.0)]);
    let pair = |x: f64, y: f64| Shape::from_paths(&[square(0.0, 0.0), square(x, y)]);
    assert!(matches!(pair(0.5, 0.5), Err(ShapeError::Crossing { path_a: 0, path_b: 1, .. })));
    assert_eq!(message(pair(1.0, 0.25)), "path 0, edge 1 meets path 1, edge 0 at (1, 0.25) m");
    assert!(matches!(pair(1.0, 1.0), Err(ShapeError::Crossing { x: 1.0, y: 1.0, .. })));
    assert!(matches!(pair(0.0, 0.0), Err(ShapeError::Crossing { .. })));
    assert!(pair(1.0 + 1e-6, 0.0).is_ok());
    let circles = [PathSpec::circle(DVec2::ZERO, 2.0), PathSpec::circle(v(1.0, 0.0), 1.0)];
    assert!(matches!(Shape::from_paths(&circles), Err(ShapeError::Crossing { .. })), "tangent from inside");
    let circles = [PathSpec::circle(DVec2::ZERO, 2.0), PathSpec::circle(DVec2::ZERO, 2.0)];
    assert!(matches!(Shape::from_paths(&circles), Err(ShapeError::Crossing { .. })), "the same circle twice");
}

#[test]
fn edges_may_not_fold_back() {
    let spike = Shape::polygon(&[v(0.0, 0.0), v(2.0, 0.0), v(1.0, 0.0), v(1.0, 1.0)]);
    assert_eq!(message(spike), "path 0, edge 0 meets path 0, edge 1 at (1, 0) m");
    let flat = PathSpec { start: DVec2::ZERO, edges: vec![line(1.0, 0.0), line(0.0, 0.0)] };
    assert_eq!(message(Shape::from_paths(&[flat])), "path 0, edge 0 meets path 0, edge 1 at (0.5, 0) m");
    // Out along an arc and back along the same arc.
    let bulges = |there, back| {
        let edges = vec![
            EdgeSpec::Bulge { to: DVec2::X, bulge: there },
            EdgeSpec::Bulge { to: DVec2::ZERO, bulge: back },
        ];
        Shape::from_paths(&[PathSpec { start: DVec2::ZERO, edges }])
    };
    assert!(matches!(bulges(0.5, -0.5), Err(ShapeError::Crossing { .. })));
    assert!(bulges(0.5, -0.4).is_ok(), "a moon");
    assert!(bulges(1.0, 1.0).is_ok(), "a disc of two halves");
    assert!(bulges(1.0, 0.0).is_ok(), "half a disc");
}

#[test]
fn an_arc_that_runs_into_its_neighbour_is_an_error() {
    let over = arc(v(1.0, -1.0), v(1.0, 0.0));
    let crossing = path_message(DVec2::ZERO, vec![line(2.0, 0.0), over, line(0.0, -1.0), line(0.0, 0.0)]);
    assert!(crossing.starts_with("path 0, edge 0 meets path 0, edge 1 at"), "{crossing}");
}

#[test]
fn a_gear_of_five_hundred_edges_is_no_crossing() {
    let shape = gear(125, 1.0);
    assert_eq!(shape.edges().count(), 500);
    let again = gear(125, 2.0);
    assert!((again.mass_properties().area / shape.mass_properties().area - 4.0).abs() < 1e-12);
}

/// A wheel with round teeth: a line up, an arc over the tooth, a line down, an arc along the bottom.
pub(crate) fn gear(teeth: u32, radius: f64) -> Shape {
    let pitch = TAU / f64::from(teeth);
    let at = |r: f64, angle: f64| v(angle.cos(), angle.sin()) * r;
    let top = radius * (1.0 + pitch);
    let mut edges = Vec::new();
    for tooth in 0..teeth {
        let start = f64::from(tooth) * pitch;
        edges.push(EdgeSpec::Line { to: at(top, start + 0.1 * pitch) });
        edges.push(EdgeSpec::Bulge { to: at(top, start + 0.4 * pitch), bulge: 0.4 });
        edges.push(EdgeSpec::Line { to: at(radius, start + 0.5 * pitch) });
        edges.push(EdgeSpec::Arc { to: at(radius, start + pitch), center: DVec2::ZERO, clockwise: false });
    }
    Shape::from_paths(&[PathSpec { start: at(radius, 0.0), edges }]).expect("a fine gear")
}
