//! Bounces too low to be told from contact: between two events the gap stayed within the target zone.
//!
//! How high a pair has risen follows from its rate when it was seen last, its rate now, and the time between: under a
//! constant acceleration that is v1^2 t / (2 (v1 + v2)). Such a pair meets without elasticity, unless something else in the
//! same event closes fast. What is cut off is shorter than the fall through the zone and no higher than it.

use super::pairs::Seen;
use super::region::Region;
use super::system::RigidSystem;
use halfgap_collision::Collision;

/// So many feature pairs are remembered of a pair of bodies.
const MOST_SEEN: usize = 16;

impl RigidSystem {
    /// Remembers the gaps and rates of the contacts of a region, whose bodies have their new velocities.
    pub(crate) fn note_seen(&mut self, region: &Region) {
        for (touch, &(gap, rate)) in region.touches.iter().zip(&region.motions) {
            let Some(pair) = self.pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
            let fresh = Seen { features: touch.features, time: self.now, gap, rate };
            let seen = self.pairs.seen_mut(pair);
            seen.retain(|old| old.features != fresh.features);
            if seen.len() == MOST_SEEN {
                seen.remove(0);
            }
            seen.push(fresh);
        }
    }

    /// True if all that closes fast in a region was seen within the target zone before and has not left it since.
    pub(crate) fn bounces_low(&self, region: &Region) -> bool {
        let mut fast = region.records.iter().filter(|record| closes_fast(record)).peekable();
        fast.peek().is_some() && fast.all(|record| self.is_low_bounce(record))
    }

    fn is_low_bounce(&self, record: &Collision) -> bool {
        let (primary, normal) = (&record.parties.primary, &record.parties.normal);
        let (Some(p), Some(n)) = (primary.feature(), normal.feature()) else { return false };
        let Some(pair) = self.pairs.between(primary.body, normal.body) else { return false };
        let features = if primary.body < normal.body { [p, n] } else { [n, p] };
        let Some(seen) = self.pairs.seen(pair).iter().find(|seen| seen.features == features) else {
            return false;
        };
        let (up, down) = (seen.rate.max(0.0), -record.motion.normal_velocity);
        let rise = 0.5 * up * up * self.now.since(seen.time) / (up + down);
        seen.gap + rise <= record.tolerances.target_gap + record.tolerances.accuracy
    }
}

/// True if a contact closes so fast that its elasticity acts.
pub(crate) fn closes_fast(record: &Collision) -> bool {
    !record.parties.bilateral && -record.motion.normal_velocity > record.tolerances.velocity_tol
}
