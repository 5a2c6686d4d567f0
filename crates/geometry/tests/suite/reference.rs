//! The reference engine's shapes and edge queries (see `tests/data/README.md`).

use halfgap_geometry::{Arc, DVec2, Edge, EdgeSpec, Line, PathSpec, Pose, Shape, edge_crossings};
use serde_json::Value;

/// Accuracy of the figures that the reference gives.
const TOLERANCE: f64 = 1e-9;

/// A file of the reference data.
pub(crate) fn data(text: &str) -> Value {
    serde_json::from_str(text).expect("the data are JSON")
}

/// A number.
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// A point or vector.
pub(crate) fn vector(value: &Value) -> DVec2 {
    DVec2::new(number(&value[0]), number(&value[1]))
}

/// The items of an array.
pub(crate) fn items(value: &Value) -> &[Value] {
    value.as_array().expect("an array")
}

fn path_spec(path: &Value) -> PathSpec {
    let parts =
        |edge: &Value| if edge["arc"].is_object() { edge["arc"].clone() } else { edge["line"].clone() };
    let spec = |edge: &Value| {
        let (to, arc) = (vector(&parts(edge)["to"]), &edge["arc"]);
        if arc.is_object() {
            let clockwise = arc["clockwise"].as_bool().expect("yes or no");
            EdgeSpec::Arc { to, center: vector(&arc["center"]), clockwise }
        } else {
            EdgeSpec::Line { to }
        }
    };
    let start = vector(&parts(&path[0])["from"]);
    PathSpec { start, edges: items(path).iter().map(spec).collect() }
}

/// Every shape of the reference with its name and description.
pub(crate) fn shapes() -> Vec<(String, Value, Shape)> {
    let all = data(include_str!("../data/shapes.json"));
    let build = |shape: &Value| {
        let name = shape["name"].as_str().expect("a name").to_owned();
        let paths: Vec<PathSpec> = items(&shape["paths"]).iter().map(path_spec).collect();
        let built = Shape::from_paths(&paths).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, shape.clone(), built)
    };
    items(&all["shapes"]).iter().map(build).collect()
}

#[test]
fn the_quarter_arc_of_the_unit_tests() {
    let arc = Arc::between(DVec2::new(0.0, 2.0), DVec2::new(2.0, 0.0), DVec2::ZERO, true, 1e-9);
    // With the outside away from its center the arc is convex: the solid on the left means running the other way.
    let edge = Edge::Arc(arc.expect("a fine arc").reversed());
    let all = data(include_str!("../data/unit_tests.json"));
    let expected = &all["tests"][0]["expected"];
    assert!((1.0 / edge.curvature() - number(&expected["curvature_at_2_0"])).abs() < 1e-12);
    for pair in items(&expected["normals"]) {
        assert!((edge.normal_at(vector(&pair[0])) - vector(&pair[1])).length() < 1e-12);
    }
    for pair in items(&expected["distance_to_point"]) {
        assert!((edge.signed_distance(vector(&pair[0])) - number(&pair[1])).abs() < 1e-12);
    }
    let bounds = edge.bounds();
    for (side, name) in
        [(bounds.min.x, "left"), (bounds.max.x, "right"), (bounds.max.y, "top"), (bounds.min.y, "bottom")]
    {
        assert!((side - number(&expected[name])).abs() < 1e-12, "{name}");
    }
}

#[test]
fn the_block_of_the_unit_tests() {
    let all = data(include_str!("../data/unit_tests.json"));
    let (test, expected) = (&all["tests"][1], &all["tests"][1]["expected"]);
    let block = Shape::block(number(&expected["width"]), number(&expected["height"])).expect("a fine block");
    assert_eq!(block.edges().count() as f64, number(&expected["edges"]));
    let pose = Pose::new(vector(&test["position"]), number(&test["angle"]));
    for (bounds, name) in [(block.bounds(), "body_bounds"), (block.bounds_at(&pose), "world_bounds")] {
        let sides = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y];
        for (side, expected) in sides.iter().zip(items(&expected[name])) {
            assert!((side - number(expected)).abs() <= 1e-15, "{name}");
        }
    }
    let moment = block.mass_properties().moment_per_mass;
    assert!((moment - number(&expected["moment_per_mass"])).abs() <= 1e-15);
}

#[test]
fn the_segments_of_the_unit_tests() {
    let all = data(include_str!("../data/unit_tests.json"));
    for case in items(&all["tests"][2]["expected"]) {
        let line = |ends: &Value| Edge::Line(Line::new(vector(&ends[0]), vector(&ends[1])).expect("a line"));
        let crossing = edge_crossings(&line(&case["a"]), &line(&case["b"])).next();
        match (crossing, &case["crossing"]) {
            (None, Value::Null) => {}
            (Some(point), expected) => assert!((point - vector(expected)).length() < 1e-12),
            (None, expected) => panic!("no crossing at {expected}"),
        }
    }
}

#[test]
fn shapes_have_the_bounds_and_corners_of_the_reference() {
    for (name, reference, shape) in shapes() {
        let (bounds, expected) = (shape.bounds(), &reference["bounds"]);
        for (side, place) in
            [(bounds.min.x, "left"), (bounds.max.x, "right"), (bounds.max.y, "top"), (bounds.min.y, "bottom")]
        {
            assert!((side - number(&expected[place])).abs() < TOLERANCE, "{name}: {place}");
        }
        let corners = items(&reference["vertexes"]).iter().filter(|vertex| vertex["corner"] == true);
        let starts: Vec<DVec2> = shape.edges().map(Edge::from).collect();
        assert_eq!(corners.clone().count(), starts.len(), "{name}");
        for corner in corners {
            let nearest = |at: DVec2| starts.iter().map(|s| (*s - at).length()).fold(f64::INFINITY, f64::min);
            assert!(nearest(vector(&corner["at"])) < TOLERANCE, "{name}");
        }
    }
}

/// The figure whose moment of inertia the reference gives to a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
enum MomentOf {
    /// The shape itself.
    Shape,
    /// Its bounding rectangle.
    Rectangle,
    /// A disc of this radius [m].
    Disc(f64),
    /// A number set by hand.
    Stated(f64),
}

#[test]
fn moments_are_those_of_the_reference_where_it_computes_them() {
    let inradius = 0.75_f64.sqrt();
    let expected = [
        ("ball", MomentOf::Shape),
        ("block", MomentOf::Shape),
        ("hexagon", MomentOf::Disc(inradius)),
        ("pendulum", MomentOf::Disc(0.602_079_728_939_614_8)),
        ("round_block", MomentOf::Rectangle),
        ("round_corner_block", MomentOf::Rectangle),
        ("frame", MomentOf::Rectangle),
        ("block_round_edge", MomentOf::Rectangle),
        ("concave_circle", MomentOf::Rectangle),
        ("ngon_7", MomentOf::Disc(0.8)),
        ("diamond", MomentOf::Shape),
        ("small_ball", MomentOf::Shape),
        ("ring", MomentOf::Stated(1.6)),
    ];
    let shapes = shapes();
    assert_eq!(shapes.len(), expected.len());
    for ((name, reference, shape), (expected_name, moment_of)) in shapes.iter().zip(expected) {
        assert_eq!(name, expected_name);
        let moment = match moment_of {
            MomentOf::Shape => shape.mass_properties().moment_per_mass,
            MomentOf::Rectangle => {
                let size = shape.bounds().size();
                let rectangle = Shape::block(size.x, size.y).expect("a fine block");
                rectangle.mass_properties().moment_per_mass
            }
            MomentOf::Disc(radius) => radius * radius / 2.0,
            MomentOf::Stated(moment) => moment,
        };
        assert!((moment - number(&reference["moment_per_mass"])).abs() < TOLERANCE, "{name}: {moment}");
        // If the moment is that of the shape, the centre of mass is its centroid, too.
        let off = (shape.mass_properties().centroid - vector(&reference["center_of_mass"])).length();
        assert!(moment_of != MomentOf::Shape || off < TOLERANCE, "{name}: {off}");
    }
}

#[test]
fn three_centers_of_mass_are_not_centroids() {
    let mut off: Vec<String> = Vec::new();
    for (name, reference, shape) in shapes() {
        let center = vector(&reference["center_of_mass"]);
        if (shape.mass_properties().centroid - center).length() > TOLERANCE {
            off.push(name);
        }
    }
    assert_eq!(off, ["pendulum", "block_round_edge", "concave_circle"]);
}

/// The shape's edge that the reference counts as number `index`.
fn edge_of(reference: &Value, shape: &Shape, index: usize) -> Edge {
    let all: Vec<&Value> = items(&reference["paths"]).iter().flat_map(items).collect();
    let part = if all[index]["arc"].is_object() { &all[index]["arc"] } else { &all[index]["line"] };
    let (from, to) = (vector(&part["from"]), vector(&part["to"]));
    let fits = |edge: &&Edge| {
        let same = |p: DVec2, q: DVec2| (p - q).length() < TOLERANCE;
        (same(edge.from(), from) && same(edge.to(), to)) || (same(edge.from(), to) && same(edge.to(), from))
    };
    *shape.edges().find(fits).expect("the shape has this edge")
}

#[test]
fn edge_queries_agree() {
    let shapes = shapes();
    let all = data(include_str!("../data/edge_queries.json"));
    let (mut points, mut segments) = (0, 0);
    for query in items(&all["queries"]) {
        let (_, reference, shape) =
            shapes.iter().find(|(name, ..)| query["shape"] == **name).expect("a known shape");
        let edge = edge_of(reference, shape, query["edge"].as_u64().expect("an index") as usize);
        for point in items(&query["points"]) {
            check_point(&edge, point);
            points += 1;
        }
        for segment in items(&query["segments"]) {
            check_segment(&edge, segment);
            segments += 1;
        }
    }
    assert_eq!((points, segments), (684, 684));
}

fn check_point(edge: &Edge, query: &Value) {
    let p = vector(&query["p"]);
    assert!((edge.signed_distance(p) - number(&query["distance_to_line"])).abs() < TOLERANCE, "{query}");
    let foot = vector(&query["nearest"]);
    assert!((edge.normal_at(foot) - vector(&query["normal"])).length() < TOLERANCE, "{query}");
    // The nearest point of the reference is that of the whole line or circle; it is ours if the edge reaches as far.
    let nearest = edge.nearest(p);
    if query["distance_to_point"].is_number() {
        assert!((nearest - foot).length() < TOLERANCE, "{query}");
        let distance = number(&query["distance_to_point"]).abs();
        assert!(((nearest - p).length() - distance).abs() < TOLERANCE, "{query}");
    } else {
        assert!(nearest == edge.from() || nearest == edge.to(), "{query}");
    }
    if let (Edge::Arc(arc), Some(within)) = (edge, query["within_arc"].as_bool()) {
        let direction = (p - arc.center()).normalize();
        assert_eq!(arc.directions().contains(direction), within, "{query}");
    }
}

fn check_segment(edge: &Edge, query: &Value) {
    let segment = Line::new(vector(&query["from"]), vector(&query["to"])).expect("a segment");
    let found: Vec<DVec2> = edge_crossings(edge, &Edge::Line(segment)).collect();
    let expected: Vec<DVec2> = items(&query["crossings"]).iter().map(vector).collect();
    assert_eq!(found.len(), expected.len(), "{query}");
    for point in &expected {
        assert!(found.iter().any(|p| (*p - *point).length() < TOLERANCE), "{query}: {found:?}");
    }
}
