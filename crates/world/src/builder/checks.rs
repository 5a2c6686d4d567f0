//! Checks of the input of a world: names, numbers out of range, unknown bodies, coordinates that are too large.

use super::{BodySpec, WorldBuilder, centered, largest_radius};
use crate::connector::ConnectorSpec;
use crate::settings::{AdvanceBy, Stabilization, ToleranceOverrides};
use crate::world::{BACKGROUND, Inertia};
use crate::world_error::{ConnectorName, WorldError};
use glam::DVec2;
use halfgap_advance::rigid::{FreeMotion, PairRule, PairSurface, Scales};
use halfgap_collision::{Anchor, BodyId, Connector, ConnectorKind, RailPath, Tolerances};
use halfgap_geometry::{Aabb, Pose};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Largest size of a coordinate [m], velocity [m/s, rad/s] or acceleration [m/s²]: areas, moments and distances take up to fourth powers of
/// sums of them, which must not overflow.
pub(crate) const LARGEST: f64 = 1e60;

/// Smallest target gap or accuracy that may be given, as a fraction of the smallest target gap that would be derived.
const GIVEN_SHARE: f64 = 1.0 / 64.0;

/// Least distance of two opposite stops of a closed rail, as a fraction of a lap.
const BACK_TO_BACK: f64 = 2e-3;

/// Point, path, place [m] and side of a rail's stop.
type Stop<'a> = (&'a Anchor, &'a Arc<RailPath>, f64, bool);

impl WorldBuilder {
    /// Checks names, numbers and references to bodies, in the order in which they were added.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let mut names = BTreeSet::new();
        for body in &self.bodies {
            if !names.insert(body.name.as_str()) {
                return Err(WorldError::DoubleName { name: body.name.clone() });
            }
            if body.name.is_empty() || body.name == BACKGROUND {
                return Err(WorldError::BadName { name: body.name.clone() });
            }
            check_body(body)?;
            let is_by_events = self.settings.strategy == AdvanceBy::Events;
            if is_by_events && body.surface.resists() && !self.projects() {
                return Err(WorldError::FrictionWithoutForces { body: body.name.clone() });
            }
        }
        for (body, law) in self.bodies.iter().zip(&self.free_motions) {
            check_flight(body, law)?;
        }
        for (index, spec) in self.connectors.iter().enumerate() {
            let named: Vec<_> = spec.connector.all_bodies().collect();
            self.check_bodies(&named, || format!("connector {index}"))?;
            let bad = |source| WorldError::BadConnector { connector: self.connector_name(index), source };
            spec.connector.check().map_err(bad)?;
            self.require_near(index, &spec.connector, LARGEST)?;
        }
        self.check_stops()?;
        self.check_contradictions()?;
        for law in &self.forces {
            self.check_bodies(law.bodies(), || format!("force \"{}\"", law.name()))?;
        }
        for &(a, b) in &self.excluded {
            self.check_bodies(&[a, b], || "let_pass".to_owned())?;
        }
        for (bodies, rule) in &self.pairs {
            self.check_bodies(bodies, || "set_pair".to_owned())?;
            self.check_pair(*bodies, rule)?;
        }
        self.check_settings()
    }

    /// True if contacts carry forces and are projected, as friction needs it in events.
    fn projects(&self) -> bool {
        self.settings.contacts && self.settings.stabilization == Stabilization::Projection
    }

    /// Refuses a pair that sticks less than it is held back when it slips, and numbers out of range.
    fn check_pair(&self, bodies: [BodyId; 2], rule: &PairRule) -> Result<(), WorldError> {
        let [Some(a), Some(b)] = bodies.map(|body| self.bodies.get(body.index())) else {
            return Ok(());
        };
        let body = || a.name.clone();
        if rule.resists() && self.settings.strategy == AdvanceBy::Events && !self.projects() {
            return Err(WorldError::FrictionWithoutForces { body: body() });
        }
        let bad = |quantity, rule, value| Err(WorldError::BadNumber { body: body(), quantity, rule, value });
        let shares = [
            ("elasticity of a pair", rule.elasticity),
            ("tangential elasticity of a pair", rule.tangential_elasticity),
        ];
        for (quantity, value) in shares {
            if let Some(value) = value.filter(|value| !(0.0..=1.0).contains(value)) {
                return bad(quantity, "between 0 and 1", value);
            }
        }
        let sizes = [
            ("friction of a pair", rule.friction),
            ("static friction of a pair", rule.static_friction),
            ("rolling resistance of a pair", rule.rolling_resistance),
        ];
        for (quantity, value) in sizes {
            if let Some(value) = value.filter(|value| !(*value >= 0.0 && value.is_finite())) {
                return bad(quantity, "finite, and not negative", value);
            }
        }
        let together = rule.apply(PairSurface::of([&a.surface, &b.surface]));
        if together.sticking < together.kinetic && rule.static_friction.is_some() {
            return bad("static friction of a pair", "at least its friction", together.sticking);
        }
        Ok(())
    }

    fn check_settings(&self) -> Result<(), WorldError> {
        let bad = |setting, rule, value| Err(WorldError::BadSetting { setting, rule, value });
        let positive = [
            ("tolerance", Some(self.settings.tolerance)),
            ("target_gap", self.settings.overrides.target_gap),
            ("accuracy", self.settings.overrides.accuracy),
            ("velocity_tol", self.settings.overrides.velocity_tol),
            ("time_step", self.settings.time_step),
            ("usual_speed", self.settings.usual_speed),
        ];
        for (setting, value) in positive {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return bad(setting, "positive and finite", value);
            }
        }
        if self.settings.tolerance > 1.0 {
            return bad("tolerance", "at most 1", self.settings.tolerance);
        }
        if !self.settings.start_time.is_finite() {
            return bad("start_time", "finite", self.settings.start_time);
        }
        let not_negative = [
            ("start_overlap", self.settings.start_overlap),
            ("start_connector_error", self.settings.start_connector_error),
            ("duration", self.settings.duration),
        ];
        for (setting, value) in not_negative {
            if let Some(value) = value.filter(|value| !(*value >= 0.0 && value.is_finite())) {
                return bad(setting, "finite, and not negative", value);
            }
        }
        Ok(())
    }

    /// Refuses an accuracy with which gaps of the target zone would not be positive, and a target gap or accuracy that
    /// rounding of coordinates would swamp.
    pub(super) fn check_zone(&self, tolerances: &Tolerances, scales: &Scales) -> Result<(), WorldError> {
        let ToleranceOverrides { target_gap, accuracy, .. } = self.settings.overrides;
        if let Some(value) = accuracy.filter(|&value| value >= tolerances.target_gap) {
            return Err(WorldError::WideAccuracy { accuracy: value, target_gap: tolerances.target_gap });
        }
        // Only movable bodies count: a floor may extend to where nothing moves.
        let movable = self.bodies.iter().filter(|body| body.inertia.is_some());
        let reach = |body: &BodySpec| farthest_in(&centered(body).bounds_at(&body.state.pose()));
        let coordinate = movable.map(reach).fold(0.0, f64::max);
        let least = GIVEN_SHARE * Scales { coordinate, ..*scales }.smallest_gap();
        for (setting, value) in [("target_gap", target_gap), ("accuracy", accuracy)] {
            if let Some(value) = value.filter(|&value| value < least) {
                return Err(WorldError::LostInRounding { setting, value, least, coordinate });
            }
        }
        Ok(())
    }

    /// Refuses a duration, but for none at all, in which the speed that crosses the scene would be too large.
    pub(super) fn check_duration(&self, scales: &Scales) -> Result<(), WorldError> {
        let least = scales.coordinate / LARGEST;
        let short = self.settings.duration.filter(|&duration| duration > 0.0 && duration < least);
        short.map_or(Ok(()), |duration| Err(WorldError::ShortDuration { duration, least }))
    }

    /// Refuses coordinates and radii so large that their rounding hides gaps as small as the smallest movable body.
    pub(super) fn check_resolution(&self, scales: &Scales) -> Result<(), WorldError> {
        let Some(largest) = scales.largest_coordinate() else { return Ok(()) };
        let bodies = self.bodies.iter().filter(|_| scales.coordinate > largest);
        let mut far = bodies.map(|body| (body, farthest_in(&centered(body).bounds_at(&body.state.pose()))));
        if let Some((body, value)) = far.find(|&(_, value)| value > largest) {
            return Err(too_large(body, "coordinates", largest, value));
        }
        let mut radii = self.bodies.iter().map(|body| (body, largest_radius(&body.shape)));
        if let Some((body, value)) = radii.find(|&(_, value)| value > largest) {
            return Err(too_large(body, "radii", largest, value));
        }
        let mut connectors = self.connectors.iter().enumerate();
        connectors.try_for_each(|(index, spec)| self.require_near(index, &spec.connector, largest))
    }

    fn require_near(&self, index: usize, connector: &Connector, largest: f64) -> Result<(), WorldError> {
        let value = farthest(connector);
        if value <= largest {
            return Ok(());
        }
        Err(WorldError::FarConnector { connector: self.connector_name(index), largest, value })
    }

    /// Refuses stops that lie back to back on a closed rail: a point between them would be beyond one of them.
    fn check_stops(&self) -> Result<(), WorldError> {
        let stops = || {
            self.connectors.iter().enumerate().filter_map(|(index, spec)| match &spec.connector.kind {
                ConnectorKind::RailStop { a, path, at, upper } => Some((index, (a, path, *at, *upper))),
                _ => None,
            })
        };
        for (first, (a, path, at, upper)) in stops() {
            let is_back_to_back =
                |&(second, (other_a, other_path, other_at, other_upper)): &(usize, Stop<'_>)| {
                    let laps = (at - other_at) / path.length();
                    let apart = (laps - laps.round()).abs();
                    let same = second > first && other_a == a && other_path == path && path.is_closed();
                    same && upper != other_upper && apart < BACK_TO_BACK
                };
            if let Some((second, _)) = stops().find(is_back_to_back) {
                let stops = Box::new([first, second].map(|index| self.connector_name(index)));
                return Err(WorldError::StopsBackToBack { stops });
            }
        }
        Ok(())
    }

    pub(super) fn connector_name(&self, index: usize) -> ConnectorName {
        let name = |body: BodyId| self.bodies.get(body.index()).map(|body| body.name.as_str());
        let ConnectorSpec { connector, name: own, .. } = &self.connectors[index];
        ConnectorName::new((index, own.as_deref()), connector, name)
    }

    fn check_bodies(&self, bodies: &[BodyId], what: impl Fn() -> String) -> Result<(), WorldError> {
        let count = self.bodies.len();
        match bodies.iter().find(|body| !body.is_world() && body.index() >= count) {
            Some(body) => Err(WorldError::NoSuchBody { what: what(), body: body.0, bodies: count }),
            None => Ok(()),
        }
    }
}

/// Refuses gravity that is not finite, and damping that is not finite or negative.
fn check_flight(body: &BodySpec, law: &FreeMotion) -> Result<(), WorldError> {
    let bad =
        |quantity, rule, value| Err(WorldError::BadNumber { body: body.name.clone(), quantity, rule, value });
    if let Some(value) = law.acceleration.to_array().into_iter().find(|value| !value.is_finite()) {
        return bad("gravity", "finite", value);
    }
    if let Some(value) =
        law.acceleration.to_array().into_iter().find(|value| body.inertia.is_some() && !is_sound(*value))
    {
        return Err(too_large(body, "gravity", LARGEST, value));
    }
    for (quantity, value) in [("damping by mass", law.linear_rate), ("damping by moment", law.angular_rate)] {
        if !(value >= 0.0 && value.is_finite()) {
            return bad(quantity, "finite, and not negative", value);
        }
    }
    Ok(())
}

/// Size of the largest coordinate of a connector [m], on a body or in the world.
fn farthest(connector: &Connector) -> f64 {
    let anchors = connector.anchors().into_iter().flatten();
    let sizes = anchors.map(|anchor| anchor.point.abs().max_element());
    sizes.fold(world_bounds(connector).map_or(0.0, |bounds| farthest_in(&bounds)), f64::max)
}

/// Bounds of a connector's points and path that are fixed in the world; `None` if it has none.
pub(super) fn world_bounds(connector: &Connector) -> Option<Aabb> {
    let anchors = connector.anchors().into_iter().flatten().filter(|anchor| anchor.body.is_world());
    let wheels = connector.wheels().into_iter().flatten();
    let points = anchors.map(|anchor| anchor.point).chain(wheels).map(Aabb::around);
    let path = connector.path().map(|path| path.bounds());
    points.chain(path).reduce(Aabb::union)
}

fn check_body(body: &BodySpec) -> Result<(), WorldError> {
    let bad =
        |quantity, rule, value| Err(WorldError::BadNumber { body: body.name.clone(), quantity, rule, value });
    if !(0.0..=1.0).contains(&body.elasticity) {
        return bad("elasticity", "between 0 and 1", body.elasticity);
    }
    let state = &body.state;
    let numbers = [
        ("position", state.position.x),
        ("position", state.position.y),
        ("angle", state.angle),
        ("velocity", state.velocity.x),
        ("velocity", state.velocity.y),
        ("angular velocity", state.angular_velocity),
    ];
    if let Some((quantity, value)) = numbers.into_iter().find(|(_, value)| !value.is_finite()) {
        return bad(quantity, "finite", value);
    }
    if body.motion.as_ref().is_some_and(|motion| !motion.is_finite()) {
        return bad("motion", "of finite numbers", f64::NAN);
    }
    let bounds = body.shape.bounds_at(&Pose::IDENTITY);
    let corners = [bounds.min, bounds.max].into_iter().flat_map(|corner| [corner.x, corner.y]);
    let center = body.center_of_mass.unwrap_or(DVec2::ZERO);
    let sizes = numbers.into_iter().filter(|(quantity, _)| *quantity != "angle");
    let mut sizes = sizes
        .chain([center.x, center.y].map(|value| ("centre of mass", value)))
        .chain(corners.map(|value| ("coordinates of the shape", value)));
    if let Some((quantity, value)) = sizes.find(|(_, value)| !is_sound(*value)) {
        return Err(too_large(body, quantity, LARGEST, value));
    }
    // Last, as a bad shape or centre of mass makes a bad moment.
    if let Some(Inertia { mass, moment }) = body.inertia {
        for (quantity, value) in [("mass", mass), ("moment", moment)] {
            if !(value > 0.0 && value.is_finite()) {
                return bad(quantity, "positive and finite", value);
            }
            if !(1.0 / value).is_normal() {
                return bad(quantity, "of a size whose inverse is a number", value);
            }
        }
    }
    Ok(())
}

fn too_large(body: &BodySpec, quantity: &'static str, largest: f64, value: f64) -> WorldError {
    WorldError::TooLarge { body: body.name.clone(), quantity, largest, value }
}

/// True for a coordinate or velocity that can be computed with.
fn is_sound(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Size of the largest coordinate within some bounds [m].
fn farthest_in(bounds: &Aabb) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}
