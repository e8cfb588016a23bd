//! `chta bodies`: the known bodies.

use std::fmt::Write;

use chta::{quantity::format_number, world::KNOWN_BODIES};

use crate::cli::{Answer, Failure, output};

/// Lists the known bodies.
pub(crate) fn run() -> Result<Answer, Failure> {
    let mut table = format!("{:<10} {:>13} {:>10}  source\n", "name", "gravity m/s^2", "radius m");
    for body in &KNOWN_BODIES {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{:<10} {:>13} {:>10}  {}", body.name, figures(body.gravity.m_s2()), body.radius_m, body.source);
    }
    output::to_stdout(table.as_bytes())?;
    Ok(Answer::Yes)
}

/// Gravity to four significant digits, finer than its variation over the surface of any of these bodies.
fn figures(gravity_m_s2: f64) -> String {
    let rounded = format!("{gravity_m_s2:.3e}").parse().unwrap_or(gravity_m_s2);
    format_number(rounded)
}
