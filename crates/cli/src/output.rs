//! Standard output, for results, and standard error, for messages.

use crate::failure::Failure;
use std::io::{self, Write};

/// Writes a text to standard output. A closed pipe, as in `halfgap ... | head`, is no error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Output(error)),
        _ => Ok(()),
    }
}

/// Writes a line to standard error. A message that cannot be written is lost: it must cost neither the result nor the
/// exit code.
pub(crate) fn tell(line: &str) {
    let _ = io::stderr().lock().write_all(format!("{line}\n").as_bytes());
}
