//! Comparison of the times of impacts in two runs.
//!
//! Two runs need not have the same impacts: a body that bounces to rest bounces longer at a tighter tolerance, and one
//! impact of two corners may be two. So impacts are not matched by their number. Two impacts of a body match if each is
//! the nearest in its run to the other. They are matched by body, not by pair of bodies: rounding may decide which of
//! several touching pairs get an impulse.

use crate::recording::Recording;
use halfgap_collision::BodyId;
use std::collections::BTreeMap;

/// Times of the impacts of a run [s], ascending, by body.
pub(super) struct EventTimes {
    of_body: BTreeMap<BodyId, Vec<f64>>,
}

impl EventTimes {
    /// Collects the times of the impacts up to the given time [s].
    pub(super) fn new(recording: &Recording, until: f64) -> Self {
        let mut of_body = BTreeMap::new();
        for impact in recording.impacts.iter().filter(|impact| impact.time <= until) {
            for (body, _) in &impact.states {
                note(of_body.entry(*body).or_default(), impact.time);
            }
        }
        Self { of_body }
    }

    /// Returns the largest difference [s] in time of two matching impacts; `None` if none match.
    ///
    /// An impact that the other run does not have is left out here and shows in the states.
    pub(super) fn largest_difference(&self, other: &Self) -> Option<f64> {
        let both = self.of_body.iter().filter_map(|(body, times)| Some((times, other.of_body.get(body)?)));
        let differences = both.flat_map(|(times, others)| {
            times.iter().filter_map(|&time| {
                let there = nearest(others, time)?;
                (nearest(times, there) == Some(time)).then_some((there - time).abs())
            })
        });
        differences.reduce(f64::max)
    }

    /// True if a body has an impact within the window [s] of a time [s] that only one of the runs has made by then. An
    /// impact exactly at that time counts as such.
    pub(super) fn is_between(runs: &[Self; 2], body: BodyId, time: f64, window: f64) -> bool {
        let times = runs.each_ref().map(|run| run.of_body.get(&body).map_or(&[][..], Vec::as_slice));
        let is_near = |times: &[f64]| nearest(times, time).is_some_and(|near| (near - time).abs() <= window);
        let [of_run, of_tighter] = times.map(|times| {
            [times.partition_point(|&other| other < time), times.partition_point(|&other| other <= time)]
        });
        let as_many_are_over = of_run == of_tighter && of_run[0] == of_run[1];
        !as_many_are_over && times.into_iter().any(is_near)
    }
}

/// Notes a time once.
fn note(times: &mut Vec<f64>, time: f64) {
    if times.last() != Some(&time) {
        times.push(time);
    }
}

/// Returns the nearest to a time [s] of ascending times; `None` if there are none.
fn nearest(times: &[f64], time: f64) -> Option<f64> {
    let after = times.partition_point(|&other| other < time);
    let near = times[after.saturating_sub(1)..].iter().take(2).copied();
    near.min_by(|one, other| (one - time).abs().total_cmp(&(other - time).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: BodyId = BodyId(1);

    fn run(times: &[f64]) -> EventTimes {
        EventTimes { of_body: BTreeMap::from([(BODY, times.to_vec())]) }
    }

    #[test]
    fn the_nearest_time_counts() {
        let times = [1.0, 2.0, 4.0];
        let found = [0.25, 1.0, 1.75, 3.5, 9.0].map(|time| nearest(&times, time));
        assert_eq!(found, [1.0, 1.0, 2.0, 4.0, 4.0].map(Some));
        assert_eq!(nearest(&[], 1.0), None);
    }

    #[test]
    fn an_impact_that_one_run_has_to_itself_is_nobodys_time() {
        let (run, tighter) = (run(&[1.0, 2.0]), run(&[1.01, 1.5, 2.0]));
        for difference in [run.largest_difference(&tighter), tighter.largest_difference(&run)] {
            assert!(difference.is_some_and(|difference| (difference - 0.01).abs() < 1e-15), "{difference:?}");
        }
    }

    #[test]
    fn velocities_are_left_out_between_two_impacts_that_belong_together() {
        let runs = [run(&[1.0, 2.0]), run(&[1.01, 2.0])];
        let is_between = |time: f64| EventTimes::is_between(&runs, BODY, time, 0.01);
        assert_eq!([0.995, 1.005, 1.015, 1.5].map(is_between), [false, true, false, false]);
        // At just that time the states may be those before or those after.
        assert!(is_between(2.0));
        assert!(!EventTimes::is_between(&runs, BodyId(2), 1.005, 0.01));
    }
}
