//! The data of a scene as serde reads them: expressions become numbers, repeated elements one of each, and names in braces
//! numbers. Whether a text is an expression is known only here: it is one where a number is expected.
//!
//! Tables are taken for structs and strings for enums, and nothing else: the visitors that serde derives would also take an array of
//! a struct's fields in their order, and name types of this program.

use super::Expansion;
use super::expression::expression_in;
use super::lets::{LET, Lets, in_expression};
use super::repeat::{Bindings, LISTS, REPEAT, Run};
use super::tree::Tree;
use serde::de::value::{Error, StrDeserializer, StringDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;

/// What names stand for.
#[derive(Clone, Copy, Debug)]
struct Scope<'t> {
    lets: &'t Lets,
    bindings: Bindings<'t>,
}

impl Scope<'_> {
    fn value(self, text: &str) -> Result<f64, Error> {
        self.bindings.value(text, self.lets).map_err(|why| Error::custom(in_expression(text, &why)))
    }
}

/// The part of a scene that is read.
#[derive(Clone, Copy, Debug)]
enum Part<'t> {
    /// The whole, with the runs of its lists.
    Top(&'t [Vec<Run>; LISTS.len()]),
    /// A list at the top.
    List(&'t [Run]),
    /// An element of such a list.
    Element,
    Inner,
}

/// A value that is read.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Reading<'t> {
    tree: &'t Tree,
    scope: Scope<'t>,
    part: Part<'t>,
}

impl<'t> Reading<'t> {
    /// The whole scene.
    pub(in crate::scene) fn new(tree: &'t Tree, expansion: &'t Expansion) -> Self {
        let scope = Scope { lets: &expansion.lets, bindings: Bindings::default() };
        Self { tree, scope, part: Part::Top(&expansion.runs) }
    }

    fn is_expected<T>(self, what: &'static str) -> Result<T, Error> {
        Err(Error::invalid_type(self.tree.unexpected(), &what))
    }
}

impl<'de> Deserializer<'de> for Reading<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.tree {
            Tree::Text(text) => match expression_in(text) {
                Some(expression) => {
                    let number = self.scope.value(expression)?;
                    match Tree::of_number(number) {
                        Tree::Whole(whole) => visitor.visit_i64(whole),
                        _ => visitor.visit_f64(number),
                    }
                }
                None => self.deserialize_str(visitor),
            },
            Tree::Null => Err(Error::invalid_type(self.tree.unexpected(), &visitor)),
            Tree::Bool(value) => visitor.visit_bool(*value),
            Tree::Whole(value) => visitor.visit_i64(*value),
            Tree::Large(value) => visitor.visit_u64(*value),
            Tree::Number(value) => visitor.visit_f64(*value),
            Tree::Array(elements) => visitor.visit_seq(Elements { reading: self, elements, next: 0, run: 0 }),
            Tree::Table(fields) => {
                visitor.visit_map(Fields { reading: self, fields: fields.iter(), value: None })
            }
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let Tree::Text(text) = self.tree else { return self.deserialize_any(visitor) };
        match self.scope.bindings.fill(text, self.scope.lets).map_err(Error::custom)? {
            Some(text) => visitor.visit_string(text),
            None => visitor.visit_str(text),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if *self.tree == Tree::Null { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if matches!(self.tree, Tree::Table(_)) {
            self.deserialize_any(visitor)
        } else {
            self.is_expected("a table")
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let Tree::Text(text) = self.tree else { return self.is_expected("a string") };
        visitor.visit_enum(StrDeserializer::new(text))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char bytes byte_buf unit unit_struct newtype_struct seq tuple
        tuple_struct map identifier
    }
}

/// The elements of an array that are left.
struct Elements<'t> {
    reading: Reading<'t>,
    elements: &'t [Tree],
    /// Number of elements before, of those that they become.
    next: u64,
    /// The run of the next, in a list at the top.
    run: usize,
}

impl<'t> Elements<'t> {
    /// The next element, with what its names stand for.
    fn take(&mut self) -> Option<Reading<'t>> {
        let Part::List(runs) = self.reading.part else {
            let (first, rest) = self.elements.split_first()?;
            self.elements = rest;
            return Some(Reading { tree: first, part: Part::Inner, ..self.reading });
        };
        let run = loop {
            let run = runs.get(self.run)?;
            if self.next < run.count() {
                break run;
            }
            (self.run, self.next) = (self.run + 1, 0);
        };
        let bindings = run.bindings(self.next);
        self.next += 1;
        let scope = Scope { bindings, ..self.reading.scope };
        Some(Reading { tree: self.elements.get(run.source)?, scope, part: Part::Element })
    }
}

impl<'de> SeqAccess<'de> for Elements<'_> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        self.take().map(|element| seed.deserialize(element)).transpose()
    }
}

/// The fields of a table that are left.
struct Fields<'t> {
    reading: Reading<'t>,
    fields: std::slice::Iter<'t, (String, Tree)>,
    value: Option<Reading<'t>>,
}

impl<'de> MapAccess<'de> for Fields<'_> {
    type Error = Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        let part = self.reading.part;
        let is_read = |name: &str| match part {
            Part::Top(_) => name != LET,
            Part::Element => name != REPEAT,
            Part::List(_) | Part::Inner => true,
        };
        let Some((name, tree)) = self.fields.find(|(name, _)| is_read(name)) else { return Ok(None) };
        let list = LISTS.iter().position(|list| list == name).filter(|_| matches!(tree, Tree::Array(_)));
        let part = match (part, list) {
            (Part::Top(runs), Some(list)) => Part::List(&runs[list]),
            _ => Part::Inner,
        };
        self.value = Some(Reading { tree, part, ..self.reading });
        seed.deserialize(StringDeserializer::new(name.clone())).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        let value = self.value.take().ok_or_else(|| Error::custom("a value is read before its key"))?;
        seed.deserialize(value)
    }
}
