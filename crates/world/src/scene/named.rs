//! Tables with one key that may have a `name` beside it.

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

/// Data that may have a name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedData<T> {
    /// The name, if one is given.
    pub name: Option<String>,
    /// The data.
    pub data: T,
}

impl<T> Deref for NamedData<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.data
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for NamedData<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Table(PhantomData))
    }
}

struct Table<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Table<T> {
    type Value = NamedData<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a table")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NamedData<T>, A::Error> {
        let mut name = None;
        let data = T::deserialize(MapAccessDeserializer::new(WithoutName { map, name: &mut name }))?;
        Ok(NamedData { name, data })
    }
}

/// A table, from which the name is taken out.
struct WithoutName<'a, A> {
    map: A,
    name: &'a mut Option<String>,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for WithoutName<'_, A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        while let Some(key) = self.map.next_key::<String>()? {
            if key != "name" {
                return seed.deserialize(StringDeserializer::new(key)).map(Some);
            }
            if self.name.is_some() {
                return Err(A::Error::duplicate_field("name"));
            }
            *self.name = Some(self.map.next_value()?);
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
}
