//! Bounces too low to be told from contact: between two events the gap stayed within the target zone.
//!
//! How high a pair has risen follows from its rate when it was seen last, its rate now, and the time between:
//! under a constant acceleration that is v1^2 t / (2 (v1 + v2)). Such a pair meets without elasticity, unless
//! something else in the same event closes fast. What is cut off is shorter than the fall through the zone
//! and no higher than it.
//!
//! That holds of what forces turn. What something else has struck since bounces as it would anywhere, unless
//! it is so slow that forces make it as fast within the zone.
//!
//! What is perfectly elastic and has come to bounce a few target gaps high, as when something light hits it
//! while it rests, would go on with that for ever, hundreds of thousands of times a second. The energy of
//! that is what the gap itself is worth: after very many such bounces in a row it is let go as well.

use crate::rigid::event::region::{Region, Touch};
use crate::rigid::search::pairs::{PairId, Seen};
use crate::rigid::system::RigidSystem;
use halfgap_collision::{Collision, Tolerances};
use halfgap_geometry::FeatureId;

/// Forces may press bodies together by so many times the acceleration of the scene.
const FORCED: f64 = 1e3;
/// So many times it they press together what something else has struck within its zone, as in a heap so many
/// bodies deep. What is faster bounces: else the energy of a blow would be lost, which an elastic body passes
/// on and gets back at once.
const STRUCK: f64 = 1e2;
/// So many feature pairs are remembered of a pair of bodies.
const MOST_SEEN: usize = 16;
/// Bounces no higher than so many target gaps are low, and end after so many in a row.
const LOW_GAPS: f64 = 10.0;
const MOST_LOW: u32 = 1000;

impl RigidSystem {
    /// Remembers the gaps and rates of the contacts of a region, whose bodies have their new velocities.
    pub(crate) fn note_seen(&mut self, region: &Region, fired_open: bool) {
        for (touch, &(gap, rate)) in region.touches.iter().zip(&region.motions) {
            let Some(pair) = self.pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
            let before = self.pairs.seen(pair).iter().find(|old| old.features == touch.features);
            let low = before.map_or(0, |before| self.low_bounces(before, gap));
            let formed = before.map_or(gap, |before| before.formed.max(gap));
            let goes_on = || before.is_some_and(|before| before.fires_open);
            let fires_open = if region.cause.fired() == Some(*touch) { fired_open } else { goes_on() };
            let fires_open = fires_open && gap < self.settings.tolerances.target_gap;
            let fresh = Seen { features: touch.features, time: self.now, gap, formed, rate, low, fires_open };
            let seen = self.pairs.seen_mut(pair);
            seen.retain(|old| old.features != fresh.features);
            if seen.len() == MOST_SEEN {
                seen.remove(0);
            }
            seen.push(fresh);
        }
    }

    /// How many low bounces in a row a contact has come to that was seen before and has a gap [m] now.
    fn low_bounces(&self, seen: &Seen, gap: f64) -> u32 {
        let way = seen.rate.max(0.0) * self.now.since(seen.time);
        // Under a constant acceleration it has come back by so much in the meantime.
        let back = way - (gap - seen.gap);
        let rise = if back > 0.0 { 0.25 * way * (way / back) } else { way };
        let is_low = seen.gap + rise <= LOW_GAPS * self.settings.tolerances.target_gap;
        if is_low { seen.low.saturating_add(u32::from(seen.rate > self.rest_speed())) } else { 0 }
    }

    /// True if all that closes fast in a region was seen within the target zone before and has not left it since.
    pub(crate) fn bounces_low(&self, region: &Region) -> bool {
        let mut fast = region.records.iter().filter(|record| closes_fast(record)).peekable();
        fast.peek().is_some() && fast.all(|record| self.is_low_bounce(record))
    }

    fn is_low_bounce(&self, record: &Collision) -> bool {
        let Some((pair, features)) = self.features_of(record) else { return false };
        self.has_stayed_low(pair, features, -record.motion.normal_velocity, &record.tolerances)
    }

    /// True if a contact of a pair would fire although it does not close.
    pub(crate) fn fires_open(&self, pair: PairId, features: [FeatureId; 2]) -> bool {
        self.pairs.seen(pair).iter().any(|seen| seen.features == features && seen.fires_open)
    }

    /// The pair whose contact a record is, and its features, those of the lesser body first.
    fn features_of(&self, record: &Collision) -> Option<(PairId, [FeatureId; 2])> {
        let Touch { bodies: [a, b], features } = Touch::of(record)?;
        Some((self.pairs.between(a, b)?, features))
    }

    /// The largest gap [m] at which the features of a record have touched, or touch now.
    pub(crate) fn formed_at(&self, record: &Collision) -> f64 {
        let before = self.features_of(record).and_then(|(pair, features)| {
            self.pairs.seen(pair).iter().find(|seen| seen.features == features).map(|seen| seen.formed)
        });
        before.unwrap_or(record.geometry.distance)
    }

    /// True if two features that close at a rate [m/s] were seen within the target zone before and have not
    /// left it since.
    pub(crate) fn has_stayed_low(
        &self,
        pair: PairId,
        features: [FeatureId; 2],
        down: f64,
        &Tolerances { target_gap, accuracy, velocity_tol }: &Tolerances,
    ) -> bool {
        let Some(seen) = self.pairs.seen(pair).iter().find(|seen| seen.features == features) else {
            return false;
        };
        // What came fast then has not been stopped since.
        if seen.rate < -velocity_tol {
            return false;
        }
        let up = seen.rate.max(0.0);
        let lasted = self.now.since(seen.time);
        let rise = 0.5 * up * up * lasted / (up + down);
        let most = if seen.low >= MOST_LOW { LOW_GAPS * target_gap } else { target_gap + accuracy };
        // What moved so under a constant acceleration is where it was. Else, as when something has lifted it
        // in between, it has stayed only if it is no faster than forces make it within the zone. Without
        // contact forces it would sink then, and that is for what is low beyond doubt.
        let went = 0.5 * (up - down).abs() * lasted;
        let forced = |times: f64| {
            self.settings.impulse_step.is_none() && down * down <= 2.0 * times * self.acceleration() * most
        };
        let is_low =
            || if self.is_struck_since(pair, seen) { forced(STRUCK) } else { went <= most || forced(FORCED) };
        seen.gap + rise <= most && is_low()
    }

    /// True if the velocity of a body of a pair was changed at once since a contact of it was seen: what has
    /// turned it is no force.
    fn is_struck_since(&self, pair: PairId, seen: &Seen) -> bool {
        let strikes = self.pairs.bodies(pair).into_iter().filter_map(|body| self.limits.struck[body.index()]);
        strikes.into_iter().any(|strike| strike > seen.time)
    }

    /// The acceleration of the scene [m/s^2]; zero where there are no forces but those of contacts and connectors.
    fn acceleration(&self) -> f64 {
        if self.is_forceless {
            0.0
        } else {
            self.settings.tolerances.velocity_tol / self.settings.resolution_time
        }
    }
}

/// True if a contact closes so fast that its elasticity acts.
pub(crate) fn closes_fast(record: &Collision) -> bool {
    !record.parties.bilateral && -record.motion.normal_velocity > record.tolerances.velocity_tol
}
