//! A text as plain data: what TOML and JSON have in common, in the order of the text.
//!
//! *Invariant*: nothing of the text is lost, not even a field that is there twice: whoever reads the data finds and refuses it.

use crate::scene::field_path::Step;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt;

/// Size below which whole numbers are exact as floating-point numbers, 2^53.
pub(super) const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// A value with all that is in it.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::scene) enum Tree {
    Null,
    Bool(bool),
    Whole(i64),
    /// A whole number beyond the others.
    Large(u64),
    Number(f64),
    Text(String),
    Array(Vec<Tree>),
    Table(Vec<(String, Tree)>),
}

impl Tree {
    /// A number: a whole one if it is, so that it also fits where whole numbers are expected.
    pub(in crate::scene) fn of_number(number: f64) -> Self {
        let is_whole = number.fract() == 0.0
            && number.abs() < LARGEST_WHOLE
            && !(number == 0.0 && number.is_sign_negative());
        if is_whole { Self::Whole(number as i64) } else { Self::Number(number) }
    }

    /// The field of a table; `None` if there is none, or this is no table.
    pub(in crate::scene) fn get(&self, name: &str) -> Option<&Self> {
        let Self::Table(fields) = self else { return None };
        fields.iter().find(|(key, _)| key == name).map(|(_, value)| value)
    }

    /// The field of a table or the element of an array at a step.
    pub(in crate::scene) fn part(&self, step: &Step) -> Option<&Self> {
        match (self, step) {
            (Self::Table(_), Step::Field(name)) => self.get(name),
            (Self::Array(elements), Step::Element(index)) => elements.get(*index),
            _ => None,
        }
    }

    pub(in crate::scene) fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    pub(in crate::scene) fn number(&self) -> Option<f64> {
        match *self {
            Self::Whole(number) => Some(number as f64),
            Self::Large(number) => Some(number as f64),
            Self::Number(number) => Some(number),
            _ => None,
        }
    }

    /// How messages tell what it is.
    pub(in crate::scene) fn unexpected(&self) -> Unexpected<'_> {
        match self {
            Self::Null => Unexpected::Other("null"),
            Self::Bool(value) => Unexpected::Bool(*value),
            Self::Whole(value) => Unexpected::Signed(*value),
            Self::Large(value) => Unexpected::Unsigned(*value),
            Self::Number(value) => Unexpected::Float(*value),
            Self::Text(value) => Unexpected::Str(value),
            Self::Array(_) => Unexpected::Other("array"),
            Self::Table(_) => Unexpected::Other("table"),
        }
    }
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyValue)
    }
}

struct AnyValue;

impl<'de> Visitor<'de> for AnyValue {
    type Value = Tree;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a value")
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Tree, E> {
        Ok(Tree::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Tree, E> {
        Ok(Tree::Whole(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Tree, E> {
        Ok(i64::try_from(value).map_or(Tree::Large(value), Tree::Whole))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Tree, E> {
        Ok(Tree::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Tree, E> {
        Ok(Tree::Text(value.to_owned()))
    }

    fn visit_string<E>(self, value: String) -> Result<Tree, E> {
        Ok(Tree::Text(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Tree, A::Error> {
        let mut array = Vec::new();
        while let Some(element) = elements.next_element()? {
            array.push(element);
        }
        Ok(Tree::Array(array))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Tree, A::Error> {
        let mut table = Vec::new();
        while let Some(field) = fields.next_entry()? {
            table.push(field);
        }
        Ok(Tree::Table(table))
    }
}
