//! How far a command has come: a progress bar on a terminal, else a line on standard error every few seconds.

use crate::numbers::given;
use crate::output;
use halfgap::Reached;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, stderr, stdout};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Number of steps of the bar.
const STEPS: u64 = 1000;
/// Time between two lines. A choice: most runs end sooner and tell nothing, and who waits for others need not wonder
/// whether they go on.
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
    /// A run, to its end [s].
    Run { end: f64 },
    /// A number of runs.
    Runs { count: usize },
}

impl Way {
    /// Says how far a command has come.
    fn tell(self, reached: &Reached) -> String {
        let Reached { fraction, time, events } = *reached;
        match self {
            Self::Run { end } => {
                format!("progress: at {} s of {} s, {events} events so far", given(time), given(end))
            }
            Self::Runs { count } => {
                format!("progress: {} of {count} runs done", (fraction * count as f64).round())
            }
        }
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

    /// Shows how far the command has come. Where it makes many runs, only the fraction of them counts.
    pub(crate) fn set(&self, reached: &Reached) {
        if let Some(bar) = &self.bar {
            bar.set_position((reached.fraction * STEPS as f64) as u64);
        }
        if let Some(lines) = &self.lines {
            lines.latest.write(reached);
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
    latest: Arc<Latest>,
    /// Dropped at the end, which ends the thread.
    goes_on: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// How far the command has come, for the thread to read.
#[derive(Debug, Default)]
struct Latest {
    /// Bits of the fraction.
    fraction: AtomicU64,
    /// Bits of the time [s].
    time: AtomicU64,
    events: AtomicU64,
}

impl Latest {
    fn write(&self, reached: &Reached) {
        self.fraction.store(reached.fraction.to_bits(), Ordering::Relaxed);
        self.time.store(reached.time.to_bits(), Ordering::Relaxed);
        self.events.store(reached.events, Ordering::Relaxed);
    }

    fn read(&self) -> Reached {
        Reached {
            fraction: f64::from_bits(self.fraction.load(Ordering::Relaxed)),
            time: f64::from_bits(self.time.load(Ordering::Relaxed)),
            events: self.events.load(Ordering::Relaxed),
        }
    }
}

impl Lines {
    fn new(way: Way) -> Self {
        let latest = Arc::new(Latest::default());
        let (goes_on, end) = channel::<()>();
        let reader = Arc::clone(&latest);
        let tell = move || {
            while end.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                output::tell(&way.tell(&reader.read()));
            }
        };
        // Where no thread can be had, nothing is told.
        let thread = std::thread::Builder::new().spawn(tell).ok();
        Self { latest, goes_on: Some(goes_on), thread }
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
        let run = |time: f64| Way::Run { end: 2.5 }.tell(&Reached { fraction: 0.25, time, events: 17 });
        assert_eq!(run(2.125), "progress: at 2.125 s of 2.5 s, 17 events so far");
        assert_eq!(run(1.5e-7), "progress: at 1.5e-7 s of 2.5 s, 17 events so far");
        let runs = Reached { fraction: 0.3, ..Reached::default() };
        assert_eq!(Way::Runs { count: 40 }.tell(&runs), "progress: 12 of 40 runs done");
    }
}
