//! Places of fields in the text of a scene.
//!
//! The data of a scene do not carry their places; they are looked up in the text when a message needs one.

mod json;
mod toml;

use super::field_path::FieldPath;
use super::source::SceneFormat;

/// Returns the byte offset of a field, or of the nearest table or array around it that the text has.
pub(super) fn find_offset(text: &str, format: SceneFormat, path: &FieldPath) -> Option<usize> {
    match format {
        SceneFormat::Toml => toml::find_offset(text, path.steps()),
        SceneFormat::Json => Some(json::find_offset(text, path.steps())),
    }
}
