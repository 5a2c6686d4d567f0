//! TODO

pub(super) mod corners;
pub(super) mod ends;
pub(super) mod rails;
pub(super) mod store;
