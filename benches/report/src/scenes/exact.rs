//! The `exact__*` scenes of the tests without friction, whose states are known to 1e-13: closed forms, or
//! integrated far tighter in minimal coordinates.

use crate::scene::{Body, Check, Connector, End, Inertia, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{EdgeSpec, PathSpec};
use halfgap::scene::{BodyData, ConnectorData, EdgeData, ExpectedData, ForceData, PointData, ShapeData};
use std::path::Path;

/// What the states in the files are good to [m].
const REFERENCE_ERROR: f64 = 1e-13;

/// Reads the scene of a file of which nothing is known, with a grid [s] of times at which it is looked at.
pub(super) fn read_pile(name: &str, grid: f64) -> Scene {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/steps").join(format!("{name}.json"));
    let data = halfgap::scene::Scene::read(file).expect("the scenes of the tests can be read");
    let bodies = data.bodies.iter().map(body).collect();
    let mut scene = Scene::new(name, data.about.as_deref().unwrap_or(&data.title), bodies);
    for force in &data.forces {
        let ForceData::Gravity(gravity) = force else { panic!("only gravity acts in {name}") };
        scene.gravity += DVec2::from(gravity.acceleration);
    }
    (scene.duration, scene.check_grid) = (data.run.duration, grid);
    scene
}

/// Reads a scene by its name, with the grid [s] of its check times.
pub(super) fn read(name: &str, grid: f64) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/scenes");
    let data = halfgap::scene::Scene::read(folder.join(format!("exact__{name}.json")))
        .expect("the scenes of the tests can be read");
    let bodies = data.bodies.iter().map(body).collect();
    let index = |name: &str| data.bodies.iter().position(|body| body.name == name);
    let mut scene = Scene::new(name, data.about.as_deref().unwrap_or(&data.title), bodies);
    scene.collisions = data.run.collisions;
    scene.connectors = data.connectors.iter().map(|pin| connector(pin, &index)).collect();
    for force in &data.forces {
        let ForceData::Gravity(gravity) = force else { panic!("only gravity acts in {name}") };
        scene.gravity += DVec2::from(gravity.acceleration);
    }
    let checks = data.expected.iter().map(|expected| check(expected, &index)).collect();
    scene.with_checks(grid, checks).with_reference(
        "closed form, or integrated far tighter in minimal coordinates; part of the tests",
        REFERENCE_ERROR,
    )
}

fn body(data: &BodyData) -> Body {
    let inertia = data.mass.zip(data.moment).map(|(mass, moment)| Inertia { mass, moment });
    let start = BodyState {
        position: data.position.unwrap_or_default().into(),
        angle: data.angle,
        velocity: data.velocity.into(),
        angular_velocity: data.angular_velocity,
    };
    Body {
        name: data.name.clone(),
        shape: shape(&data.shape),
        inertia,
        start,
        elasticity: data.elasticity,
        friction: data.friction,
        spin: 0.0,
    }
}

fn shape(data: &ShapeData) -> Shape {
    match data {
        ShapeData::Disc(disc) => Shape::Disc { radius: disc.radius },
        ShapeData::Block(block) => Shape::Block { width: block.width, height: block.height },
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
    let end = |point: &PointData| End { body: index(&point.body), point: point.point.into() };
    Connector::Pin(end(&pin.a), end(&pin.b))
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
