//! The surfaces of all bodies, and pairs of bodies that differ from what their surfaces say.

use crate::rigid::surface::{PairSurface, Surface};
use halfgap_collision::{BodyId, Collision};

/// What holds for a pair of bodies instead of what their surfaces say together; `None` leaves that as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct PairRule {
    /// Coefficient of a contact that slips [-].
    pub friction: Option<f64>,
    /// Coefficient [-] up to which a contact sticks; as `friction` if only that is given.
    pub static_friction: Option<f64>,
    /// Coefficient of restitution [-].
    pub elasticity: Option<f64>,
    /// Rolling resistance [-].
    pub rolling_resistance: Option<f64>,
    /// Tangential elasticity [-].
    pub tangential_elasticity: Option<f64>,
}

impl PairRule {
    /// The surfaces of a pair under this rule.
    #[must_use]
    pub fn apply(&self, surface: PairSurface) -> PairSurface {
        PairSurface {
            kinetic: self.friction.unwrap_or(surface.kinetic),
            sticking: self.static_friction.or(self.friction).unwrap_or(surface.sticking),
            speeds: surface.speeds,
            rolling: self.rolling_resistance.unwrap_or(surface.rolling),
            tangential_elasticity: self.tangential_elasticity.unwrap_or(surface.tangential_elasticity),
        }
    }

    /// True if it gives a pair friction or rolling resistance, whatever the surfaces say.
    #[must_use]
    pub fn resists(&self) -> bool {
        [self.friction, self.static_friction, self.rolling_resistance]
            .into_iter()
            .flatten()
            .any(|coefficient| coefficient > 0.0)
    }
}

/// Rules of some pairs.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PairRules(Vec<([BodyId; 2], PairRule)>);

impl PairRules {
    /// Of two rules for one pair the first holds.
    pub(crate) fn new(rules: impl IntoIterator<Item = ([BodyId; 2], PairRule)>) -> Self {
        let mut rules: Vec<_> = rules.into_iter().map(|(bodies, rule)| (sorted(bodies), rule)).collect();
        rules.sort_by_key(|(bodies, _)| *bodies);
        Self(rules)
    }

    /// The rule of a pair, if it has one.
    #[inline]
    pub(crate) fn of(&self, bodies: [BodyId; 2]) -> Option<&PairRule> {
        if self.0.is_empty() {
            return None;
        }
        let bodies = sorted(bodies);
        let first = self.0.partition_point(|(other, _)| *other < bodies);
        self.0.get(first).filter(|(other, _)| *other == bodies).map(|(_, rule)| rule)
    }

    /// The surfaces of two bodies together, of which each has its own.
    #[inline]
    pub(crate) fn together(&self, bodies: [BodyId; 2], surfaces: [&Surface; 2]) -> PairSurface {
        let surface = PairSurface::of(surfaces);
        self.of(bodies).map_or(surface, |rule| rule.apply(surface))
    }
}

/// The surfaces of all bodies, with the rules of pairs.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Surfaces {
    /// One of each body; none of any if nothing resists slip or rolling.
    of_bodies: Vec<Surface>,
    rules: PairRules,
}

impl Surfaces {
    pub(crate) fn new(of_bodies: Vec<Surface>, rules: PairRules) -> Self {
        let resists =
            of_bodies.iter().any(Surface::resists) || rules.0.iter().any(|(_, rule)| rule.resists());
        Self { of_bodies: if resists { of_bodies } else { Vec::new() }, rules }
    }

    /// True if anything resists slip or rolling.
    #[inline]
    pub(crate) fn any_resists(&self) -> bool {
        !self.of_bodies.is_empty()
    }

    /// Speed [m/s] at which the surface of a body runs along its outline, counter-clockwise positive.
    #[inline]
    pub(crate) fn speed(&self, body: BodyId) -> f64 {
        self.of(body).velocity
    }

    /// The surfaces of two bodies together.
    #[inline]
    pub(crate) fn together(&self, bodies: [BodyId; 2]) -> PairSurface {
        self.rules.together(bodies, bodies.map(|body| self.of(body)))
    }

    /// Gives the records of a pair the coefficient of restitution of its rule, if there is one.
    pub(crate) fn set_elasticity(&self, bodies: [BodyId; 2], records: &mut [Collision]) {
        if let Some(elasticity) = self.rules.of(bodies).and_then(|rule| rule.elasticity) {
            records.iter_mut().for_each(|record| record.response.elasticity = elasticity);
        }
    }

    #[inline]
    fn of(&self, body: BodyId) -> &Surface {
        self.of_bodies.get(body.index()).unwrap_or(&Surface::SMOOTH)
    }
}

fn sorted([a, b]: [BodyId; 2]) -> [BodyId; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_holds_for_its_pair_alone_and_leaves_what_it_does_not_name() {
        let rough =
            Surface { friction: 0.5, static_friction: 0.6, rolling_resistance: 0.1, ..Surface::SMOOTH };
        let rule = PairRule { friction: Some(0.2), rolling_resistance: Some(0.0), ..PairRule::default() };
        let surfaces = Surfaces::new(vec![rough; 3], PairRules::new([([BodyId(2), BodyId(0)], rule)]));
        let own = surfaces.together([BodyId(0), BodyId(2)]);
        assert_eq!([own.kinetic, own.sticking, own.rolling], [0.2, 0.2, 0.0]);
        let other = surfaces.together([BodyId(1), BodyId(2)]);
        assert_eq!([other.kinetic, other.sticking, other.rolling], [0.5, 0.6, 0.1]);
    }

    #[test]
    fn a_rule_makes_smooth_bodies_rough_and_others_leave_them_as_they_are() {
        let smooth = || vec![Surface::SMOOTH; 2];
        let with = |rule: PairRule| Surfaces::new(smooth(), PairRules::new([([BodyId(0), BodyId(1)], rule)]));
        let rough = with(PairRule { friction: Some(0.3), ..PairRule::default() });
        assert!(rough.any_resists() && rough.together([BodyId(1), BodyId(0)]).has_friction());
        let bouncy = with(PairRule { elasticity: Some(0.3), ..PairRule::default() });
        assert!(!bouncy.any_resists());
    }
}
