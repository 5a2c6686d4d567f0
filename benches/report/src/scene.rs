//! A scene as every engine gets it: bodies, connectors, gravity, and the states that a perfect run would reach.
//!
//! Nothing here is of one engine: how arcs are cut into segments, or thresholds derived, is for the engines' modules.

use crate::on_joint::OnJoint;
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{self, EdgeSpec, PathSpec};

/// A scene with its known answer.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of files and of rows: lower case, underscores.
    pub name: String,
    /// One line for people.
    pub about: String,
    /// The bodies; connectors and states refer to them by their index here.
    pub bodies: Vec<Body>,
    /// The connectors.
    pub connectors: Vec<Connector>,
    /// What acts on the free coordinates of connectors, each with the connector's index.
    pub on_joints: Vec<(usize, OnJoint)>,
    /// The springs.
    pub springs: Vec<Spring>,
    /// Acceleration of all movable bodies [m/s^2].
    pub gravity: DVec2,
    /// False if bodies pass through each other.
    pub collisions: bool,
    /// End time [s]; a scene starts at 0.
    pub duration: f64,
    /// All check times are multiples of this [s], and so may be those of steps.
    pub check_grid: f64,
    /// States that are known, in order of time.
    pub checks: Vec<Check>,
    /// Method by which the checks were computed.
    pub reference: String,
    /// Error of the checks themselves [m].
    pub reference_error: f64,
}

/// A body. The origin of its shape's coordinates is its centre of mass.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Mass and moment; `None` for a fixed body.
    pub inertia: Option<Inertia>,
    /// State at the start.
    pub start: BodyState,
    /// Share of the closing speed with which it leaves an impact. All bodies of a scene that collide have the same, for
    /// engines differ in how they combine two.
    pub elasticity: f64,
    /// Its friction. All bodies of a scene that touch have the same coefficients, for engines differ in how they combine two.
    pub surface: Surface,
    /// Angular velocity at which a fixed body turns [rad/s].
    pub spin: f64,
}

/// Friction of a body's surface, by Coulomb's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Coefficient where it slips [-].
    pub friction: f64,
    /// Coefficient up to which it sticks [-], not below the other.
    pub static_friction: f64,
    /// Speed at which it runs along the outline [m/s], counter-clockwise positive: a belt.
    pub speed: f64,
}

impl Surface {
    /// Without friction.
    pub const SMOOTH: Self = Self::rough(0.0);

    /// With one coefficient [-].
    #[must_use]
    pub const fn rough(friction: f64) -> Self {
        Self { friction, static_friction: friction, speed: 0.0 }
    }
}

/// Mass and moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre of mass [kg m^2].
    pub moment: f64,
}

impl Inertia {
    /// Radius of gyration [m].
    #[must_use]
    pub fn gyration(&self) -> f64 {
        (self.moment / self.mass).sqrt()
    }
}

/// The shape of a body.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A disc about the origin.
    Disc {
        /// Its radius [m].
        radius: f64,
    },
    /// A rectangle about the origin.
    Block {
        /// Size along x [m].
        width: f64,
        /// Size along y [m].
        height: f64,
    },
    /// A convex polygon about its centroid: corners, counter-clockwise [m].
    Polygon(Vec<DVec2>),
    /// All points within a radius of a convex polygon.
    Rounded {
        /// Corners of the polygon, counter-clockwise [m].
        corners: Vec<DVec2>,
        /// The radius [m].
        radius: f64,
    },
    /// The solid that closed paths of lines and arcs surround; only discs may collide with it.
    Outline(Vec<PathSpec>),
}

/// One end of a connector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// The body; `None` for the background.
    pub body: Option<usize>,
    /// The point in the body's coordinates, or in those of the world [m].
    pub point: DVec2,
}

/// A connector.
#[derive(Clone, Debug)]
pub enum Connector {
    /// Keeps two points together.
    Pin(End, End),
    /// Keeps two points exactly a length [m] apart.
    Rod(End, End, f64),
    /// Keeps the centre of a body on a line through a point of the world, along a unit vector.
    Guide {
        /// The body.
        body: usize,
        /// A point of the line [m].
        point: DVec2,
        /// Its direction.
        axis: DVec2,
    },
    /// Keeps the centre of a body on a line through a point of the world, along a unit vector, and the body from turning.
    Slider {
        /// The body.
        body: usize,
        /// A point of the line [m].
        point: DVec2,
        /// Its direction.
        axis: DVec2,
    },
    /// Keeps the centre of a body on the natural cubic spline through points [m].
    Rail {
        /// The body.
        body: usize,
        /// The points.
        points: Vec<DVec2>,
    },
}

/// Scenes that stand in one picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Neither friction nor anything that acts on joints.
    Smooth,
    /// Contacts have friction.
    Friction,
    /// Something acts on a joint.
    MotorsAndLimits,
}

/// A spring that pulls two points together with stiffness (length - rest length).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// One end.
    pub a: End,
    /// The other end.
    pub b: End,
    /// Length without force [m].
    pub rest_length: f64,
    /// Force per length [N/m].
    pub stiffness: f64,
}

impl Spring {
    /// Force on its first end [N], with the places of its ends [m].
    #[must_use]
    pub fn force(&self, a: DVec2, b: DVec2) -> DVec2 {
        let offset = b - a;
        self.stiffness * (offset - self.rest_length * offset.normalize_or_zero())
    }
}

/// Known states at one time.
#[derive(Clone, Debug)]
pub struct Check {
    /// The time [s].
    pub time: f64,
    /// Bodies and their states.
    pub states: Vec<(usize, BodyState)>,
}

impl Scene {
    /// A scene of the given bodies in which nothing is known yet.
    #[must_use]
    pub fn new(name: &str, about: &str, bodies: Vec<Body>) -> Self {
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            bodies,
            connectors: Vec::new(),
            on_joints: Vec::new(),
            springs: Vec::new(),
            gravity: DVec2::ZERO,
            collisions: true,
            duration: 0.0,
            check_grid: 0.0,
            checks: Vec::new(),
            reference: String::new(),
            reference_error: 0.0,
        }
    }

    /// Ends the scene at its last check, which all lie on a grid of times.
    #[must_use]
    pub fn with_checks(mut self, grid: f64, checks: Vec<Check>) -> Self {
        self.duration = checks.last().map_or(0.0, |check| check.time);
        self.check_grid = grid;
        self.checks = checks;
        self
    }

    /// Sets the method by which the checks were computed, and their error [m].
    #[must_use]
    pub fn with_reference(mut self, how: &str, error: f64) -> Self {
        how.clone_into(&mut self.reference);
        self.reference_error = error;
        self
    }

    /// Sets the method by which the checks were computed.
    #[must_use]
    pub fn with_method(mut self, how: &str) -> Self {
        how.clone_into(&mut self.reference);
        self
    }

    /// True if its answer is known; of other scenes only the time is measured.
    #[must_use]
    pub fn has_answer(&self) -> bool {
        !self.checks.is_empty()
    }

    /// True if some body is rough.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.bodies.iter().any(|body| body.surface.static_friction > 0.0)
    }

    /// What acts on a connector.
    #[must_use]
    pub fn on_joint(&self, connector: usize) -> OnJoint {
        let found = self.on_joints.iter().find(|(index, _)| *index == connector);
        found.map(|&(_, on_joint)| on_joint).unwrap_or_default()
    }

    /// The group in whose picture the scene is.
    #[must_use]
    pub fn group(&self) -> Group {
        match (self.on_joints.is_empty(), self.has_friction()) {
            (false, _) => Group::MotorsAndLimits,
            (true, true) => Group::Friction,
            (true, false) => Group::Smooth,
        }
    }

    /// True if some shape has arcs that are no full circle, which engines of segments must cut up.
    #[must_use]
    pub fn has_arcs(&self) -> bool {
        let is_arc = |edge: &EdgeSpec| !matches!(edge, EdgeSpec::Line { .. });
        let has_arcs = |path: &PathSpec| path.edges.iter().any(is_arc);
        self.bodies.iter().any(|body| match &body.shape {
            Shape::Outline(paths) => paths.iter().any(has_arcs),
            Shape::Disc { .. } | Shape::Block { .. } | Shape::Polygon(_) | Shape::Rounded { .. } => false,
        })
    }

    /// Kinetic energy and that of gravity and springs [J].
    #[must_use]
    pub fn energy(&self, states: &[BodyState]) -> f64 {
        let energy = |body: &Body, state: &BodyState| {
            body.inertia.map_or(0.0, |inertia| {
                let kinetic = inertia.mass * state.velocity.length_squared()
                    + inertia.moment * state.angular_velocity * state.angular_velocity;
                0.5 * kinetic - inertia.mass * self.gravity.dot(state.position)
            })
        };
        let stretched = |spring: &Spring| {
            let length = (self.place(&spring.b, states) - self.place(&spring.a, states)).length();
            0.5 * spring.stiffness * (length - spring.rest_length).powi(2)
        };
        let of_bodies: f64 = self.bodies.iter().zip(states).map(|(body, state)| energy(body, state)).sum();
        of_bodies + self.springs.iter().map(stretched).sum::<f64>()
    }

    /// Error of states at a check [m]: the largest error of a position, and of an angle times the radius
    /// of gyration.
    #[must_use]
    pub fn error(&self, check: &Check, states: &[BodyState]) -> f64 {
        let error = |(body, known): &(usize, BodyState)| {
            let state = &states[*body];
            let turn = (state.angle - known.angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
            let lever = self.bodies[*body].inertia.map_or(0.0, |inertia| inertia.gyration());
            let turned = lever * (turn - std::f64::consts::PI).abs();
            (state.position - known.position).length().max(turned)
        };
        // A state that is not finite is infinitely wrong.
        let worst = |worst: f64, error: f64| if error.is_nan() { f64::INFINITY } else { worst.max(error) };
        check.states.iter().map(error).fold(0.0, worst)
    }

    /// World position of an end of a connector [m].
    #[must_use]
    pub fn place(&self, end: &End, states: &[BodyState]) -> DVec2 {
        end.body.map_or(end.point, |body| {
            states[body].position + DVec2::from_angle(states[body].angle).rotate(end.point)
        })
    }

    /// Largest error of a connector [m]; rails are left out.
    #[must_use]
    pub fn connector_error(&self, states: &[BodyState]) -> f64 {
        let error = |connector: &Connector| match connector {
            Connector::Pin(a, b) => (self.place(a, states) - self.place(b, states)).length(),
            Connector::Rod(a, b, length) => {
                ((self.place(a, states) - self.place(b, states)).length() - length).abs()
            }
            Connector::Guide { body, point, axis } | Connector::Slider { body, point, axis } => {
                (states[*body].position - *point).perp_dot(*axis).abs()
            }
            Connector::Rail { .. } => 0.0,
        };
        self.connectors.iter().map(error).fold(0.0, f64::max)
    }
}

impl Shape {
    /// The shape as geometry has it, with the same origin.
    ///
    /// # Errors
    /// It is none: a size is not positive, or lines cross.
    pub fn geometry(&self) -> Result<geometry::Shape, geometry::ShapeError> {
        match self {
            Self::Disc { radius } => geometry::Shape::disc(*radius),
            Self::Block { width, height } => geometry::Shape::block(*width, *height),
            Self::Polygon(corners) => geometry::Shape::from_paths(&[PathSpec::polygon(corners)]),
            Self::Rounded { corners, radius } => geometry::Shape::from_paths(&[rounded(corners, *radius)]),
            Self::Outline(paths) => geometry::Shape::from_paths(paths),
        }
    }
}

impl Body {
    /// An elastic body without friction.
    fn smooth(name: &str, shape: Shape, inertia: Option<Inertia>, start: BodyState) -> Self {
        let name = name.to_owned();
        Self { name, shape, inertia, start, elasticity: 1.0, surface: Surface::SMOOTH, spin: 0.0 }
    }

    /// A fixed body with the origin of its shape at a place [m].
    #[must_use]
    pub fn fixed(name: &str, shape: Shape, position: DVec2) -> Self {
        let start = BodyState { position, ..BodyState::default() };
        Self::smooth(name, shape, None, start)
    }

    /// A disc of uniform density and a given mass [kg] that moves without turning.
    #[must_use]
    pub fn disc(name: &str, radius: f64, mass: f64, position: DVec2, velocity: DVec2) -> Self {
        let start = BodyState { position, velocity, ..BodyState::default() };
        let inertia = Some(Inertia { mass, moment: 0.5 * mass * radius * radius });
        let shape = Shape::Disc { radius };
        Self::smooth(name, shape, inertia, start)
    }

    /// A rectangle of uniform density and a given mass [kg].
    #[must_use]
    pub fn block(name: &str, size: DVec2, mass: f64, start: BodyState) -> Self {
        let inertia = Some(Inertia { mass, moment: mass * size.length_squared() / 12.0 });
        let shape = Shape::Block { width: size.x, height: size.y };
        Self::smooth(name, shape, inertia, start)
    }

    /// A convex polygon about its centroid, grown by a radius [m], of uniform density [kg/m^2].
    ///
    /// # Panics
    /// If the corners make no polygon.
    #[must_use]
    pub fn rounded(name: &str, corners: &[DVec2], radius: f64, density: f64, start: BodyState) -> Self {
        let shape = halfgap::geometry::Shape::from_paths(&[rounded(corners, radius)]).expect("a polygon");
        let of_shape = shape.mass_properties();
        let mass = density * of_shape.area;
        let inertia = Inertia { mass, moment: mass * of_shape.moment_per_mass };
        let shape = Shape::Rounded { corners: corners.to_vec(), radius };
        Self::smooth(name, shape, Some(inertia), start)
    }

    /// The body with friction.
    #[must_use]
    pub fn with_friction(self, friction: f64) -> Self {
        Self { surface: Surface::rough(friction), ..self }
    }

    /// The body with another elasticity.
    #[must_use]
    pub fn with_elasticity(self, elasticity: f64) -> Self {
        Self { elasticity, ..self }
    }
}

/// Outline of all points within a radius [m] of a convex polygon.
#[must_use]
pub fn rounded(corners: &[DVec2], radius: f64) -> PathSpec {
    let count = corners.len();
    let out = |index: usize| {
        let along = corners[(index + 1) % count] - corners[index % count];
        -radius * along.normalize().perp()
    };
    let edges = (0..count).flat_map(|index| {
        let (center, out) = (corners[(index + 1) % count], [out(index), out(index + 1)]);
        let arc = EdgeSpec::Arc { to: center + out[1], center, clockwise: false };
        [EdgeSpec::Line { to: center + out[0] }, arc]
    });
    PathSpec { start: corners[0] + out(0), edges: edges.collect() }
}

impl End {
    /// A point of a body [m].
    #[must_use]
    pub fn body(body: usize, point: DVec2) -> Self {
        Self { body: Some(body), point }
    }

    /// A point of the world [m].
    #[must_use]
    pub fn world(point: DVec2) -> Self {
        Self { body: None, point }
    }
}
