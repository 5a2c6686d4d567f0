//! Scenes of the tests whose states are known to 1e-13: closed forms, or integrated far tighter in minimal coordinates.

use crate::scene::{Body, Check, Connector, End, Inertia, Scene, Shape, Spring, Surface};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{EdgeSpec, PathSpec};
use halfgap::scene::{
    BodyData, ConnectorData, EdgeData, ExpectedData, ForceData, PointData, ShapeData, SpringData,
};
use std::path::Path;

/// What the states in the files are good to [m].
const REFERENCE_ERROR: f64 = 1e-13;

/// Reads the scene of a file of which nothing is known, with a grid [s] of times at which it is looked at.
pub(super) fn read_pile(name: &str, grid: f64) -> Scene {
    let (mut scene, data) = scene(name, &format!("steps/{name}.json"));
    (scene.duration, scene.check_grid) = (data.run.duration, grid);
    scene
}

/// Reads a scene by its name, with the grid [s] of its check times.
pub(super) fn read(name: &str, grid: f64) -> Scene {
    read_known(name, &format!("scenes/exact__{name}.json"), grid)
}

/// Reads a scene with known states from a file of the tests. States at times off the grid [s] are left out, for peers
/// cannot stop there.
pub(super) fn read_known(name: &str, file: &str, grid: f64) -> Scene {
    let (scene, data) = scene(name, file);
    let index = |name: &str| data.bodies.iter().position(|body| body.name == name);
    let is_on_grid = |time: f64| (time / grid - (time / grid).round()).abs() < 1e-9;
    let known = data.expected.iter().filter(|expected| is_on_grid(expected.time));
    let checks = known.map(|expected| check(expected, &index)).collect();
    scene.with_checks(grid, checks).with_reference(
        "closed form, or integrated far tighter in minimal coordinates; part of the tests",
        REFERENCE_ERROR,
    )
}

/// What a file of the tests has of a scene besides known states, and the file itself.
fn scene(name: &str, file: &str) -> (Scene, halfgap::scene::Scene) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data");
    let data = halfgap::scene::Scene::read(folder.join(file)).expect("the scenes of the tests can be read");
    let bodies = data.bodies.iter().map(body).collect();
    let index = |name: &str| data.bodies.iter().position(|body| body.name == name);
    let mut scene = Scene::new(name, data.about.as_deref().unwrap_or(&data.title), bodies);
    scene.collisions = data.run.collisions;
    scene.connectors = data.connectors.iter().map(|pin| connector(pin, &index)).collect();
    for force in &data.forces {
        match &force.data {
            ForceData::Gravity(gravity) => scene.gravity += DVec2::from(gravity.acceleration),
            ForceData::Spring(spring) => scene.springs.push(spring_between(spring, &index)),
            _ => panic!("only gravity and springs act in {name}"),
        }
    }
    (scene, data)
}

/// # Panics
/// The body has something that scenes of the report do not.
fn body(data: &BodyData) -> Body {
    let of_origin = data.center_of_mass.is_none_or(|center| DVec2::from(center) == DVec2::ZERO);
    let is_plain =
        data.origin.is_none() && data.rolling_resistance == 0.0 && data.tangential_elasticity == 0.0;
    assert!(of_origin && is_plain && data.motion.is_none(), "the report knows no such body: {data:?}");
    let shape = shape(&data.shape);
    // Uniform over the shape, if not given.
    let moment = |mass: f64| {
        let geometry = shape.geometry().expect("the scenes of the tests have sound shapes");
        mass * geometry.mass_properties().moment_per_mass
    };
    let inertia = |mass| Inertia { mass, moment: data.moment.unwrap_or_else(|| moment(mass)) };
    let inertia = data.mass.filter(|_| !data.fixed).map(inertia);
    let start = BodyState {
        position: data.position.unwrap_or_default().into(),
        angle: data.angle,
        velocity: data.velocity.into(),
        angular_velocity: data.angular_velocity,
    };
    Body {
        name: data.name.clone(),
        shape,
        inertia,
        start,
        elasticity: data.elasticity,
        surface: Surface {
            friction: data.friction,
            static_friction: data.static_friction.unwrap_or(data.friction),
            speed: data.surface_velocity,
        },
        spin: 0.0,
    }
}

fn shape(data: &ShapeData) -> Shape {
    match data {
        ShapeData::Disc(disc) => Shape::Disc { radius: disc.radius },
        ShapeData::Block(block) => Shape::Block { width: block.width, height: block.height },
        ShapeData::Polygon(polygon) => {
            Shape::Polygon(polygon.vertices.iter().map(|&vertex| vertex.into()).collect())
        }
        ShapeData::Outline(outline) => {
            let path = |path: &halfgap::scene::PathData| PathSpec {
                start: path.start.into(),
                edges: path.edges.iter().map(edge).collect(),
            };
            Shape::Outline(outline.paths.iter().map(path).collect())
        }
        other => panic!("no exact scene has the shape {other:?}"),
    }
}

fn edge(data: &EdgeData) -> EdgeSpec {
    match data {
        EdgeData::Line(to) => EdgeSpec::Line { to: (*to).into() },
        EdgeData::Arc(arc) => {
            EdgeSpec::Arc { to: arc.to.into(), center: arc.center.into(), clockwise: arc.clockwise }
        }
    }
}

fn connector(data: &ConnectorData, index: &impl Fn(&str) -> Option<usize>) -> Connector {
    let ConnectorData::Pin(pin) = data else { panic!("exact scenes have pins only") };
    Connector::Pin(end(&pin.a, index), end(&pin.b, index))
}

fn spring_between(data: &SpringData, index: &impl Fn(&str) -> Option<usize>) -> Spring {
    assert!(data.damping == 0.0, "springs of exact scenes have no damping");
    let SpringData { a, b, rest_length, stiffness, .. } = data;
    Spring { a: end(a, index), b: end(b, index), rest_length: *rest_length, stiffness: *stiffness }
}

fn end(data: &PointData, index: &impl Fn(&str) -> Option<usize>) -> End {
    End { body: index(&data.body), point: data.point.into() }
}

fn check(data: &ExpectedData, index: &impl Fn(&str) -> Option<usize>) -> Check {
    let states = data.bodies.iter().map(|(name, known)| {
        let body = index(name).expect("expected bodies exist");
        let state = BodyState {
            position: known.position.map(DVec2::from).expect("exact scenes tell positions"),
            angle: known.angle.unwrap_or(0.0),
            velocity: known.velocity.map(DVec2::from).unwrap_or_default(),
            angular_velocity: known.angular_velocity.unwrap_or(0.0),
        };
        (body, state)
    });
    Check { time: data.time, states: states.collect() }
}
