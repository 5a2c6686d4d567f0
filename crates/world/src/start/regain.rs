//! Contacts that the correction would lose: the least displacement that lifts all gaps to their target carries some
//! beyond it, as where two of three discs push the third away. These gaps, and all others that were lifted, are brought
//! back to their target where that is possible.

use super::correction::bring_to_target;
use super::joined::worst_connector;
use super::touching::{Touch, is_below_zone, record_of, touch, touching};
use super::{MOST_ROUNDS, StartRules, ways};
use crate::builder::Joints;
use crate::near::NearPairs;
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyState, Collision};

/// Brings the lifted gaps to their target, from both sides, if some of them lie beyond it. Leaves the bodies as they
/// are if none does, or if that is not possible. `given` holds the bodies before they were lifted.
pub(super) fn regain_touches(
    bodies: &mut [BodyPart],
    (lifted, given): (&[Touch], &[BodyState]),
    connectors: &Joints,
    (rules, near): (&StartRules<'_>, &mut NearPairs),
) {
    let sink = rules.tolerances.sink();
    let is_lost = |record: &Collision| record.distance_to_target() > sink;
    if !measured(bodies, lifted, rules).iter().any(is_lost) {
        return;
    }
    let corrected: Vec<BodyState> = bodies.iter().map(|part| part.state).collect();
    for _ in 0..MOST_ROUNDS {
        let ways = ways(bodies, given);
        let pairs = rules.near_pairs(near, bodies);
        let mut others = touching(bodies, pairs, rules, &ways);
        others.retain(|record| touch(record).is_none_or(|touch| !lifted.contains(&touch)));
        let held = measured(bodies, lifted, rules);
        let is_at_target = held.iter().all(|record| record.distance_to_target().abs() <= sink);
        let error = worst_connector(bodies, connectors).map_or(0.0, |off| off.error);
        if is_at_target && !others.iter().any(is_below_zone) && error <= rules.rounding {
            return;
        }
        if bring_to_target(bodies, &held, &others, connectors).is_none() {
            break;
        }
    }
    bodies.iter_mut().zip(&corrected).for_each(|(part, corrected)| part.state = *corrected);
}

/// Returns the records of known places at the present positions of the bodies.
fn measured(bodies: &[BodyPart], touches: &[Touch], rules: &StartRules<'_>) -> Vec<Collision> {
    touches.iter().filter_map(|&touch| record_of(bodies, touch, rules)).collect()
}
