//! TODO

pub(super) mod depth;
