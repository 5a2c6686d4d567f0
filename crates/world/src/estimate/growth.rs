//! Distinction of chaos from integration error, by the growth of the difference of two runs.
//!
//! Errors of an integration grow with a low power of the time: the phase of an orbit drifts. In chaos
//! neighbouring runs part exponentially, or at once where a small difference decides which of two events
//! happens; then no tolerance helps for long, and the run is meaningful only until the difference has
//! grown to the size of the bodies.

/// Difference up to which a run is trusted, as a fraction of a body's own size.
const WORTH: f64 = 1e-2;
/// Difference up to which a run is trusted, as a multiple of the usual difference, if that is more.
const WORTH_OF_USUAL: f64 = 4.0;
/// Difference that counts as amplified although it is still small, as a multiple of the usual difference.
const AMPLIFIED: f64 = 1e4;
/// Factor by which an error that grows with the sixth power of the time grows in the second half of the time.
const SECOND_HALF: f64 = 64.0;

/// Judgement on the growth of a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Growth {
    /// Whether the difference grows faster than errors of integration do.
    pub(super) chaotic: bool,
    /// The last time [s] up to which the difference was small; `None` if it is small to the end.
    pub(super) trusted_until: Option<f64>,
}

/// Judges a list of times [s] and differences, as fractions of a body's size. `usual` is the difference that is normal:
/// the tolerance, or the target gap as a fraction of a body's size.
pub(super) fn judge(shifts: &[(f64, f64)], usual: f64) -> Growth {
    let small = |shift: f64| shift <= WORTH.max(WORTH_OF_USUAL * usual);
    let lost = shifts.iter().position(|&(_, shift)| !small(shift));
    let trusted_until = lost.map(|index| shifts[index.saturating_sub(1)].0);
    let used = &shifts[..lost.map_or(shifts.len(), |index| index + 1)];
    let (Some(first), Some(last)) = (used.first(), used.last()) else {
        return Growth { chaotic: false, trusted_until };
    };
    let half = 0.5 * (first.0 + last.0);
    let largest = |until: f64| {
        used.iter().filter(|(time, _)| *time <= until).map(|(_, shift)| *shift).fold(0.0, f64::max)
    };
    let (at_half, at_end) = (largest(half).max(usual), largest(last.0));
    let matters = lost.is_some() || at_end > AMPLIFIED * usual;
    let chaotic = matters && at_end > SECOND_HALF * at_half;
    Growth { chaotic, trusted_until }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shifts(of_time: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..=100).map(f64::from).map(|time| (time, of_time(time))).collect()
    }

    #[test]
    fn a_drift_is_not_chaos() {
        let drift = shifts(|time| 1e-8 * time * time);
        assert_eq!(judge(&drift, 1e-8), Growth { chaotic: false, trusted_until: None });
        // A drift that is lost in the end is inexact, but not chaotic.
        let loose = shifts(|time| 1e-5 * time * time);
        assert_eq!(judge(&loose, 1e-5), Growth { chaotic: false, trusted_until: Some(31.0) });
    }

    #[test]
    fn exponential_growth_is_chaos() {
        // From 1e-8 to 1e-2 by exp(t/2): t = 2 ln(1e6) = 27.6.
        let chaos = shifts(|time| (1e-8 * (0.5 * time).exp()).min(3.0));
        assert_eq!(judge(&chaos, 1e-8), Growth { chaotic: true, trusted_until: Some(27.0) });
    }

    #[test]
    fn a_touch_at_a_wide_gap_is_not_chaos() {
        // A ball of 0.1 m whose zone is 5 mm away from the floor.
        let shift = shifts(|time| if time > 40.0 { 0.1 } else { 1e-9 });
        assert_eq!(judge(&shift, 5e-2), Growth { chaotic: false, trusted_until: None });
        assert!(judge(&shift, 1e-8).chaotic);
    }

    #[test]
    fn a_sudden_parting_is_chaos() {
        let fork = shifts(|time| if time > 40.0 { 0.5 } else { 1e-9 });
        assert_eq!(judge(&fork, 1e-8), Growth { chaotic: true, trusted_until: Some(40.0) });
    }
}
