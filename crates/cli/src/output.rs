//! Standard output.

use std::io::{self, Write};

/// Writes a text to standard output; that nobody reads on (as in `halfgap ... | head`) is no error.
pub(crate) fn print(text: &str) {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    if let Err(error) = written.or_else(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Ok(()),
        _ => Err(error),
    }) {
        eprintln!("error: cannot write to standard output: {error}");
    }
}
