//! TODO

pub(super) mod cause;
pub(super) mod collecting;
pub(super) mod records;
pub(super) mod touching;
pub(super) mod view;
