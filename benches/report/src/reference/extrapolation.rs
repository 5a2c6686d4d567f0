//! Integration of `y' = f(y)` by extrapolated midpoint steps.
//!
//! The modified midpoint rule with 2, 4, ..., 16 substeps has an error in even powers of the substep, so
//! extrapolation in its square gives order 16. W. B. Gragg, "On extrapolation algorithms for ordinary initial
//! value problems", SIAM J. Numer. Anal. 2 (1965), 384-403; E. Hairer, S. P. Nørsett, G. Wanner, "Solving
//! Ordinary Differential Equations I", II.9.

/// Columns of the extrapolation table.
const COLUMNS: usize = 8;

/// A right-hand side: writes `f(y)` to its second argument.
pub(crate) type Rates<'a> = &'a dyn Fn(&[f64], &mut [f64]);

/// Integrates from time 0 to each of the ascending `times` by steps of at most `step`; a state per time.
#[must_use]
pub(crate) fn solve(rates: Rates, start: &[f64], times: &[f64], step: f64) -> Vec<Vec<f64>> {
    let (mut state, mut now) = (start.to_vec(), 0.0);
    let mut states = Vec::with_capacity(times.len());
    for &time in times {
        let count = ((time - now) / step).ceil().max(1.0);
        for _ in 0..count as u64 {
            state = extrapolated(rates, &state, (time - now) / count);
        }
        now = time;
        states.push(state.clone());
    }
    states
}

/// One step: the last entry of the table of Aitken and Neville.
pub(super) fn extrapolated(rates: Rates, state: &[f64], step: f64) -> Vec<f64> {
    let substeps = |row: usize| 2 * (row + 1);
    let mut table: Vec<Vec<f64>> = Vec::with_capacity(COLUMNS);
    for row in 0..COLUMNS {
        let mut entry = midpoint(rates, state, step, substeps(row));
        for column in 1..=row {
            let ratio = substeps(row) as f64 / substeps(row - column) as f64;
            let previous = &mut table[column - 1];
            let better: Vec<f64> = entry
                .iter()
                .zip(previous.iter())
                .map(|(fine, coarse)| fine + (fine - coarse) / (ratio * ratio - 1.0))
                .collect();
            *previous = std::mem::replace(&mut entry, better);
        }
        table.push(entry);
    }
    table.pop().unwrap_or_default()
}

/// The modified midpoint rule without smoothing; an even number of substeps keeps the expansion even.
fn midpoint(rates: Rates, state: &[f64], step: f64, substeps: usize) -> Vec<f64> {
    let part = step / substeps as f64;
    let mut rate = vec![0.0; state.len()];
    let advanced = |from: &[f64], rate: &[f64], step: f64| -> Vec<f64> {
        from.iter().zip(rate).map(|(from, rate)| from + step * rate).collect()
    };
    rates(state, &mut rate);
    let mut before = state.to_vec();
    let mut now = advanced(state, &rate, part);
    for _ in 1..substeps {
        rates(&now, &mut rate);
        let next = advanced(&before, &rate, 2.0 * part);
        before = std::mem::replace(&mut now, next);
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_of_an_oscillator_comes_back() {
        let rates = |y: &[f64], rate: &mut [f64]| rate.copy_from_slice(&[y[1], -y[0]]);
        let states = solve(&rates, &[1.0, 0.0], &[1.0, std::f64::consts::TAU], 0.2);
        assert!((states[0][0] - 1.0_f64.cos()).abs() < 1e-13, "{states:?}");
        assert!((states[1][0] - 1.0).abs() < 1e-13 && states[1][1].abs() < 1e-13, "{states:?}");
    }
}
