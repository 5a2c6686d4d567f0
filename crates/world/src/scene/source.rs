//! The text of a scene: read from a file, parsed, and searched for the place of an error.

use super::Scene;
use super::error::SceneError;
use super::field_path::{FieldPath, Step};
use super::language::{Expansion, Reading, Tree, expression_in};
use super::locate::find_offset;
use super::nearest::with_nearest;
use serde::Deserialize;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Largest size of a file [bytes]; larger ones are refused unread. Scenes of 100,000 bodies fit.
const LARGEST_FILE: u64 = 64 << 20;

/// serde_json's message for a number beyond the doubles.
const TOO_LARGE: &str = "number out of range";
/// serde_json's message for what is nested too deeply.
const TOO_DEEP: &str = "recursion limit exceeded";
/// The byte order mark that some editors put before a text.
const MARK: char = '\u{feff}';

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

    /// Guesses the format of a text: JSON begins with a brace.
    #[must_use]
    pub fn of_text(text: &str) -> Self {
        if text.trim_start_matches(MARK).trim_start().starts_with('{') { Self::Json } else { Self::Toml }
    }
}

/// A scene as text, kept so that messages can name the line of a field.
#[derive(Clone, Debug)]
pub struct SceneSource {
    text: String,
    format: SceneFormat,
    file: Option<PathBuf>,
    /// Names in `[let]`, with the numbers or expressions that take the place of theirs.
    changes: Vec<(String, String)>,
}

impl SceneSource {
    /// Makes the source of a scene from its text.
    #[must_use]
    pub fn new(text: impl Into<String>, format: SceneFormat) -> Self {
        Self { text: without_mark(text.into()), format, file: None, changes: Vec::new() }
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
        let too_large =
            |size: String| fail(format!("has {size} bytes; a scene file may have at most {LARGEST_FILE}"));
        if metadata.len() > LARGEST_FILE {
            return Err(too_large(metadata.len().to_string()));
        }
        let file = File::open(path).map_err(unreadable)?;
        let bytes = read_at_most(file).map_err(unreadable)?;
        let bytes = bytes.ok_or_else(|| too_large(format!("more than {LARGEST_FILE}")))?;
        let text = text_of(bytes).map_err(fail)?;
        Ok(Self { file: Some(path.to_path_buf()), ..Self::new(text, format) })
    }

    /// Reads a scene from a stream, such as standard input; the format is guessed if it is not given. Messages call the file `-`.
    ///
    /// # Errors
    /// [`SceneError`] for a stream that cannot be read, is too large, or is not UTF-8.
    pub fn read_from(stream: impl Read, format: Option<SceneFormat>) -> Result<Self, SceneError> {
        let file = Path::new("-");
        let fail = |message: String| SceneError::new(FieldPath::top(), message).in_file(Some(file));
        let unreadable = |cause: io::Error| fail(format!("cannot be read: {cause}")).caused_by(cause);
        let bytes = read_at_most(stream).map_err(unreadable)?;
        let bytes = bytes.ok_or_else(|| fail(format!("a scene may have at most {LARGEST_FILE} bytes")))?;
        let text = text_of(bytes).map_err(fail)?;
        let format = format.unwrap_or_else(|| SceneFormat::of_text(&text));
        Ok(Self { file: Some(file.to_path_buf()), ..Self::new(text, format) })
    }

    /// Gives a name in `[let]` another value: a number or an expression, with or without its `=`.
    #[must_use]
    pub fn with_let(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.changes.push((name.into(), value.into()));
        self
    }

    /// Parses and validates the scene.
    ///
    /// # Errors
    /// [`SceneError`] for the first fault, with line and field.
    pub fn parse(&self) -> Result<Scene, SceneError> {
        self.scene_of(&self.tree()?)
    }

    /// Adds file, line and text to an error that has only its field. What comes from a repeated element is led back to it.
    #[must_use]
    pub fn locate(&self, error: SceneError) -> SceneError {
        let Ok(tree) = self.tree() else { return self.place(error) };
        match Expansion::of(&tree, &self.changes) {
            Ok(expansion) => self.place_origin(error, &tree, &expansion),
            Err(_) => self.place(error),
        }
    }

    /// Adds file, line and text to an error whose field is one of the text.
    pub(super) fn place(&self, error: SceneError) -> SceneError {
        let offset = find_offset(&self.text, self.format, error.field());
        let error = error.in_file(self.file.as_deref());
        match offset {
            Some(offset) if !error.field().is_top() => error.at_offset(&self.text, offset),
            _ => error,
        }
    }

    /// The scene that a text stands for, of which `tree` are the data.
    pub(super) fn scene_of(&self, tree: &Tree) -> Result<Scene, SceneError> {
        if !matches!(tree, Tree::Table(_)) {
            let message = format!("invalid type: {}, expected a table", tree.unexpected());
            return Err(self.data_error(FieldPath::top(), &message));
        }
        let expansion = Expansion::of(tree, &self.changes).map_err(|error| self.place(error))?;
        let scene: Scene =
            serde_path_to_error::deserialize(Reading::new(tree, &expansion)).map_err(|error| {
                let error = SceneError::new(field_path(error.path()), plain(&error.inner().to_string()));
                // A field that is missing at the top has no place: line 1 is named.
                self.place_origin(error, tree, &expansion).at_offset(&self.text, 0)
            })?;
        scene.validate().map_err(|error| self.place_origin(error, tree, &expansion))?;
        Ok(scene)
    }

    /// Places an error of the scene that the text stands for, and tells the expression and the numbers that have led to it.
    fn place_origin(&self, error: SceneError, tree: &Tree, expansion: &Expansion) -> SceneError {
        let origin = expansion.origin(error.field());
        let value = origin.field.steps().iter().try_fold(tree, |tree, step| tree.part(step));
        let expression = value.and_then(Tree::text).and_then(expression_in);
        let expression =
            expression.filter(|_| !error.message().contains("in `=")).map(|text| format!("from `={text}`"));
        let names = Some(format!("with {}", origin.bindings)).filter(|_| !origin.bindings.is_empty());
        let told: Vec<String> = expression.into_iter().chain(names).collect();
        let message = if told.is_empty() {
            error.message().to_owned()
        } else {
            format!("{} ({})", error.message(), told.join(", "))
        };
        self.place(error.moved_to(origin.field, message))
    }

    /// Parses the text as plain data, without checks of its fields.
    pub(super) fn tree(&self) -> Result<Tree, SceneError> {
        match self.format {
            SceneFormat::Toml => self.parse_toml(),
            SceneFormat::Json => self.parse_json(),
        }
    }

    fn parse_toml(&self) -> Result<Tree, SceneError> {
        let syntax = |error: toml::de::Error| {
            let offset = error.span().map_or(0, |span| span.start);
            self.syntax_error(&error.message().trim_end().replace('\n', "; "), offset)
        };
        let deserializer = toml::Deserializer::parse(&self.text).map_err(syntax)?;
        Tree::deserialize(deserializer).map_err(syntax)
    }

    fn parse_json(&self) -> Result<Tree, SceneError> {
        let mut deserializer = serde_json::Deserializer::from_str(&self.text);
        let tree = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
            let (field, inner) = (field_path(error.path()), error.inner());
            let offset = offset_of(&self.text, inner.line(), inner.column());
            let message = inner.to_string();
            // serde_json puts its own place behind the message.
            let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
            match message {
                // serde_json counts this among the mistakes of syntax.
                TOO_LARGE => self.data_error(field, "the number is too large"),
                TOO_DEEP => self.syntax_error("arrays and tables are nested deeper than 127 levels", offset),
                _ => self.syntax_error(message, offset),
            }
        })?;
        deserializer.end().map_err(|error| {
            self.syntax_error(
                "text after the end of the scene",
                offset_of(&self.text, error.line(), error.column()),
            )
        })?;
        Ok(tree)
    }

    fn data_error(&self, field: FieldPath, message: &str) -> SceneError {
        self.place(SceneError::new(field, plain(message))).at_offset(&self.text, 0)
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

/// Reads a stream to its end; `None` if that is farther than a scene may go. A device or a growing file may hold more than its size says.
fn read_at_most(stream: impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    let read = stream.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    Ok((read as u64 <= LARGEST_FILE).then_some(bytes))
}

fn text_of(bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes)
        .map_err(|error| format!("is not UTF-8 text: byte {} is not", error.utf8_error().valid_up_to()))
}

/// Returns the text without the byte order mark that some editors put before it.
fn without_mark(mut text: String) -> String {
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
    let is_text = message.starts_with("invalid type: string");
    let number = if is_text {
        "expected a number, or an expression that begins with `=`"
    } else {
        "expected a number"
    };
    with_nearest(message.trim_end())
        .replace("expected f64", number)
        .replace("expected u64", "expected a whole number that is not negative")
        .replace("expected a sequence", "expected an array")
        .replace("invalid type: map", "invalid type: table")
        .replace("invalid type: sequence", "invalid type: array")
}
