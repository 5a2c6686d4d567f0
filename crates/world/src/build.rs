//! A world from a scene.

use crate::builder::{BodySpec, WorldBuilder, WorldError, WorldSettings};
use crate::scales::ToleranceOverrides;
use crate::scene::{self, BodyData, EdgeData, FieldPath, ForceData, PathData, Scene, SceneError, ShapeData};
use crate::world::{Inertia, World};
use halfgap_collision::{BodyId, BodyState};
use halfgap_contact::{ImpactLaw, ImpactOrder};
use halfgap_geometry::{EdgeSpec, PathSpec, Shape, ShapeError};

impl World {
    /// Builds the world of a scene.
    ///
    /// # Errors
    /// What is not simulated yet, shapes that cannot be, and bodies that overlap at the start; the error names the field.
    pub fn from_scene(scene: &Scene) -> Result<World, SceneError> {
        scene.check_supported()?;
        let mut builder = WorldBuilder::new(settings(scene));
        for (index, body) in scene.bodies.iter().enumerate() {
            builder.add(body_spec(body).map_err(|error| {
                let field = FieldPath::top().field("body").element(index).field("shape");
                SceneError::new(field, error.to_string())
            })?);
        }
        for force in &scene.forces {
            add_force(&mut builder, scene, force);
        }
        for (index, body) in scene.bodies.iter().enumerate() {
            for other in
                scene.bodies.iter().enumerate().filter(|(_, other)| body.passes_through.contains(&other.name))
            {
                builder.let_pass(body_id(index), body_id(other.0));
            }
        }
        builder.build().map_err(|error| located(error, scene))
    }
}

fn settings(scene: &Scene) -> WorldSettings {
    let run = &scene.run;
    WorldSettings {
        start_time: run.start_time,
        tolerance: run.tolerance,
        overrides: ToleranceOverrides {
            target_gap: run.target_gap,
            accuracy: run.accuracy,
            velocity_tol: run.velocity_tol,
        },
        start_overlap: run.start_overlap,
        impact_law: match run.impact_law {
            scene::ImpactLaw::Simultaneous => ImpactLaw::Simultaneous,
            scene::ImpactLaw::Hybrid => ImpactLaw::Hybrid,
            scene::ImpactLaw::SerialSeparate => ImpactLaw::SerialSeparate,
            scene::ImpactLaw::SerialGrouped => ImpactLaw::SerialGrouped,
            scene::ImpactLaw::SerialSeparateLastpass => ImpactLaw::SerialSeparateLastpass,
            scene::ImpactLaw::SerialGroupedLastpass => ImpactLaw::SerialGroupedLastpass,
        },
        impact_order: run.seed.map_or(ImpactOrder::Fastest, ImpactOrder::Seeded),
        collisions: run.collisions,
    }
}

fn body_spec(body: &BodyData) -> Result<BodySpec, ShapeError> {
    let shape = build_shape(&body.shape)?;
    let uniform = shape.mass_properties();
    let center_of_mass = body.center_of_mass.map(glam::DVec2::from);
    let mass = body.mass.or(body.density.map(|density| density * uniform.area));
    let inertia = mass.filter(|_| !body.fixed).map(|mass| {
        // A uniform shape about a centre of mass that is not its centroid: the parallel axis theorem.
        let shift = center_of_mass.map_or(0.0, |center| (center - uniform.centroid).length_squared());
        Inertia { mass, moment: body.moment.unwrap_or(mass * (uniform.moment_per_mass + shift)) }
    });
    let state = BodyState {
        position: body.position.into(),
        angle: body.angle,
        velocity: body.velocity.into(),
        angular_velocity: body.angular_velocity,
    };
    Ok(BodySpec {
        name: body.name.clone(),
        shape,
        center_of_mass,
        inertia,
        state,
        elasticity: body.elasticity,
    })
}

fn build_shape(shape: &ShapeData) -> Result<Shape, ShapeError> {
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
            let paths: Vec<_> = outline.paths.iter().map(path_spec).collect();
            Shape::from_paths(&paths)
        }
    }
}

fn path_spec(path: &PathData) -> PathSpec {
    let edge = |edge: &EdgeData| match edge {
        EdgeData::Line(to) => EdgeSpec::Line { to: (*to).into() },
        EdgeData::Arc(arc) => {
            EdgeSpec::Arc { to: arc.to.into(), center: arc.center.into(), clockwise: arc.clockwise }
        }
    };
    PathSpec { start: path.start.into(), edges: path.edges.iter().map(edge).collect() }
}

fn add_force(builder: &mut WorldBuilder, scene: &Scene, force: &ForceData) {
    let acts_on = |body: &BodyData| force.bodies().is_none_or(|names| names.contains(&body.name));
    for (index, _) in scene.bodies.iter().enumerate().filter(|(_, body)| acts_on(body)) {
        match force {
            ForceData::Gravity(gravity) => builder.add_gravity(body_id(index), gravity.acceleration.into()),
            ForceData::Damping(damping) => {
                builder.add_damping(body_id(index), damping.linear, damping.angular)
            }
            // Refused by `check_supported`.
            ForceData::MutualGravity(_)
            | ForceData::Spring(_)
            | ForceData::Constant(_)
            | ForceData::Rotating(_) => {}
        }
    }
}

fn body_id(index: usize) -> BodyId {
    BodyId(u32::try_from(index).unwrap_or(u32::MAX))
}

/// Points the error at the body that it names.
fn located(error: WorldError, scene: &Scene) -> SceneError {
    let named = match &error {
        WorldError::DoubleName { name } => Some((name, "name")),
        WorldError::BadNumber { body, .. } => Some((body, "name")),
        WorldError::Overlap { second, .. } | WorldError::CannotLift { second, .. } => {
            Some((second, "position"))
        }
        WorldError::BadSetting { .. } => None,
    };
    let place = named.and_then(|(name, field)| {
        let index = scene.bodies.iter().position(|body| body.name == *name)?;
        Some(FieldPath::top().field("body").element(index).field(field))
    });
    SceneError::new(place.unwrap_or_else(|| FieldPath::top().field("run")), error.to_string())
}
