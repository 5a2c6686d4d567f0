//! Round numbers for axes and scale bars.
//!
//! A round step is 1, 2 or 5 times a power of ten, and ticks are whole multiples of it: they are written from the whole
//! number and the power, so that no rounding of their values shows.

use std::ops::Range;

/// Decimal exponents of numbers that are written without a power of ten.
const PLAIN: Range<i32> = -4..7;
/// Largest number of digits of a double that mean something.
const DIGITS: i32 = 15;
/// Part of a step by which rounding may put a tick beyond the end of its axis.
const TICK_ROUNDING: f64 = 1e-9;
/// Largest whole multiple of a step; beyond it neighbours are one double.
const LARGEST_MULTIPLE: f64 = 9e15;

/// A round number: 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RoundStep {
    lead: i64,
    exponent: i32,
}

impl RoundStep {
    const ONE: Self = Self { lead: 1, exponent: 0 };

    /// Returns a round step of which about `count` fit into `range`.
    pub(super) fn of(range: f64, count: f64) -> Self {
        let rough = range / count;
        if !(rough.is_finite() && rough > 0.0) {
            return Self::ONE;
        }
        let exponent = rough.log10().floor() as i32;
        let (lead, exponent) = match rough / decimal(1, exponent) {
            part if part < 1.5 => (1, exponent),
            part if part < 3.5 => (2, exponent),
            part if part < 7.5 => (5, exponent),
            _ => (1, exponent + 1),
        };
        Self { lead, exponent }
    }

    pub(super) fn size(self) -> f64 {
        decimal(self.lead, self.exponent)
    }

    /// Writes the number.
    pub(super) fn label(self) -> String {
        written(self.lead, self.exponent)
    }
}

/// The ticks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Values of the ticks with their labels, in units of the power.
    pub(super) labels: Vec<(f64, String)>,
    /// Exponent of the power of ten by which the labels are to be multiplied.
    pub(super) power: i32,
}

impl Ticks {
    /// Returns the multiples of a round step from `low` to `high`, about `count` of them, with labels of at most
    /// `longest` characters; `None` if the digits that tell them apart are more than that.
    pub(super) fn new((low, high): (f64, f64), count: f64, longest: usize) -> Option<Self> {
        let step = RoundStep::of(high - low, count);
        let (first, last) =
            ((low / step.size() - TICK_ROUNDING).ceil(), (high / step.size() + TICK_ROUNDING).floor());
        let most = 4.0 * count;
        let few = last - first <= most && first.abs().max(last.abs()) <= LARGEST_MULTIPLE;
        if !few {
            return None;
        }
        let multiples: Vec<i64> = (first as i64..=last as i64).map(|index| index * step.lead).collect();
        let largest = multiples.iter().map(|multiple| multiple.unsigned_abs()).max().unwrap_or(0);
        let lead = digits(largest) - 1 + step.exponent;
        let plain = PLAIN.contains(&step.exponent) && PLAIN.contains(&lead);
        let powers = plain.then_some(0).into_iter().chain([lead]);
        powers.into_iter().find_map(|power| {
            let label =
                |&multiple: &i64| (decimal(multiple, step.exponent), fixed(multiple, step.exponent - power));
            let labels: Vec<_> = multiples.iter().map(label).collect();
            let fit = labels.iter().all(|(_, label)| label.chars().count() <= longest);
            fit.then_some(Self { labels, power })
        })
    }

    /// Returns a unit with the power of ten of the labels.
    pub(super) fn unit(&self, unit: &str) -> String {
        if self.power == 0 { unit.to_owned() } else { format!("10^{} {unit}", self.power) }
    }
}

/// Writes a number rounded to a power of ten, with all digits down to it; with a power of ten where that is shorter.
pub(super) fn rounded(value: f64, exponent: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let exponent = exponent.max(value.abs().log10().floor() as i32 - DIGITS);
    written((value / decimal(1, exponent)).round() as i64, exponent)
}

/// Exponent of the power of ten that is at most a positive number.
pub(super) fn exponent_below(value: f64) -> i32 {
    if value > 0.0 && value.is_finite() { value.log10().floor() as i32 } else { 0 }
}

/// Writes `number · 10^exponent`.
fn written(number: i64, exponent: i32) -> String {
    let lead = digits(number.unsigned_abs()) - 1 + exponent;
    if number == 0 {
        "0".to_owned()
    } else if PLAIN.contains(&lead) {
        fixed(number, exponent)
    } else {
        let text = fixed(number, exponent - lead);
        let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        format!("{short}·10^{lead}")
    }
}

/// Writes `number · 10^exponent` without a power of ten.
fn fixed(number: i64, exponent: i32) -> String {
    let places = usize::try_from(-exponent).unwrap_or(0);
    let sign = if number < 0 { "-" } else { "" };
    let figures = format!("{:0>1$}", number.unsigned_abs(), places + 1);
    let (whole, part) = figures.split_at(figures.len() - places);
    let zeros = if number == 0 { 0 } else { usize::try_from(exponent).unwrap_or(0) };
    let point = if part.is_empty() { "" } else { "." };
    if number == 0 { "0".to_owned() } else { format!("{sign}{whole}{}{point}{part}", "0".repeat(zeros)) }
}

/// Number of digits of a whole number; 1 for 0.
fn digits(number: u64) -> i32 {
    number.checked_ilog10().map_or(1, |log| log as i32 + 1)
}

/// Returns `number · 10^exponent`, the nearest double for common sizes.
fn decimal(number: i64, exponent: i32) -> f64 {
    const LARGEST_POWER: i32 = 300;
    if exponent >= 0 {
        number as f64 * 10.0_f64.powi(exponent)
    } else {
        // In two steps, as the power of a very small number would overflow.
        let first = (-exponent).min(LARGEST_POWER);
        number as f64 / 10.0_f64.powi(first) / 10.0_f64.powi(-exponent - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: (f64, f64), count: f64, longest: usize) -> (Vec<String>, i32) {
        let ticks = Ticks::new(range, count, longest).expect("labels that fit");
        (ticks.labels.into_iter().map(|(_, label)| label).collect(), ticks.power)
    }

    #[test]
    fn steps_are_round() {
        assert_eq!(
            [(10.0, 5.0), (1.3, 5.0), (0.0, 5.0)].map(|(range, count)| RoundStep::of(range, count).size()),
            [2.0, 0.2, 1.0]
        );
        assert_eq!(
            [5e-6, 2e9, 0.5, 100.0, 1e-3].map(|size| RoundStep::of(size, 1.0).label()),
            ["5·10^-6", "2·10^9", "0.5", "100", "0.001"]
        );
    }

    #[test]
    fn ticks_cover_the_range_and_no_more() {
        assert_eq!(labels((-0.1, 1.05), 5.0, 9).0, ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert!(Ticks::new((1e300, 1e300), 5.0, 9).is_none_or(|ticks| ticks.labels.len() <= 1));
        assert!(Ticks::new((f64::NAN, 1.0), 5.0, 9).is_none());
        assert!(Ticks::new((1e16, 1e16 + 2.0), 5.0, 9).is_none());
        assert_eq!(labels((0.0, 3e-310), 5.0, 9).1, -310);
    }

    #[test]
    fn labels_show_no_rounding_and_share_a_power_of_ten() {
        assert_eq!(
            labels((0.0, 3e-5), 8.0, 7),
            (["0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"].map(str::to_owned).to_vec(), -5)
        );
        let (texts, power) = labels((0.0, 3.2e7), 8.0, 7);
        assert_eq!((texts[1].as_str(), power), ("0.5", 7));
        assert_eq!(labels((-30.0, 70.0), 5.0, 7).0, ["-20", "0", "20", "40", "60"]);
        assert!(
            Ticks::new((1_000_000.5, 1_000_005.5), 8.0, 7).is_none(),
            "seven characters do not tell them apart"
        );
        assert_eq!(labels((1_000_000.5, 1_000_005.5), 8.0, 9).0[1], "1000001.0");
    }

    #[test]
    fn numbers_are_rounded_to_a_power_of_ten() {
        assert_eq!(
            [rounded(0.300_000_000_000_000_04, -1), rounded(2.0, -3), rounded(1_000_005.5, -3)],
            ["0.3", "2.000", "1000005.500"]
        );
        assert_eq!(
            [rounded(2.999_999_999_999_999_7e-5, -8), rounded(3.2e9, -3), rounded(1e-9, -3)],
            ["3·10^-5", "3.2·10^9", "0"]
        );
    }
}
