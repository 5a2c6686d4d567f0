//! First time at which a parabola closes to zero, computed without cancellation.

/// First time t >= 0 [s] at which the gap c + v t + a t^2/2 is at most 0 while not growing (v + a t <= 0), for c [m],
/// v [m/s] and a [m/s^2].
///
/// It is 0 if the gap starts at most 0 and closes; `None` if this never happens, or if the gap starts at most 0, stands
/// still and does not close from there (v = 0 and a >= 0). Roots are taken in the form in which nothing cancels, so
/// that a = 0 and a double root need no special care. The result is unspecified for numbers that are not finite, or
/// whose squares and products overflow.
#[must_use]
#[inline]
pub fn first_closing_time(c: f64, v: f64, a: f64) -> Option<f64> {
    first_closing_by(c, v, a, v * v - 2.0 * a * c)
}

/// [`first_closing_time`] [s] for callers that know the discriminant v^2 - 2 a c more exactly than its terms give it.
#[inline]
pub(crate) fn first_closing_by(c: f64, v: f64, a: f64, discriminant: f64) -> Option<f64> {
    if c <= 0.0 {
        // At the target already: at once if closing, else when the parabola turns round below it or comes down to it.
        if v < 0.0 || (v == 0.0 && a < 0.0) {
            return Some(0.0);
        }
        if a >= 0.0 {
            return None;
        }
        return Some(if discriminant <= 0.0 { v / -a } else { (v + discriminant.sqrt()) / -a });
    }
    if discriminant < 0.0 || (v >= 0.0 && a >= 0.0) {
        return None;
    }
    let root = discriminant.sqrt();
    Some(if v <= 0.0 { 2.0 * c / (root - v) } else { (v + root) / -a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_falling_ball_lands() {
        assert_eq!(first_closing_time(5.0, 0.0, -10.0), Some(1.0));
        let thrown = first_closing_time(0.0, 10.0, -10.0).expect("it comes down");
        assert!((thrown - 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_receding_point_never_closes() {
        assert_eq!(first_closing_time(1.0, 0.0, 0.0), None);
        assert_eq!(first_closing_time(1.0, 2.0, 1.0), None);
        assert_eq!(first_closing_time(1.0, -1.0, 1.0), None);
        assert_eq!(first_closing_time(-1.0, 1.0, 0.0), None);
    }

    #[test]
    fn a_start_at_the_target_counts_if_it_closes() {
        assert_eq!(first_closing_time(0.0, -1.0, 5.0), Some(0.0));
        assert_eq!(first_closing_time(0.0, 0.0, -1.0), Some(0.0));
        assert_eq!(first_closing_time(0.0, 1.0, 1.0), None);
        assert_eq!(first_closing_time(0.0, 0.0, 0.0), None);
    }

    #[test]
    fn a_start_below_the_target_turns_back_at_the_top() {
        assert_eq!(first_closing_time(-1.0, 1.0, -1.0), Some(1.0));
        let over = first_closing_time(-0.375, 1.0, -1.0).expect("it rises above and falls back");
        assert!((over - 1.5).abs() < 1e-15);
    }

    #[test]
    fn nothing_cancels_for_tiny_accelerations() {
        let t = first_closing_time(1.0, -1.0, 1e-18).expect("it closes");
        assert!((t - 1.0).abs() < 1e-15);
    }
}
