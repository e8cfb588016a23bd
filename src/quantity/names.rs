//! Closed sets of names: one list, `name()`, behind text, serde and the JSON schema.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, de::Error};

/// Gives an enum with `name()` and a list of all its variants the same names in text, in serde (both directions) and in the JSON schema.
macro_rules! by_name {
    ($type:ident, $all:expr) => {
        impl std::fmt::Display for $type {
            fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.pad(self.name())
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::quantity::variant_by_name(deserializer, &$all, Self::name)
            }
        }

        impl schemars::JsonSchema for $type {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({ "type": "string", "enum": $all.map(Self::name) })
            }
        }
    };
}
pub(crate) use by_name;

/// The variant with the name that is read.
///
/// # Errors
/// An unknown name, with all known ones.
pub(crate) fn variant_by_name<'de, D: Deserializer<'de>, T: Copy>(
    deserializer: D,
    all: &[T],
    name: fn(T) -> &'static str,
) -> Result<T, D::Error> {
    let found = Cow::<str>::deserialize(deserializer)?;
    all.iter().copied().find(|variant| name(*variant) == found).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|variant| name(*variant)).collect();
        D::Error::custom(format!("found \"{found}\", expected one of {}", names.join(", ")))
    })
}
