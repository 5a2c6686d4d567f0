//! Steps over singular configurations of closed loops, in which the Jacobian J of the constraint rows loses rank, as
//! that of a parallelogram linkage does when it lies flat.
//!
//! Such a configuration is a bifurcation point: two branches of motion meet there, and the velocities decide on which
//! one the loop goes on. The *kept share* of a row is the fraction of its square, the diagonal entry of the Delassus
//! matrix J M^-1 J^T, that elimination of the rows before it leaves. Its root is the sine of the angle between the row
//! and the span of those, in the metric of the masses; it falls linearly with the distance to the bifurcation point.
//!
//! Forces are found by division by the share, so near the point the rates are all rounding, and errors of the loop
//! decide on the branch. Far from it none of that shows. So steps are placed such that no stage comes near the point:
//! they go astride of it, with the point in the middle of the widest interval between stages, and the stages are moved
//! onto the rows (`on_rows`). A stage off the rows by e makes accelerations of e over the cube of the distance from the
//! point, however small e is: a step that is too short amplifies rounding. Whether a loop passes a bifurcation point,
//! or only comes near one, shows in how well the rows are kept along the step (`extending`).

use crate::ode::Method;
use crate::rigid::shares::{SEVERAL, SMALL};

/// A step comes to a bifurcation point if the root of the least kept share falls to this fraction of its largest value.
const LOW: f64 = 0.35;
/// A bifurcation point may be ahead if that root has fallen to this fraction of its largest value.
const LOWER: f64 = 0.7;
/// Stages are moved onto the rows if that root has fallen to this fraction of its largest value.
const NEAR: f64 = 0.15;
/// A step longer than this multiple of the way to a bifurcation point passes it before its first stage.
const EARLY: f64 = 40.0;

/// Error up to which a step astride is accepted if shorter ones err by no less, relative to the length and speed that
/// errors of steps are relative to: that is rounding.
const ROUNDING: f64 = 1e-7;
/// Least factor by which a step astride is shortened at once: rounding errors grow with the inverse square of its
/// length.
const SHORTENING: f64 = 0.5;

/// Kept shares of the rows of loops at the stages of a step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Kept {
    /// Offset [s] of each stage, and the root of the least kept share there.
    stages: Vec<(f64, f64)>,
    /// That root at the start of the next step, in the first measure, if shares are measured in another way from there
    /// on.
    known: Option<f64>,
    /// Factor that makes roots in the other measure comparable with those in the first.
    unit: Option<f64>,
    /// The largest root since the group was made.
    most: f64,
    /// The least root of the last step.
    least: f64,
    /// Index in `stages` of the least root, if the last step came to a bifurcation point.
    lowest: Option<usize>,
    /// A step is being made.
    is_open: bool,
    /// The last step was made shorter because of a bifurcation point, and tells nothing about those after it.
    pub(crate) is_led: bool,
    /// Error norm of the last step astride whose error was larger than that of other steps may be.
    missed: Option<f64>,
    /// Error norm of the last step, if it was accepted because it went astride.
    passed: Option<f64>,
}

impl Kept {
    /// Forgets the shares of another group.
    pub(crate) fn clear(&mut self) {
        self.stages.clear();
        (self.most, self.least, self.lowest) = (0.0, 0.0, None);
        (self.known, self.unit) = (None, None);
        (self.missed, self.passed, self.is_led) = (None, None, false);
    }

    pub(crate) fn open(&mut self) {
        self.stages.clear();
        (self.is_open, self.passed) = (true, None);
    }

    pub(crate) fn close(&mut self) {
        self.is_open = false;
        self.lowest = None;
        self.measure_as_before();
        let roots = || self.stages.iter().map(|stage| stage.1);
        self.most = roots().fold(self.most, f64::max);
        self.least = roots().fold(f64::INFINITY, f64::min);
        if self.least < LOW * self.most {
            self.stages.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            self.stages.dedup_by_key(|stage| stage.0);
            let numbered = self.stages.iter().enumerate();
            self.lowest = numbered.min_by(|a, b| a.1.1.total_cmp(&b.1.1)).map(|(place, _)| place);
        }
    }

    /// Announces that shares are measured in another way from the next step on, which starts where the last one did.
    pub(crate) fn change_measure(&mut self) {
        let first = self.stages.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        (self.known, self.unit) = (first.map(|stage| stage.1), None);
    }

    /// Announces that shares are measured in the first way again.
    pub(crate) fn restore_measure(&mut self) {
        (self.known, self.unit) = (None, None);
    }

    /// Converts the roots of a step to the first measure.
    fn measure_as_before(&mut self) {
        if let Some(known) = self.known.take() {
            let first = self.stages.iter().min_by(|a, b| a.0.total_cmp(&b.0));
            self.unit = first.map(|first| known / first.1).filter(|unit| unit.is_normal());
        }
        if let Some(unit) = self.unit {
            self.stages.iter_mut().for_each(|stage| stage.1 *= unit);
        }
    }

    /// True if stages are noted now: only while a step is being made, not at other evaluations of rates.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Notes the least kept share at a stage with an offset [s].
    pub(crate) fn note(&mut self, offset: f64, kept: f64) {
        if self.is_open {
            self.stages.push((offset, kept.sqrt()));
        }
    }

    /// Rate [1/s] at which the root of the least kept share falls towards a bifurcation point, and rises again.
    fn slope(&self) -> f64 {
        let slopes =
            self.stages.windows(2).map(|pair| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs());
        slopes.fold(0.0, f64::max)
    }

    /// Offset [s] of the bifurcation point, and the distance [s] from it to the nearest stage; `None` if the last step
    /// has not come to one.
    fn point(&self) -> Option<(f64, f64)> {
        let place = self.lowest?;
        let (offset, root) = self.stages[place];
        let slope = self.slope();
        if slope == 0.0 {
            return None;
        }
        let away = root / slope;
        // The point lies on the side where the next stage's root is less than the slope would make it.
        let short = |other: Option<&(f64, f64)>| {
            other.map_or(0.0, |other| slope * (other.0 - offset).abs() - other.1)
        };
        let before = short(place.checked_sub(1).and_then(|before| self.stages.get(before)));
        let after = short(self.stages.get(place + 1));
        Some((if before > after { offset - away } else { offset + away }, away))
    }

    /// True if the last step came to a bifurcation point, or nearly.
    pub(crate) fn nears_singular(&self) -> bool {
        self.lowest.is_some()
    }

    /// True if the last step came so near a bifurcation point that stages off the rows make large spurious forces.
    pub(crate) fn is_near_singular(&self) -> bool {
        self.least < NEAR * self.most
    }

    /// True if the next steps may come to a bifurcation point: errors of a loop grow on the way there.
    pub(crate) fn may_near_singular(&self) -> bool {
        self.least < LOWER * self.most
    }

    /// A length [s] for the last step, of `most` at most, with which none of its stages will be near the bifurcation
    /// point; `None` if none has been.
    pub(crate) fn better_length(&self, length: f64, most: f64, method: Method) -> Option<f64> {
        let (point, away) = self.point()?;
        let better = led(point, most, method)?;
        (away <= SMALL * length || (point > length && better < length)).then_some(better)
    }

    /// True if a step astride of a bifurcation point, whose error norm is too large, is accepted all the same: its
    /// error is not too large by much, or a longer step before it erred by no more, so that no shorter one will err by
    /// less. A norm of 1 is a relative error of `local_error`.
    pub(crate) fn passes_astride(&mut self, length: f64, error: f64, local_error: f64) -> bool {
        if !self.is_astride(length) {
            return false;
        }
        let before = self.missed.replace(error);
        let is_rounding = before.is_some_and(|before| error >= before);
        let most = if is_rounding { ROUNDING / local_error } else { 0.0 };
        let passes = error <= most.max(SEVERAL);
        self.passed = passes.then_some(error);
        passes
    }

    /// Factor, at least 1, by which the errors of the last step may exceed those of others, because it went astride.
    pub(crate) fn allowance(&self) -> f64 {
        self.passed.map_or(1.0, |error| error.max(1.0))
    }

    /// Notes that a step was accepted. Beyond a bifurcation point, or if none is ahead, errors of earlier steps tell
    /// nothing any more.
    pub(crate) fn note_accepted(&mut self, length: f64) {
        let rises = || self.stages.last().map(|stage| stage.1) >= self.stages.first().map(|stage| stage.1);
        if self.lowest.is_none() || rises() || self.point().is_some_and(|(point, _)| point < length) {
            self.missed = None;
        }
    }

    /// Two lengths [s] for a step whose error asks for a `factor` below 1: the one asked for, and one no longer with
    /// which neither its stages nor its end are near a bifurcation point.
    pub(crate) fn shorter_lengths(&self, length: f64, factor: f64, method: Method) -> [f64; 2] {
        let factor = if self.is_astride(length) { factor.max(SHORTENING) } else { factor };
        let shorter = factor * length;
        let better = self.point().and_then(|(point, _)| led(point, shorter, method));
        [shorter, better.map_or(shorter, |better| better.min(shorter))]
    }

    /// True if a step goes astride of a bifurcation point: passes it far from its stages.
    fn is_astride(&self, length: f64) -> bool {
        self.point().is_some_and(|(point, away)| point < length && away > SMALL * length)
    }
}

/// A length [s], of `length` at most, with which a step goes astride of a point at an offset [s], or ends short of it
/// such that the next step can; `None` if the point is behind, or so near the start that no stage can be farther from
/// it.
fn led(point: f64, length: f64, method: Method) -> Option<f64> {
    let middle = method.middle_between_stages()?;
    let is_at_start = point <= 0.0 || EARLY * point <= length;
    let astride = point / middle;
    let short_of_it = (point - middle * length).max(SMALL * point);
    (!is_at_start).then_some(if astride <= length { astride } else { short_of_it })
}

#[cfg(test)]
mod tests {

    use super::*;

    /// Shares at the stages of a step of a length [s]: `floor` plus the square of the distance to a point [s], up to a
    /// factor.
    fn seen(length: f64, point: f64, floor: f64) -> Kept {
        let mut kept = Kept::default();
        kept.open();
        for node in [0.25, 0.05, 0.08, 0.12, 0.28, 1.0 / 3.0, 0.31, 0.65, 0.6, 0.86, 1.0, 1.0] {
            let way = 7.0 * (node * length - point);
            kept.note(node * length, floor + way * way);
        }
        kept.close();
        kept
    }

    #[test]
    fn a_step_is_led_astride_of_a_point_that_a_stage_comes_near() {
        for (length, point) in [(1.0, 0.3), (1.0, 0.27), (0.01, 0.0025), (2.0, 0.31), (1.0, 0.06)] {
            let better = seen(length, point, 0.0)
                .better_length(length, length, Method::Dop853)
                .expect("a stage is near");
            assert!(better < length);
            // The better step has the point in the middle of the widest interval, and is left as it is.
            assert!(
                (point / better - Method::Dop853.middle_between_stages().expect("it has stages")).abs()
                    < 1e-2,
                "{better}"
            );
            assert_eq!(seen(better, point, 0.0).better_length(better, better, Method::Dop853), None);
        }
    }

    #[test]
    fn a_step_that_cannot_pass_a_point_between_its_stages_ends_where_the_next_one_can() {
        let middle = Method::Dop853.middle_between_stages().expect("it has stages");
        for point in [0.6, 0.86, 0.97, 1.03, 1.3] {
            let better = seen(1.0, point, 0.0).better_length(1.0, 1.0, Method::Dop853).expect("it is near");
            assert!((better + middle - point).abs() < 1e-2, "{point}: {better}");
        }
        // If the point is nearly in the middle, the step still goes part of the way.
        let better = seen(1.0, 0.57, 0.0).better_length(1.0, 1.0, Method::Dop853).expect("a stage is near");
        assert!(better >= SMALL * 0.56, "{better}");
    }

    #[test]
    fn a_step_that_may_be_longer_passes_a_point_rather_than_ending_before_it() {
        let middle = Method::Dop853.middle_between_stages().expect("it has stages");
        let (length, point) = (0.5, 0.3);
        let kept = seen(length, point, 0.0);
        let [before, beyond] = [length, 1.0]
            .map(|most| kept.better_length(length, most, Method::Dop853).expect("a stage is near"));
        assert!(before < point && (beyond - point / middle).abs() < 1e-2, "{before}, {beyond}");
    }

    #[test]
    fn an_error_that_shorter_steps_do_not_mend_passes_astride() {
        let local_error: f64 = 1e-9;
        let mut kept = seen(1.0, 0.46, 0.0);
        assert!(kept.passes_astride(1.0, 3.0, local_error));
        assert_eq!(kept.allowance(), 3.0);
        kept.note_accepted(1.0);
        for (error, passes) in [(20.0, false), (10.0, false), (15.0, true), (1e4, false)] {
            assert_eq!(kept.passes_astride(1.0, error, local_error), passes, "{error}");
        }
        // With a coarse tolerance an error norm above 4 is not rounding.
        let mut kept = seen(1.0, 0.46, 0.0);
        for error in [10.0, 15.0] {
            assert!(!kept.passes_astride(1.0, error, 1e-5), "{error}");
            assert_eq!(kept.allowance(), 1.0);
        }
        // A step that is not astride is rejected as usual.
        for point in [0.3, 1.2] {
            assert!(!seen(1.0, point, 0.0).passes_astride(1.0, 3.0, local_error), "{point}");
        }
    }

    #[test]
    fn shares_that_show_no_point_ahead_lead_no_step() {
        // The point is behind, or far ahead, or before the first stage, or astride; or the share does not vanish.
        for (point, floor) in [(-0.5, 0.0), (1.6, 0.0), (0.01, 0.0), (0.45, 0.0), (0.3, 1.0)] {
            assert_eq!(seen(1.0, point, floor).better_length(1.0, 1.0, Method::Dop853), None, "{point}");
        }
        assert_eq!(seen(1.0, 0.3, 0.0).better_length(1.0, 1.0, Method::Rk4), None);
    }

    #[test]
    fn shares_in_another_measure_compare_with_those_before() {
        /// Makes a step that starts 0.5 s before a point, with the roots of the shares in some unit.
        fn step(kept: &mut Kept, unit: f64) {
            kept.open();
            for node in [0.1, 0.2, 0.4] {
                kept.note(node, (unit * (0.5 - node)).powi(2));
            }
            kept.close();
        }
        let mut kept = Kept::default();
        step(&mut kept, 2.0);
        let (most, least, point) = (kept.most, kept.least, kept.point());
        for _ in 0..2 {
            kept.change_measure();
            step(&mut kept, 1e-4);
            assert!((kept.least / least - 1.0).abs() < 1e-12 && kept.most == most, "{kept:?}");
        }
        // The other measure goes on until the first is restored.
        step(&mut kept, 1e-4);
        assert!((kept.least / least - 1.0).abs() < 1e-12);
        kept.restore_measure();
        step(&mut kept, 2.0);
        assert_eq!((kept.most, kept.least, kept.point()), (most, least, point));
    }

    #[test]
    fn a_shortened_step_does_not_end_at_a_point() {
        let kept = seen(1.0, 0.3, 0.0);
        for (factor, expected) in [(0.9, 0.643), (0.5, 0.0667), (0.2, 0.2)] {
            let [asked, led] = kept.shorter_lengths(1.0, factor, Method::Dop853);
            assert!(asked == factor && (led - expected).abs() < 1e-2, "{factor}: {led}");
        }
        for (point, factor) in [(2.0, 0.9), (-0.1, 0.9), (0.01, 0.9)] {
            assert_eq!(
                seen(1.0, point, 0.0).shorter_lengths(1.0, factor, Method::Dop853),
                [factor; 2],
                "{point}"
            );
        }
        // A step astride is shortened less at once: its errors are rounding, which grows as steps become shorter.
        let [asked, _] = seen(1.0, 0.46, 0.0).shorter_lengths(1.0, 0.2, Method::Dop853);
        assert_eq!(asked, SHORTENING);
    }
}
