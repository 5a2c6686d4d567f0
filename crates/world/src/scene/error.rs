//! What is wrong with a scene, and where.

use super::field_path::FieldPath;
use std::fmt;
use std::path::{Path, PathBuf};

/// Why a scene could not be read, is not valid, or cannot be built.
///
/// Displays as `file:line: field: message`, as far as these are known.
#[derive(Debug, thiserror::Error)]
pub struct SceneError {
    // Boxed, so that results stay small.
    report: Box<Report>,
}

#[derive(Debug)]
struct Report {
    file: Option<PathBuf>,
    position: Option<Position>,
    line_text: Option<String>,
    field: FieldPath,
    message: String,
    cause: Option<std::io::Error>,
}

/// A position in a text, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

impl SceneError {
    /// An error at a field of the scene, or at the top where no single field is to blame.
    ///
    /// The message starts lower case and names the offending value and its unit.
    #[must_use]
    pub fn new(field: FieldPath, message: impl Into<String>) -> Self {
        let message = message.into();
        let report = Report { file: None, position: None, line_text: None, field, message, cause: None };
        Self { report: Box::new(report) }
    }

    /// The file, if the scene came from one.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        self.report.file.as_deref()
    }

    /// Where in the text.
    #[must_use]
    pub fn position(&self) -> Option<Position> {
        self.report.position
    }

    /// The line of the text at that position.
    #[must_use]
    pub fn line_text(&self) -> Option<&str> {
        self.report.line_text.as_deref()
    }

    /// The field, or the top of the file.
    #[must_use]
    pub fn field(&self) -> &FieldPath {
        &self.report.field
    }

    /// What is wrong, without the place.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.report.message
    }

    /// What kept the file from being read, where that was it.
    #[must_use]
    pub fn cause(&self) -> Option<&std::io::Error> {
        self.report.cause.as_ref()
    }

    pub(crate) fn caused_by(mut self, cause: std::io::Error) -> Self {
        self.report.cause = Some(cause);
        self
    }

    pub(crate) fn in_file(mut self, file: Option<&Path>) -> Self {
        self.report.file = file.map(Path::to_path_buf);
        self
    }

    /// Fills in the position and the line of text there, unless the position is known already.
    pub(crate) fn at_offset(mut self, text: &str, offset: usize) -> Self {
        if self.report.position.is_none() {
            let (position, line) = place_of(text, offset);
            self.report.position = Some(position);
            self.report.line_text = Some(shortened(line));
        }
        self
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &*self.report;
        match (&report.file, report.position) {
            (Some(file), Some(Position { line, .. })) => write!(formatter, "{}:{line}: ", file.display())?,
            (Some(file), None) => write!(formatter, "{}: ", file.display())?,
            (None, Some(Position { line, .. })) => write!(formatter, "line {line}: ")?,
            (None, None) => {}
        }
        if !report.field.is_top() {
            write!(formatter, "{}: ", report.field)?;
        }
        formatter.write_str(&report.message)
    }
}

/// Line and column of a byte offset, and the text of that line.
fn place_of(text: &str, offset: usize) -> (Position, &str) {
    let offset = (0..=offset.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let (before, after) = text.split_at(offset);
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    let line_end = after.find('\n').map_or(text.len(), |at| offset + at);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let column = before[line_start..].chars().count() + 1;
    (Position { line, column }, text[line_start..line_end].trim_end())
}

/// A line that fits a terminal; files written by programs may be one line of megabytes.
fn shortened(line: &str) -> String {
    const LONGEST: usize = 120;
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_becomes_line_and_column() {
        let text = "one\ntwö x\n";
        let (position, line) = place_of(text, text.find('x').expect("there is one"));
        assert_eq!(position, Position { line: 2, column: 5 });
        assert_eq!(line, "twö x");
        assert_eq!(place_of(text, 1000).0, Position { line: 3, column: 1 });
    }

    #[test]
    fn a_long_line_is_cut() {
        assert_eq!(shortened(&"x".repeat(1000)).len(), 123);
    }
}
