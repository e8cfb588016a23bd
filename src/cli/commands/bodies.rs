//! `chta bodies`: the known bodies.

use std::fmt::Write;

use chta::world::KNOWN_BODIES;

use crate::cli::{Answer, Failure, output};

/// Lists the known bodies.
pub(crate) fn run() -> Result<Answer, Failure> {
    let mut table = format!("{:<10} {:>14} {:>12}  source\n", "name", "gravity m/s^2", "radius m");
    for body in &KNOWN_BODIES {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{:<10} {:>14.6e} {:>12}  {}", body.name, body.gravity_m_s2, body.radius_m, body.source);
    }
    output::to_stdout(table.as_bytes())?;
    Ok(Answer::Yes)
}
