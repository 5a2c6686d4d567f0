//! How far a command has come: a progress bar on a terminal, else a line on standard error every few seconds.

use crate::output;
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;
use std::io::{IsTerminal, stderr, stdout};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Number of steps of the bar.
const STEPS: u64 = 1000;
/// Time between two lines.
const PAUSE: Duration = Duration::from_secs(3);

/// What is shown of the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Nothing.
    Nothing,
    /// Lines, also on a terminal: standard output is for a program to read.
    Lines,
    /// A bar, if standard error and output are a terminal; else lines.
    Bar,
}

impl Shown {
    pub(crate) fn of(quiet: bool, json: bool) -> Self {
        match (quiet, json) {
            (true, _) => Self::Nothing,
            (false, true) => Self::Lines,
            (false, false) => Self::Bar,
        }
    }
}

/// The way of a command, in its own unit.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Way {
    /// A run, from its start for a duration [s].
    Run { start: f64, duration: f64 },
    /// A number of runs.
    Runs { count: usize },
}

impl Way {
    /// Says how far a command has come: at a fraction of its way, with a number of events so far.
    fn tell(self, fraction: f64, events: u64) -> String {
        let mut text = String::new();
        let _ = match self {
            Self::Run { start, duration } => {
                let (now, end) = (start + fraction * duration, start + duration);
                write!(text, "progress: at {now:.6} s of {end} s, {events} events so far")
            }
            Self::Runs { count } => {
                write!(text, "progress: {} of {count} runs done", (fraction * count as f64).round())
            }
        };
        text
    }
}

/// Shows how far a command has come.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    lines: Option<Lines>,
}

impl Progress {
    pub(crate) fn new(shown: Shown, title: &str, way: Way) -> Self {
        let has_bar = shown == Shown::Bar && stderr().is_terminal() && stdout().is_terminal();
        let bar = has_bar.then(|| {
            let bar = ProgressBar::new(STEPS);
            if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {eta}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(title.to_owned());
            bar
        });
        let has_lines = shown != Shown::Nothing && !has_bar;
        Self { bar, lines: has_lines.then(|| Lines::new(way)) }
    }

    /// Shows the fraction done, 0 to 1, and the number of events so far.
    pub(crate) fn set(&self, part: f64, events: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position((part * STEPS as f64) as u64);
        }
        if let Some(lines) = &self.lines {
            lines.reached.fraction.store(part.to_bits(), Ordering::Relaxed);
            lines.reached.events.store(events, Ordering::Relaxed);
        }
    }

    pub(crate) fn finish(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        self.lines = None;
    }
}

/// Lines on standard error, written by a thread of their own: a command that is stuck in one place tells that, too.
#[derive(Debug)]
struct Lines {
    reached: Arc<Reached>,
    /// Dropped at the end, which ends the thread.
    goes_on: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// How far the command has come, for the thread to read.
#[derive(Debug, Default)]
struct Reached {
    /// Bits of the fraction.
    fraction: AtomicU64,
    events: AtomicU64,
}

impl Lines {
    fn new(way: Way) -> Self {
        let reached = Arc::new(Reached::default());
        let (goes_on, end) = channel::<()>();
        let read = Arc::clone(&reached);
        let tell = move || {
            while end.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                let fraction = f64::from_bits(read.fraction.load(Ordering::Relaxed));
                output::tell(&way.tell(fraction, read.events.load(Ordering::Relaxed)));
            }
        };
        // Where no thread can be had, nothing is told.
        let thread = std::thread::Builder::new().spawn(tell).ok();
        Self { reached, goes_on: Some(goes_on), thread }
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.goes_on = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_how_far_a_command_has_come() {
        let run = Way::Run { start: 2.0, duration: 0.5 };
        assert_eq!(run.tell(0.25, 17), "progress: at 2.125000 s of 2.5 s, 17 events so far");
        assert_eq!(Way::Runs { count: 40 }.tell(0.3, 0), "progress: 12 of 40 runs done");
    }
}
