//! Rules for values, each with its message, at a place in the scene.

use crate::scene::Vector;
use crate::scene::error::SceneError;
use crate::scene::field_path::{FieldPath, Step};

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
        if holds { Ok(()) } else { Err(self.error(format!("{rule}, got {value}{space}{unit}"))) }
    }

    pub(super) fn finite(&self, value: f64) -> Result<(), SceneError> {
        self.require(true, "", value, "")
    }

    pub(super) fn positive(&self, value: f64, unit: &str) -> Result<(), SceneError> {
        self.require(value > 0.0, "must be positive", value, unit)
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

/// Applies a rule to a value, if there is one.
pub(super) fn optional<T: Copy>(
    value: Option<T>,
    rule: impl FnOnce(T) -> Result<(), SceneError>,
) -> Result<(), SceneError> {
    value.map_or(Ok(()), rule)
}
