//! Problems with friction, by all methods that take them.

mod cases;
#[cfg(feature = "json")]
mod files;
mod generated;
mod judge;
mod walls;
