//! The halfgap command.
fn main() {}
