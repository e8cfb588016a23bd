//! The names of layers, as limits and amounts.

use std::{collections::BTreeSet, fmt, sync::Mutex};

/// The name of a layer of a scenario: the part after the point of `[layer.sun]`.
///
/// A [`Limit`](super::Limit) is copied for every refused hop, so a name is a reference: each different name that a process reads is kept
/// until its end.
///
/// ```
/// use chta::world::{LayerName, Limit};
/// let sun = LayerName::new("sun").unwrap();
/// assert_eq!((sun.name(), Limit::Layer(sun).name()), ("sun", "layer:sun"));
/// assert_eq!(LayerName::new("two words"), None);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LayerName(&'static str);

/// Every name read so far, with its prefix.
static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());

impl LayerName {
    /// What begins the name of a layer where other limits and amounts have names too.
    pub const PREFIX: &'static str = "layer:";

    /// The names with their prefix, as a regular expression.
    pub(crate) const LIMIT_PATTERN: &'static str = "^layer:[A-Za-z0-9_-]{1,64}$";

    /// A name of 1 to 64 letters, digits, `_` and `-`; `None` for any other text.
    pub fn new(name: &str) -> Option<Self> {
        let fits = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
        if !(1..=64).contains(&name.len()) || !name.chars().all(fits) {
            return None;
        }
        let full = format!("{}{name}", Self::PREFIX);
        // A set is whole whatever a thread that held it was doing.
        let mut known = KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(known) = known.get(full.as_str()) {
            return Some(Self(known));
        }
        let kept: &'static str = Box::leak(full.into_boxed_str());
        known.insert(kept);
        Some(Self(kept))
    }

    /// The name as in the scenario.
    pub fn name(self) -> &'static str {
        &self.0[Self::PREFIX.len()..]
    }

    /// The name with its prefix, as that of a limit.
    pub const fn as_limit(self) -> &'static str {
        self.0
    }
}

impl fmt::Display for LayerName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl fmt::Debug for LayerName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.name(), formatter)
    }
}
