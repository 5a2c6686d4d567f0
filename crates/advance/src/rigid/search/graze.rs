//! Contacts that graze: features that come nearer than where bodies fire, and turn back before they touch.
//!
//! Near a dead point of what connectors hold, a part of a body comes towards another at a speed that vanishes
//! with the gap: the corner beside the hinge of a lid that falls shut, a bob that just clears the floor, a
//! slider at its dead centre. To stop such a part stops the whole mechanism, by a lever that is next to none;
//! and where it lies flush in the end, it is the far corner that should do so. What fires at the target gap,
//! but is turned back by its own motion before it lies deeper than contacts may anyway, is let pass.

use super::pairs::PairId;
use crate::rigid::event::region::Touch;
use crate::rigid::held::settle::DEEPEST;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, ConnectorId, FeatureRule};
use halfgap_geometry::{Feature, FeatureId};

/// Depth, in target gaps, that what grazes does not come to: a little less than that from which contacts are lifted.
const DEPTH: f64 = 0.9 * DEEPEST;
/// Gaps may seem to be less than they are by so many times what connectors are off by in the middle of a step.
const SEEMING: f64 = 2.0;

impl RigidSystem {
    /// True if two features that fire only graze: the search lets them come as deep from now on.
    pub(crate) fn grazes(&mut self, pair: PairId, features: [FeatureId; 2]) -> bool {
        let touch = Touch { bodies: self.pairs.bodies(pair), features };
        let most = self.grazing_gap(touch.bodies);
        let has_come =
            |rule: &FeatureRule| rule.features == features && rule.target.is_some_and(|gap| gap <= most);
        if self.pairs.rules(pair).iter().any(has_come) || !self.turns_back(touch) {
            return false;
        }
        let rule = touch.lowered_to(self.least_grazing_gap(touch.bodies));
        self.pairs.change_rules(pair, |rules| {
            // Of several rules for the same features the first counts.
            rules.retain(|rule| rule.features != features);
            rules.push(rule);
        });
        self.predict(pair);
        true
    }

    /// True if a record is of features that close, and only graze.
    pub(crate) fn is_grazing(&self, record: &Collision) -> bool {
        record.motion.normal_velocity < -self.rest_speed()
            && Touch::of(record).is_some_and(|touch| self.turns_back(touch))
    }

    /// The gap [m] of what grazes is larger: bodies do not overlap by what one sees.
    pub(crate) fn grazing_gap(&self, bodies: [BodyId; 2]) -> f64 {
        if self.is_zone_seen(bodies) { 0.0 } else { -DEPTH * self.settings.tolerances.target_gap }
    }

    /// True if features of which one is held by connectors, as they move now, part again before they are as
    /// deep as what grazes never is.
    fn turns_back(&self, touch: Touch) -> bool {
        let least = self.least_grazing_gap(touch.bodies);
        let Some(corners) = self.corners_of(touch) else {
            return self.parts_again(touch.bodies, least, |time| self.gap_at(touch, time));
        };
        // Of two corners that run into each other the distance is never negative: it would grow again.
        let apart = |time: Time| {
            let [a, b] = [0, 1].map(|side: usize| {
                let moving = self.flyer(touch.bodies[side]).moving_at(time);
                let arm = moving.pose.vector_to_world(corners[side]);
                (moving.pose.position + arm, moving.velocity_at(arm))
            });
            (a.0 - b.0, a.1 - b.1)
        };
        let direction = apart(self.now).0.normalize_or_zero();
        self.parts_again(touch.bodies, least, |time| {
            let (offset, velocity) = apart(time);
            (direction.dot(offset), direction.dot(velocity))
        })
    }

    /// The places of two sharp corners that touch [m], each in its body's coordinates; `None` of other features.
    fn corners_of(&self, Touch { bodies, features }: Touch) -> Option<[DVec2; 2]> {
        let corner = |side: usize| match self.flyer(bodies[side]).body().shape.feature(features[side]) {
            Feature::Round(round) if round.radius == 0.0 => Some(round.center),
            _ => None,
        };
        Some([corner(0)?, corner(1)?])
    }

    /// The gap [m] to which what grazes may seem to come: between the ends of a step its dense output has
    /// bodies off what holds them, and that is no depth.
    fn least_grazing_gap(&self, bodies: [BodyId; 2]) -> f64 {
        let errors = bodies.iter().filter_map(|&body| self.group_of(body)).map(|group| group.largest_error);
        self.grazing_gap(bodies) - SEEMING * errors.sum::<f64>()
    }

    /// True if a rope one end of which is held by other connectors, too, as it moves now, is slack again
    /// before it is longer by as much as what grazes may be deep.
    pub(crate) fn rope_grazes(&self, id: ConnectorId) -> bool {
        let connector = self.connector(id);
        let bodies = connector.bodies();
        self.parts_again(bodies, -self.grazing_slack(), |time| {
            let [a, b] = bodies.map(|body| self.moving_at(body, time));
            let sample = connector.measure(0, &a, &b);
            (sample.gap, sample.kinematics.rate)
        })
    }

    /// How much longer [m] a rope is taken that grazes.
    pub(crate) fn grazing_slack(&self) -> f64 {
        DEPTH * self.settings.tolerances.target_gap
    }

    /// True if a gap that closes between bodies of which one is held by connectors, as they move now, opens
    /// again before it is less than so much [m]. It is given, with its rate [m/s], at any time of the present
    /// motion.
    fn parts_again(&self, bodies: [BodyId; 2], least: f64, gap_at: impl Fn(Time) -> (f64, f64)) -> bool {
        let is_moved = |body: &BodyId| !body.is_world() && self.group_of(*body).is_some();
        if !bodies.iter().any(|&body| self.is_tied(body)) || !bodies.iter().any(is_moved) {
            return false;
        }
        let (gap, rate) = gap_at(self.now);
        let room = gap - least;
        if rate >= 0.0 || room <= 0.0 {
            return false;
        }
        // With a constant acceleration, what turns back within the room does so within this time.
        let ends = bodies.into_iter().filter_map(|body| self.segment_end(body));
        let known = ends.map(|end| end.since(self.now)).fold(f64::INFINITY, f64::min);
        let span = (-2.0 * room / rate).min(known);
        if span <= 0.0 {
            return false;
        }
        let acceleration = (gap_at(self.now.plus(span)).1 - rate) / span;
        let turns = acceleration > 0.0 && rate * rate < 2.0 * acceleration * room;
        let nearest = -rate / acceleration;
        turns && (nearest > known || gap_at(self.now.plus(nearest)).0 > least)
    }

    /// True if a body is held by a connector, whichever way it is pushed.
    pub(crate) fn is_tied(&self, body: BodyId) -> bool {
        !body.is_world() && self.connectors.of(body).iter().any(|&id| self.connector(id).is_bilateral())
    }
}
