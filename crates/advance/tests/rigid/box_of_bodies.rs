//! Scenes of the tests: bodies in a square box of four walls.

use glam::DVec2;
use halfgap_advance::ode::Method;
use halfgap_advance::rigid::{
    AdvanceError, BodyPart, FreeMotion, RigidParts, RigidSettings, RigidSystem, StepControl,
};
use halfgap_advance::{Time, advance_until};
use halfgap_collision::{Body, BodyId, BodyState, SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};
use halfgap_geometry::{Pose, Relation, Shape};

pub(crate) const TOLERANCES: Tolerances =
    Tolerances { target_gap: 1e-10, accuracy: 0.6e-10, velocity_tol: 1e-9 };

pub(crate) const SETTINGS: RigidSettings = RigidSettings {
    tolerances: TOLERANCES,
    impact_law: ImpactLaw::Hybrid,
    order: ImpactOrder::Fastest,
    restitution: Restitution::Energetic,
    collisions: true,
    search: SearchSettings::STANDARD,
    method: Method::Dop853,
    steps: StepControl { local_error: 1e-11, length: 1.0, speed: 1.0, largest_step: None },
    projection: true,
    extra: None,
    impulse_step: None,
    without: halfgap_advance::rigid::RemedySet::NONE,
    joint_small_impacts: false,
    rest_speed: 1e-12,
    resolution_time: 1e-10,
    region_steps: None,
};

/// SplitMix64: the same scenes on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn vector(&mut self, size: f64) -> DVec2 {
        DVec2::new(self.between(-size, size), self.between(-size, size))
    }
}

/// A body of uniform density 1 kg/m^2 about its centroid.
pub(crate) fn body(shape: &Shape, state: BodyState) -> BodyPart {
    let mass = shape.mass_properties();
    let body = Body {
        shape: shape.translated(-mass.centroid),
        inverse_mass: 1.0 / mass.area,
        inverse_moment: 1.0 / (mass.area * mass.moment_per_mass),
        elasticity: 1.0,
    };
    BodyPart::new(body, FreeMotion::default(), state)
}

pub(crate) fn fixed(shape: &Shape, position: DVec2) -> BodyPart {
    let body = Body { shape: shape.clone(), inverse_mass: 0.0, inverse_moment: 0.0, elasticity: 1.0 };
    BodyPart::new(body, FreeMotion::default(), BodyState { position, ..BodyState::default() })
}

pub(crate) fn disc(radius: f64) -> Shape {
    Shape::disc(radius).expect("a fine radius")
}

pub(crate) fn block(width: f64, height: f64) -> Shape {
    Shape::block(width, height).expect("fine sides")
}

pub(crate) fn moving(position: DVec2, velocity: DVec2, angular_velocity: f64) -> BodyState {
    BodyState { position, velocity, angular_velocity, angle: 0.0 }
}

/// Four walls around the square [0, size]^2.
pub(crate) fn walls(size: f64) -> Vec<BodyPart> {
    let half = 0.5 * size;
    let (long, tall) = (block(size + 2.0, 1.0), block(1.0, size));
    vec![
        fixed(&long, DVec2::new(half, -0.5)),
        fixed(&long, DVec2::new(half, size + 0.5)),
        fixed(&tall, DVec2::new(-0.5, half)),
        fixed(&tall, DVec2::new(size + 0.5, half)),
    ]
}

/// Walls and bodies of the given shapes in the cells of a square grid, each cell a little larger than any of them.
pub(crate) fn crowd(shapes: &[Shape], speed: f64, random: &mut Random) -> Vec<BodyPart> {
    let cell = 2.2 * shapes.iter().map(Shape::reach).fold(0.0, f64::max);
    let columns = (shapes.len() as f64).sqrt().ceil();
    let mut parts = walls(cell * columns);
    for (index, shape) in shapes.iter().enumerate() {
        let place = DVec2::new((index as f64) % columns, (index as f64 / columns).floor());
        let state = BodyState {
            position: (place + DVec2::splat(0.5)) * cell + random.vector(0.02 * cell),
            angle: random.between(-3.0, 3.0),
            velocity: random.vector(speed),
            angular_velocity: random.between(-speed, speed),
        };
        parts.push(body(shape, state));
    }
    parts
}

pub(crate) fn discs_in_a_box(count: usize, random: &mut Random) -> Vec<BodyPart> {
    let shapes: Vec<Shape> = (0..count).map(|_| disc(random.between(0.1, 0.3))).collect();
    crowd(&shapes, 1.0, random)
}

pub(crate) fn system(bodies: Vec<BodyPart>) -> RigidSystem {
    system_of(RigidParts { bodies, ..RigidParts::default() }, Time::ZERO)
}

pub(crate) fn system_of(parts: RigidParts, start: Time) -> RigidSystem {
    RigidSystem::new(parts, SETTINGS, start).expect("forces at the start can be found")
}

pub(crate) fn advance(system: &mut RigidSystem, until: f64) -> Result<(), AdvanceError> {
    advance_until(system, Time::from_seconds(until), |_, _| {})
}

pub(crate) fn bodies(system: &RigidSystem) -> impl Iterator<Item = BodyId> + use<> {
    (0..system.body_count() as u32).map(BodyId)
}

pub(crate) fn states(system: &RigidSystem, time: f64) -> Vec<BodyState> {
    bodies(system).map(|body| system.trajectory(body).state_at(Time::from_seconds(time))).collect()
}

pub(crate) fn energy(system: &RigidSystem, time: f64) -> f64 {
    let of = |body: BodyId| {
        let trajectory = system.trajectory(body);
        let (state, inertia) = (trajectory.state_at(Time::from_seconds(time)), trajectory.body());
        if inertia.is_fixed() {
            return 0.0;
        }
        let spin = state.angular_velocity;
        0.5 * (state.velocity.length_squared() / inertia.inverse_mass + spin * spin / inertia.inverse_moment)
    };
    bodies(system).map(of).sum()
}

/// Least distance of any two bodies, by looking at all of them; negative if two overlap.
pub(crate) fn least_distance(system: &RigidSystem, time: f64) -> (f64, [BodyId; 2]) {
    let states = states(system, time);
    let mut least = (f64::INFINITY, [BodyId(0); 2]);
    for a in bodies(system) {
        for b in bodies(system).filter(|&b| b > a) {
            let (body_a, body_b) = (system.trajectory(a).body(), system.trajectory(b).body());
            let (state_a, state_b) = (&states[a.index()], &states[b.index()]);
            let apart =
                (state_a.position - state_b.position).length() - body_a.shape.reach() - body_b.shape.reach();
            if (body_a.is_fixed() && body_b.is_fixed()) || apart > least.0 {
                continue;
            }
            let pose = |state: &BodyState| Pose::new(state.position, state.angle);
            let found = body_a.shape.distance(&pose(state_a), &body_b.shape, &pose(state_b));
            let distance = if found.relation == Relation::Apart {
                found.distance
            } else {
                -f64::EPSILON - found.distance
            };
            if distance < least.0 {
                least = (distance, [a, b]);
            }
        }
    }
    least
}
