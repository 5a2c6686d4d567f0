//! Contacts near a dead point: features that come nearer than the gap at which bodies fire, and turn back before they touch.
//!
//! Near a dead point of a mechanism held by connectors, a part of a body comes towards another at a speed that vanishes
//! with the gap: the corner beside the hinge of a lid that falls shut, a bob that just clears the floor, a slider at
//! its dead centre. Stopping such a part stops the whole mechanism, by next to no lever arm; and where the part lies
//! flush in the end, it is the far corner that should stop it. A contact that fires at the target gap, but is turned
//! back by its own motion before it lies deeper than contacts may anyway, is let pass.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::PairId;
use crate::rigid::contacts::table::Mode;
use crate::rigid::contacts::touch::{DEEPEST, Touch};
use crate::rigid::remedies::Remedy;
use crate::rigid::search::searching::Searching;
use crate::rigid::shares::NEARLY_ALL;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, ConnectorId, GapState, first_closing_time};
use halfgap_geometry::{Feature, FeatureId};

impl Searching<'_> {
    /// True if two features that fire turn back at a dead point: the search lets them come down to the least gap of
    /// such from now on.
    pub(crate) fn turns_back(&mut self, pair: PairId, features: [FeatureId; 2]) -> bool {
        let touch = Touch { bodies: self.pairs.bodies(pair), features };
        let most = dead_point_gap(self.assembly, touch.bodies);
        let has_come = matches!(self.pairs.mode(pair, features), Some(Mode::Open(gap)) if gap <= most);
        if has_come || !turns_back(self.assembly, self.connectors, touch) {
            return false;
        }
        if !self.assembly.remedies().act(Remedy::DeadPoints) {
            return false;
        }
        let gap = least_dead_point_gap(self.assembly, touch.bodies);
        self.pairs.set_mode(pair, features, Mode::Open(gap));
        self.predict(pair);
        true
    }
}

/// True if the features of a record close, and turn back at a dead point.
pub(crate) fn is_near_dead_point(assembly: &Assembly, connectors: &Connectors, record: &Collision) -> bool {
    record.gap_state().is_colliding(assembly.rest_speed())
        && Touch::of(record).is_some_and(|touch| turns_back(assembly, connectors, touch))
        && assembly.remedies().act(Remedy::DeadPoints)
}

/// Gap [m] above which grazing features stay: not negative where the target zone is large enough to be seen, for
/// bodies do not visibly overlap.
pub(crate) fn dead_point_gap(assembly: &Assembly, bodies: [BodyId; 2]) -> f64 {
    if assembly.is_zone_seen(bodies) {
        0.0
    } else {
        -NEARLY_ALL * DEEPEST * assembly.settings().tolerances.target_gap
    }
}

/// True if features, one of them on a body held by connectors, part again in their present motion before they come
/// to the least grazing gap.
fn turns_back(assembly: &Assembly, connectors: &Connectors, touch: Touch) -> bool {
    let least = least_dead_point_gap(assembly, touch.bodies);
    let Some(corners) = corners_of(assembly, touch) else {
        return parts_again(assembly, connectors, touch.bodies, least, |time| {
            let GapState { distance, normal_velocity, .. } = gap_at(assembly, touch, time);
            (distance, normal_velocity)
        });
    };
    // The distance of two corners that run into each other is never negative: it would grow again.
    let apart = |time: Time| {
        let [a, b] = [0, 1].map(|side: usize| {
            let moving = assembly.trajectory(touch.bodies[side]).moving_at(time);
            let arm = moving.pose.vector_to_world(corners[side]);
            (moving.pose.position + arm, moving.velocity_at(arm))
        });
        (a.0 - b.0, a.1 - b.1)
    };
    let direction = apart(assembly.now()).0.normalize_or_zero();
    parts_again(assembly, connectors, touch.bodies, least, |time| {
        let (offset, velocity) = apart(time);
        (direction.dot(offset), direction.dot(velocity))
    })
}

/// Positions [m] of two sharp corners that touch, each in its body's coordinates; `None` for other features.
fn corners_of(assembly: &Assembly, Touch { bodies, features }: Touch) -> Option<[DVec2; 2]> {
    let corner = |side: usize| match assembly.trajectory(bodies[side]).body().shape.feature(features[side]) {
        Feature::Round(round) if round.radius == 0.0 => Some(round.center),
        _ => None,
    };
    Some([corner(0)?, corner(1)?])
}

/// Gap [m] to which grazing features may seem to come: between the ends of a step dense output has bodies off their
/// active rows, by twice the connectors' error in the middle of the step, which is no real depth.
fn least_dead_point_gap(assembly: &Assembly, bodies: [BodyId; 2]) -> f64 {
    let errors =
        bodies.iter().filter_map(|&body| assembly.shared_by(body)).map(|shared| shared.largest_error);
    dead_point_gap(assembly, bodies) - 2.0 * errors.sum::<f64>()
}

/// True if a rope, one end of which other connectors hold, too, is slack again in its present motion before it is
/// longer by the grazing slack.
pub(crate) fn rope_is_near_dead_point(assembly: &Assembly, connectors: &Connectors, id: ConnectorId) -> bool {
    let connector = connectors.connector(id);
    let bodies = connector.bodies();
    let turns_back = parts_again(assembly, connectors, bodies, -dead_point_slack(assembly), |time| {
        let [a, b] = bodies.map(|body| assembly.moving_at(body, time));
        let sample = connector.measure(0, &a, &b);
        (sample.gap, sample.kinematics.rate)
    });
    turns_back && assembly.remedies().act(Remedy::DeadPoints)
}

/// Excess length [m] that a grazing rope is given.
pub(crate) fn dead_point_slack(assembly: &Assembly) -> f64 {
    NEARLY_ALL * DEEPEST * assembly.settings().tolerances.target_gap
}

/// True if a closing gap between bodies, one of them held by connectors, opens again in the present motion before
/// it falls below `least` [m]. `gap_at` returns gap [m] and rate [m/s] at any time of this motion.
fn parts_again(
    assembly: &Assembly,
    connectors: &Connectors,
    bodies: [BodyId; 2],
    least: f64,
    gap_at: impl Fn(Time) -> (f64, f64),
) -> bool {
    let is_moved = |body: &BodyId| !body.is_world() && assembly.shared_by(*body).is_some();
    if !bodies.iter().any(|&body| is_tied(connectors, body)) || !bodies.iter().any(is_moved) {
        return false;
    }
    let (gap, rate) = gap_at(assembly.now());
    let room = gap - least;
    if rate >= 0.0 || room <= 0.0 {
        return false;
    }
    // With a constant acceleration, a gap that turns back within the room does so within this time.
    let ends = bodies.into_iter().filter_map(|body| assembly.segment_end(body));
    let known = ends.map(|end| end.since(assembly.now())).fold(f64::INFINITY, f64::min);
    let span = (-2.0 * room / rate).min(known);
    if span <= 0.0 {
        return false;
    }
    let acceleration = (gap_at(assembly.now().plus(span)).1 - rate) / span;
    let turns = first_closing_time(room, rate, acceleration).is_none();
    let nearest = -rate / acceleration;
    turns && (nearest > known || gap_at(assembly.now().plus(nearest)).0 > least)
}

/// True if a body is tied by a bilateral connector.
pub(crate) fn is_tied(connectors: &Connectors, body: BodyId) -> bool {
    !body.is_world() && connectors.of(body).iter().any(|&id| connectors.connector(id).is_bilateral())
}
