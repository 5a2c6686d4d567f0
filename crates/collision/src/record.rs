//! The collision record: everything that is known of one place where two bodies touch or are about to.

use crate::body::BodyId;
use crate::estimate::{EstimatePoint, estimate_target_time};
use crate::kinematics::{Arms, GapKinematics};
use crate::motion::Moving;
use crate::tolerances::Tolerances;
use glam::DVec2;
use halfgap_geometry::{FeatureId, FeatureKind, GapSample, Shape};

/// What found a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detector {
    /// A vertex near a vertex.
    CornerCorner,
    /// A vertex near an edge.
    VertexEdge,
    /// Two edges, at least one of them an arc.
    EdgeEdge,
}

/// One body's side of a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Participant {
    /// The body.
    pub body: BodyId,
    /// The feature of its shape.
    pub feature: FeatureId,
    /// What kind of feature that is.
    pub kind: FeatureKind,
    /// Index of the path.
    pub path: u32,
    /// Index of the edge; for a vertex, of the edge that starts at it.
    pub edge: u32,
}

impl Participant {
    /// Describes a feature of a body's shape.
    #[must_use]
    pub fn new(body: BodyId, shape: &Shape, feature: FeatureId) -> Self {
        let source = shape.source(feature);
        Self { body, feature, kind: source.kind, path: source.path, edge: source.edge }
    }
}

/// Who collides, and how that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parties {
    /// The body that the normal points to.
    pub primary: Participant,
    /// The body that the normal points out of.
    pub normal: Participant,
    /// True if the gap may neither close nor open.
    pub bilateral: bool,
    /// What found it.
    pub detector: Detector,
}

/// Where the bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// Point of the primary body that touches [m].
    pub point_primary: DVec2,
    /// Point of the normal body that touches [m].
    pub point_normal: DVec2,
    /// Unit normal, from the normal body to the primary one.
    pub normal: DVec2,
    /// True if the normal is fixed in the world.
    pub normal_is_fixed: bool,
    /// Time derivative of the normal [1/s].
    pub normal_rate: DVec2,
    /// Distance [m] along the normal; negative for penetration.
    pub distance: f64,
    /// Distance [m] by which the impact lies beyond the ends of its edges; 0 within them. A vertex has no ends.
    pub outside: f64,
    /// Signed radius of curvature of the primary body at the impact [m]; `None` where it is straight.
    pub radius_primary: Option<f64>,
    /// Signed radius of curvature of the normal body at the impact [m]; `None` where it is straight.
    pub radius_normal: Option<f64>,
    /// R1: from the primary centre of mass to the impact point [m].
    pub impact_arm_primary: DVec2,
    /// R2: from the normal centre of mass to the impact point [m].
    pub impact_arm_normal: DVec2,
    /// U1, U2: from the centres of mass to the arcs' centres [m]; R where there is no arc.
    pub arms: Arms,
}

impl ContactGeometry {
    /// Unit tangent: the normal turned +90 degrees.
    #[must_use]
    pub fn tangent(&self) -> DVec2 {
        self.normal.perp()
    }

    /// True if the primary body is an arc at the impact.
    #[must_use]
    pub fn primary_is_curved(&self) -> bool {
        self.radius_primary.is_some_and(|radius| radius != 0.0)
    }

    /// True if the normal body is an arc at the impact.
    #[must_use]
    pub fn normal_is_curved(&self) -> bool {
        self.radius_normal.is_some_and(|radius| radius != 0.0)
    }
}

/// How the bodies move at the place where they touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactMotion {
    /// Velocity of the primary impact point relative to the normal one [m/s].
    pub impact_velocity: DVec2,
    /// Its component along the tangent [m/s].
    pub lateral_velocity: f64,
    /// Velocity of the primary arc's centre relative to the normal one [m/s].
    pub center_velocity: DVec2,
    /// Rate of the distance [m/s]; negative when closing.
    pub normal_velocity: f64,
    /// Derivative of the rate by the bodies' velocities, and the acceleration that velocities alone cause.
    pub kinematics: GapKinematics,
}

/// What was seen when the collision was first detected, before the back-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Time [s].
    pub time: f64,
    /// Distance [m].
    pub distance: f64,
    /// Normal velocity [m/s].
    pub normal_velocity: f64,
}

/// What was done about the collision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Lesser of the two bodies' elasticities.
    pub elasticity: f64,
    /// Impulse applied along the normal [N s].
    pub impulse: Option<f64>,
    /// Contact force along the normal [N].
    pub force: Option<f64>,
}

/// A collision record was used against its rules.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CollisionError {
    /// Detection is set once.
    #[error("the collision of bodies {primary} and {normal} was already detected at {time} s")]
    AlreadyDetected {
        /// Index of the primary body.
        primary: u32,
        /// Index of the normal body.
        normal: u32,
        /// When it was detected [s].
        time: f64,
    },
}

/// One place where two bodies touch or are about to. Absent values are `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Who collides.
    pub parties: Parties,
    /// Where.
    pub geometry: ContactGeometry,
    /// How fast.
    pub motion: ContactMotion,
    /// Thresholds of this collision: a tight fit has its own.
    pub tolerances: Tolerances,
    /// What was done about it.
    pub response: Response,
    /// True if it must be handled: it was found penetrating before the back-up, or someone says so.
    pub must_handle: bool,
    /// Time [s] of the last update of geometry and motion.
    pub updated: f64,
    detection: Option<Detection>,
    estimate: Option<f64>,
}

impl Collision {
    /// The record of a measured gap at a time [s].
    #[must_use]
    pub fn new(
        parties: Parties,
        measured: (&GapSample, [Option<f64>; 2]),
        bodies: [&Moving; 2],
        tolerances: Tolerances,
        elasticity: f64,
        time: f64,
    ) -> Self {
        let (geometry, motion) = describe(measured.0, measured.1, bodies);
        let mut record = Self {
            parties,
            geometry,
            motion,
            tolerances,
            response: Response { elasticity, ..Response::default() },
            must_handle: false,
            updated: time,
            detection: None,
            estimate: None,
        };
        record.must_handle = record.is_illegal();
        record
    }

    /// Distance [m] beyond the target gap; negative when nearer.
    #[must_use]
    pub fn distance_to_target(&self) -> f64 {
        self.geometry.distance - self.tolerances.target_gap
    }

    /// What was seen at first detection, if that has been noted.
    #[must_use]
    pub fn detection(&self) -> Option<&Detection> {
        self.detection.as_ref()
    }

    /// Time [s] at which the distance reaches the target gap, if that is estimated.
    #[must_use]
    pub fn estimate(&self) -> Option<f64> {
        self.estimate
    }

    /// Notes the record's present state as that of its first detection.
    ///
    /// # Errors
    /// If it was noted before: the first detection stays.
    pub fn note_detection(&mut self) -> Result<(), CollisionError> {
        if let Some(detection) = self.detection {
            let (primary, normal) = (self.parties.primary.body.0, self.parties.normal.body.0);
            return Err(CollisionError::AlreadyDetected { primary, normal, time: detection.time });
        }
        self.detection = Some(Detection {
            time: self.updated,
            distance: self.geometry.distance,
            normal_velocity: self.motion.normal_velocity,
        });
        Ok(())
    }

    /// Brings geometry and motion to another time [s], earlier after a back-up, and estimates anew when the distance
    /// reaches the target gap.
    ///
    /// `must_handle` stays true once it was: the collision happened, even though the bodies are apart again.
    pub fn update(&mut self, measured: (&GapSample, [Option<f64>; 2]), bodies: [&Moving; 2], time: f64) {
        (self.geometry, self.motion) = describe(measured.0, measured.1, bodies);
        self.updated = time;
        self.must_handle |= self.is_illegal();
        self.estimate = self.detection.and_then(|seen| {
            let later = EstimatePoint {
                time: seen.time,
                distance: seen.distance,
                normal_velocity: seen.normal_velocity,
            };
            let earlier = EstimatePoint {
                time,
                distance: self.geometry.distance,
                normal_velocity: self.motion.normal_velocity,
            };
            estimate_target_time(earlier, later, self.tolerances.target_gap)
        });
    }

    /// True if the body takes part.
    #[must_use]
    pub fn involves_body(&self, body: BodyId) -> bool {
        self.parties.primary.body == body || self.parties.normal.body == body
    }

    /// True if the given edge of the body takes part.
    #[must_use]
    pub fn involves_edge(&self, body: BodyId, path: u32, edge: u32) -> bool {
        self.involves(body, path, edge, |kind| kind != FeatureKind::Vertex)
    }

    /// True if the vertex of the body at which the given edge starts takes part.
    #[must_use]
    pub fn involves_vertex(&self, body: BodyId, path: u32, edge: u32) -> bool {
        self.involves(body, path, edge, |kind| kind == FeatureKind::Vertex)
    }

    fn involves(&self, body: BodyId, path: u32, edge: u32, of_kind: impl Fn(FeatureKind) -> bool) -> bool {
        [self.parties.primary, self.parties.normal]
            .iter()
            .any(|side| side.body == body && side.path == path && side.edge == edge && of_kind(side.kind))
    }
}

/// By how much a contact lies beyond the ends of its line, or of its arcs.
fn outside(sample: &GapSample, radii: [Option<f64>; 2]) -> f64 {
    let excess = [sample.excess_primary, sample.excess_normal];
    let beyond = |side: usize| excess[side] * radii[side].map_or(0.0, f64::abs);
    sample.overrun.max(beyond(0)).max(beyond(1))
}

fn describe(
    sample: &GapSample,
    radii: [Option<f64>; 2],
    [primary, normal]: [&Moving; 2],
) -> (ContactGeometry, ContactMotion) {
    let kinematics = GapKinematics::of(sample, primary, normal);
    let impact_arm_primary = sample.point_primary - primary.pose.position;
    let impact_arm_normal = sample.point_normal - normal.pose.position;
    let geometry = ContactGeometry {
        point_primary: sample.point_primary,
        point_normal: sample.point_normal,
        normal: sample.normal,
        normal_is_fixed: false,
        normal_rate: kinematics.normal_rate,
        distance: sample.gap,
        outside: outside(sample, radii),
        radius_primary: radii[0],
        radius_normal: radii[1],
        impact_arm_primary,
        impact_arm_normal,
        arms: Arms::of(sample, primary, normal),
    };
    let impact_velocity = primary.velocity_at(impact_arm_primary) - normal.velocity_at(impact_arm_normal);
    let motion = ContactMotion {
        impact_velocity,
        lateral_velocity: geometry.tangent().dot(impact_velocity),
        center_velocity: kinematics.center_velocity,
        normal_velocity: kinematics.rate,
        kinematics,
    };
    (geometry, motion)
}
