//! Ends of commands with their exit codes, and messages of failures.

use crate::output;
use halfgap::scene::SceneError;
use std::fmt::Write;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

/// End of a command, apart from failures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Everything was done.
    Done,
    /// A check failed.
    CheckFailed,
    /// A scene among several could not be read, and the others were checked; a contact problem could not be read.
    BadInput,
    /// The simulation stopped early, or a contact problem has no answer.
    Stopped,
}

impl From<End> for ExitCode {
    fn from(end: End) -> Self {
        ExitCode::from(match end {
            End::Done => 0,
            End::CheckFailed => 1,
            End::BadInput => 2,
            End::Stopped => 3,
        })
    }
}

/// Failure that kept a command from its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The scene or an option is wrong.
    Scene(SceneError),
    /// A file of the recording could not be written.
    Write(PathBuf, io::Error),
    /// Standard output could not be written to.
    Output(io::Error),
    /// The threads of a sweep could not be started.
    Threads(rayon::ThreadPoolBuildError),
}

impl Failure {
    pub(crate) fn exit_code(&self) -> u8 {
        // An output that cannot be written counts as a wrong option.
        2
    }

    /// Writes the message to standard error.
    pub(crate) fn report(&self) {
        output::tell(&self.message());
    }

    fn message(&self) -> String {
        match self {
            Self::Scene(error) => describe(error),
            Self::Write(path, error) => format!("error: --out: cannot write {}: {error}", path.display()),
            Self::Output(error) => format!("error: cannot write to standard output: {error}"),
            Self::Threads(error) => format!("error: --threads: {error}"),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

/// Returns the message of an error, with the line of the file and a mark at the column.
pub(crate) fn describe(error: &SceneError) -> String {
    let mut text = format!("error: {error}");
    if let (Some(position), Some(excerpt)) = (error.position(), error.excerpt()) {
        let number = position.line.to_string();
        let margin = " ".repeat(number.len());
        let line = &excerpt.text;
        let _ =
            write!(text, "\n {margin} |\n {number} | {line}\n {margin} | {:>1$}", '^', excerpt.before + 1);
    }
    text
}
