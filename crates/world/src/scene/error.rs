//! Errors of scenes, with file, line and field.

use super::field_path::FieldPath;
use std::fmt;
use std::path::{Path, PathBuf};

/// Error of a scene that cannot be read, is not valid, or cannot be built.
///
/// Displays as `file:line: field: message`, as far as these are known.
#[derive(Debug, thiserror::Error)]
pub struct SceneError {
    // Boxed, to keep results small.
    report: Box<Report>,
}

#[derive(Debug)]
struct Report {
    file: Option<PathBuf>,
    position: Option<Position>,
    excerpt: Option<Excerpt>,
    field: FieldPath,
    message: String,
    cause: Option<std::io::Error>,
}

/// A position in a text, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Line number.
    pub line: usize,
    /// Column number, in characters.
    pub column: usize,
}

/// A line of text, cut to fit a terminal: files written by programs may be one line of megabytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The text.
    pub text: String,
    /// Number of its characters before the place of the error.
    pub before: usize,
}

impl Excerpt {
    fn of_line(line: &str, before: usize) -> Self {
        const LONGEST: usize = 100;
        const LEAD: usize = 40;
        const DOTS: &str = "...";
        if line.chars().count() <= LONGEST {
            return Self { text: line.to_owned(), before };
        }
        let skipped = if before < LONGEST { 0 } else { before - LEAD };
        let shown: String = line.chars().skip(skipped).take(LONGEST).collect();
        let head = if skipped > 0 { DOTS } else { "" };
        let tail = if line.chars().nth(skipped + LONGEST).is_some() { DOTS } else { "" };
        Self { text: format!("{head}{shown}{tail}"), before: before - skipped + head.len() }
    }
}

impl SceneError {
    /// Makes an error at a field of the scene, or at the top where no single field is to blame.
    ///
    /// The message starts lower case and names the offending value and its unit.
    #[must_use]
    pub fn new(field: FieldPath, message: impl Into<String>) -> Self {
        let message = message.into();
        let report = Report { file: None, position: None, excerpt: None, field, message, cause: None };
        Self { report: Box::new(report) }
    }

    /// The file, if the scene came from one.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        self.report.file.as_deref()
    }

    /// Position in the text, if it is known.
    #[must_use]
    pub fn position(&self) -> Option<Position> {
        self.report.position
    }

    /// The line of text at the position, cut to fit a terminal.
    #[must_use]
    pub fn excerpt(&self) -> Option<&Excerpt> {
        self.report.excerpt.as_ref()
    }

    /// Path of the field, or of the top of the file.
    #[must_use]
    pub fn field(&self) -> &FieldPath {
        &self.report.field
    }

    /// The message without file, line and field.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.report.message
    }

    /// The error of the file system, if the file could not be read.
    #[must_use]
    pub fn cause(&self) -> Option<&std::io::Error> {
        self.report.cause.as_ref()
    }

    pub(crate) fn caused_by(mut self, cause: std::io::Error) -> Self {
        self.report.cause = Some(cause);
        self
    }

    /// The same at another field and with another message.
    pub(crate) fn moved_to(mut self, field: FieldPath, message: String) -> Self {
        (self.report.field, self.report.message) = (field, message);
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
            self.report.excerpt = Some(Excerpt::of_line(line, position.column - 1));
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
    fn a_long_line_is_cut_around_the_place() {
        let line = format!("{}x{}", "a".repeat(500), "b".repeat(500));
        let excerpt = Excerpt::of_line(&line, 500);
        assert_eq!(excerpt.text.chars().nth(excerpt.before), Some('x'));
        assert_eq!(excerpt.text.len(), 106);
        assert_eq!(Excerpt::of_line("short", 9), Excerpt { text: "short".to_owned(), before: 9 });
        assert_eq!(Excerpt::of_line(&line, 3).before, 3);
    }
}
