//! `[contact]`: how the hopper bounces after a first contact.

use super::{Entries, ProblemKind};
use crate::world::Restitution;

const KEYS: [&str; 2] = ["restitution_normal", "restitution_tangential"];

/// The restitution; `None` if the scenario has no `[contact]`.
pub(super) fn restitution(entries: &mut Entries) -> Option<Restitution> {
    if !entries.has_table("contact") {
        return None;
    }
    let [normal, tangential] = KEYS.map(|key| entries.number("contact", key));
    if let (Some(normal), Some(tangential)) = (normal, tangential) {
        // The catalogue's ranges are those of a restitution.
        return Restitution::new(normal, tangential, entries.number("contact", "settle_speed_m_s")).ok();
    }
    for missing in KEYS {
        // A value of the wrong kind has been reported already.
        if entries.value("contact", missing).is_none() && !entries.has_refused("contact", &[missing]) {
            let given = ["restitution_normal", "restitution_tangential", "settle_speed_m_s"];
            let given = given.into_iter().find(|key| entries.value("contact", key).is_some()).unwrap_or(missing);
            let place = entries.place("contact", given).unwrap_or(super::Place::Nowhere);
            let message = format!("contact.{given} is given without contact.{missing}, expected both coefficients of restitution");
            let help = format!("add {missing}, a number from 0 to 0.99, or remove [contact]: the hopper then stays where it lands");
            entries.problem_at(place, ("contact", missing), ProblemKind::Missing, message, help);
        }
    }
    None
}
