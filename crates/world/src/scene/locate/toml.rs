//! Places of fields in TOML, from the spans of its parser.

use crate::scene::field_path::Step;
use ::toml::de::{DeTable, DeValue};

/// Returns the byte offset of the field, or of the nearest table or array around it; `None` if the text does not parse.
pub(super) fn find_offset(text: &str, steps: &[Step]) -> Option<usize> {
    let table = DeTable::parse(text).ok()?;
    let (first, rest) = match steps.split_first() {
        Some((Step::Field(name), rest)) => (name, rest),
        _ => return Some(0),
    };
    let Some((key, value)) = table.get_ref().get_key_value(first.as_str()) else { return Some(0) };
    let mut offset = key.span().start;
    let mut value = value;
    for step in rest {
        let next = match (step, value.get_ref()) {
            (Step::Field(name), DeValue::Table(table)) => {
                table.get_key_value(name.as_str()).map(|(key, value)| (key.span().start, value))
            }
            (Step::Element(index), DeValue::Array(array)) => {
                array.get(*index).map(|value| (value.span().start, value))
            }
            _ => None,
        };
        let Some((start, inner)) = next else { break };
        (offset, value) = (start, inner);
    }
    Some(offset)
}
