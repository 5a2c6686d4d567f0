//! Laws of motion: a coordinate as a function of time, prescribed by what drives it.
//!
//! A law tells value, rate and acceleration at any time, and bounds on rate and acceleration between two times, so that
//! searches along it miss nothing. Values count from wherever the law likes: what it drives starts from where it is.
//!
//! *Invariant*: rate and acceleration are the derivatives of the value, and the acceleration is continuous but for the
//! times that [`PrescribedMotion::next_kink`] tells.

mod body_motion;
mod table;

pub use body_motion::{BodyMotion, MovedPath};
pub use table::{MotionTable, TableError};

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::sync::Arc;

/// A prescribed coordinate and its derivatives at one time, in the unit of the coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionMoment {
    /// Value.
    pub value: f64,
    /// Rate [1/s].
    pub rate: f64,
    /// Acceleration [1/s^2].
    pub acceleration: f64,
}

/// Intervals in which rate and acceleration of a prescribed coordinate lie during a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionSpread {
    /// The least and the largest rate.
    pub rate: [f64; 2],
    /// The least and the largest acceleration.
    pub acceleration: [f64; 2],
}

/// A law of motion of one's own.
pub trait PrescribedMotion: Debug + Send + Sync {
    /// Value, rate and acceleration at a time [s].
    fn at(&self, time: f64) -> MotionMoment;

    /// Bounds that hold between two times [s]. They should narrow to the values themselves as the times come together:
    /// the wider they are, the more work has a search for contacts.
    fn spread(&self, from: f64, to: f64) -> MotionSpread;

    /// The first time [s] later than `after` at which the acceleration jumps or has a kink; `None` if there is none any
    /// more. Steps end there.
    fn next_kink(&self, after: f64) -> Option<f64> {
        let _ = after;
        None
    }
}

/// A law of motion.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum MotionLaw {
    /// At a constant rate, per second.
    Uniform(f64),
    /// A sine.
    Oscillating(Oscillation),
    /// A spline through values at given times.
    Table(Arc<MotionTable>),
    /// A law of one's own, which cannot be saved.
    #[cfg_attr(feature = "save", serde(skip))]
    Own(Arc<dyn PrescribedMotion>),
}

/// The law amplitude sin(2 pi frequency t + phase).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Oscillation {
    /// Amplitude, in the unit of the coordinate.
    pub amplitude: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase [rad].
    pub phase: f64,
}

impl MotionLaw {
    /// Value, rate and acceleration at a time [s].
    #[must_use]
    #[inline]
    pub fn at(&self, time: f64) -> MotionMoment {
        match self {
            Self::Uniform(rate) => MotionMoment { value: rate * time, rate: *rate, acceleration: 0.0 },
            Self::Oscillating(oscillation) => oscillation.at(time),
            Self::Table(table) => table.at(time),
            Self::Own(own) => own.at(time),
        }
    }

    /// Bounds that hold between two times [s].
    #[must_use]
    pub fn spread(&self, from: f64, to: f64) -> MotionSpread {
        match self {
            Self::Uniform(rate) => MotionSpread { rate: [*rate; 2], acceleration: [0.0; 2] },
            Self::Oscillating(oscillation) => oscillation.spread(from, to),
            Self::Table(table) => table.spread(from, to),
            Self::Own(own) => own.spread(from, to),
        }
    }

    /// The first time [s] later than `after` at which the law is not smooth.
    #[must_use]
    pub fn next_kink(&self, after: f64) -> Option<f64> {
        match self {
            Self::Uniform(_) | Self::Oscillating(_) => None,
            Self::Table(table) => table.next_kink(after),
            Self::Own(own) => own.next_kink(after),
        }
    }

    /// True for a constant rate.
    #[must_use]
    #[inline]
    pub fn is_uniform(&self) -> bool {
        matches!(self, Self::Uniform(_))
    }

    /// True if all numbers of the law are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Uniform(rate) => rate.is_finite(),
            Self::Oscillating(Oscillation { amplitude, frequency, phase }) => {
                amplitude.is_finite() && frequency.is_finite() && phase.is_finite()
            }
            Self::Table(_) | Self::Own(_) => true,
        }
    }
}

/// Laws of one's own are equal if they are one and the same.
impl PartialEq for MotionLaw {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Uniform(one), Self::Uniform(other)) => one == other,
            (Self::Oscillating(one), Self::Oscillating(other)) => one == other,
            (Self::Table(one), Self::Table(other)) => one == other,
            (Self::Own(one), Self::Own(other)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }
}

impl Oscillation {
    fn at(&self, time: f64) -> MotionMoment {
        let speed = TAU * self.frequency;
        let (sin, cos) = libm::sincos(speed * time + self.phase);
        MotionMoment {
            value: self.amplitude * sin,
            rate: self.amplitude * speed * cos,
            acceleration: -self.amplitude * speed * speed * sin,
        }
    }

    /// From the middle of the time on, rate and acceleration change by no more than their largest derivatives allow, and
    /// are never larger than their amplitudes.
    fn spread(&self, from: f64, to: f64) -> MotionSpread {
        let (middle, half) = (self.at(0.5 * (from + to)), 0.5 * (to - from).abs());
        let speed = (TAU * self.frequency).abs();
        let largest = self.amplitude.abs() * speed;
        let around = |value: f64, largest: f64| {
            let change = largest * speed * half;
            [(value - change).max(-largest), (value + change).min(largest)]
        };
        MotionSpread {
            rate: around(middle.rate, largest),
            acceleration: around(middle.acceleration, largest * speed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(super) fn laws() -> impl Strategy<Value = MotionLaw> {
        let oscillation = (-2.0..2.0, 0.1..3.0, -4.0..4.0).prop_map(|(amplitude, frequency, phase)| {
            MotionLaw::Oscillating(Oscillation { amplitude, frequency, phase })
        });
        let table = (prop::collection::vec((0.2..1.5, -1.0..1.0), 4..9), any::<bool>()).prop_map(
            |(knots, periodic)| {
                let mut time = -1.0;
                let times: Vec<f64> = knots
                    .iter()
                    .map(|(wait, _)| {
                        time += wait;
                        time
                    })
                    .collect();
                let mut values: Vec<f64> = knots.iter().map(|(_, value)| *value).collect();
                if periodic {
                    values[knots.len() - 1] = values[0];
                }
                let table = MotionTable::new(&times, &values, periodic).expect("fine numbers");
                MotionLaw::Table(Arc::new(table))
            },
        );
        prop_oneof![(-3.0..3.0).prop_map(MotionLaw::Uniform), oscillation, table]
    }

    proptest! {
        #[test]
        fn rates_and_accelerations_are_derivatives_and_lie_within_their_bounds(
            law in laws(),
            from in -2.0..6.0,
            span in 1e-3..2.0,
        ) {
            let spread = law.spread(from, from + span);
            for part in 0..=16 {
                let time = from + span * f64::from(part) / 16.0;
                let moment = law.at(time);
                let step = 1e-5;
                // Across a kink differences have an error of first order.
                if law.next_kink(time - 2.0 * step).is_none_or(|kink| kink > time + 2.0 * step) {
                    let [before, after] = [law.at(time - step), law.at(time + step)];
                    let rate = (after.value - before.value) / (2.0 * step);
                    let acceleration = (after.rate - before.rate) / (2.0 * step);
                    prop_assert!((rate - moment.rate).abs() < 1e-6, "{rate} {moment:?}");
                    prop_assert!((acceleration - moment.acceleration).abs() < 1e-4, "{acceleration} {moment:?}");
                }
                let rounding = 1e-12;
                for (value, [least, most]) in
                    [(moment.rate, spread.rate), (moment.acceleration, spread.acceleration)]
                {
                    prop_assert!(least - rounding <= value && value <= most + rounding);
                }
            }
        }
    }
}
