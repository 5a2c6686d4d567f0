//! Building a world from a scene: its bodies here (`bodies` finds them by name), the rest in `settings`, `shape`,
//! `force` and `connector`; `hints` tells what the author may not have meant.

mod bodies;
mod connector;
mod force;
mod hints;
pub(crate) mod settings;
mod shape;

use self::bodies::Bodies;
use self::shape::build_shape;
use crate::builder::{BodySpec, WorldBuilder};
use crate::run_error::RunError;
use crate::scene::{BodyData, FieldPath, ForceData, MotionData, PairData, Scene, SceneError};
use crate::world::{Inertia, World};
use crate::world_error::{ConnectorName, WorldError};
use halfgap_advance::rigid::{PairRule, Surface};
use halfgap_collision::{BodyId, BodyState};
use halfgap_geometry::{Shape, ShapeError};

impl World {
    /// Builds the world of a scene.
    ///
    /// # Errors
    /// [`SceneError`] for values that break a rule, fields that are not simulated yet, impossible shapes, and bodies
    /// that overlap at the start; the error names the field.
    pub fn from_scene(scene: &Scene) -> Result<World, SceneError> {
        WorldBuilder::from_scene(scene)?.build().map_err(|error| located(error, scene))
    }
}

impl WorldBuilder {
    /// Collects the parts of a scene, to which more can be added before the world is built: force laws of one's own, say.
    /// Bodies have the ids of their places in the scene, and connectors likewise.
    ///
    /// ```
    /// use halfgap::force::{ConstantForce, ForceFrame, Push};
    /// use halfgap::geometry::DVec2;
    /// use halfgap::scene::{Scene, SceneFormat};
    /// use halfgap::{BodyId, WorldBuilder};
    /// use std::sync::Arc;
    ///
    /// let scene = r#"
    ///     format = "halfgap-scene-1"
    ///     title = "Sled"
    ///     run = { duration = 1.0 }
    ///     body = [{ name = "sled", shape = { disc = { radius = 0.5 } }, mass = 2.0 }]
    /// "#;
    /// let mut builder = WorldBuilder::from_scene(&Scene::parse(scene, SceneFormat::Toml)?)?;
    /// let push = Push { frame: ForceFrame::World, point: DVec2::ZERO, force: DVec2::new(4.0, 0.0), torque: 0.0 };
    /// builder.add_force(Arc::new(ConstantForce::new("wind", BodyId(0), push)));
    /// let mut world = builder.build()?;
    /// world.advance_to(1.0, &mut |_| ())?;
    /// assert!((world.state(BodyId(0)).position.x - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError`] for values that break a rule, fields that are not simulated yet, and impossible shapes; the error
    /// names the field. What only shows when the bodies are put together is told by [`build`](Self::build), whose errors
    /// name bodies.
    pub fn from_scene(scene: &Scene) -> Result<Self, SceneError> {
        scene.validate_world()?;
        scene.check_supported()?;
        let mut builder = collect(scene)?;
        hints::of(scene, &builder).into_iter().for_each(|hint| builder.warn(hint));
        Ok(builder)
    }
}

/// Collects the parts of a scene in a builder.
fn collect(scene: &Scene) -> Result<WorldBuilder, SceneError> {
    let mut builder = WorldBuilder::new(settings::of_run(&scene.run));
    for (index, body) in scene.bodies.iter().enumerate() {
        let field = FieldPath::top().field("body").element(index);
        let spec = body_spec(body)
            .map_err(|error| SceneError::new(field.clone().field("shape"), error.to_string()))?;
        let motion = body.motion.as_ref().map(MotionData::to_motion).transpose();
        let motion = motion.map_err(|(table, error)| {
            SceneError::new(field.field("motion").field("table").field(table), error.to_string())
        })?;
        builder.add(BodySpec { motion, ..spec });
    }
    let bodies = Bodies::of(scene);
    for (index, force) in scene.forces.iter().enumerate() {
        force::add(&mut builder, &bodies, (index, force))?;
    }
    connector::add_all(&mut builder, &bodies)?;
    for (index, body) in scene.bodies.iter().enumerate() {
        for other in &body.passes_through {
            builder.let_pass(BodyId::from_index(index), bodies.find(other));
        }
    }
    for pair in &scene.pairs {
        add_pair(&mut builder, pair.bodies.each_ref().map(|name| bodies.find(name)), pair);
    }
    Ok(builder)
}

fn add_pair(builder: &mut WorldBuilder, [a, b]: [BodyId; 2], pair: &PairData) {
    match pair.collide {
        Some(true) => builder.let_collide(a, b),
        Some(false) => builder.let_pass(a, b),
        None => (),
    }
    let rule = PairRule {
        friction: pair.friction,
        static_friction: pair.static_friction,
        elasticity: pair.elasticity,
        rolling_resistance: pair.rolling_resistance,
        tangential_elasticity: pair.tangential_elasticity,
    };
    if rule != PairRule::default() {
        builder.set_pair(a, b, rule);
    }
}

fn body_spec(body: &BodyData) -> Result<BodySpec, ShapeError> {
    let shape = build_shape(&body.shape)?;
    let uniform = shape.mass_properties();
    let center_of_mass = body.center_of_mass.map(glam::DVec2::from);
    let inertia = mass(body, &shape).filter(|_| !body.fixed).map(|mass| {
        // A uniform shape about a centre of mass that is not its centroid: the parallel axis theorem.
        let shift = center_of_mass.map_or(0.0, |center| (center - uniform.centroid).length_squared());
        Inertia { mass, moment: body.moment.unwrap_or(mass * (uniform.moment_per_mass + shift)) }
    });
    let state = BodyState {
        position: body.position.unwrap_or_default().into(),
        angle: body.angle,
        velocity: body.velocity.into(),
        angular_velocity: body.angular_velocity,
    };
    let spec = BodySpec {
        name: body.name.clone(),
        shape,
        center_of_mass,
        inertia,
        state,
        elasticity: body.elasticity,
        surface: Surface {
            friction: body.friction,
            static_friction: body.static_friction.unwrap_or(body.friction),
            velocity: body.surface_velocity,
            rolling_resistance: body.rolling_resistance,
            tangential_elasticity: body.tangential_elasticity,
        },
        motion: None,
    };
    Ok(match body.origin {
        Some(origin) => spec.with_origin(origin.into()),
        None => spec,
    })
}

/// Mass of a body [kg], given or from its density; a fixed body may have none.
fn mass(body: &BodyData, shape: &Shape) -> Option<f64> {
    body.mass.or_else(|| body.density.map(|density| density * shape.mass_properties().area))
}

/// Returns the error of a world as that of the field to blame.
fn located(error: WorldError, scene: &Scene) -> SceneError {
    let top = FieldPath::top();
    let body = |name: &String, field: &dyn Fn(&BodyData) -> &'static str| {
        let index = scene.bodies.iter().position(|body| body.name == *name)?;
        Some(top.field("body").element(index).field(field(&scene.bodies[index])))
    };
    let place = match &error {
        WorldError::DoubleName { name } | WorldError::BadName { name } => body(name, &|_| "name"),
        WorldError::TooLarge { quantity: "gravity", .. } => strongest_gravity(scene),
        WorldError::FrictionWithoutForces { body: name } => body(name, &|_| "name"),
        WorldError::BadNumber { body: name, quantity, .. }
        | WorldError::TooLarge { body: name, quantity, .. } => body(name, &|body| field_of(body, quantity)),
        WorldError::Overlap { second, .. } | WorldError::CannotLift { second, .. } => body(second, &place_of),
        // The name of a law is the path of its field.
        WorldError::BadForce { law, .. }
        | WorldError::StrongForce { law, .. }
        | WorldError::UnnamedBody { law, .. } => law.parse().ok(),
        WorldError::StopsBackToBack { stops: connectors } | WorldError::Contradiction { connectors } => {
            let ConnectorName { index, kind, .. } = &connectors[1];
            Some(top.field("connector").element(*index).field(*kind))
        }
        WorldError::ConnectorError { connector, .. }
        | WorldError::CannotConnect { connector, .. }
        | WorldError::BadConnector { connector, .. }
        | WorldError::FarConnector { connector, .. }
        | WorldError::ConnectorComesApart { connector, .. } => {
            let ConnectorName { index, kind, .. } = connector;
            let element = top.field("connector").element(*index);
            // What acts on a free coordinate is a field of its connector.
            let whole = scene.connectors.get(*index).map_or(*kind, |connector| connector.key());
            let field = element.field(whole);
            Some(if whole == *kind { field } else { field.field(*kind) })
        }
        WorldError::BadSetting { setting, .. } | WorldError::LostInRounding { setting, .. } => {
            Some(top.field("run").field(*setting))
        }
        WorldError::ShortDuration { .. } => Some(top.field("run").field("duration")),
        WorldError::WideAccuracy { .. } => Some(top.field("run").field("accuracy")),
        WorldError::Start { source: RunError::Squeezed { light, .. } } => {
            body(light, &|body| field_of(body, "mass"))
        }
        WorldError::NoSuchBody { .. } | WorldError::Start { .. } => None,
    };
    SceneError::new(place.unwrap_or_else(|| top.field("run")), error.to_string())
}

/// Returns the place of the greatest of the scene's uniform accelerations.
fn strongest_gravity(scene: &Scene) -> Option<FieldPath> {
    let size = |force: &ForceData| match force {
        ForceData::Gravity(gravity) => Some(gravity.acceleration.x.abs().max(gravity.acceleration.y.abs())),
        _ => None,
    };
    let sizes = scene.forces.iter().enumerate().filter_map(|(index, force)| Some((index, size(force)?)));
    let (index, _) = sizes.max_by(|p, q| p.1.total_cmp(&q.1))?;
    Some(FieldPath::top().field("force").element(index).field("gravity").field("acceleration"))
}

/// Returns the name of the field of a body that determines its place.
fn place_of(body: &BodyData) -> &'static str {
    if body.origin.is_some() { "origin" } else { "position" }
}

/// Returns the name of the field of a body that determines a quantity.
fn field_of(body: &BodyData, quantity: &str) -> &'static str {
    match quantity {
        "mass" | "moment" if body.mass.is_none() => "density",
        "mass" => "mass",
        "moment" if body.moment.is_none() => "mass",
        "moment" => "moment",
        "elasticity" => "elasticity",
        "position" | "coordinates" => place_of(body),
        "angle" => "angle",
        "velocity" => "velocity",
        "angular velocity" => "angular_velocity",
        "centre of mass" => "center_of_mass",
        "coordinates of the shape" => "shape",
        _ => "name",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFormat;

    /// The bodies of a scene to which tests add force laws.
    const FORCES: &str = r#"
        format = "halfgap-scene-1"
        title = "Forces"
        run = { duration = 1.0, start_time = 3.0 }

        [[body]]
        name = "plate"
        shape = { block = { width = 2.0, height = 2.0 } }
        center_of_mass = [0.0, 1.0]
        position = [1.0, 5.0]
        mass = 2.0

        [[body]]
        name = "sun"
        fixed = true
        shape = { disc = { radius = 0.5 } }
        density = 100.0
        position = [-9.0, 5.0]

        [[body]]
        name = "wall"
        fixed = true
        shape = { disc = { radius = 0.5 } }
        position = [-9.0, -5.0]
    "#;

    fn world(forces: &str) -> Result<World, SceneError> {
        let scene = Scene::parse(&format!("{FORCES}{forces}"), SceneFormat::Toml).expect("a fine scene");
        collect(&scene)?.build().map_err(|error| located(error, &scene))
    }

    fn potential(forces: &str) -> f64 {
        world(forces).unwrap_or_else(|error| panic!("{error}")).energy().potential
    }

    #[test]
    fn a_spring_is_tied_to_shape_coordinates() {
        // The point (1, 1) is 1 m to the right of the centre of mass: at (2, 5), 3 m from the other end.
        let spring = r#"
            [[force]]
            spring = { a = { body = "plate", point = [1, 1] }, b = { body = "world", point = [2, 2] }, rest_length = 1, stiffness = 7, damping = 2 }"#;
        assert_eq!(potential(spring), 14.0);
        let names: Vec<_> =
            world(spring).expect("a fine world").forces().map(|law| law.name().to_owned()).collect();
        assert_eq!(names, ["force[0].spring", "force[0].spring.damping"]);
    }

    #[test]
    fn fixed_bodies_attract_with_the_mass_they_are_given() {
        let sun = 100.0 * std::f64::consts::PI * 0.25;
        let found = potential("[[force]]\nmutual_gravity = { strength = 3.0 }");
        assert!((found + 3.0 * 2.0 * sun / 10.0).abs() < 1e-12, "{found}");
        assert_eq!(potential("[[force]]\nmutual_gravity = { strength = 3.0, bodies = [\"plate\"] }"), 0.0);
        let error = world("[[force]]\nmutual_gravity = { strength = 3.0, bodies = [\"plate\", \"wall\"] }");
        let error = error.expect_err("the wall has no mass").to_string();
        assert_eq!(
            error,
            "force[0].mutual_gravity.bodies: body \"wall\" is fixed and has no mass to attract with"
        );
    }

    #[test]
    fn pushes_act_where_the_scene_says() {
        use crate::force::{Moving, Snapshot, Wrench, Wrenches};
        let push = |force: &str, time: f64| {
            let world = world(&format!("[[force]]\n{force}")).expect("a fine world");
            let moving: Vec<_> = world.bodies().map(|body| Moving::from(&world.state(body))).collect();
            let mut sums = vec![Wrench::default(); moving.len()];
            let law = world.forces().next().expect("the force was added");
            law.apply(&Snapshot::new(time, &moving), &mut Wrenches::new(&mut sums));
            (sums[0].force, sums[0].torque)
        };
        let up = glam::DVec2::new(0.0, 2.0);
        let body =
            "constant = { body = \"plate\", point = [3, 1], force = [0, 2], frame = \"body\", torque = 0.5 }";
        // The direction turns with the body, whose angle is read from a segment.
        let (force, torque) = push(body, 0.0);
        assert!((force - up).length() < 1e-15 && (torque - 6.5).abs() < 1e-14, "{force}, {torque}");
        let fixed = "constant = { body = \"plate\", point = [3, 1], force = [0, 2] }";
        assert_eq!(push(fixed, 0.0), (up, 4.0));
        // Time counts from the start of the run.
        let turning = "rotating = { body = \"plate\", point = [3, 1], magnitude = 2, rate = 1, phase = 0 }";
        let (force, torque) = push(turning, 3.0);
        assert!(
            (force - glam::DVec2::new(2.0, 0.0)).length() < 1e-15 && torque.abs() < 1e-15,
            "{force}, {torque}"
        );
    }

    #[test]
    fn accelerations_of_laws_at_the_start_scale_the_thresholds() {
        let velocity_tol = |force: f64| {
            let forces =
                format!("[[force]]\nconstant = {{ body = \"plate\", point = [1, 5], force = [{force}, 0] }}");
            world(&forces).expect("a fine world").tolerances().velocity_tol
        };
        assert!((velocity_tol(40.0) / velocity_tol(10.0) - 2.0).abs() < 1e-12);
    }

    /// The world of a scene, or the error of building it, without the check for fields that are not simulated yet.
    fn built(text: &str) -> Result<World, SceneError> {
        let scene = Scene::parse(text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
        collect(&scene)?.build().map_err(|error| located(error, &scene))
    }

    const CONNECTORS: &str = r#"
        format = "halfgap-scene-1"
        title = "Connectors"
        run = { duration = 1.0 }

        [[body]]
        name = "bob"
        shape = { disc = { radius = 0.5 } }
        center_of_mass = [0.0, 0.25]
        position = [0.0, 1.0]
        mass = 2.0
    "#;

    #[test]
    fn every_kind_of_connector_is_built_from_a_scene() {
        let connectors = r#"
            [[connector]]
            pin = { a = { body = "world", point = [0, 0.75] }, b = { body = "bob", point = [0, 0] } }
            [[connector]]
            slot = { a = { body = "bob", point = [0, 0.25] }, b = { body = "world", point = [0, 9] }, normal = [3, 0], elasticity = 0.5 }
            [[connector]]
            rod = { a = { body = "bob", point = [0, 0.25] }, b = { body = "world", point = [3, 5] }, length = 5 }
            [[connector]]
            rope = { a = { body = "bob", point = [0, 0.25] }, b = { body = "world", point = [3, 5] }, length = 6 }
            [[connector]]
            rail = { a = { body = "bob", point = [0, 0.25] }, path = { points = [[0, 1], [1, 1], [1, 2], [0, 2]] }, closed = true }
            [[connector]]
            rail_stop = { a = { body = "bob", point = [0, 0.25] }, path = { points = [[0, 1], [1, 1], [1, 2], [0, 2]] }, at = 1, upper = true }"#;
        let world = built(&format!("{CONNECTORS}{connectors}")).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(world.start_correction(), 0.0);
        let elasticities: Vec<_> = world.connectors().iter().map(|one| one.elasticity).collect();
        assert_eq!(elasticities, [0.0, 0.5, 0.0, 1.0, 0.0, 1.0]);
        let paths: Vec<_> = world.connectors().iter().filter_map(|one| one.path()).collect();
        assert!(std::sync::Arc::ptr_eq(paths[0], paths[1]) && paths[0].is_closed(), "one closed path");
    }

    #[test]
    fn connectors_that_cannot_be_are_named_with_their_field() {
        let message = |connector: &str| {
            let text = format!("{CONNECTORS}[[connector]]\n{connector}");
            built(&text).expect_err("it cannot be").to_string()
        };
        let pin =
            "pin = { a = { body = \"bob\", point = [0, 0] }, b = { body = \"world\", point = [0, 0.5] } }";
        assert_eq!(
            message(pin),
            "connector[0].pin: connector 0 (pin of \"bob\" and \"world\") is off by 0.25 m at the start; at most \
             7.5e-7 m are allowed"
        );
        let path = "path = { start = [0, 0], edges = [{ line = [2, 0] }] }";
        let stop = format!(
            "rail_stop = {{ a = {{ body = \"bob\", point = [0, 0] }}, {path}, at = 3, upper = true }}"
        );
        assert_eq!(
            message(&stop),
            "connector[0].rail_stop.at: a stop must lie on its rail, between 0 and 2 m, got 3 m"
        );
        let path = "path = { points = [[0, 0], [0, 0]] }";
        let rail = format!("rail = {{ a = {{ body = \"bob\", point = [0, 0] }}, {path} }}");
        assert_eq!(
            message(&rail),
            "connector[0].rail.path: point 1 of the rail coincides with the point before it"
        );
    }

    #[test]
    fn every_reference_scene_can_be_built() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/scenes");
        let mut count = 0;
        for entry in std::fs::read_dir(folder).expect("the reference scenes are there") {
            let file = entry.expect("a readable entry").path();
            let scene = Scene::read(&file).unwrap_or_else(|error| panic!("{error}"));
            let builder = collect(&scene).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let world = builder.build().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let off = (0..u32::try_from(scene.connectors.len()).unwrap_or(0))
                .map(|index| world.connector_error(halfgap_collision::ConnectorId(index)))
                .fold(0.0, f64::max);
            assert!(off < 1e-12, "{}: a connector is off by {off} m", file.display());
            count += 1;
        }
        assert!(count >= 88);
    }
}
