//! Shapes as data: the paths alone. All else in a shape follows from them, with the same bits.

use crate::path::Path;
use crate::shape::Shape;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.paths().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Shape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let paths = Vec::<Path>::deserialize(deserializer)?;
        if paths.is_empty() || paths.iter().any(|path| path.edges().is_empty()) {
            return Err(D::Error::custom("a shape or a path of it is empty"));
        }
        Ok(Self::from_oriented(paths))
    }
}
