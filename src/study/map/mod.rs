//! Hops over a whole DEM: from a scenario, its starts and its goals to the maps, the paths and their trials.
//!
//! [`map`] answers a [`MapQuestion`] at once. A caller that has something to do in between, such as opening its files, calls
//! [`PreparedMap::new`], which reads the terrain and finds the posts, and then [`PreparedMap::answered`].

mod aim;
mod answered;
mod error;
mod flown;
mod memory;
mod prepared;
mod question;
mod refused;

pub(super) use aim::{Aim, allowed};
pub use answered::{MapStudy, NO_PREDECESSOR};
pub use error::MapStudyError;
pub use memory::MapMemory;
pub(in crate::study) use prepared::spot;
pub use prepared::{PreparedMap, Spot};
pub use question::{MapQuestion, NamedPlace};
pub use refused::{NodeRefusal, RefusedNodes};

use crate::progress::Progress;

/// Answers a question about a map: reads the terrain, searches, plans the path to every goal and flies it again with the independent
/// checker, and flies its trials.
///
/// The answer does not depend on the number of threads.
///
/// # Errors
/// [`MapStudyError`].
pub fn map(question: &MapQuestion<'_>, progress: &impl Progress) -> Result<MapStudy, MapStudyError> {
    PreparedMap::new(question)?.answered(question, progress)
}
