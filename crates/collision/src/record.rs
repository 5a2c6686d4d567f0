//! The collision record: all data of one place where two bodies touch or are about to.
//!
//! It is what an advance decides by. The predicates are those of its [`GapState`], which two features or a rope have as
//! well without a record; the record adds what a gap alone cannot tell: where and when it was found, and whether it must
//! be handled although its gap is open again.
//!
//! *Invariant*: geometry and motion are those at the time `updated`, the detection is that of the first moment, and
//! `must_handle` once true stays true.

use crate::body::BodyId;
use crate::connector::{Connector, ConnectorId, ConnectorSample};
use crate::estimate::EstimatePoint;
use crate::gap_state::GapState;
use crate::kinematics::{Arms, GapKinematics};
use crate::motion::Moving;
use crate::tolerances::Tolerances;
use crate::zone::Zone;
use glam::DVec2;
use halfgap_geometry::{FeatureId, FeatureKind, GapSample, Shape};
use std::ops::RangeInclusive;

/// Origin of a collision record: the kinds of the two features, or a row of a connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Detector {
    /// A vertex near a vertex.
    CornerCorner,
    /// A vertex near an edge.
    VertexEdge,
    /// Two edges, at least one of them an arc.
    EdgeEdge,
    /// A row of a connector, which is not detected.
    Connector {
        /// The connector.
        id: ConnectorId,
        /// Index of the row in the connector.
        row: u32,
    },
}

/// One body's side of a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Participant {
    /// The body.
    pub body: BodyId,
    /// The part of the body's shape that touches; `None` in a connector, which ties points that may lie anywhere.
    pub site: Option<Site>,
}

/// Part of a shape that takes part in a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Site {
    /// The feature of the shape.
    pub feature: FeatureId,
    /// Kind of the feature.
    pub kind: FeatureKind,
    /// Index of the path.
    pub path: u32,
    /// Index of the edge; for a vertex, of the edge that starts at it.
    pub edge: u32,
}

impl Participant {
    /// The side of a body that touches with a feature of its shape.
    ///
    /// # Panics
    /// If the feature is not one of the shape's.
    #[must_use]
    #[inline]
    pub fn new(body: BodyId, shape: &Shape, feature: FeatureId) -> Self {
        let source = shape.source(feature);
        let site = Site { feature, kind: source.kind, path: source.path, edge: source.edge };
        Self { body, site: Some(site) }
    }

    /// The side of a body to which a connector is tied.
    #[must_use]
    #[inline]
    pub fn of_connector(body: BodyId) -> Self {
        Self { body, site: None }
    }

    /// The feature of the body's shape that touches; `None` in a connector.
    #[must_use]
    #[inline]
    pub fn feature(&self) -> Option<FeatureId> {
        self.site.map(|site| site.feature)
    }
}

/// The two sides of a collision, and its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Parties {
    /// The body that the normal points to.
    pub primary: Participant,
    /// The body that the normal points out of.
    pub normal: Participant,
    /// A third body, and the coefficient [m] of its angular velocity in the rate of the gap: as [`Connector::third`].
    pub third: Option<(BodyId, f64)>,
    /// True if the gap may neither close nor open.
    pub bilateral: bool,
    /// Origin of the record.
    pub detector: Detector,
}

/// Place, normal and distance of a collision, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
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
    /// Distance [m] by which the impact point lies beyond the ends of its edges; 0 within them. A vertex has no ends.
    pub outside: f64,
    /// Signed radius of curvature of the primary body at the impact [m]; `None` where it is straight.
    pub radius_primary: Option<f64>,
    /// Signed radius of curvature of the normal body at the impact [m]; `None` where it is straight.
    pub radius_normal: Option<f64>,
    /// Arm R1 from the primary centre of mass to the impact point [m].
    pub impact_arm_primary: DVec2,
    /// Arm R2 from the normal centre of mass to the impact point [m].
    pub impact_arm_normal: DVec2,
    /// Arms U1 and U2 from the centres of mass to the arcs' centres [m]; R1 and R2 on sides without an arc.
    pub arms: Arms,
}

impl ContactGeometry {
    /// Unit tangent: the normal turned +90 degrees.
    #[must_use]
    #[inline]
    pub fn tangent(&self) -> DVec2 {
        self.normal.perp()
    }
}

/// Velocities of the bodies at the place where they touch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactMotion {
    /// Velocity of the primary impact point relative to the normal one [m/s].
    pub impact_velocity: DVec2,
    /// Component of `impact_velocity` along [`ContactGeometry::tangent`] [m/s].
    pub lateral_velocity: f64,
    /// Velocity of the primary arc's centre relative to that of the normal arc [m/s].
    pub center_velocity: DVec2,
    /// Rate of the distance [m/s]; negative when closing.
    pub normal_velocity: f64,
    /// What of it a drive prescribes [m/s]: no motion of the bodies has a share in it.
    pub prescribed: f64,
    /// Jacobian of the rate of the distance, and the part of its acceleration that velocities alone cause.
    pub kinematics: GapKinematics,
}

/// Response to a collision: restitution, impulse and force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Response {
    /// Coefficient of restitution [-]: the lesser of the two bodies' elasticities, or that of the connector.
    pub elasticity: f64,
    /// Impulse [N s] on the primary body along the normal; `None` until a caller sets it.
    pub impulse: Option<f64>,
    /// Contact force [N] on the primary body along the normal; `None` until a caller sets it.
    pub force: Option<f64>,
}

/// Record of one place where two bodies touch or are about to. Absent values are `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Collision {
    /// The two sides, and the origin of the record.
    pub parties: Parties,
    /// Place, normal and distance.
    pub geometry: ContactGeometry,
    /// Velocities at that place.
    pub motion: ContactMotion,
    /// Thresholds of this collision: a tight fit has its own.
    pub tolerances: Tolerances,
    /// Restitution, impulse and force.
    pub response: Response,
    /// True if the collision must be handled, however far apart its bodies are by now: it was found penetrating before the
    /// back-up, or a caller set this, as for the contact that caused an event, or a rope that is active.
    pub must_handle: bool,
    /// Time [s] of the last update of geometry and motion.
    pub updated: f64,
    detection: EstimatePoint,
}

impl Collision {
    /// The connector that the record is a row of; `None` for bodies that touch.
    #[must_use]
    #[inline]
    pub fn connector(&self) -> Option<ConnectorId> {
        match self.parties.detector {
            Detector::Connector { id, .. } => Some(id),
            _ => None,
        }
    }

    /// The record of a measured gap, given with the signed radii [m] of the primary and the normal feature (`None` for
    /// a line), at a time [s]. `bodies` are the primary and the normal body.
    #[must_use]
    #[inline]
    pub fn new(
        parties: Parties,
        measured: (&GapSample, [Option<f64>; 2]),
        bodies: [&Moving; 2],
        tolerances: Tolerances,
        elasticity: f64,
        time: f64,
    ) -> Self {
        let described = describe(measured.0, measured.1, bodies);
        Self::from_parts(parties, described, tolerances, elasticity, time)
    }

    /// The record of a connector's measured row for its bodies a and b at a time [s]; its target gap is 0.
    #[must_use]
    pub fn of_connector(
        id: ConnectorId,
        row: u32,
        connector: &Connector,
        sample: &ConnectorSample,
        bodies: [&Moving; 2],
        tolerances: &Tolerances,
        time: f64,
    ) -> Self {
        let [primary, normal] = connector.bodies().map(Participant::of_connector);
        let detector = Detector::Connector { id, row };
        let (third, bilateral) = (connector.third(), connector.is_bilateral());
        let parties = Parties { primary, normal, third, bilateral, detector };
        let tolerances = Tolerances { target_gap: 0.0, ..*tolerances };
        let described = describe_connector(connector, sample, bodies, time);
        Self::from_parts(parties, described, tolerances, connector.elasticity, time)
    }

    fn from_parts(
        parties: Parties,
        (geometry, motion): (ContactGeometry, ContactMotion),
        tolerances: Tolerances,
        elasticity: f64,
        time: f64,
    ) -> Self {
        let detection =
            EstimatePoint { time, distance: geometry.distance, normal_velocity: motion.normal_velocity };
        let mut record = Self {
            parties,
            geometry,
            motion,
            tolerances,
            response: Response { elasticity, ..Response::default() },
            must_handle: false,
            updated: time,
            detection,
        };
        record.must_handle = record.gap_state().is_illegal(0.0);
        record
    }

    /// Distance [m] beyond the target gap; negative when nearer.
    #[must_use]
    #[inline]
    pub fn distance_to_target(&self) -> f64 {
        self.geometry.distance - self.tolerances.target_gap
    }

    /// True if a corner touches something that is not straight: the normal turns about it.
    #[must_use]
    #[inline]
    pub fn turns_about_corner(&self) -> bool {
        let radii = [self.geometry.radius_primary, self.geometry.radius_normal];
        radii.contains(&Some(0.0)) && !radii.contains(&None)
    }

    /// The distance and its rate, as the predicates take them.
    #[must_use]
    #[inline]
    pub fn gap_state(&self) -> GapState {
        GapState {
            distance: self.geometry.distance,
            normal_velocity: self.motion.normal_velocity,
            bilateral: self.parties.bilateral,
            tolerances: self.tolerances,
        }
    }

    /// True for a contact or a connector's row that may be active: one by its gap ([`GapState::is_contact`]), or one that
    /// must be handled, at whatever gap, if its rate is in `rates` [m/s].
    #[must_use]
    #[inline]
    pub fn is_contact(&self, rates: RangeInclusive<f64>) -> bool {
        (self.must_handle && rates.contains(&self.motion.normal_velocity))
            || self.gap_state().is_contact(rates)
    }

    /// True if the record may be handled now: it must be, or it is at its target but for the distance `above` [m], or it
    /// closes faster than `rest` [m/s] in the target zone or nearer.
    ///
    /// A gap in the upper half of the zone that rests or opens has room left, and is handled when it closes.
    #[must_use]
    #[inline]
    pub fn is_close_enough(&self, above: f64, rest: f64) -> bool {
        let gap = self.gap_state();
        self.must_handle || gap.is_at_target(above) || (gap.zone() >= Zone::Target && gap.closes(rest))
    }

    /// The state in which the collision was first found, before the back-up.
    #[must_use]
    #[inline]
    pub fn detection(&self) -> &EstimatePoint {
        &self.detection
    }

    /// Updates geometry and motion to another time [s] (an earlier one after a back-up), from a gap and radii as in
    /// [`Collision::new`].
    ///
    /// `must_handle`, once true, stays true: the collision happened, even though the bodies are apart again.
    #[inline]
    pub fn update(&mut self, measured: (&GapSample, [Option<f64>; 2]), bodies: [&Moving; 2], time: f64) {
        self.update_parts(describe(measured.0, measured.1, bodies), time);
    }

    /// Updates the record of a connector's row to another time [s], as [`Collision::update`] does that of a contact.
    #[inline]
    pub fn update_connector(
        &mut self,
        connector: &Connector,
        sample: &ConnectorSample,
        bodies: [&Moving; 2],
        time: f64,
    ) {
        self.update_parts(describe_connector(connector, sample, bodies, time), time);
    }

    fn update_parts(&mut self, (geometry, motion): (ContactGeometry, ContactMotion), time: f64) {
        (self.geometry, self.motion) = (geometry, motion);
        self.updated = time;
        self.must_handle |= self.gap_state().is_illegal(0.0);
    }

    /// Ids of the primary and of the normal body.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> [BodyId; 2] {
        [self.parties.primary.body, self.parties.normal.body]
    }

    /// True if the body takes part.
    #[must_use]
    #[inline]
    pub fn involves_body(&self, body: BodyId) -> bool {
        self.bodies().contains(&body) || self.parties.third.is_some_and(|(third, _)| third == body)
    }
}

/// Distance [m] by which a contact lies beyond the ends of its line or of its arcs; 0 within them.
fn outside(sample: &GapSample, radii: [Option<f64>; 2]) -> f64 {
    let excess = [sample.excess_primary, sample.excess_normal];
    let beyond = |side: usize| excess[side] * radii[side].map_or(0.0, f64::abs);
    sample.overrun.max(beyond(0)).max(beyond(1))
}

fn describe(
    sample: &GapSample,
    radii: [Option<f64>; 2],
    bodies: [&Moving; 2],
) -> (ContactGeometry, ContactMotion) {
    let [primary, normal] = bodies;
    let kinematics = GapKinematics::of(sample, primary, normal);
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
        impact_arm_primary: sample.point_primary - primary.pose.position,
        impact_arm_normal: sample.point_normal - normal.pose.position,
        arms: Arms::of(sample, primary, normal),
    };
    (geometry, describe_motion(&geometry, kinematics, bodies))
}

fn describe_connector(
    connector: &Connector,
    sample: &ConnectorSample,
    bodies: [&Moving; 2],
    time: f64,
) -> (ContactGeometry, ContactMotion) {
    let [primary, normal] =
        [sample.point_a - bodies[0].pose.position, sample.point_b - bodies[1].pose.position];
    let [radius_primary, radius_normal] = connector.radii(sample);
    let geometry = ContactGeometry {
        point_primary: sample.point_a,
        point_normal: sample.point_b,
        normal: sample.normal,
        normal_is_fixed: connector.has_fixed_normal(),
        normal_rate: sample.kinematics.normal_rate,
        distance: sample.gap,
        outside: 0.0,
        radius_primary,
        radius_normal,
        impact_arm_primary: primary,
        impact_arm_normal: normal,
        arms: Arms { primary, normal },
    };
    let motion = describe_motion(&geometry, sample.kinematics, bodies);
    (geometry, ContactMotion { prescribed: connector.prescribed_rate(time), ..motion })
}

fn describe_motion(
    geometry: &ContactGeometry,
    kinematics: GapKinematics,
    [primary, normal]: [&Moving; 2],
) -> ContactMotion {
    let impact_velocity =
        primary.velocity_at(geometry.impact_arm_primary) - normal.velocity_at(geometry.impact_arm_normal);
    ContactMotion {
        impact_velocity,
        lateral_velocity: geometry.tangent().dot(impact_velocity),
        center_velocity: kinematics.center_velocity,
        normal_velocity: kinematics.rate,
        prescribed: 0.0,
        kinematics,
    }
}
