//! The parts of a system, and the checks that refuse missing bodies and numbers out of range.

use crate::rigid::bodies::force_law::ForceLaw;
use crate::rigid::bodies::trajectory::FreeMotion;
use crate::rigid::settings::RigidSettings;
use crate::rigid::surface::Surface;
use crate::rigid::surfaces::PairRule;
use crate::time::Time;
use halfgap_collision::{Body, BodyId, BodyMotion, BodyState, Connector, ConnectorError, Tolerances};
use std::sync::Arc;

/// Parts of which a system is made.
#[derive(Clone, Debug, Default)]
pub struct RigidParts {
    /// Bodies with their laws of free flight and their states at the start. A [`BodyId`] is an index of this list.
    pub bodies: Vec<BodyPart>,
    /// Connectors between bodies, or between a body and the background.
    pub connectors: Vec<Connector>,
    /// Force laws beyond those of free flight.
    pub force_laws: Vec<Arc<dyn ForceLaw>>,
    /// Pairs of bodies that never collide with each other.
    pub excluded: Vec<(BodyId, BodyId)>,
    /// Pairs of bodies that differ from what their surfaces and elasticities say; of two rules for one pair the first holds.
    pub pairs: Vec<([BodyId; 2], PairRule)>,
}

/// A body, its law of free flight, and its state at the start.
#[derive(Clone, Debug)]
pub struct BodyPart {
    /// Shape, inverse mass [1/kg], inverse moment of inertia [1/(kg m^2)] and elasticity [-].
    pub body: Body,
    /// Uniform acceleration [m/s^2] and damping rates [1/s] in free flight; ignored for a fixed body.
    pub free_motion: FreeMotion,
    /// Position [m] of the centre of mass, angle [rad], velocity [m/s] and angular velocity [rad/s] at the start, in the
    /// world frame; both velocities are ignored for a fixed body.
    pub state: BodyState,
    /// What the surface does to bodies that touch it.
    pub surface: Surface,
    /// Motion of a fixed body that is moved. `None` for one that stays, ignored for a movable body.
    pub motion: Option<BodyMotion>,
}

impl BodyPart {
    /// Makes a body with a smooth surface, which stays where it is if it is fixed.
    #[must_use]
    pub fn new(body: Body, free_motion: FreeMotion, state: BodyState) -> Self {
        Self { body, free_motion, state, surface: Surface::default(), motion: None }
    }
}

/// Reason why no system can be made of some parts or settings.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartsError {
    /// A connector, a law or an excluded pair names a body that does not exist.
    #[error("{part} {index} names body {}, but there are {count} bodies", body.0)]
    NoSuchBody {
        /// Kind of the part.
        part: &'static str,
        /// Index of the part among those of its kind.
        index: usize,
        /// The missing body.
        body: BodyId,
        /// Number of bodies.
        count: usize,
    },
    /// A number of a body is out of range.
    #[error("the {quantity} of body {} must be {rule}, got {value}", body.0)]
    BadBody {
        /// The body.
        body: BodyId,
        /// Name of the quantity.
        quantity: &'static str,
        /// The rule that it breaks.
        rule: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number of a connector is out of range.
    #[error("connector {index}: {source}")]
    BadConnector {
        /// Index of the connector.
        index: usize,
        /// Error of the connector.
        source: ConnectorError,
    },
    /// A saved system is given another number of force laws than it had.
    #[error("{given} force laws are given to a saved system that had {count}")]
    OtherLaws {
        /// Number of laws given.
        given: usize,
        /// Number of laws that the system had.
        count: usize,
    },
    /// A setting is out of range.
    #[error("{setting} must be {rule}, got {value}")]
    BadSetting {
        /// Name of the setting.
        setting: &'static str,
        /// The rule that it breaks.
        rule: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Wording and test of a rule, and the named quantities that must keep to it.
type Rule<'a> = (&'static str, fn(f64) -> bool, &'a [(&'static str, f64)]);

pub(crate) const FINITE: (&str, fn(f64) -> bool) = ("finite", f64::is_finite);
const NOT_NEGATIVE: (&str, fn(f64) -> bool) =
    ("finite, and not negative", |value| value >= 0.0 && value.is_finite());
pub(crate) const POSITIVE: (&str, fn(f64) -> bool) =
    ("positive and finite", |value| value > 0.0 && value.is_finite());

impl RigidParts {
    /// Checks the parts, the settings and the time of the start [s].
    ///
    /// # Errors
    /// The first setting, body, connector or name that breaks its rule.
    pub(crate) fn check(&self, settings: &RigidSettings, start: Time) -> Result<(), PartsError> {
        check_settings(settings, start)?;
        if self.bodies.iter().any(|part| !part.body.is_fixed()) {
            check_zone(&settings.tolerances)?;
        }
        for (index, part) in self.bodies.iter().enumerate() {
            let body = BodyId(u32::try_from(index).unwrap_or(u32::MAX));
            let bad = |(quantity, rule, value)| PartsError::BadBody { body, quantity, rule, value };
            check_body(part).map_err(bad)?;
        }
        for &([body, _], rule) in &self.pairs {
            let bad = |(quantity, rule, value)| PartsError::BadBody { body, quantity, rule, value };
            check_pair(&rule).map_err(bad)?;
        }
        for (index, connector) in self.connectors.iter().enumerate() {
            connector.check().map_err(|source| PartsError::BadConnector { index, source })?;
        }
        self.check_names()
    }

    /// Refuses connectors, laws and pairs that name missing bodies.
    fn check_names(&self) -> Result<(), PartsError> {
        let count = self.bodies.len();
        let check = |part, index, body| check_named(part, index, body, count);
        for (index, connector) in self.connectors.iter().enumerate() {
            connector.all_bodies().try_for_each(|body| check("connector", index, body))?;
        }
        for (index, law) in self.force_laws.iter().enumerate() {
            check_bodies_of_force_law(index, law.as_ref(), count)?;
        }
        for (index, &(a, b)) in self.excluded.iter().enumerate() {
            [a, b].into_iter().try_for_each(|body| check("excluded pair", index, body))?;
        }
        for (index, &(bodies, _)) in self.pairs.iter().enumerate() {
            bodies.into_iter().try_for_each(|body| check("pair", index, body))?;
        }
        Ok(())
    }
}

fn check_named(part: &'static str, index: usize, body: BodyId, count: usize) -> Result<(), PartsError> {
    match body.is_world() || body.index() < count {
        true => Ok(()),
        false => Err(PartsError::NoSuchBody { part, index, body, count }),
    }
}

/// Refuses a law that names a body which is not among `count`.
pub(crate) fn check_bodies_of_force_law(
    index: usize,
    law: &dyn ForceLaw,
    count: usize,
) -> Result<(), PartsError> {
    law.bodies().iter().try_for_each(|&body| check_named("force law", index, body, count))
}

fn check_settings(settings: &RigidSettings, start: Time) -> Result<(), PartsError> {
    let RigidSettings { tolerances, steps, search, .. } = settings;
    // Settings that are zero where a scene has nothing to derive them from.
    let sizes = [
        ("target_gap", tolerances.target_gap),
        ("accuracy", tolerances.accuracy),
        ("velocity_tol", tolerances.velocity_tol),
        ("rest_speed", settings.rest_speed),
        ("resolution_time", settings.resolution_time),
        ("steps.length", steps.length),
        ("steps.speed", steps.speed),
        ("search.depth", search.depth),
        ("search.rest", search.rest),
    ];
    let largest_step = steps.largest_step.unwrap_or(1.0);
    let extra_time = settings.extra.map_or(1.0, |extra| extra.time);
    let steps = [
        ("steps.local_error", steps.local_error),
        ("steps.largest_step", largest_step),
        ("impulse_step", settings.impulse_step.unwrap_or(1.0)),
        ("extra.time", extra_time),
    ];
    let rules: [Rule<'_>; 3] = [
        (NOT_NEGATIVE.0, NOT_NEGATIVE.1, &sizes),
        (POSITIVE.0, POSITIVE.1, &steps),
        (FINITE.0, FINITE.1, &[("start", start.seconds())]),
    ];
    let bad = |(setting, rule, value)| PartsError::BadSetting { setting, rule, value };
    keep_to(&rules).map_err(bad)
}

/// Refuses a target gap or a zone of no width, which contacts of movable bodies need.
fn check_zone(&Tolerances { target_gap, accuracy, .. }: &Tolerances) -> Result<(), PartsError> {
    let sizes = [("target_gap", target_gap), ("accuracy", accuracy)];
    let bad = |(setting, rule, value)| PartsError::BadSetting { setting, rule, value };
    keep_to(&[(POSITIVE.0, POSITIVE.1, &sizes)]).map_err(bad)
}

fn check_body(BodyPart { body, free_motion, state, surface, motion }: &BodyPart) -> Result<(), Broken> {
    let sizes = [
        ("inverse mass", body.inverse_mass),
        ("inverse moment", body.inverse_moment),
        ("linear rate", free_motion.linear_rate),
        ("angular rate", free_motion.angular_rate),
        ("friction", surface.friction),
        ("static friction", surface.static_friction),
        ("rolling resistance", surface.rolling_resistance),
    ];
    let shares = [("elasticity", body.elasticity), ("tangential elasticity", surface.tangential_elasticity)];
    let numbers = [
        ("x", state.position.x),
        ("y", state.position.y),
        ("angle", state.angle),
        ("velocity.x", state.velocity.x),
        ("velocity.y", state.velocity.y),
        ("angular velocity", state.angular_velocity),
        ("acceleration.x", free_motion.acceleration.x),
        ("acceleration.y", free_motion.acceleration.y),
        ("surface velocity", surface.velocity),
    ];
    if motion.as_ref().is_some_and(|motion| !motion.is_finite()) {
        return Err(("motion", FINITE.0, f64::NAN));
    }
    keep_to(&[
        (NOT_NEGATIVE.0, NOT_NEGATIVE.1, &sizes),
        (FINITE.0, FINITE.1, &numbers),
        ("between 0 and 1", |value| (0.0..=1.0).contains(&value), &shares),
    ])?;
    if (body.inverse_mass > 0.0) != (body.inverse_moment > 0.0) {
        return Err(("inverse moment", "positive exactly if the inverse mass is", body.inverse_moment));
    }
    Ok(())
}

fn check_pair(rule: &PairRule) -> Result<(), Broken> {
    let or_none = |value: Option<f64>| value.unwrap_or(0.0);
    let sizes = [
        ("friction with its partner", or_none(rule.friction)),
        ("static friction with its partner", or_none(rule.static_friction)),
        ("rolling resistance with its partner", or_none(rule.rolling_resistance)),
    ];
    let shares = [
        ("elasticity with its partner", or_none(rule.elasticity)),
        ("tangential elasticity with its partner", or_none(rule.tangential_elasticity)),
    ];
    keep_to(&[
        (NOT_NEGATIVE.0, NOT_NEGATIVE.1, &sizes),
        ("between 0 and 1", |value| (0.0..=1.0).contains(&value), &shares),
    ])
}

/// A quantity, the rule that it breaks, and its value.
type Broken = (&'static str, &'static str, f64);

/// The first quantity that breaks its rule, if any.
pub(crate) fn keep_to(rules: &[Rule<'_>]) -> Result<(), Broken> {
    for &(rule, keeps, quantities) in rules {
        if let Some(&(quantity, value)) = quantities.iter().find(|(_, value)| !keeps(*value)) {
            return Err((quantity, rule, value));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::error::AdvanceError;

    use crate::rigid::settings::{ExtraAcceleration, StepControl};
    use crate::rigid::system::RigidSystem;
    use crate::rigid::test_scene::FINE;
    use glam::DVec2;
    use halfgap_collision::{Anchor, ConnectorKind};
    use halfgap_geometry::Shape;

    fn disc() -> BodyPart {
        let shape = Shape::disc(0.5).expect("a fine radius");
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 8.0, elasticity: 1.0 };
        BodyPart::new(body, FreeMotion::default(), BodyState::default())
    }

    /// The error message for a system of one disc after a change of its parts or settings.
    fn refused(change: impl FnOnce(&mut RigidParts, &mut RigidSettings)) -> String {
        let (mut parts, mut settings) = (RigidParts { bodies: vec![disc()], ..RigidParts::default() }, FINE);
        change(&mut parts, &mut settings);
        match RigidSystem::new(parts, settings, Time::ZERO) {
            Err(AdvanceError::Parts(error)) => error.to_string(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn missing_bodies_cannot_be_named() {
        let none = BodyId(1);
        let of_pair = refused(|parts, _| parts.excluded.push((BodyId(0), none)));
        assert_eq!(of_pair, "excluded pair 0 names body 1, but there are 1 bodies");
        let [a, b] = [BodyId::WORLD, none].map(|body| Anchor { body, point: DVec2::ZERO });
        let rod = Connector::new(ConnectorKind::Rod { a, b, length: 1.0 }, 0.0).expect("a fine rod");
        let of_rod = refused(|parts, _| parts.connectors.push(rod));
        assert_eq!(of_rod, "connector 0 names body 1, but there are 1 bodies");
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let of_body =
            |change: fn(&mut BodyPart)| refused(|parts, _| parts.bodies.iter_mut().for_each(change));
        let spin = of_body(|disc| disc.state.angular_velocity = f64::NAN);
        assert_eq!(spin, "the angular velocity of body 0 must be finite, got NaN");
        let mass = of_body(|disc| disc.body.inverse_mass = -1.0);
        assert_eq!(mass, "the inverse mass of body 0 must be finite, and not negative, got -1");
        let lively = of_body(|disc| disc.body.elasticity = 1.5);
        assert_eq!(lively, "the elasticity of body 0 must be between 0 and 1, got 1.5");
        let stiff = of_body(|disc| disc.body.inverse_moment = 0.0);
        assert_eq!(
            stiff,
            "the inverse moment of body 0 must be positive exactly if the inverse mass is, got 0"
        );
        let extra = ExtraAcceleration { time: 0.0, distance: false, joints_only: false };
        let remedy = refused(|_, settings| settings.extra = Some(extra));
        assert_eq!(remedy, "extra.time must be positive and finite, got 0");
        let depth = refused(|_, settings| settings.search.depth = -1.0);
        assert_eq!(depth, "search.depth must be finite, and not negative, got -1");
        let gap = refused(|_, settings| settings.tolerances.target_gap = f64::INFINITY);
        assert_eq!(gap, "target_gap must be finite, and not negative, got inf");
        let none = refused(|_, settings| settings.tolerances.target_gap = 0.0);
        assert_eq!(none, "target_gap must be positive and finite, got 0");
        let point = refused(|_, settings| settings.tolerances.accuracy = 0.0);
        assert_eq!(point, "accuracy must be positive and finite, got 0");
        let steps = StepControl { largest_step: Some(0.0), ..FINE.steps };
        let step = refused(|_, settings| settings.steps = steps);
        assert_eq!(step, "steps.largest_step must be positive and finite, got 0");
    }
}
