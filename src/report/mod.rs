//! What goes to people: the picture of an analysis.

#[cfg(feature = "plot")]
pub mod figure;
