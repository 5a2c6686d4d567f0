//! Names of kinds of connectors as data: read back, they are again the words of this crate.

use crate::connector::{KIND_NAMES, KindName};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

pub(crate) fn serialize<S: Serializer>(name: &KindName, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(name)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<KindName, D::Error> {
    let found = String::deserialize(deserializer)?;
    let known = KIND_NAMES.into_iter().find(|name| *name == found);
    known.ok_or_else(|| D::Error::custom(format_args!("no kind of connector: {found}")))
}
