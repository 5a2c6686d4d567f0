//! Numbers in messages: as many digits as tell something to a person.

use std::fmt::{Display, Formatter, Result};

/// From here to there numbers are written out, others with a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-3..1e6;

/// A number of which three digits are shown.
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
