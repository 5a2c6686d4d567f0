//! The command, run as users run it.

mod command;
mod determinism;
mod language;
mod messages;
mod newcomer;
