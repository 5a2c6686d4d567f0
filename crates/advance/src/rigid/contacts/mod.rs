//! TODO

pub(super) mod bounces;
pub(super) mod gaps;
pub(super) mod pairs;
pub(super) mod rows;
pub(super) mod touch;
