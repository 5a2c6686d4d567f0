//! Gathers what may touch within a step of a region: features that are as near as their bodies may come in it.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::pairs::Link;
use crate::rigid::group::groups::group_of;
use crate::rigid::region::collecting::collect_mates;
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::settings::RegionSteps;
use crate::rigid::shares::{LARGE, SMALL};
use halfgap_collision::{BodyId, Collision, Moment, Moving, Tolerances, detect_features_of_pair};
use halfgap_geometry::FeatureId;

/// Bodies farther apart than this multiple of the slack of a step are not in one region [-]: half of it lets a body that
/// lies on another come off by rounding, and half is the fall within a step.
pub(crate) const JOINED: f64 = 2.0;

/// Collects the bodies that touch some seeds, or each other, within the slack of a step, with the records of all places where
/// they may touch each other or a fixed body within it; bodies that do not step are left out. Each body is where it is now, in flight or not.
pub(crate) fn collect_wide(view: &View<'_>, region: &mut Region, seeds: &[BodyId], steps: RegionSteps) {
    collect(view, region, seeds, steps, true);
}

/// Collects the records of places where some bodies may touch each other or a fixed body within a step.
pub(crate) fn collect_wide_among(
    view: &View<'_>,
    region: &mut Region,
    bodies: &[BodyId],
    steps: RegionSteps,
) {
    collect(view, region, bodies, steps, false);
}

/// True for a body that only contacts and a uniform acceleration act on: others do not step.
pub(crate) fn is_plain(view: &View<'_>, body: BodyId) -> bool {
    view.connectors.of(body).is_empty()
        && view.assembly.force_laws().of(body).is_empty()
        && !view.assembly.trajectory(body).free_motion().is_damped()
}

/// True for a body that steps, unless it moves along with one that does not.
fn may_join(view: &View<'_>, body: BodyId) -> bool {
    is_plain(view, body)
        && group_of(view.assembly, view.groups, body)
            .is_none_or(|group| group.bodies().iter().all(|&mate| is_plain(view, mate)))
}

fn collect(view: &View<'_>, region: &mut Region, seeds: &[BodyId], steps: RegionSteps, all: bool) {
    let now = view.assembly.now();
    region.clear(view.assembly.body_count());
    for &seed in seeds.iter().filter(|seed| view.assembly.is_movable(**seed) && is_plain(view, **seed)) {
        region.add(seed);
    }
    let mut next = 0;
    while next < region.bodies.len() {
        let body = region.bodies[next];
        if all {
            collect_mates(view, region, body);
        }
        let moving = view.assembly.trajectory(body).moving_at(now);
        for &Link { other, .. } in view.pairs.of_body(body) {
            let place = region.place(other);
            let is_movable = view.assembly.is_movable(other);
            let is_out = is_movable && place.is_none() && !(all && may_join(view, other));
            if is_out || place.is_some_and(|earlier| earlier < next) {
                continue;
            }
            let other_moving = view.assembly.trajectory(other).moving_at(now);
            let sides = [(body, moving), (other, other_moving)];
            if collect_near(view.assembly, region, sides, steps) && view.assembly.is_movable(other) {
                region.add(other);
            }
        }
        next += 1;
    }
    let mut records = std::mem::take(&mut region.records);
    records.retain(|record| {
        record
            .bodies()
            .into_iter()
            .all(|body| !view.assembly.is_movable(body) || region.place(body).is_some())
    });
    region.records = records;
}

/// The corner of a record that touches a side, with its body.
fn corner_of(record: &Collision) -> Option<(BodyId, FeatureId)> {
    let Collision { parties, geometry, .. } = record;
    let radii = [geometry.radius_primary, geometry.radius_normal];
    let sides = [parties.primary, parties.normal];
    let mut corners = sides.into_iter().zip(radii).filter(|&(_, radius)| radius == Some(0.0));
    let (corner, _) = corners.next()?;
    Some((corner.body, corner.feature()?))
}

/// Adds the records of two bodies that may touch within a step; true if they touch now, within its slack.
fn collect_near(
    assembly: &Assembly,
    region: &mut Region,
    sides: [(BodyId, Moving); 2],
    steps: RegionSteps,
) -> bool {
    let now = assembly.now();
    let speed = |(body, moving): &(BodyId, Moving)| {
        let velocity = [moving.velocity.x, moving.velocity.y, moving.angular_velocity];
        assembly.trajectory(*body).fastest_point(velocity)
    };
    // A blow may give a body that is at rest the speed of another, which none within the scene exceeds by much.
    let fastest = assembly.settings().steps.speed + sides.iter().map(speed).sum::<f64>();
    let margin = fastest * steps.span + JOINED * steps.slack;
    let target_gap = assembly.settings().tolerances.target_gap;
    if sides.iter().all(|&(body, _)| assembly.is_movable(body)) {
        let reach = sides.iter().map(|&(body, _)| assembly.trajectory(body).reach()).sum::<f64>();
        let far = reach + margin + target_gap;
        let offset = sides[0].1.pose.position - sides[1].1.pose.position;
        if offset.length_squared() > far * far {
            return false;
        }
    }
    // A record is made of features up to twice the target gap apart. A corner that does not lie lowest yet may do so within the
    // step; what lies deeper than a step may be off lies on the far side of a corner.
    let tolerances =
        Tolerances { target_gap: margin + target_gap, accuracy: margin, ..assembly.settings().tolerances };
    let least_reach =
        sides.iter().map(|&(body, _)| assembly.trajectory(body).reach()).fold(f64::INFINITY, f64::min);
    let depth = SMALL * least_reach;
    let mut moments = sides.map(|(id, moving)| Moment { id, body: assembly.trajectory(id).body(), moving });
    // The lesser body first: records do not depend on which of the two was found first.
    if moments[1].id < moments[0].id {
        moments.swap(0, 1);
    }
    let first = region.records.len();
    let [a, b] = &moments;
    let mut fresh = std::mem::take(&mut region.fresh);
    fresh.clear();
    detect_features_of_pair(a, b, &tolerances, depth, now.seconds(), &mut fresh);
    assembly.surfaces().set_elasticity([a.id, b.id], &mut fresh);
    fresh.retain(|record| record.geometry.outside <= JOINED * steps.slack);
    let sunk = |record: &Collision| record.geometry.distance < target_gap - LARGE * steps.slack;
    for index in (0..fresh.len()).rev() {
        // A corner touches the side from which it is farthest: seen from the others it only lies behind them.
        let own = corner_of(&fresh[index]);
        let is_nearer = |other: &Collision| {
            own.is_some()
                && corner_of(other) == own
                && other.geometry.distance > fresh[index].geometry.distance
        };
        if sunk(&fresh[index]) && fresh.iter().any(is_nearer) {
            fresh.remove(index);
        }
    }
    region.records.append(&mut fresh);
    region.fresh = fresh;
    // What will touch within the step belongs to it, too: it would be cut short when that happens.
    let touches = |record: &Collision| {
        let gap = record.geometry.distance - target_gap;
        gap <= JOINED * steps.slack || gap + steps.span * record.motion.normal_velocity <= 0.0
    };
    region.records[first..].iter().any(touches)
}
