//! A clock whose sums lose no digits: an unevaluated sum of two numbers.

use std::cmp::Ordering;
use std::fmt;

/// A time [s], held as the unevaluated sum of two numbers and compared exactly. A NaN, as of 0/0, becomes
/// [`NEVER`](Self::NEVER).
///
/// Adding a step is exact to about 1e-32 of the time, so that an event a million seconds into a run is as sharp as one
/// at its start. Source of the exact sum: D. Knuth, The Art of Computer Programming 2, 4.2.2, theorem B.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Time {
    seconds: f64,
    rest: f64,
}

impl Time {
    /// The start of the clock.
    pub const ZERO: Time = Time { seconds: 0.0, rest: 0.0 };
    /// Later than any event.
    pub const NEVER: Time = Time { seconds: f64::INFINITY, rest: 0.0 };

    /// The time of a number of seconds, exactly; [`NEVER`](Self::NEVER) for NaN.
    #[must_use]
    #[inline]
    pub fn from_seconds(seconds: f64) -> Self {
        if seconds.is_nan() { Self::NEVER } else { Self { seconds, rest: 0.0 } }
    }

    /// Both numbers of the sum [s]. The first alone orders times in which it differs.
    #[inline]
    pub(crate) fn parts(self) -> (f64, f64) {
        (self.seconds, self.rest)
    }

    /// The time of two numbers [s] from [`Self::parts`].
    #[inline]
    pub(crate) fn from_parts(seconds: f64, rest: f64) -> Self {
        Self { seconds, rest }
    }

    /// The time as one number [s], rounded.
    #[must_use]
    #[inline]
    pub fn seconds(self) -> f64 {
        self.seconds
    }

    /// The time `step` seconds later; earlier for a negative step.
    #[must_use]
    #[inline]
    pub fn plus(self, step: f64) -> Self {
        let sum = self.seconds + step;
        if !sum.is_finite() {
            return Self::from_seconds(sum);
        }
        let step_part = sum - self.seconds;
        let error = (self.seconds - (sum - step_part)) + (step - step_part);
        // Renormalise, so that comparisons may look at the first number first.
        let rest = self.rest + error;
        let seconds = sum + rest;
        Self { seconds, rest: rest - (seconds - sum) }
    }

    /// Seconds from an earlier time to this one; negative if it is later.
    #[must_use]
    #[inline]
    pub fn since(self, earlier: Time) -> f64 {
        (self.seconds - earlier.seconds) + (self.rest - earlier.rest)
    }

    /// True if this time is earlier, found without a branch.
    #[inline]
    pub(crate) fn is_before(self, other: Time) -> bool {
        (self.seconds < other.seconds) | ((self.seconds == other.seconds) & (self.rest < other.rest))
    }

    /// The earlier of two times.
    #[must_use]
    #[inline]
    pub fn min(self, other: Time) -> Time {
        // A branch would be mispredicted often: there is none.
        [self, other][usize::from(other < self)]
    }

    /// The later of two times.
    #[must_use]
    #[inline]
    pub fn max(self, other: Time) -> Time {
        if other > self { other } else { self }
    }
}

impl PartialEq for Time {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        (self.seconds == other.seconds) & (self.rest == other.rest)
    }
}

impl Eq for Time {}

impl PartialOrd for Time {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }

    #[inline]
    fn lt(&self, other: &Self) -> bool {
        self.is_before(*other)
    }

    #[inline]
    fn gt(&self, other: &Self) -> bool {
        other < self
    }

    #[inline]
    fn le(&self, other: &Self) -> bool {
        !other.is_before(*self)
    }

    #[inline]
    fn ge(&self, other: &Self) -> bool {
        other <= self
    }
}

impl Ord for Time {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        debug_assert!(!self.seconds.is_nan() && !other.seconds.is_nan(), "times are numbers");
        if self < other {
            Ordering::Less
        } else if other < self {
            Ordering::Greater
        } else {
            Ordering::Equal
        }
    }
}

impl fmt::Display for Time {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.seconds.fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_steps_lose_nothing() {
        let mut time = Time::from_seconds(1e6);
        for _ in 0..1_000_000 {
            time = time.plus(0.1);
        }
        // 0.1 as a double, a million times.
        let exact = 0.1f64.mul_add(1e6, -1e5);
        assert!((time.since(Time::from_seconds(1.1e6)) - exact).abs() < 1e-16);
    }

    #[test]
    fn times_closer_than_a_double_can_tell_are_ordered() {
        let late = Time::from_seconds(1e6);
        let later = late.plus(1e-15);
        assert_eq!(later.seconds(), late.seconds());
        assert!(later > late);
        assert!((later.since(late) - 1e-15).abs() < 1e-30);
        assert!(late.plus(-1e-15) < late);
    }

    #[test]
    fn never_is_later_than_everything() {
        assert!(Time::NEVER > Time::from_seconds(f64::MAX));
        assert_eq!(Time::ZERO.plus(f64::INFINITY), Time::NEVER);
        for none in
            [Time::from_seconds(f64::NAN), Time::ZERO.plus(f64::NAN), Time::NEVER.plus(-f64::INFINITY)]
        {
            assert_eq!(none, Time::NEVER);
        }
    }
}
