//! Numbers in messages, to three digits.

use std::fmt::{Display, Formatter, Result};

/// Sizes of numbers that are written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-3..1e6;

/// A number that displays with three digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded(pub(crate) f64);

impl Display for Rounded {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let short = format!("{:.2e}", self.0);
        let value: f64 = short.parse().unwrap_or(self.0);
        let is_plain = value == 0.0 || PLAIN.contains(&value.abs());
        if is_plain { write!(out, "{value}") } else { write!(out, "{value:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::Rounded;

    #[test]
    fn three_digits_are_shown() {
        let shown = [0.0, 0.25, 0.099_999_999_98, -123.456, 6.400_000_000_001e-7, 3.012e-13, 2.5e7]
            .map(|value| Rounded(value).to_string());
        assert_eq!(shown, ["0", "0.25", "0.1", "-123", "6.4e-7", "3.01e-13", "2.5e7"]);
    }
}
