//! Factors as data: the pattern with its values, and the numbers of the factor. The symbolic analysis is made anew from
//! the pattern, as in a clone.

use super::BodyFactor;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The pattern and the numbers, borrowed while they are written.
type Numbers<F, I, P> = (I, P, I, I, F, P, I, Option<F>);

impl Serialize for BodyFactor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers: Numbers<&[f64], &[usize], &[u32]> = (
            &self.start,
            &self.column,
            &self.column_start,
            &self.row,
            &self.value,
            &self.place,
            &self.place_start,
            self.analysis.as_ref().map(|analysis| analysis.factor.as_slice()),
        );
        numbers.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for BodyFactor {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Numbers::<Vec<f64>, Vec<usize>, Vec<u32>>::deserialize(deserializer)?;
        let (start, column, column_start, row, value, place, place_start, known) = numbers;
        let mut factor = Self { start, column, column_start, row, value, place, place_start, analysis: None };
        match known {
            Some(known) if !factor.analyse_as(&known) => Err(D::Error::custom("a factor of another pattern")),
            _ => Ok(factor),
        }
    }
}
