//! The command, run as users run it.

mod command;
mod determinism;
mod messages;
mod newcomer;
