//! Lengths of steps.

use crate::rigid::settings::RegionSteps;
use crate::rigid::shares::LARGE;
use crate::rigid::stepping::rows::StepRow;

/// Length [s] of the step after one of a length `span`. Contacts that close or open at up to a speed `fastest` [m/s] have begun or ended
/// to press: they may do so at any time of the step, and should not go farther meanwhile than the slack. What bodies whose points move
/// at up to `speed` [m/s] meet at other features is seen at the end of a step, and should not be much farther.
pub(super) fn next_span(steps: RegionSteps, span: f64, [fastest, speed]: [f64; 2]) -> f64 {
    let longest = LARGE * steps.span;
    let wanted = (steps.slack / fastest).min(LARGE * steps.slack / speed);
    wanted.min(2.0 * span).clamp(steps.span, longest)
}

/// Length [s] of a step, at most that proposed, in which contacts that press bend off the straight ways of their bodies by no more than the
/// slack; no less than the least length.
pub(super) fn straight_span(rows: &[StepRow], proposed: f64, steps: RegionSteps) -> f64 {
    let pressing = rows.iter().filter(|row| row.touches);
    let most = pressing.map(|row| row.bend_within(proposed).abs()).fold(0.0, f64::max);
    let straight = if most > 0.0 { (8.0 * steps.slack / most).sqrt() } else { proposed };
    proposed.min(straight).max(steps.span)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_lengthen_where_nothing_changes_and_nothing_moves() {
        let steps = RegionSteps { span: 1.0, slack: 1.0, slow: 1.0 };
        assert_eq!(next_span(steps, 1.0, [0.0, 0.0]), 2.0);
        assert_eq!(next_span(steps, LARGE, [0.0, 0.0]), LARGE);
        assert_eq!(next_span(steps, LARGE, [0.2, 0.0]), 5.0);
        assert_eq!(next_span(steps, LARGE, [0.0, 5.0]), 2.0);
        assert_eq!(next_span(steps, LARGE, [1e3, 1e3]), 1.0);
    }
}
