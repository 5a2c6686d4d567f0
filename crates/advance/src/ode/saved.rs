//! Coefficients as data: the name of their method.

use super::method::Method;
use super::tableau::Tableau;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub(super) fn serialize<S: Serializer>(tableau: &&'static Tableau, serializer: S) -> Result<S::Ok, S::Error> {
    tableau.method.serialize(serializer)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<&'static Tableau, D::Error> {
    let tableau = Method::deserialize(deserializer)?.tableau();
    tableau.ok_or_else(|| D::Error::custom("an implicit method has no tableau"))
}
