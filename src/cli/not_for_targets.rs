//! Options that have no meaning for a mission over several targets.

use super::{Failure, not_on_mesh::Given};

/// Refuses the first option that was given.
pub(crate) fn refuse(options: &[Given]) -> Result<(), Failure> {
    let Some((option, _, what)) = options.iter().find(|(_, given, _)| *given) else { return Ok(()) };
    Err(Failure::message(format!(
        "{option}: found this option, which {what}, and this scenario visits targets: leave the option out, or remove [mission] and give \
         terrain.goal_m"
    )))
}
