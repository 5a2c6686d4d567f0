//! Rules for values, each with its message, at a place in the scene.

use crate::builder::LARGEST;
use crate::scene::Vector;
use crate::scene::error::SceneError;
use crate::scene::field_path::{FieldPath, Step};
use std::fmt::{self, Display, Formatter};
use std::ops::Range;

/// Smallest length of a shape [m]: moments take fourth powers of it, which must not underflow.
const SMALLEST: f64 = 1e-60;
/// Sizes of numbers that are written without a power of ten.
const PLAIN: Range<f64> = 1e-9..1e16;

/// A place in the scene, chained to the one around it so that a scene without errors allocates no paths.
#[derive(Clone, Copy, Debug)]
pub(super) enum At<'a> {
    Top,
    Field(&'a At<'a>, &'a str),
    Element(&'a At<'a>, usize),
}

impl<'a> At<'a> {
    pub(super) fn field(&'a self, name: &'a str) -> At<'a> {
        At::Field(self, name)
    }

    pub(super) fn element(&'a self, index: usize) -> At<'a> {
        At::Element(self, index)
    }

    pub(super) fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::new(self.path(), message)
    }

    /// Returns an error unless the rule holds and the value is finite.
    fn require(&self, holds: bool, rule: &str, value: f64, unit: &str) -> Result<(), SceneError> {
        if !value.is_finite() {
            return Err(self.error(format!("must be a finite number, got {value}")));
        }
        let space = if unit.is_empty() { "" } else { " " };
        if holds { Ok(()) } else { Err(self.error(format!("{rule}, got {}{space}{unit}", Digits(value)))) }
    }

    pub(super) fn finite(&self, value: f64) -> Result<(), SceneError> {
        self.require(true, "", value, "")
    }

    pub(super) fn positive(&self, value: f64, unit: &str) -> Result<(), SceneError> {
        self.require(value > 0.0, "must be positive", value, unit)
    }

    /// Returns an error for a length that is not positive, or whose powers over- or underflow.
    pub(super) fn length(&self, value: f64) -> Result<(), SceneError> {
        self.positive(value, "m")?;
        let rule = format!("must lie between {SMALLEST:e} and {LARGEST:e} m");
        self.require((SMALLEST..=LARGEST).contains(&value), &rule, value, "m")
    }

    pub(super) fn not_negative(&self, value: f64, unit: &str) -> Result<(), SceneError> {
        self.require(value >= 0.0, "must not be negative", value, unit)
    }

    pub(super) fn zero_to_one(&self, value: f64) -> Result<(), SceneError> {
        self.require((0.0..=1.0).contains(&value), "must lie between 0 and 1", value, "")
    }

    pub(super) fn below(
        &self,
        value: f64,
        limit: f64,
        limit_name: &str,
        unit: &str,
    ) -> Result<(), SceneError> {
        let rule = format!("must be less than {limit_name} ({limit} {unit})");
        self.require(value < limit, &rule, value, unit)
    }

    pub(super) fn at_most(
        &self,
        value: f64,
        limit: f64,
        limit_name: &str,
        unit: &str,
    ) -> Result<(), SceneError> {
        let rule = format!("must be at most {limit_name} ({limit} {unit})");
        self.require(value <= limit, &rule, value, unit)
    }

    pub(super) fn at_least(
        &self,
        value: f64,
        limit: f64,
        limit_name: &str,
        unit: &str,
    ) -> Result<(), SceneError> {
        let rule = format!("must be at least {limit_name} ({limit} {unit})");
        self.require(value >= limit, &rule, value, unit)
    }

    pub(super) fn finite_point(&self, point: Vector) -> Result<(), SceneError> {
        self.element(0).finite(point.x)?;
        self.element(1).finite(point.y)
    }

    fn path(&self) -> FieldPath {
        let mut steps = Vec::new();
        let mut place = *self;
        loop {
            place = match place {
                At::Top => break,
                At::Field(around, name) => {
                    steps.push(Step::Field(name.to_owned()));
                    *around
                }
                At::Element(around, index) => {
                    steps.push(Step::Element(index));
                    *around
                }
            };
        }
        steps.into_iter().rev().collect()
    }
}

/// A number with all its digits, and with a power of ten where it is very large or small.
struct Digits(f64);

impl Display for Digits {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let is_plain = self.0 == 0.0 || PLAIN.contains(&self.0.abs());
        if is_plain { write!(out, "{}", self.0) } else { write!(out, "{:e}", self.0) }
    }
}

/// Applies a rule to a value, if there is one.
pub(super) fn optional<T: Copy>(
    value: Option<T>,
    rule: impl FnOnce(T) -> Result<(), SceneError>,
) -> Result<(), SceneError> {
    value.map_or(Ok(()), rule)
}
