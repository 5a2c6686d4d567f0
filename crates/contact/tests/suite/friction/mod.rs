//! Problems with friction, by all methods that take them.

mod cases;
#[cfg(feature = "json")]
mod files;
pub(crate) mod generated;
mod judge;
mod walls;

pub(crate) use generated::Random;
