//! The progress bar, shown on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr, stdout};

/// Number of steps of the bar.
const STEPS: u64 = 1000;

/// A bar on standard error, hidden if it is not wanted, or if standard error or output is not a terminal.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(wanted: bool, title: &str) -> Self {
        let shown = wanted && stderr().is_terminal() && stdout().is_terminal();
        let bar = shown.then(|| {
            let bar = ProgressBar::new(STEPS);
            if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {eta}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(title.to_owned());
            bar
        });
        Self { bar }
    }

    /// Shows the fraction done, 0 to 1.
    pub(crate) fn set(&self, part: f64) {
        if let Some(bar) = &self.bar {
            bar.set_position((part * STEPS as f64) as u64);
        }
    }

    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
