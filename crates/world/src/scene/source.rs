//! The text of a scene: read from a file, parsed, and searched for the place of an error.

use super::Scene;
use super::error::SceneError;
use super::field_path::{FieldPath, Step};
use super::locate::find_offset;
use super::nearest::with_nearest;
use super::tables::Tables;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Largest size of a JSON file [bytes]; larger ones are refused unread. Scenes of 100,000 bodies fit.
const LARGEST_JSON: u64 = 64 << 20;
/// Largest size of a TOML file [bytes]; larger ones are refused unread. TOML is written by hand, and its parser needs
/// up to fifty times as much memory.
const LARGEST_TOML: u64 = 8 << 20;

/// serde_json's message for a number beyond the doubles.
const TOO_LARGE: &str = "number out of range";

/// Text format of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneFormat {
    /// TOML, written by hand.
    Toml,
    /// JSON, written by programs.
    Json,
}

impl SceneFormat {
    /// Returns the format by the ending of a file's name; `None` for other endings.
    #[must_use]
    pub fn of_file(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "toml" => Some(Self::Toml),
            "json" => Some(Self::Json),
            _ => None,
        }
    }

    fn largest_file(self) -> u64 {
        match self {
            Self::Toml => LARGEST_TOML,
            Self::Json => LARGEST_JSON,
        }
    }
}

/// A scene as text, kept so that messages can name the line of a field.
#[derive(Clone, Debug)]
pub struct SceneSource {
    text: String,
    format: SceneFormat,
    file: Option<PathBuf>,
}

impl SceneSource {
    /// Makes the source of a scene from its text.
    #[must_use]
    pub fn new(text: impl Into<String>, format: SceneFormat) -> Self {
        Self { text: without_mark(text.into()), format, file: None }
    }

    /// Reads a `.toml` or `.json` file.
    ///
    /// # Errors
    /// [`SceneError`] for a file that cannot be read, is too large, is not UTF-8, or has a name with another ending.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let fail = |message: String| SceneError::new(FieldPath::top(), message).in_file(Some(path));
        let unreadable = |cause: io::Error| fail(format!("cannot be read: {cause}")).caused_by(cause);
        let metadata = std::fs::metadata(path).map_err(unreadable)?;
        if metadata.is_dir() {
            return Err(fail("is a directory, not a scene file".to_owned()));
        }
        let Some(format) = SceneFormat::of_file(path) else {
            return Err(fail("a scene file's name must end in .toml or .json".to_owned()));
        };
        let limit = format.largest_file();
        let too_large =
            |size: String| fail(format!("has {size} bytes; a scene file may have at most {limit}"));
        if metadata.len() > limit {
            return Err(too_large(metadata.len().to_string()));
        }
        let mut bytes = Vec::new();
        // A device or a growing file may hold more than its size says.
        let file = File::open(path).map_err(unreadable)?;
        let read = file.take(limit + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        if read as u64 > limit {
            return Err(too_large(format!("more than {limit}")));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            fail(format!("is not UTF-8 text: byte {} is not", error.utf8_error().valid_up_to()))
        })?;
        Ok(Self { text: without_mark(text), format, file: Some(path.to_path_buf()) })
    }

    /// Parses and validates the scene.
    ///
    /// # Errors
    /// [`SceneError`] for the first fault, with line and field.
    pub fn parse(&self) -> Result<Scene, SceneError> {
        let scene = match self.format {
            SceneFormat::Toml => self.parse_toml(),
            SceneFormat::Json => self.parse_json(),
        }?;
        scene.validate().map_err(|error| self.locate(error))?;
        Ok(scene)
    }

    /// Adds file, line and text to an error that has only its field.
    #[must_use]
    pub fn locate(&self, error: SceneError) -> SceneError {
        let offset = find_offset(&self.text, self.format, error.field());
        let error = error.in_file(self.file.as_deref());
        match offset {
            Some(offset) if !error.field().is_top() => error.at_offset(&self.text, offset),
            _ => error,
        }
    }

    /// Parses the text as plain data, without checks of its fields.
    pub(super) fn data(&self) -> Result<serde_json::Value, SceneError> {
        match self.format {
            SceneFormat::Toml => {
                toml::from_str(&self.text).map_err(|error| self.syntax_error(error.message(), 0))
            }
            SceneFormat::Json => {
                serde_json::from_str(&self.text).map_err(|error| self.syntax_error(&error.to_string(), 0))
            }
        }
    }

    fn parse_toml(&self) -> Result<Scene, SceneError> {
        let syntax = |error: toml::de::Error| {
            let offset = error.span().map_or(0, |span| span.start);
            self.syntax_error(&error.message().trim_end().replace('\n', "; "), offset)
        };
        let deserializer = toml::Deserializer::parse(&self.text).map_err(syntax)?;
        serde_path_to_error::deserialize(Tables(deserializer)).map_err(|error| {
            let field = field_path(error.path());
            self.data_error(field, error.inner().message())
        })
    }

    fn parse_json(&self) -> Result<Scene, SceneError> {
        let mut deserializer = serde_json::Deserializer::from_str(&self.text);
        let scene = serde_path_to_error::deserialize(Tables(&mut deserializer)).map_err(|error| {
            let (field, inner) = (field_path(error.path()), error.inner());
            let offset = offset_of(&self.text, inner.line(), inner.column());
            let message = inner.to_string();
            // serde_json puts its own place behind the message.
            let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
            match inner.classify() {
                // serde_json counts this among the mistakes of syntax.
                _ if message == TOO_LARGE => self.data_error(field, "the number is too large"),
                serde_json::error::Category::Data => self.data_error(field, message),
                _ => self.syntax_error(message, offset),
            }
        })?;
        deserializer.end().map_err(|error| {
            self.syntax_error(
                "text after the end of the scene",
                offset_of(&self.text, error.line(), error.column()),
            )
        })?;
        Ok(scene)
    }

    fn data_error(&self, field: FieldPath, message: &str) -> SceneError {
        // A field that is missing at the top has no place: line 1 is named.
        self.locate(SceneError::new(field, plain(message))).at_offset(&self.text, 0)
    }

    fn syntax_error(&self, message: &str, offset: usize) -> SceneError {
        let format = match self.format {
            SceneFormat::Toml => "TOML",
            SceneFormat::Json => "JSON",
        };
        SceneError::new(FieldPath::top(), format!("not valid {format}: {message}"))
            .in_file(self.file.as_deref())
            .at_offset(&self.text, offset)
    }
}

/// Returns the text without the byte order mark that some editors put before it.
fn without_mark(mut text: String) -> String {
    const MARK: char = '\u{feff}';
    if text.starts_with(MARK) {
        text.remove(0);
    }
    text
}

/// Returns the byte offset of a line and a column in bytes, both counted from 1 (a column of 0 is the end of the line
/// before).
fn offset_of(text: &str, line: usize, column: usize) -> usize {
    let line_start = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum::<usize>();
    (line_start + column).saturating_sub(1)
}

pub(super) fn field_path(path: &serde_path_to_error::Path) -> FieldPath {
    use serde_path_to_error::Segment;
    path.iter()
        .filter_map(|segment| match segment {
            Segment::Seq { index } => Some(Step::Element(*index)),
            Segment::Map { key } => Some(Step::Field(key.clone())),
            Segment::Enum { variant } => Some(Step::Field(variant.clone())),
            Segment::Unknown => None,
        })
        .collect()
}

/// Replaces serde's names of types by those that authors of scenes know.
pub(super) fn plain(message: &str) -> String {
    with_nearest(message.trim_end())
        .replace("expected f64", "expected a number")
        .replace("expected u64", "expected a whole number that is not negative")
        .replace("expected a sequence", "expected an array")
        .replace("invalid type: map", "invalid type: table")
        .replace("invalid type: sequence", "invalid type: array")
}
