//! The keys of a scenario about landings, propellant, times and energies of a hop.

use super::{Entries, ProblemKind};
use crate::world::LandingMode;

/// How the hopper lands: the mode, and the touchdown speed that belongs to it.
pub(super) fn landing(entries: &mut Entries) -> LandingMode {
    let braked = entries.text("hopper", "landing") == Some(LandingMode::NAMES[1]);
    let touchdown = entries.number("hopper", "touchdown_speed_m_s");
    match (braked, touchdown) {
        (false, None) => LandingMode::Ballistic,
        (true, Some(touchdown_speed_m_s)) => LandingMode::Braked { touchdown_speed_m_s },
        (true, None) => {
            // A value of the wrong kind has been reported already.
            if !entries.has_refused("hopper", &["touchdown_speed_m_s"]) {
                let message =
                    "hopper.landing is \"braked\" without hopper.touchdown_speed_m_s, the speed to which it brakes".to_owned();
                let help = "add touchdown_speed_m_s, or say landing = \"ballistic\"";
                entries.problem(("hopper", "landing"), ProblemKind::Missing, message, help);
            }
            LandingMode::Ballistic
        }
        // An unknown mode has been reported already.
        (false, Some(_)) if entries.has_refused("hopper", &["landing"]) => LandingMode::Ballistic,
        (false, Some(speed)) => {
            let message = format!(
                "hopper.touchdown_speed_m_s is {speed}, but the landing is ballistic: its speed is that of the arc, which \
                 landing_speed_max_m_s limits"
            );
            let help = "add landing = \"braked\", or remove touchdown_speed_m_s";
            entries.problem(("hopper", "touchdown_speed_m_s"), ProblemKind::Conflict, message, help);
            LandingMode::Ballistic
        }
    }
}

/// How to mend what two keys mean together; `None` for other keys.
pub(super) fn help(key: &str) -> Option<&'static str> {
    Some(match key {
        "touchdown_speed_m_s" => "touch down more slowly, or raise landing_speed_max_m_s",
        "isp_s" => "add mass_kg, the mass at the start, or remove isp_s",
        "propellant_max_kg" => "give isp_s and a mass_kg above it, or remove propellant_max_kg",
        "takeoff_speed_step_m_s" => "give a step of at most the greatest take-off speed, without levels beside it, or leave it out",
        "rest_time_s" => "move its value to settling_time_s",
        "preparation_energy_j" => "add mass_kg, or remove preparation_energy_j",
        _ => return None,
    })
}
