//! Scene files, format `halfgap-scene-1`: plain data, read from TOML or JSON.
//!
//! `source` reads and parses a text, `language` knows names, expressions and repetition, `validate` checks the values, `locate` finds
//! the line of a field for messages, `nearest` finds what a mistyped name may stand for, `varied` puts other numbers
//! into one field, and `supported` refuses fields of the format that are not simulated yet. SI units, radians,
//! counter-clockwise positive, y up.

mod body;
mod connector;
mod error;
mod expected;
mod field_path;
mod force;
mod language;
mod locate;
mod machine_shape;
mod motion;
mod named;
mod nearest;
mod one_key;
mod pair;
mod probe;
mod run_data;
mod shape;
mod source;
mod supported;
mod validate;
mod varied;
mod vector;

pub use body::{BodyData, WORLD};
pub use connector::{
    AxisFrame, ConnectorData, ConnectorOptions, GearData, JointData, JointSpringData, LengthData, LimitsData,
    MotorData, NormalFrame, PinData, PointData, PulleyData, RackData, RailData, RailPath, RailStopData,
    SliderData, SlotData, WeldData,
};
pub use error::{Excerpt, Position, SceneError};
pub use expected::{ExpectedData, ExpectedState};
pub use field_path::{BadFieldPath, FieldPath, Step};
pub use force::{
    ConstantData, DampingData, ForceData, GravityData, MutualGravityData, PushData, RotatingData, SineData,
    SpringData, TableData, TorsionSpringData, VaryData,
};
pub use machine_shape::{
    CamData, CapsuleData, GearShapeData, GenevaData, LeanData, RackBarData, RatchetData, RegularData,
};
pub use motion::{BodyTableData, DriveData, MotionData, OscillateBodyData, OscillateData, ValueTableData};
pub use named::NamedData;
pub use pair::PairData;
pub use probe::{AngleData, ConnectorRef, DistanceData, ProbeData};
pub use run_data::{RunData, StrategyData};
pub use shape::{
    ArcData, BlockData, DiscData, EdgeData, OutlineData, PathData, PolygonData, RingData, RoundedBlockData,
    ShapeData,
};
pub use source::{SceneFormat, SceneSource};
pub use varied::VariedScene;
pub use vector::Vector;

use serde::Deserialize;
use std::path::Path;

/// A scene: bodies, connectors, force laws, and how to run it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the format.
    pub format: FormatVersion,
    /// Title, for people.
    pub title: String,
    /// Description in one line, for people.
    pub about: Option<String>,
    /// Duration and accuracy of the run.
    pub run: RunData,
    /// The bodies.
    #[serde(default, rename = "body")]
    pub bodies: Vec<BodyData>,
    /// The connectors, which tie bodies together.
    #[serde(default, rename = "connector")]
    pub connectors: Vec<NamedData<ConnectorData>>,
    /// The force laws, which act on bodies.
    #[serde(default, rename = "force")]
    pub forces: Vec<NamedData<ForceData>>,
    /// Pairs of bodies that differ from what their bodies say.
    #[serde(default, rename = "pair")]
    pub pairs: Vec<PairData>,
    /// What is told of the run besides the states.
    #[serde(default, rename = "probe")]
    pub probes: Vec<NamedData<ProbeData>>,
    /// States that a run is expected to reach.
    #[serde(default)]
    pub expected: Vec<ExpectedData>,
}

/// Version of the scene format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum FormatVersion {
    /// Version 1.
    #[default]
    #[serde(rename = "halfgap-scene-1")]
    One,
}

impl Scene {
    /// Reads, parses and validates a `.toml` or `.json` file.
    ///
    /// Use [`SceneSource`] to keep the text, so that later errors can name their line too.
    ///
    /// # Errors
    /// [`SceneError`] for the first fault, with file, line and field.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        SceneSource::read(path)?.parse()
    }

    /// Parses and validates a text.
    ///
    /// # Errors
    /// [`SceneError`] for the first fault, with line and field.
    ///
    /// # Examples
    /// ```
    /// use halfgap::scene::{Scene, SceneFormat};
    ///
    /// let text = r#"
    ///     format = "halfgap-scene-1"
    ///     title = "A disc on its way"
    ///     run = { duration = 1.0 }
    ///
    ///     [[body]]
    ///     name = "disc"
    ///     shape = { disc = { radius = 0.5 } }
    ///     mass = -2
    /// "#;
    /// let error = Scene::parse(text, SceneFormat::Toml).expect_err("nothing weighs less than nothing");
    /// assert_eq!(error.to_string(), "line 9: body[0].mass: must be positive, got -2 kg");
    /// ```
    pub fn parse(text: &str, format: SceneFormat) -> Result<Self, SceneError> {
        SceneSource::new(text, format).parse()
    }

    /// The place of a connector, by its index or its name; `None` if there is none.
    #[must_use]
    pub fn find_connector(&self, connector: &ConnectorRef) -> Option<usize> {
        match connector {
            ConnectorRef::Index(index) => Some(*index).filter(|index| *index < self.connectors.len()),
            ConnectorRef::Name(name) => {
                self.connectors.iter().position(|connector| connector.name.as_ref() == Some(name))
            }
        }
    }

    /// Checks every value but the expected states.
    pub(crate) fn validate_world(&self) -> Result<(), SceneError> {
        validate::validate_world(self)
    }

    /// Checks every value; data from a file have been checked already.
    ///
    /// # Errors
    /// [`SceneError`] for the first value that breaks a rule, with its field.
    pub fn validate(&self) -> Result<(), SceneError> {
        validate::validate(self)
    }

    /// Sets the relative accuracy [-]; an error names `origin` instead of a field.
    ///
    /// # Errors
    /// [`SceneError`] for a tolerance that is not a positive number up to 1.
    pub fn set_tolerance(&mut self, tolerance: f64, origin: &str) -> Result<(), SceneError> {
        self.set_run(RunData { tolerance: Some(tolerance), ..self.run.clone() }, origin)
    }

    /// Sets the duration [s]; an error names `origin` instead of a field.
    ///
    /// # Errors
    /// [`SceneError`] for a duration that is not positive and finite, or that is lost in rounding.
    pub fn set_duration(&mut self, duration: f64, origin: &str) -> Result<(), SceneError> {
        self.set_run(RunData { duration, ..self.run.clone() }, origin)
    }

    fn set_run(&mut self, run: RunData, origin: &str) -> Result<(), SceneError> {
        let renamed = |error: SceneError| SceneError::new(FieldPath::top().field(origin), error.message());
        validate::validate_run(&run).map_err(renamed)?;
        self.run = run;
        Ok(())
    }

    /// Refuses a scene whose recording of everything, [`Record::Everything`](crate::Record), would not fit into memory.
    ///
    /// # Errors
    /// [`SceneError`] for too many states: the number of output times times that of movable bodies.
    pub fn check_recording(&self) -> Result<(), SceneError> {
        validate::validate_recording(self)
    }

    /// Refuses fields of the format that are not simulated yet.
    ///
    /// # Errors
    /// [`SceneError`] for the first field that is not supported.
    pub fn check_supported(&self) -> Result<(), SceneError> {
        supported::check_supported(self)
    }
}
