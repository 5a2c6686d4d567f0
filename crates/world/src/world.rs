//! (stand-in) A world in which bodies fly freely.

use glam::DVec2;
use halfgap_geometry::Shape;

/// Index of a body in the order of the scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub u32);

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Position of the centre of mass [m].
    pub position: DVec2,
    /// Angle, not reduced [rad].
    pub angle: f64,
    /// Velocity of the centre of mass [m/s].
    pub velocity: DVec2,
    /// Angular velocity [rad/s].
    pub angular_velocity: f64,
}

/// Energy of a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Kinetic [J].
    pub kinetic: f64,
    /// Potential [J].
    pub potential: f64,
}

impl Energy {
    /// Kinetic and potential [J].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
}

/// Counters of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Steps.
    pub steps: u64,
    /// Evaluations of forces.
    pub evaluations: u64,
    /// Impacts.
    pub impacts: u64,
    /// Back-ups.
    pub backups: u64,
    /// Contact solves.
    pub contact_solves: u64,
    /// Smallest gap seen [m].
    pub smallest_gap: Option<f64>,
    /// Largest connector error seen [m].
    pub largest_connector_error: Option<f64>,
}

/// One row of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRow {
    /// Primary body.
    pub primary: BodyId,
    /// Normal body.
    pub normal_body: BodyId,
    /// Where [m].
    pub point: DVec2,
    /// From the normal body to the primary one.
    pub normal: DVec2,
    /// Gap [m].
    pub gap: f64,
    /// Normal velocity before [m/s].
    pub velocity_before: f64,
    /// Normal velocity after [m/s].
    pub velocity_after: f64,
    /// Impulse [N·s].
    pub impulse: f64,
}

/// An impact.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// When [s].
    pub time: f64,
    /// Its rows.
    pub rows: Vec<ImpactRow>,
    /// Change of the energy [J].
    pub energy_change: f64,
}

/// How a run stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It could not go on.
    Stuck,
    /// No forces satisfy the constraints.
    Infeasible,
}

/// Why a run stopped early.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// It could not go on.
    #[error("stuck at {time} s: bodies {bodies}")]
    Stuck {
        /// When [s].
        time: f64,
        /// Which.
        bodies: String,
    },
}

impl RunError {
    /// Which kind.
    #[must_use]
    pub fn status(&self) -> Status {
        Status::Stuck
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Flyer {
    pub(crate) name: String,
    pub(crate) fixed: bool,
    pub(crate) shape: Shape,
    pub(crate) mass: f64,
    pub(crate) moment: f64,
    pub(crate) acceleration: DVec2,
    pub(crate) state: BodyState,
}

/// Bodies that fly freely.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) time: f64,
    pub(crate) bodies: Vec<Flyer>,
}

impl World {
    /// Now [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of bodies.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Name of a body.
    #[must_use]
    pub fn name(&self, body: BodyId) -> &str {
        &self.bodies[body.0 as usize].name
    }

    /// Whether it is immovable.
    #[must_use]
    pub fn is_fixed(&self, body: BodyId) -> bool {
        self.bodies[body.0 as usize].fixed
    }

    /// Its shape in body coordinates.
    #[must_use]
    pub fn shape(&self, body: BodyId) -> &Shape {
        &self.bodies[body.0 as usize].shape
    }

    /// Its state now.
    #[must_use]
    pub fn state(&self, body: BodyId) -> BodyState {
        self.bodies[body.0 as usize].state
    }

    /// The energy now.
    #[must_use]
    pub fn energy(&self) -> Energy {
        let mut energy = Energy { kinetic: 0.0, potential: 0.0 };
        for body in self.bodies.iter().filter(|body| !body.fixed) {
            let state = &body.state;
            energy.kinetic += 0.5 * body.mass * state.velocity.length_squared()
                + 0.5 * body.moment * state.angular_velocity * state.angular_velocity;
            energy.potential -= body.mass * body.acceleration.dot(state.position);
        }
        energy
    }

    /// Counters.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        Statistics::default()
    }

    /// Goes on to a time [s].
    ///
    /// # Errors
    /// A body named `sticky` stops the world after one second.
    pub fn advance_to(&mut self, time: f64, on_impact: &mut dyn FnMut(&Impact)) -> Result<(), RunError> {
        let stop = if self.bodies.iter().any(|body| body.name == "sticky") { 1.0 } else { f64::INFINITY };
        let step = time.min(stop) - self.time;
        for body in self.bodies.iter_mut().filter(|body| !body.fixed) {
            let state = &mut body.state;
            state.position += state.velocity * step + 0.5 * body.acceleration * step * step;
            state.velocity += body.acceleration * step;
            state.angle += state.angular_velocity * step;
        }
        self.time = time.min(stop);
        if self.bodies.iter().any(|body| body.name == "pretend") {
            let state = self.bodies[1].state;
            on_impact(&Impact {
                time: self.time,
                rows: vec![ImpactRow {
                    primary: BodyId(1),
                    normal_body: BodyId(0),
                    point: state.position,
                    normal: DVec2::Y,
                    gap: 0.01,
                    velocity_before: -1.0,
                    velocity_after: 1.0,
                    impulse: 2.0,
                }],
                energy_change: 0.0,
            });
        }
        if time > stop { Err(RunError::Stuck { time: stop, bodies: "\"sticky\"".into() }) } else { Ok(()) }
    }
}
