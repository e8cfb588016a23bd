//! Keys that are absent, null or a value.

use serde::{Deserialize, Deserializer};

/// A key that is there: null is `Some(None)`. The key's field has `#[serde(default)]`, so that an absent key is `None`.
///
/// # Errors
/// A value of another type.
#[expect(clippy::option_option, reason = "absent, null and a value are three answers")]
pub(super) fn stated<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<Option<Option<T>>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}
