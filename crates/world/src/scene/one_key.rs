//! Tables that must have exactly one key, such as `shape = { disc = { radius = 1.0 } }`, as enums.
//!
//! serde's own externally tagged enums read the same form, but their message for two keys differs between formats and
//! names neither key.

/// Returns the message for a table that has the key `extra` beside `key`, one of the `known` ones.
pub(super) fn misplaced(key: &str, extra: &str, known: &[&str]) -> String {
    let both = format!("must have exactly one key, found `{key}` and `{extra}`");
    if known.contains(&extra) { both } else { format!("{both}: what belongs to `{key}` goes into its table") }
}

/// Declares an enum and reads it from a table with exactly one key, which names the variant.
macro_rules! one_key_enum {
    ($(#[$meta:meta])* $name:ident: $what:literal { $($(#[$doc:meta])* $key:literal => $variant:ident($data:ty)),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $name {
            $($(#[$doc])* $variant($data)),+
        }

        impl $name {
            /// The key that names this variant in a scene file.
            #[must_use]
            pub fn key(&self) -> &'static str {
                match self {
                    $($name::$variant(_) => $key),+
                }
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct OneKey;

                impl<'de> serde::de::Visitor<'de> for OneKey {
                    type Value = $name;

                    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        formatter.write_str(concat!("a table with one key that names the ", $what))
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<$name, A::Error> {
                        use serde::de::Error;
                        let Some(key) = map.next_key::<String>()? else {
                            let known = [$(concat!("`", $key, "`")),+].join(", ");
                            return Err(A::Error::custom(format!("must have exactly one key, one of {known}")));
                        };
                        let value = match key.as_str() {
                            $($key => $name::$variant(map.next_value()?),)+
                            _ => {
                                map.next_value::<serde::de::IgnoredAny>()?;
                                let named = map.next_key::<String>()?.filter(|key| [$($key),+].contains(&key.as_str()));
                                return Err(named.map_or_else(
                                    || A::Error::unknown_field(&key, &[$($key),+]),
                                    |named| A::Error::custom($crate::scene::one_key::misplaced(&named, &key, &[$($key),+])),
                                ));
                            }
                        };
                        let extra = map.next_key::<String>()?;
                        extra.map_or(Ok(value), |extra| {
                            Err(A::Error::custom($crate::scene::one_key::misplaced(&key, &extra, &[$($key),+])))
                        })
                    }
                }

                deserializer.deserialize_map(OneKey)
            }
        }
    };
}

pub(crate) use one_key_enum;
