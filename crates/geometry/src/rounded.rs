//! Numbers in messages: as many digits as one reads, and a power of ten only where it is needed.

use std::fmt::{Display, Formatter, Result};
use std::ops::Range;

/// Sizes of numbers that are written without a power of ten.
const PLAIN: Range<f64> = 1e-3..1e6;

/// A size that displays with three digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded(pub f64);

/// A time or a place that displays with seven digits, by which it can be found again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedPlace(pub f64);

impl Display for Rounded {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        write_rounded(out, self.0, 3)
    }
}

impl Display for RoundedPlace {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        write_rounded(out, self.0, 7)
    }
}

fn write_rounded(out: &mut Formatter<'_>, value: f64, digits: usize) -> Result {
    let short = format!("{value:.0$e}", digits - 1);
    let value: f64 = short.parse().unwrap_or(value);
    let is_plain = value == 0.0 || PLAIN.contains(&value.abs());
    if is_plain { write!(out, "{value}") } else { write!(out, "{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_of_a_size_are_shown_and_seven_of_a_place() {
        let values =
            [0.0, 0.25, 0.099_999_999_98, -123.456, 6.400_000_000_001e-7, 3.012e-13, 2.5e7, 1.5, f64::NAN];
        let shown = values.map(|value| Rounded(value).to_string());
        assert_eq!(shown, ["0", "0.25", "0.1", "-123", "6.4e-7", "3.01e-13", "2.5e7", "1.5", "NaN"]);
        let shown = [0.000_001_682_455_835_353, 0.454_903_810_567, 12_345.678_9]
            .map(|value| RoundedPlace(value).to_string());
        assert_eq!(shown, ["1.682456e-6", "0.4549038", "12345.68"]);
    }
}
