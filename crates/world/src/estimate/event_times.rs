//! When bodies collide, in two runs.
//!
//! Two runs need not have the same impacts: a body that bounces to rest bounces longer at a tighter
//! tolerance, and what is one impact of two corners may be two. So impacts are not counted off against each
//! other: each is compared with the nearest of the same pair.

use crate::recording::Recording;
use halfgap_collision::BodyId;
use std::collections::BTreeMap;

/// Times of the impacts of a run [s], ascending, by pair of bodies and by body.
pub(super) struct EventTimes {
    of_pair: BTreeMap<[BodyId; 2], Vec<f64>>,
    of_body: BTreeMap<BodyId, Vec<f64>>,
}

impl EventTimes {
    /// Those up to the given time [s].
    pub(super) fn new(recording: &Recording, until: f64) -> Self {
        let mut times = Self { of_pair: BTreeMap::new(), of_body: BTreeMap::new() };
        for impact in recording.impacts.iter().filter(|impact| impact.time <= until) {
            for row in &impact.rows {
                let pair = [row.primary.min(row.normal_body), row.primary.max(row.normal_body)];
                note(times.of_pair.entry(pair).or_default(), impact.time);
            }
            for (body, _) in &impact.states {
                note(times.of_body.entry(*body).or_default(), impact.time);
            }
        }
        times
    }

    /// The largest difference [s] of an impact of this run to the nearest one of the same pair in the other.
    ///
    /// A pair that never collides in the other run has no time there: states tell of that.
    pub(super) fn largest_difference(&self, other: &Self) -> Option<f64> {
        let both = self.of_pair.iter().filter_map(|(pair, times)| Some((times, other.of_pair.get(pair)?)));
        both.flat_map(|(times, others)| times.iter().map(|&time| distance_to(others, time))).reduce(f64::max)
    }

    /// True if the body has an impact within the window [s] of a time [s].
    pub(super) fn has_impact(&self, body: BodyId, time: f64, window: f64) -> bool {
        self.of_body.get(&body).is_some_and(|times| distance_to(times, time) <= window)
    }
}

/// Notes a time once.
fn note(times: &mut Vec<f64>, time: f64) {
    if times.last() != Some(&time) {
        times.push(time);
    }
}

/// Distance [s] of a time to the nearest of some, which ascend; infinite if there are none.
fn distance_to(times: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|&other| other < time);
    let near = times[after.saturating_sub(1)..].iter().take(2);
    near.map(|other| (other - time).abs()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_time_counts() {
        let times = [1.0, 2.0, 4.0];
        let distances = [0.25, 1.0, 1.75, 3.5, 9.0].map(|time| distance_to(&times, time));
        assert_eq!(distances, [0.75, 0.0, 0.25, 0.5, 5.0]);
        assert_eq!(distance_to(&[], 1.0), f64::INFINITY);
    }
}
