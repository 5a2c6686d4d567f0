//! TODO

pub(super) mod corners;
pub(super) mod impacts;
pub(super) mod jams;
