//! Where in a scene's text a field stands.
//!
//! The data of a scene do not carry their places; this finds them again in the text when a message needs one.

mod json;
mod toml;

use super::field_path::FieldPath;
use super::source::SceneFormat;

/// The byte offset of a field, or of the nearest table or array around it that is there.
pub(super) fn find_offset(text: &str, format: SceneFormat, path: &FieldPath) -> Option<usize> {
    match format {
        SceneFormat::Toml => toml::find_offset(text, path.steps()),
        SceneFormat::Json => Some(json::find_offset(text, path.steps())),
    }
}
