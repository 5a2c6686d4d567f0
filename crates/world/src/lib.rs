//! (outline)

#[cfg(feature = "scene")]
pub mod scene;
