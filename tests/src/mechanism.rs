//! Bars, discs and connectors of the tests, placed by world coordinates.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{
    Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorId, ConnectorKind, ConnectorSpec, Event,
    Inertia, World, WorldBuilder, WorldSettings,
};

/// Gravity of the tests [m/s^2].
pub const GRAVITY: f64 = 10.0;

/// A builder of worlds with gravity on all movable bodies.
#[derive(Debug)]
pub struct Workshop {
    /// The builder, for parts that have no method here.
    pub builder: WorldBuilder,
    gravity: DVec2,
}

impl Workshop {
    /// A workshop without bodies, with the given settings.
    #[must_use]
    pub fn of(settings: WorldSettings) -> Self {
        Self { builder: WorldBuilder::new(settings), gravity: DVec2::new(0.0, -GRAVITY) }
    }

    /// A workshop without bodies, at a tolerance.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self::of(WorldSettings { tolerance, ..WorldSettings::default() })
    }

    /// A workshop without bodies, at a tolerance, whose bodies pass through each other.
    #[must_use]
    pub fn passing(tolerance: f64) -> Self {
        Self::of(WorldSettings { tolerance, collisions: false, ..WorldSettings::default() })
    }

    /// A workshop without bodies, at a tolerance, and without gravity.
    #[must_use]
    pub fn weightless(tolerance: f64) -> Self {
        Self::new(tolerance).without_gravity()
    }

    /// Switches gravity off for bodies that are added from now on.
    #[must_use]
    pub fn without_gravity(self) -> Self {
        Self { gravity: DVec2::ZERO, ..self }
    }

    /// A movable body of the given mass [kg].
    pub fn body(&mut self, name: &str, shape: Shape, mass: f64, state: BodyState) -> BodyId {
        self.spec(BodySpec::movable(name, shape, mass, state))
    }

    /// A movable body that does not bounce.
    pub fn dull(&mut self, name: &str, shape: Shape, mass: f64, state: BodyState) -> BodyId {
        self.spec(BodySpec { elasticity: 0.0, ..BodySpec::movable(name, shape, mass, state) })
    }

    /// A movable body of the given mass [kg] and elasticity.
    pub fn settler(
        &mut self,
        name: &str,
        shape: Shape,
        mass: f64,
        state: BodyState,
        elasticity: f64,
    ) -> BodyId {
        self.spec(BodySpec { elasticity, ..BodySpec::movable(name, shape, mass, state) })
    }

    /// A movable body of the given mass [kg] and moment [kg m^2].
    pub fn inert(&mut self, name: &str, shape: Shape, [mass, moment]: [f64; 2], state: BodyState) -> BodyId {
        let inertia = Some(Inertia { mass, moment });
        self.spec(BodySpec { inertia, ..BodySpec::movable(name, shape, mass, state) })
    }

    fn spec(&mut self, spec: BodySpec) -> BodyId {
        let body = self.builder.add(spec);
        self.builder.add_gravity(body, self.gravity);
        body
    }

    /// A fixed body.
    pub fn fixed(&mut self, name: &str, shape: Shape, position: DVec2) -> BodyId {
        self.builder.add(BodySpec::fixed(name, shape, position))
    }

    /// A bar of 1 kg between two points, a tenth of a metre thick.
    pub fn bar(&mut self, name: &str, from: DVec2, to: DVec2) -> BodyId {
        let along = to - from;
        let state =
            BodyState { position: 0.5 * (from + to), angle: along.to_angle(), ..BodyState::default() };
        self.body(name, block(along.length(), 0.1), 1.0, state)
    }

    /// The point of a body that lies at a given place of the world now.
    #[must_use]
    pub fn anchor(&self, body: BodyId, place: DVec2) -> Anchor {
        if body.is_world() {
            return Anchor { body, point: place };
        }
        Anchor { body, point: self.builder.body(body).state.pose().point_to_body(place) }
    }

    /// A pin of two bodies at a place of the world.
    pub fn pin(&mut self, a: BodyId, b: BodyId, place: DVec2) -> ConnectorId {
        let kind = ConnectorKind::Pin { a: self.anchor(a, place), b: self.anchor(b, place) };
        self.connect(kind, 0.0)
    }

    /// Any connector.
    pub fn connect(&mut self, kind: ConnectorKind, elasticity: f64) -> ConnectorId {
        let connector = Connector::new(kind, elasticity).expect("a fine connector");
        self.builder.add_connector(ConnectorSpec::new(connector))
    }

    /// The world.
    ///
    /// # Panics
    /// If it cannot be built: the test fails.
    #[must_use]
    pub fn build(self) -> World {
        self.builder.build().unwrap_or_else(|error| panic!("{error}"))
    }
}

/// A disc of a radius [m].
#[must_use]
pub fn disc(radius: f64) -> Shape {
    Shape::disc(radius).expect("a fine radius")
}

/// A block of a width and a height [m].
#[must_use]
pub fn block(width: f64, height: f64) -> Shape {
    Shape::block(width, height).expect("fine sides")
}

/// State of a body at rest at a place.
#[must_use]
pub fn at_rest(x: f64, y: f64) -> BodyState {
    BodyState { position: DVec2::new(x, y), ..BodyState::default() }
}

/// State of a body in motion without spin.
#[must_use]
pub fn thrown(x: f64, y: f64, velocity: DVec2) -> BodyState {
    BodyState { velocity, ..at_rest(x, y) }
}

/// Advances a world, and ignores its events.
///
/// # Panics
/// If it stops early: the test fails.
pub fn advance(world: &mut World, time: f64) {
    world.advance_to(time, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
}

/// Advances a world, and returns the time [s] at which the last contact has come to rest, with the bounces
/// that were cut off.
///
/// # Panics
/// If it stops early: the test fails.
pub fn rest_time(world: &mut World, until: f64) -> f64 {
    let mut last = 0.0;
    let mut note = |event: &Event| {
        if let Event::ContactBegins(begin) = event {
            last = begin.time + begin.bouncing.unwrap_or(0.0);
        }
    };
    world.advance_to(until, &mut note).unwrap_or_else(|error| panic!("{error}"));
    last
}

/// Largest error of any connector now [m].
#[must_use]
pub fn connector_error(world: &World) -> f64 {
    let count = u32::try_from(world.connectors().len()).unwrap_or(u32::MAX);
    (0..count).map(|index| world.connector_error(ConnectorId(index))).fold(0.0, f64::max)
}

/// Period [s] of a pendulum whose small swings have the angular frequency `rate` [rad/s], with an amplitude [rad]:
/// 2 pi over the rate and the arithmetic-geometric mean of 1 and cos(amplitude/2).
#[must_use]
pub fn pendulum_period(rate: f64, amplitude: f64) -> f64 {
    let (mut a, mut g) = (1.0, (0.5 * amplitude).cos());
    while (a - g).abs() > f64::EPSILON * a {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    std::f64::consts::TAU / (rate * a)
}
