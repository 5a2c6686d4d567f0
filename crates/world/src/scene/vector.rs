//! Pairs of coordinates in a scene file.

use glam::DVec2;
use serde::Deserialize;
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;

/// Two coordinates or components, `[x, y]` in a file.
///
/// A type of its own, because the TOML reader silently accepts a longer array for a pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector {
    /// Along x, to the right.
    pub x: f64,
    /// Along y, upwards.
    pub y: f64,
}

impl Vector {
    /// The zero vector.
    pub const ZERO: Self = Self { x: 0.0, y: 0.0 };
}

impl From<Vector> for DVec2 {
    fn from(vector: Vector) -> Self {
        DVec2::new(vector.x, vector.y)
    }
}

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Pair)
    }
}

struct Pair;

impl<'de> Visitor<'de> for Pair {
    type Value = Vector;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an array [x, y] of two numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Vector, A::Error> {
        let x = numbers.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let y = numbers.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
        let mut length = 2;
        while numbers.next_element::<IgnoredAny>()?.is_some() {
            length += 1;
        }
        if length == 2 { Ok(Vector { x, y }) } else { Err(A::Error::invalid_length(length, &self)) }
    }
}
