//! Options that have no meaning for a robot whose heading is not controlled.

use super::{Failure, not_on_mesh::Given};

/// Refuses the first option that was given.
pub(crate) fn refuse(options: &[Given]) -> Result<(), Failure> {
    let Some((option, _, what)) = options.iter().find(|(_, given, _)| *given) else { return Ok(()) };
    Err(Failure::message(format!(
        "{option}: found this option, which {what}, and uncertainty.heading is \"uncontrolled\", so that there is no path: leave the option out"
    )))
}
