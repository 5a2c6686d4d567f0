//! Forces that vary with the time.

use super::{ForceLaw, Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A factor as a function of the time.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Vary(Course);

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Course {
    Sine { frequency: f64, phase: f64 },
    Table { times: Vec<f64>, values: Vec<f64> },
    On([f64; 2]),
}

/// Why a factor cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VaryError {
    /// A number is not finite.
    #[error("must have finite numbers")]
    NotFinite,
    /// A table has no times, or another number of values.
    #[error("must have a value for each of at least one time, got {times} times and {values} values")]
    Uneven {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Times do not grow.
    #[error("must have times that grow, got {later} s after {earlier} s")]
    NotGrowing {
        /// A time [s].
        earlier: f64,
        /// The next [s].
        later: f64,
    },
}

impl Vary {
    /// sin(2 pi frequency t + phase), of a frequency [Hz] and a phase [rad].
    ///
    /// # Errors
    /// [`VaryError::NotFinite`].
    pub fn sine(frequency: f64, phase: f64) -> Result<Self, VaryError> {
        if !(frequency.is_finite() && phase.is_finite()) {
            return Err(VaryError::NotFinite);
        }
        Ok(Self(Course::Sine { frequency, phase }))
    }

    /// Linear between values [-] at times [s], constant before the first and after the last.
    ///
    /// # Errors
    /// [`VaryError`].
    pub fn table(times: Vec<f64>, values: Vec<f64>) -> Result<Self, VaryError> {
        if times.is_empty() || times.len() != values.len() {
            return Err(VaryError::Uneven { times: times.len(), values: values.len() });
        }
        if !times.iter().chain(&values).all(|number| number.is_finite()) {
            return Err(VaryError::NotFinite);
        }
        check_growing(&times)?;
        Ok(Self(Course::Table { times, values }))
    }

    /// 1 from one time [s] until another, else 0.
    ///
    /// # Errors
    /// [`VaryError`].
    pub fn on(from: f64, until: f64) -> Result<Self, VaryError> {
        if !(from.is_finite() && until.is_finite()) {
            return Err(VaryError::NotFinite);
        }
        check_growing(&[from, until])?;
        Ok(Self(Course::On([from, until])))
    }

    /// The factor at a time [s].
    #[must_use]
    pub fn factor(&self, time: f64) -> f64 {
        match &self.0 {
            Course::Sine { frequency, phase } => (TAU * frequency * time + phase).sin(),
            Course::Table { times, values } => match times.partition_point(|&other| other <= time) {
                0 => values[0],
                after if after == times.len() => values[after - 1],
                after => {
                    let [from, until] = [times[after - 1], times[after]];
                    let share = (time - from) / (until - from);
                    values[after - 1] + share * (values[after] - values[after - 1])
                }
            },
            Course::On([from, until]) => f64::from(u8::from(*from <= time && time < *until)),
        }
    }

    /// The first time [s] later than another at which the factor jumps or has a kink.
    #[must_use]
    pub fn next_kink(&self, after: f64) -> Option<f64> {
        let times = match &self.0 {
            Course::Sine { .. } => return None,
            Course::Table { times, .. } => times.as_slice(),
            Course::On(times) => times.as_slice(),
        };
        times.get(times.partition_point(|&time| time <= after)).copied()
    }
}

fn check_growing(times: &[f64]) -> Result<(), VaryError> {
    let pair = times.windows(2).find(|pair| pair[0] >= pair[1]);
    pair.map_or(Ok(()), |pair| Err(VaryError::NotGrowing { earlier: pair[0], later: pair[1] }))
}

/// A law whose forces are taken times a factor of the time. It has no potential, whatever the law has.
#[derive(Clone, Debug)]
pub struct Varied {
    law: Arc<dyn ForceLaw>,
    vary: Vary,
}

impl Varied {
    /// Lets a law vary.
    #[must_use]
    pub fn new(law: Arc<dyn ForceLaw>, vary: Vary) -> Self {
        Self { law, vary }
    }

    /// The law that varies, and its factor.
    #[must_use]
    pub fn parts(&self) -> (&Arc<dyn ForceLaw>, &Vary) {
        (&self.law, &self.vary)
    }
}

impl ForceLaw for Varied {
    fn name(&self) -> &str {
        self.law.name()
    }

    fn bodies(&self) -> &[BodyId] {
        self.law.bodies()
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        self.law.apply(now, &mut wrenches.scaled(self.vary.factor(now.time)));
    }

    fn ends(&self) -> Option<[Anchor; 2]> {
        self.law.ends()
    }

    fn fixed_point(&self) -> Option<(BodyId, DVec2)> {
        self.law.fixed_point()
    }

    fn length(&self, now: &Snapshot<'_>) -> Option<f64> {
        self.law.length(now)
    }

    fn next_kink(&self, after: f64) -> Option<f64> {
        let kinks = [self.law.next_kink(after), self.vary.next_kink(after)];
        kinks.into_iter().flatten().reduce(f64::min)
    }

    fn switches(&self) -> usize {
        self.law.switches()
    }

    fn switch(&self, index: usize, now: &Snapshot<'_>) -> f64 {
        self.law.switch(index, now)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{states, wrenches_at};
    use super::super::{PointForce, PointPush};
    use super::*;

    #[test]
    fn factors_are_those_of_their_courses() {
        let sine = Vary::sine(0.5, 0.3).expect("it is finite");
        assert!((sine.factor(1.7) - (std::f64::consts::PI * 1.7 + 0.3).sin()).abs() < 1e-15);
        let table = Vary::table(vec![1.0, 2.0, 4.0], vec![3.0, -1.0, 0.5]).expect("it is fine");
        for (time, factor) in
            [(0.0, 3.0), (1.0, 3.0), (1.5, 1.0), (2.0, -1.0), (3.0, -0.25), (4.0, 0.5), (9.0, 0.5)]
        {
            assert_eq!(table.factor(time), factor, "{time}");
        }
        let on = Vary::on(0.5, 2.0).expect("it is fine");
        assert_eq!([0.4, 0.5, 1.9, 2.0].map(|time| on.factor(time)), [0.0, 1.0, 1.0, 0.0]);
        let kinks = [0.0, 1.0, 1.5, 2.0, 4.0].map(|after| table.next_kink(after));
        assert_eq!(kinks, [Some(1.0), Some(2.0), Some(2.0), Some(4.0), None]);
        assert_eq!((sine.next_kink(0.0), on.next_kink(0.5)), (None, Some(2.0)));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        assert_eq!(Vary::sine(f64::NAN, 0.0), Err(VaryError::NotFinite));
        assert_eq!(Vary::table(vec![], vec![]), Err(VaryError::Uneven { times: 0, values: 0 }));
        assert_eq!(Vary::table(vec![1.0], vec![]), Err(VaryError::Uneven { times: 1, values: 0 }));
        let table = Vary::table(vec![1.0, 1.0], vec![2.0, 3.0]);
        assert_eq!(table, Err(VaryError::NotGrowing { earlier: 1.0, later: 1.0 }));
        assert_eq!(Vary::on(2.0, 1.0), Err(VaryError::NotGrowing { earlier: 2.0, later: 1.0 }));
    }

    #[test]
    fn a_law_varies_with_its_factor() {
        let push = PointPush { force: DVec2::new(2.0, 0.0), torque: 1.0, ..PointPush::default() };
        let law = PointForce::new("push", BodyId(0), push);
        let varied = Varied::new(Arc::new(law), Vary::on(1.0, 2.0).expect("it is fine"));
        let at = |time: f64| wrenches_at(&varied, &states(), time)[0];
        assert_eq!((at(0.5).force, at(0.5).torque), (DVec2::ZERO, 0.0));
        assert_eq!((at(1.5).force, at(1.5).torque), (DVec2::new(2.0, 0.0), 1.0));
        assert!(varied.potential(&Snapshot::new(1.5, &states().map(|state| (&state).into()))).is_none());
    }
}
