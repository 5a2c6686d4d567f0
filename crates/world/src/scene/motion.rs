//! Prescribed motions in a scene file: of a fixed body that is moved, and of a coordinate that is driven.
//!
//! A coordinate's motion is a number, a body's three. Each tells its laws, in the scene's time.

use super::vector::Vector;
use halfgap_collision::{BodyMotion, MotionLaw, MotionTable, Oscillation, TableError};
use serde::Deserialize;
use std::sync::Arc;

/// Motion of a fixed body: at constant velocities, or by one of the others.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionData {
    /// Velocity of the centre of mass [m/s].
    pub velocity: Option<Vector>,
    /// Angular velocity [rad/s].
    pub angular_velocity: Option<f64>,
    /// Sines of one frequency.
    pub oscillate: Option<OscillateBodyData>,
    /// Splines through places at given times.
    pub table: Option<BodyTableData>,
}

/// Displacement and turn amplitude sin(2 pi frequency t + phase) of a body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OscillateBodyData {
    /// Amplitude of the displacement [m].
    #[serde(default)]
    pub amplitude: Vector,
    /// Amplitude of the angle [rad].
    #[serde(default)]
    pub angle: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase [rad].
    #[serde(default)]
    pub phase: f64,
}

/// Displacements and angles of a body at given times.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyTableData {
    /// Times [s], ascending.
    pub times: Vec<f64>,
    /// Displacements [m]; none if not given.
    pub positions: Option<Vec<Vector>>,
    /// Turns [rad]; none if not given.
    pub angles: Option<Vec<f64>>,
    /// Whether the table repeats after its last time.
    #[serde(default)]
    pub periodic: bool,
}

super::one_key::one_key_enum! {
    /// Motion of a driven coordinate, in metres or radians.
    DriveData: "motion" {
        /// At a constant speed [m/s or rad/s].
        "speed" => Speed(f64),
        /// A sine.
        "oscillate" => Oscillate(OscillateData),
        /// A spline through values at given times.
        "table" => Table(ValueTableData),
    }
}

/// The motion amplitude sin(2 pi frequency t + phase) of a coordinate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OscillateData {
    /// Amplitude [m or rad].
    pub amplitude: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase [rad].
    #[serde(default)]
    pub phase: f64,
}

/// Values of a coordinate at given times.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueTableData {
    /// Times [s], ascending.
    pub times: Vec<f64>,
    /// Values [m or rad].
    pub values: Vec<f64>,
    /// Whether the table repeats after its last time.
    #[serde(default)]
    pub periodic: bool,
}

/// A table that is no law, and the field in which that shows.
pub(crate) type BadTable = (&'static str, TableError);

impl MotionData {
    /// The laws of the body. Of several forms the last counts; [`validate`](super::Scene::validate) refuses them.
    ///
    /// # Errors
    /// The field of the table that makes no law, and why.
    pub(crate) fn to_motion(&self) -> Result<BodyMotion, BadTable> {
        if let Some(table) = &self.table {
            return table.to_motion();
        }
        if let Some(OscillateBodyData { amplitude, angle, frequency, phase }) = self.oscillate {
            let [x, y, angle] = [amplitude.x, amplitude.y, angle]
                .map(|amplitude| MotionLaw::Oscillating(Oscillation { amplitude, frequency, phase }));
            return Ok(BodyMotion { x, y, angle });
        }
        let velocity = self.velocity.unwrap_or_default().into();
        Ok(BodyMotion::uniform(velocity, self.angular_velocity.unwrap_or_default()))
    }
}

impl BodyTableData {
    fn to_motion(&self) -> Result<BodyMotion, BadTable> {
        let law = |values: Option<Vec<f64>>, field| match values {
            Some(values) => table_law(&self.times, &values, self.periodic, field),
            None => Ok(MotionLaw::Uniform(0.0)),
        };
        let along = |part: fn(&Vector) -> f64| {
            self.positions.as_ref().map(|positions| positions.iter().map(part).collect::<Vec<f64>>())
        };
        Ok(BodyMotion {
            x: law(along(|position| position.x), "positions")?,
            y: law(along(|position| position.y), "positions")?,
            angle: law(self.angles.clone(), "angles")?,
        })
    }
}

impl DriveData {
    /// The law of the coordinate.
    ///
    /// # Errors
    /// The field of the table that makes no law, and why.
    pub(crate) fn to_law(&self) -> Result<MotionLaw, BadTable> {
        match self {
            Self::Speed(speed) => Ok(MotionLaw::Uniform(*speed)),
            Self::Oscillate(OscillateData { amplitude, frequency, phase }) => {
                let [amplitude, frequency, phase] = [*amplitude, *frequency, *phase];
                Ok(MotionLaw::Oscillating(Oscillation { amplitude, frequency, phase }))
            }
            Self::Table(table) => table_law(&table.times, &table.values, table.periodic, "values"),
        }
    }
}

/// The spline through values of a field at times [s].
fn table_law(
    times: &[f64],
    values: &[f64],
    periodic: bool,
    field: &'static str,
) -> Result<MotionLaw, BadTable> {
    let table = MotionTable::new(times, values, periodic).map_err(|error| {
        let of_times = matches!(error, TableError::TooFew { .. } | TableError::NotAscending(_));
        (if of_times { "times" } else { field }, error)
    })?;
    Ok(MotionLaw::Table(Arc::new(table)))
}
