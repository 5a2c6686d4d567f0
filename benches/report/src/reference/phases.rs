//! Motion in minimal coordinates whose law changes at events: a motor that reaches its speed, a joint that meets a limit
//! or sticks.
//!
//! Each phase is smooth and is integrated by extrapolated steps of order 16. A step in which a guard turns negative is
//! cut where it does so, by halving; there the next phase begins.

use super::extrapolation::extrapolated;

/// Halvings of a step until nothing is left of it.
const HALVINGS: usize = 60;

/// A system whose phases have numbers.
pub(crate) trait Phased {
    /// Writes the rates of the state in a phase.
    fn rates(&self, phase: usize, state: &[f64], rates: &mut [f64]);

    /// Values that are positive while a phase lasts; at its very start they may be 0.
    fn guards(&self, phase: usize, state: &[f64]) -> Vec<f64>;

    /// The phase that begins where a guard of one turned negative; the state may jump.
    fn next(&self, phase: usize, guard: usize, state: &mut [f64]) -> usize;
}

/// States at the ascending times, from time 0 on, and the largest difference to those by steps half as long again.
#[must_use]
pub(crate) fn solve(
    system: &dyn Phased,
    phase: usize,
    start: &[f64],
    times: &[f64],
    step: f64,
) -> (Vec<Vec<f64>>, f64) {
    let [fine, coarse] = [step, 1.5 * step].map(|step| by_steps(system, phase, start, times, step));
    let differences = fine.iter().flatten().zip(coarse.iter().flatten()).map(|(a, b)| (a - b).abs());
    let doubt = differences.fold(0.0, f64::max);
    (fine, doubt)
}

fn by_steps(system: &dyn Phased, mut phase: usize, start: &[f64], times: &[f64], step: f64) -> Vec<Vec<f64>> {
    let (mut state, mut now) = (start.to_vec(), 0.0);
    let mut states = Vec::with_capacity(times.len());
    for &time in times {
        while now < time {
            // No sliver of a step before the time.
            let left = time - now;
            let length = if left < 1.5 * step { left } else { step };
            let rates = |state: &[f64], rates: &mut [f64]| system.rates(phase, state, rates);
            let after = |length: f64| extrapolated(&rates, &state, length);
            let first_broken =
                |state: &[f64]| system.guards(phase, state).iter().position(|&guard| guard < 0.0);
            let whole = after(length);
            if first_broken(&whole).is_none() {
                (state, now) = (whole, now + length);
                continue;
            }
            let (mut kept, mut broken) = (0.0, length);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (kept + broken);
                if first_broken(&after(middle)).is_some() { broken = middle } else { kept = middle }
            }
            let mut at_event = after(broken);
            let guard = first_broken(&at_event).unwrap_or(0);
            phase = system.next(phase, guard, &mut at_event);
            (state, now) = (at_event, now + broken);
        }
        states.push(state.clone());
    }
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball that falls and loses half its speed in each bounce.
    struct Ball;

    impl Phased for Ball {
        fn rates(&self, _: usize, state: &[f64], rates: &mut [f64]) {
            rates.copy_from_slice(&[state[1], -10.0]);
        }

        fn guards(&self, _: usize, state: &[f64]) -> Vec<f64> {
            vec![state[0]]
        }

        fn next(&self, phase: usize, _: usize, state: &mut [f64]) -> usize {
            state[0] = 0.0;
            state[1] *= -0.5;
            phase
        }
    }

    #[test]
    fn a_ball_bounces_where_it_should() {
        // It falls 5 m in 1 s, then rises at 5 m/s.
        let (states, doubt) = solve(&Ball, 0, &[5.0, 0.0], &[0.9, 1.4], 0.07);
        assert!((states[0][0] - 0.95).abs() < 1e-12 && doubt < 1e-11);
        assert!((states[1][0] - 1.2).abs() < 1e-12 && (states[1][1] - 1.0).abs() < 1e-12, "{states:?}");
    }
}
