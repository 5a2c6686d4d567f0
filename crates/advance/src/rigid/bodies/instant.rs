//! When two events are at one time.

use crate::time::Time;

/// Two events are at one time if they differ by at most this multiple of machine epsilon times the clock.
const SAME_TIME: f64 = 4.0;

/// True if no time but rounding lies between two events.
pub(crate) fn is_same_time(earlier: Time, later: Time) -> bool {
    later.since(earlier) <= SAME_TIME * f64::EPSILON * later.seconds().abs()
}
