//! Round numbers for axes and scale bars.

use std::ops::Range;

/// Sizes of numbers that are written without an exponent.
const PLAIN: Range<f64> = 1e-4..1e6;

/// Returns a round step (1, 2 or 5 times a power of ten) of which about `count` fit into `range`.
pub(super) fn round_step(range: f64, count: f64) -> f64 {
    let rough = range / count;
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let power = 10.0_f64.powf(rough.log10().floor());
    let lead = rough / power;
    let round = match lead {
        _ if lead < 1.5 => 1.0,
        _ if lead < 3.5 => 2.0,
        _ if lead < 7.5 => 5.0,
        _ => 10.0,
    };
    round * power
}

/// Returns the multiples of a round step from `low` to `high`, about `count` of them.
pub(super) fn ticks(low: f64, high: f64, count: f64) -> Vec<f64> {
    let step = round_step(high - low, count);
    let first = (low / step).ceil();
    let last = (high / step).floor();
    let most = 4.0 * count;
    if !(last - first).is_finite() || last - first > most {
        return Vec::new();
    }
    let steps = (last - first).max(-1.0) as i64;
    (0..=steps).map(|index| (first + index as f64) * step).collect()
}

/// Formats a number of an axis with a step: without an exponent where that is short.
pub(super) fn label(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let size = value.abs();
    if PLAIN.contains(&size) {
        let decimals = (-step.abs().log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:e}").chars().take(24).collect::<String>().replace("e", "·10^")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        assert_eq!([round_step(10.0, 5.0), round_step(1.3, 5.0), round_step(0.0, 5.0)], [2.0, 0.2, 1.0]);
    }

    #[test]
    fn ticks_cover_the_range_and_no_more() {
        assert_eq!(ticks(-0.1, 1.05, 5.0).len(), 6);
        assert!(ticks(1e300, 1e300, 5.0).len() <= 1);
        assert!(ticks(f64::NAN, 1.0, 5.0).is_empty());
        assert!(ticks(1e16, 1e16 + 2.0, 5.0).len() < 20);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!(
            [label(0.30000000000000004, 0.1), label(2e9, 1e9), label(5.0, 1.0)],
            ["0.3", "2·10^9", "5"]
        );
    }
}
