//! Steps over points where the rows of loops depend on each other for a moment, as those of a parallelogram
//! do when it lies flat.
//!
//! There a loop could go on in two ways, and its motion says in which it does. Forces near such a point
//! follow from the rows divided by what a row keeps once the others are held, which falls with the square of
//! the distance, so near it rates are all rounding, and errors of the loop decide which way it goes. Far from
//! it nothing of that shows, so steps are made such that no stage comes near it: it is passed in the widest
//! interval between stages, and these are moved onto the rows (`on_rows`). A stage that is off them by e makes
//! accelerations of e over the cube of the distance from the point, whatever e is: a step that is too short
//! makes much of rounding. Whether a loop does pass such a point, or only nearly, tells how it is held along
//! the step, which `extending` looks at.

use crate::ode::Method;

/// A stage is near such a point when the point is less than this part of the step away.
const CLOSE: f64 = 0.1;
/// A step comes to such a point if the root of what a row keeps falls to this part of its largest.
const LOW: f64 = 0.35;
/// Such a point may be ahead where it has fallen to this part.
const LOWER: f64 = 0.7;
/// Stages are moved onto the rows where it has fallen to this part.
const NEAR: f64 = 0.15;
/// A step so many times as long as the way to such a point leaves it before its first stage.
const EARLY: f64 = 40.0;
/// Where a step cannot pass the point between its stages, it ends so early that one of its length can, after at
/// least this part of the way there.
const LEAST_WAY: f64 = 0.1;

/// A step astride of such a point may err by so many times what is acceptable: to come nearer to the point
/// costs more than that.
const ASTRIDE_ERROR: f64 = 4.0;
/// And by so much relative to what is usual, if shorter ones err by no less: that is rounding.
const ROUNDING: f64 = 1e-7;
/// It is made shorter by no more than this at once: what rounding makes of it grows with the square of that.
const SHORTENING: f64 = 0.5;

/// What the rows of loops kept at the stages of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept {
    /// Offset [s] and the root of the least part that a row kept.
    stages: Vec<(f64, f64)>,
    /// The root where the first stage of the next step is, if what rows keep is measured otherwise from there on.
    known: Option<f64>,
    /// What roots that are measured otherwise are multiplied by, so that they compare with those from before.
    unit: Option<f64>,
    /// The largest such root since there is the group.
    most: f64,
    /// The least of the last step.
    least: f64,
    /// The place in the list of the stage at which a row kept least, if that is little.
    lowest: Option<usize>,
    /// A step is made.
    is_open: bool,
    /// The last step was made shorter for such a point, and tells nothing about those after it.
    pub(crate) is_led: bool,
    /// Error norm of the last step astride of a point that erred by too much.
    missed: Option<f64>,
    /// Error norm of the last step astride of a point that passed although it is larger than others may be.
    passed: Option<f64>,
}

impl Kept {
    /// Forgets another group.
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

    /// Tells that rows keep parts of another measure from the next step on, which begins where the last one did.
    pub(crate) fn change_measure(&mut self) {
        let first = self.stages.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        (self.known, self.unit) = (first.map(|stage| stage.1), None);
    }

    /// Tells that rows keep parts of the first measure again.
    pub(crate) fn restore_measure(&mut self) {
        (self.known, self.unit) = (None, None);
    }

    /// Makes the roots of a step comparable with those from before they were measured otherwise.
    fn measure_as_before(&mut self) {
        if let Some(known) = self.known.take() {
            let first = self.stages.iter().min_by(|a, b| a.0.total_cmp(&b.0));
            self.unit = first.map(|first| known / first.1).filter(|unit| unit.is_normal());
        }
        if let Some(unit) = self.unit {
            self.stages.iter_mut().for_each(|stage| stage.1 *= unit);
        }
    }

    /// Whether stages are noted now: those of a step are, and nothing else that asks for rates.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Notes the least part that a row keeps at an offset [s].
    pub(crate) fn note(&mut self, offset: f64, kept: f64) {
        if self.is_open {
            self.stages.push((offset, kept.sqrt()));
        }
    }

    /// How fast [1/s] the root of what a row keeps falls towards a point where it keeps nothing, and rises again.
    fn slope(&self) -> f64 {
        let slopes =
            self.stages.windows(2).map(|pair| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs());
        slopes.fold(0.0, f64::max)
    }

    /// The point [s] where a row keeps nothing, or nearly, and how far [s] from it the nearest stage is.
    fn point(&self) -> Option<(f64, f64)> {
        let place = self.lowest?;
        let (offset, root) = self.stages[place];
        let slope = self.slope();
        if slope == 0.0 {
            return None;
        }
        let away = root / slope;
        // Towards the point the root falls short of what its slope makes of the way to the next stage.
        let short = |other: Option<&(f64, f64)>| {
            other.map_or(0.0, |other| slope * (other.0 - offset).abs() - other.1)
        };
        let before = short(place.checked_sub(1).and_then(|before| self.stages.get(before)));
        let after = short(self.stages.get(place + 1));
        Some((if before > after { offset - away } else { offset + away }, away))
    }

    /// True if the last step came to a point where rows depend on each other, or nearly.
    pub(crate) fn nears_singular(&self) -> bool {
        self.lowest.is_some()
    }

    /// True if the last step came so near such a point that stages off the rows make large forces of nothing.
    pub(crate) fn is_near_singular(&self) -> bool {
        self.least < NEAR * self.most
    }

    /// True if the next steps may come to such a point: what a loop is off by grows on the way there.
    pub(crate) fn may_near_singular(&self) -> bool {
        self.least < LOWER * self.most
    }

    /// A length [s], of `most` at most, for the last step, with which it will not come near such a point by one of its
    /// stages; `None` if it has not.
    pub(crate) fn better_length(&self, length: f64, most: f64, method: Method) -> Option<f64> {
        let (point, away) = self.point()?;
        let better = led(point, most, method)?;
        (away <= CLOSE * length || (point > length && better < length)).then_some(better)
    }

    /// True if a step that passed such a point between its stages, and whose error norm is too large, may
    /// pass all the same: it is not by much, or a longer one before it erred by no more, so no shorter one
    /// will err by less. A norm of 1 is an error of so much relative to what is usual.
    pub(crate) fn passes_astride(&mut self, length: f64, error: f64, local_error: f64) -> bool {
        if !self.is_astride(length) {
            return false;
        }
        let before = self.missed.replace(error);
        let is_rounding = before.is_some_and(|before| error >= before);
        let most = if is_rounding { ROUNDING / local_error } else { 0.0 };
        let passes = error <= most.max(ASTRIDE_ERROR);
        self.passed = passes.then_some(error);
        passes
    }

    /// By how many times what others may the last step may err: those astride of a point do so by more.
    pub(crate) fn allowance(&self) -> f64 {
        self.passed.map_or(1.0, |error| error.max(1.0))
    }

    /// Notes that a step was accepted: beyond a point, or where none is ahead, what erred before it tells
    /// nothing any more.
    pub(crate) fn note_accepted(&mut self, length: f64) {
        let rises = || self.stages.last().map(|stage| stage.1) >= self.stages.first().map(|stage| stage.1);
        if self.lowest.is_none() || rises() || self.point().is_some_and(|(point, _)| point < length) {
            self.missed = None;
        }
    }

    /// The length [s] that a step gets which erred by so much that it is to be made shorter by a factor, and one no
    /// longer with which it comes near such a point neither by its stages nor by its end.
    pub(crate) fn shorter_lengths(&self, length: f64, factor: f64, method: Method) -> [f64; 2] {
        let factor = if self.is_astride(length) { factor.max(SHORTENING) } else { factor };
        let shorter = factor * length;
        let better = self.point().and_then(|(point, _)| led(point, shorter, method));
        [shorter, better.map_or(shorter, |better| better.min(shorter))]
    }

    /// True if a step passes such a point between its stages.
    fn is_astride(&self, length: f64) -> bool {
        self.point().is_some_and(|(point, away)| point < length && away > CLOSE * length)
    }
}

/// A length [s] for a step that may be so long, with which it passes a point between its stages, or ends where the
/// next one will; `None` if that is behind, or so near the start that no stage can be farther from it.
fn led(point: f64, length: f64, method: Method) -> Option<f64> {
    let middle = method.middle_between_stages()?;
    let is_at_start = point <= 0.0 || EARLY * point <= length;
    let astride = point / middle;
    let short_of_it = (point - middle * length).max(LEAST_WAY * point);
    (!is_at_start).then_some(if astride <= length { astride } else { short_of_it })
}

#[cfg(test)]
mod tests {
    use super::*;

    const METHOD: Method = Method::Dop853;

    /// What a row keeps that keeps the square of the way to a point [s], at the stages of a step of so many seconds.
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
            let better =
                seen(length, point, 0.0).better_length(length, length, METHOD).expect("a stage is near");
            assert!(better < length);
            // The next one sees the point in the widest interval, and is left as it is.
            assert!(
                (point / better - METHOD.middle_between_stages().expect("it has stages")).abs() < 1e-2,
                "{better}"
            );
            assert_eq!(seen(better, point, 0.0).better_length(better, better, METHOD), None);
        }
    }

    #[test]
    fn a_step_that_cannot_pass_a_point_between_its_stages_ends_where_the_next_one_can() {
        let middle = METHOD.middle_between_stages().expect("it has stages");
        for point in [0.6, 0.86, 0.97, 1.03, 1.3] {
            let better = seen(1.0, point, 0.0).better_length(1.0, 1.0, METHOD).expect("it is near");
            assert!((better + middle - point).abs() < 1e-2, "{point}: {better}");
        }
        // What is nearly in the middle already is passed from not much nearer.
        let better = seen(1.0, 0.57, 0.0).better_length(1.0, 1.0, METHOD).expect("a stage is near");
        assert!(better >= LEAST_WAY * 0.56, "{better}");
    }

    #[test]
    fn a_step_that_may_be_longer_passes_a_point_rather_than_ending_before_it() {
        let middle = METHOD.middle_between_stages().expect("it has stages");
        let (length, point) = (0.5, 0.3);
        let kept = seen(length, point, 0.0);
        let [before, beyond] =
            [length, 1.0].map(|most| kept.better_length(length, most, METHOD).expect("a stage is near"));
        assert!(before < point && (beyond - point / middle).abs() < 1e-2, "{before}, {beyond}");
    }

    #[test]
    fn what_shorter_steps_do_not_mend_passes_astride() {
        const LOCAL_ERROR: f64 = 1e-9;
        let mut kept = seen(1.0, 0.46, 0.0);
        assert!(kept.passes_astride(1.0, 3.0, LOCAL_ERROR));
        assert_eq!(kept.allowance(), 3.0);
        kept.note_accepted(1.0);
        for (error, passes) in [(20.0, false), (10.0, false), (15.0, true), (1e4, false)] {
            assert_eq!(kept.passes_astride(1.0, error, LOCAL_ERROR), passes, "{error}");
        }
        // Of what is not asked for with much care, little is rounding.
        let mut kept = seen(1.0, 0.46, 0.0);
        for error in [10.0, 15.0] {
            assert!(!kept.passes_astride(1.0, error, 1e-5), "{error}");
            assert_eq!(kept.allowance(), 1.0);
        }
        // What does not pass a point by its middle is rejected as ever.
        for point in [0.3, 1.2] {
            assert!(!seen(1.0, point, 0.0).passes_astride(1.0, 3.0, LOCAL_ERROR), "{point}");
        }
    }

    #[test]
    fn what_rows_keep_otherwise_leads_no_step() {
        // Far from a point, or beyond it, or where rows come near to depending on each other but do not.
        for (point, floor) in [(-0.5, 0.0), (1.6, 0.0), (0.01, 0.0), (0.45, 0.0), (0.3, 1.0)] {
            assert_eq!(seen(1.0, point, floor).better_length(1.0, 1.0, METHOD), None, "{point}");
        }
        assert_eq!(seen(1.0, 0.3, 0.0).better_length(1.0, 1.0, Method::Rk4), None);
    }

    #[test]
    fn what_is_measured_otherwise_compares_with_what_was_before() {
        /// A step from 0.5 s before a point on, of which what rows keep is measured in some unit.
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
        // As long as it lasts, and no longer.
        step(&mut kept, 1e-4);
        assert!((kept.least / least - 1.0).abs() < 1e-12);
        kept.restore_measure();
        step(&mut kept, 2.0);
        assert_eq!((kept.most, kept.least, kept.point()), (most, least, point));
    }

    #[test]
    fn what_is_made_shorter_does_not_end_at_a_point() {
        let kept = seen(1.0, 0.3, 0.0);
        for (factor, expected) in [(0.9, 0.643), (0.5, 0.0667), (0.2, 0.2)] {
            let [asked, led] = kept.shorter_lengths(1.0, factor, METHOD);
            assert!(asked == factor && (led - expected).abs() < 1e-2, "{factor}: {led}");
        }
        for (point, factor) in [(2.0, 0.9), (-0.1, 0.9), (0.01, 0.9)] {
            assert_eq!(seen(1.0, point, 0.0).shorter_lengths(1.0, factor, METHOD), [factor; 2], "{point}");
        }
        // Astride of a point rounding decides, and grows where steps are short.
        let [asked, _] = seen(1.0, 0.46, 0.0).shorter_lengths(1.0, 0.2, METHOD);
        assert_eq!(asked, SHORTENING);
    }
}
