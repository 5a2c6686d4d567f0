//! A law of motion through values at given times: the cubic spline, natural or periodic.

use super::{MotionMoment, MotionSpread};
use crate::spline_seconds::{closed_seconds, natural_seconds};

/// A cubic spline through values at given times, with continuous acceleration.
///
/// A natural spline has no acceleration at its ends, and goes on beyond them at the rate that it has there; a periodic
/// one repeats after the time from the first value to the last.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionTable {
    /// Times [s], ascending.
    times: Vec<f64>,
    values: Vec<f64>,
    /// Second derivatives at the times.
    seconds: Vec<f64>,
    periodic: bool,
}

/// Reason why a table is no law of motion. Entries are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// Times and values do not belong together.
    #[error("a table needs one value for each time, got {times} times and {values} values")]
    Uneven {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// There are not enough entries.
    #[error("a table needs at least {least} times, got {got}")]
    TooFew {
        /// Number of entries that the spline needs.
        least: usize,
        /// Number of entries given.
        got: usize,
    },
    /// A number is infinite or not a number.
    #[error("the numbers of a table must be finite")]
    NotFinite,
    /// A time is not later than the one before it.
    #[error("the times of a table must grow: entry {0} is not later than the one before it")]
    NotAscending(usize),
    /// The values of a periodic table do not come back to the first.
    #[error("the last value of a periodic table must be the first again, got {last} for {first}")]
    NotPeriodic {
        /// First value.
        first: f64,
        /// Last value.
        last: f64,
    },
}

impl MotionTable {
    /// Makes the spline through values at times [s].
    ///
    /// # Errors
    /// [`TableError`] tells which entry is wrong.
    pub fn new(times: &[f64], values: &[f64], periodic: bool) -> Result<Self, TableError> {
        if times.len() != values.len() {
            return Err(TableError::Uneven { times: times.len(), values: values.len() });
        }
        let least = if periodic { 4 } else { 2 };
        if times.len() < least {
            return Err(TableError::TooFew { least, got: times.len() });
        }
        if !times.iter().chain(values).all(|number| number.is_finite()) {
            return Err(TableError::NotFinite);
        }
        let widths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let Some(place) = widths.iter().position(|&width| width <= 0.0) {
            return Err(TableError::NotAscending(place + 1));
        }
        let (first, last) = (values[0], values[values.len() - 1]);
        if periodic && first != last {
            return Err(TableError::NotPeriodic { first, last });
        }
        let slopes: Vec<f64> =
            values.windows(2).zip(&widths).map(|(pair, width)| (pair[1] - pair[0]) / width).collect();
        let mut seconds =
            if periodic { closed_seconds(&widths, &slopes) } else { natural_seconds(&widths, &slopes) };
        if periodic {
            seconds.push(seconds[0]);
        }
        Ok(Self { times: times.to_vec(), values: values.to_vec(), seconds, periodic })
    }

    /// The first and the last time [s] of the table.
    #[must_use]
    #[inline]
    pub fn range(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// True if the table repeats.
    #[must_use]
    #[inline]
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }

    pub(super) fn at(&self, time: f64) -> MotionMoment {
        let (piece, time) = self.find(time);
        let ([t0, t1], [m0, m1]) = (self.times_of(piece), self.seconds_of(piece));
        let width = t1 - t0;
        let slope = (self.values[piece + 1] - self.values[piece]) / width;
        let inside = time.clamp(t0, t1);
        let (u, beyond) = (inside - t0, time - inside);
        let rate_here =
            |u: f64| slope - (2.0 * m0 + m1) * width / 6.0 + m0 * u + (m1 - m0) * u * u / (2.0 * width);
        let start_rate = slope - (2.0 * m0 + m1) * width / 6.0;
        let value = self.values[piece] + u * (start_rate + u * (0.5 * m0 + u * (m1 - m0) / (6.0 * width)));
        let rate = rate_here(u);
        let acceleration = if beyond == 0.0 { m0 + (m1 - m0) * u / width } else { 0.0 };
        MotionMoment { value: value + rate * beyond, rate, acceleration }
    }

    pub(super) fn spread(&self, from: f64, to: f64) -> MotionSpread {
        let [first, last] = self.range();
        let reaches_round = self.periodic && to - from >= last - first;
        let (start, end) = if reaches_round { (first, last) } else { (from, to) };
        // Accelerations are linear between the times, and rates parabolas: both are bounded by their values at the
        // ends of the pieces, and at the tops of the parabolas.
        let mut spread = Spread::default();
        spread.take(&self.at(start));
        let mut time = start;
        while time < end {
            let next = self.next_kink(time).map_or(end, |kink| kink.min(end));
            let [one, other] = [self.at(time), self.at(next)];
            let jump = one.acceleration - other.acceleration;
            let top = one.acceleration / jump;
            if (0.0..=1.0).contains(&top) {
                spread.take(&self.at(time + top * (next - time)));
            }
            spread.take(&other);
            time = if next > time { next } else { end };
        }
        spread.found
    }

    pub(super) fn next_kink(&self, after: f64) -> Option<f64> {
        let [first, last] = self.range();
        let (laps, time) = if self.periodic { self.wrap(after) } else { (0.0, after) };
        let next = self.times.partition_point(|&knot| knot <= time);
        let shift = laps * (last - first);
        match self.times.get(next) {
            // The clock rounds: a kink is later than the time asked for.
            Some(knot) if knot + shift > after => Some(knot + shift),
            Some(_) => self.times.get(next + 1).map(|knot| knot + shift),
            None => None,
        }
    }

    /// Number of whole periods before a time, and the time less these.
    fn wrap(&self, time: f64) -> (f64, f64) {
        let [first, last] = self.range();
        let period = last - first;
        let laps = ((time - first) / period).floor();
        (laps, (time - laps * period).clamp(first, last))
    }

    /// The piece in which a time lies, and the time there.
    fn find(&self, time: f64) -> (usize, f64) {
        let time = if self.periodic { self.wrap(time).1 } else { time };
        let next = self.times.partition_point(|&knot| knot <= time);
        (next.clamp(1, self.times.len() - 1) - 1, time)
    }

    fn times_of(&self, piece: usize) -> [f64; 2] {
        [self.times[piece], self.times[piece + 1]]
    }

    fn seconds_of(&self, piece: usize) -> [f64; 2] {
        [self.seconds[piece], self.seconds[piece + 1]]
    }
}

/// The spread of the moments taken so far.
struct Spread {
    found: MotionSpread,
}

impl Default for Spread {
    fn default() -> Self {
        let nothing = [f64::INFINITY, f64::NEG_INFINITY];
        Self { found: MotionSpread { rate: nothing, acceleration: nothing } }
    }
}

impl Spread {
    fn take(&mut self, moment: &MotionMoment) {
        let MotionSpread { rate, acceleration } = &mut self.found;
        for ([least, most], value) in [(rate, moment.rate), (acceleration, moment.acceleration)] {
            (*least, *most) = (least.min(value), most.max(value));
        }
    }
}
