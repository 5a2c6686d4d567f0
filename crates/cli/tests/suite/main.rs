//! The command, run as users run it.

mod command;
mod determinism;
mod messages;
#[cfg(unix)]
mod newcomer;
