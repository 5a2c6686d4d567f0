//! Numbers in tables: no more digits than a run can know, and a power of ten only where it is needed.
//!
//! Sums of numbers of a size are known to some digits of that size: a speed of 1e-80 m/s beside others of 1 m/s is 0.

use std::ops::Range;

/// Sizes that are written without a power of ten.
const PLAIN: Range<f64> = 1e-3..1e5;

/// Digits of states, counted from that of the largest in the scene. A table is read by eye; `--json` has all digits.
const OF_STATES: i32 = 10;
/// Digits of energies, counted from that of the largest in the run: beyond, sums are rounding.
const OF_ENERGIES: i32 = 15;
/// Digits of lengths, counted from that of the largest coordinate, in which gaps are told from rounding.
const OF_GAPS: i32 = 16;
/// Exponent of the last digit of a number that is no sum: below that of any, and far enough from the least integer for
/// sums with it.
const EXACT: i32 = i32::MIN / 2;

/// Returns a state in a column of numbers of a scale: all have their last digit at the same place, where that
/// can be without a power of ten.
pub(crate) fn state(value: f64, scale: f64) -> String {
    let last = exponent_above(scale.max(value.abs())) - OF_STATES;
    if PLAIN.contains(&scale) && value.abs() < PLAIN.end {
        let text = format!("{value:.0$}", places(last));
        return if text.trim_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { text };
    }
    written(value, last, OF_STATES)
}

/// Returns an energy [J] with up to ten digits, of a run in which energies are of a scale [J].
pub(crate) fn energy(value: f64, scale: f64) -> String {
    written(value, exponent_above(scale) - OF_ENERGIES, 10)
}

/// Returns a change of the energy [J] with its sign and four digits.
pub(crate) fn change(value: f64, scale: f64) -> String {
    signed(written(value, exponent_above(scale) - OF_ENERGIES, 4))
}

/// Returns a change of the energy [J] with its sign and up to ten digits, as energies have them.
pub(crate) fn booked(value: f64, scale: f64) -> String {
    signed(energy(value, scale))
}

/// Returns a gap or an error [m] with four digits, in a scene whose coordinates are of a scale [m].
pub(crate) fn gap(value: f64, scale: f64) -> String {
    written(value, exponent_above(scale) - OF_GAPS, 4)
}

/// Returns a size with three digits.
pub(crate) fn size(value: f64) -> String {
    written(value, EXACT, 3)
}

/// Returns a number that is known exactly, such as a given one, with up to ten digits.
pub(crate) fn given(value: f64) -> String {
    written(value, EXACT, 10)
}

/// Puts a sign before a written number that is positive.
fn signed(text: String) -> String {
    let is_positive = !text.starts_with('-') && text != "0" && text != "NaN";
    if is_positive { format!("+{text}") } else { text }
}

/// Writes a number to the digit of 10^`last`, and to `most` digits at most, without zeros at the end.
fn written(value: f64, last: i32, most: i32) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    let first = exponent(value);
    let last = last.max(first - most + 1);
    if value == 0.0 || first < last {
        return "0".to_owned();
    }
    if PLAIN.contains(&value.abs()) {
        return short(&format!("{value:.0$}", places(last)));
    }
    let text = format!("{value:.0$e}", places(last - first));
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{power}", short(digits))
}

/// Returns a text of digits without zeros behind the point.
fn short(digits: &str) -> String {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        digits.to_owned()
    }
}

/// Number of places behind the point, or behind the first digit, down to the digit of 10^`last`.
fn places(last: i32) -> usize {
    usize::try_from(-last).unwrap_or(0)
}

/// Exponent of the first digit of a number; 0 for 0.
fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// Exponent of the least power of ten that is more than a scale.
fn exponent_above(scale: f64) -> i32 {
    exponent(scale) + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_show_no_digits_below_ten_of_the_scale() {
        let of_metres =
            [2.0, -0.430_604_508_12, 4.5e-213, -1e-10, 1.75e-4, 0.0].map(|value| state(value, 3.0));
        assert_eq!(of_metres, ["2.000000000", "-0.430604508", "0", "0", "0.000175000", "0"]);
        assert_eq!([state(384_400_000.0, 4e8), state(1.5, 4e8)], ["3.844e8", "1.5"]);
        assert_eq!(state(0.001_234_567_890_123, 0.005), "0.001234567890");
        assert_eq!([state(2e-9, 1e-8), state(1.0, 1.0)], ["2e-9", "1.000000000"]);
        assert_eq!([state(f64::NAN, 1.0), state(1e9, 1.0)], ["NaN", "1e9"]);
    }

    #[test]
    fn energies_below_a_digit_that_sums_have_are_zero() {
        assert_eq!(energy(5.717e-158, 80.0), "0");
        assert_eq!(energy(22.185_496_627_123, 22.2), "22.18549663");
        assert_eq!(
            [change(1.2e-35, 9.81), change(-3.2e-14, 9.81), change(2.5e-9, 9.81)],
            ["0", "-3e-14", "+2.5e-9"]
        );
        assert_eq!([change(-30.24, 80.0), change(1.5, 80.0)], ["-30.24", "+1.5"]);
        assert_eq!([change(0.0, 0.0), change(f64::NAN, 1.0)], ["0", "NaN"]);
        assert_eq!([booked(1e-35, 9.81), booked(-0.25, 9.81), booked(0.125, 9.81)], ["0", "-0.25", "+0.125"]);
    }

    #[test]
    fn sizes_have_few_digits_and_no_power_of_ten_that_is_not_needed() {
        assert_eq!([size(1.5), size(0.0), size(6.172_839e-9), size(0.25)], ["1.5", "0", "6.17e-9", "0.25"]);
        assert_eq!(
            [given(0.2), given(0.1 + 0.2), given(1e-8), given(123_456.0)],
            ["0.2", "0.3", "1e-8", "1.23456e5"]
        );
        assert_eq!([gap(9.9994e-11, 10.0), gap(1e-30, 10.0)], ["9.999e-11", "0"]);
    }
}
