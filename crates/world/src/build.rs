//! (stand-in) A world from a scene.

use crate::scene::{EdgeData, FieldPath, ForceData, Scene, SceneError, ShapeData};
use crate::world::{BodyState, Flyer, World};
use glam::DVec2;
use halfgap_geometry::{EdgeSpec, PathSpec, Shape, ShapeError};

impl World {
    /// Builds the world of a scene.
    ///
    /// # Errors
    /// What is not supported, and shapes that cannot be.
    pub fn from_scene(scene: &Scene) -> Result<World, SceneError> {
        scene.check_supported()?;
        let mut acceleration = DVec2::ZERO;
        for force in &scene.forces {
            if let ForceData::Gravity(gravity) = force {
                acceleration += DVec2::from(gravity.acceleration);
            }
        }
        let mut bodies = Vec::new();
        for (index, body) in scene.bodies.iter().enumerate() {
            let at = FieldPath::top().field("body").element(index).field("shape");
            let shape = build(&body.shape).map_err(|error| SceneError::new(at, error.to_string()))?;
            let properties = shape.mass_properties();
            let center = body.center_of_mass.map_or(properties.centroid, DVec2::from);
            let mass = body.mass.unwrap_or(body.density.unwrap_or(0.0) * properties.area);
            let state = BodyState {
                position: body.position.into(),
                angle: body.angle,
                velocity: body.velocity.into(),
                angular_velocity: body.angular_velocity,
            };
            bodies.push(Flyer {
                name: body.name.clone(),
                fixed: body.fixed,
                shape: shape.translated(-center),
                mass,
                moment: body.moment.unwrap_or(mass * properties.moment_per_mass),
                acceleration,
                state,
            });
        }
        Ok(World { time: scene.run.start_time, bodies })
    }
}

fn build(shape: &ShapeData) -> Result<Shape, ShapeError> {
    match shape {
        ShapeData::Disc(disc) => Shape::disc(disc.radius),
        ShapeData::Block(block) => Shape::block(block.width, block.height),
        ShapeData::RoundedBlock(block) => Shape::rounded_block(block.width, block.height, block.radius),
        ShapeData::Polygon(polygon) => {
            let vertices: Vec<_> = polygon.vertices.iter().map(|&vertex| vertex.into()).collect();
            Shape::polygon(&vertices)
        }
        ShapeData::Ring(ring) => Shape::ring(ring.outer, ring.inner),
        ShapeData::Outline(outline) => {
            let edge = |edge: &EdgeData| match edge {
                EdgeData::Line(to) => EdgeSpec::Line { to: (*to).into() },
                EdgeData::Arc(arc) => {
                    EdgeSpec::Arc { to: arc.to.into(), center: arc.center.into(), clockwise: arc.clockwise }
                }
            };
            let paths: Vec<_> = outline
                .paths
                .iter()
                .map(|path| PathSpec {
                    start: path.start.into(),
                    edges: path.edges.iter().map(edge).collect(),
                })
                .collect();
            Shape::from_paths(&paths)
        }
    }
}
