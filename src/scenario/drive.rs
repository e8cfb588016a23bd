//! `[drive]`: wheels beside hops, of free routes and maps over a DEM.

use super::{Entries, ProblemKind, Route, TerrainSource};
use crate::{
    planner::Travel,
    quantity::Angle,
    world::{HopperLimits, InvalidRover, Neighbours, Rover, RoverLimits, RoverProblem},
};

/// How a machine that drives travels.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveKeys {
    /// Its wheels.
    pub rover: Rover,
    /// Whether it drives, hops or does both.
    pub travel: Travel,
}

/// The keys; `None` if the scenario has no `[drive]`.
pub(super) fn drive(
    entries: &mut Entries,
    terrain: Option<&TerrainSource>,
    route: Route,
    hopper: &HopperLimits,
) -> Option<DriveKeys> {
    if !entries.has_table("drive") {
        return None;
    }
    misplaced(entries, terrain, route);
    let number = |name| entries.number("drive", name);
    let angle = |name| match entries.value("drive", name) {
        // The catalogue's kind has other texts and numbers refused.
        Some(value) if value.as_str().is_some() => Some(Angle::from_degrees(90.0)),
        Some(_) => number(name).map(|degrees| Angle::from_degrees(degrees.min(90.0))),
        None => None,
    };
    let (Some(speed_m_s), Some(slope_up_max)) = (number("speed_m_s"), angle("slope_up_max_deg")) else {
        missing(entries);
        return None;
    };
    let stated = |name, absent| number(name).unwrap_or(absent);
    let neighbours = entries.count("drive", "neighbours");
    let limits = RoverLimits {
        slope_down_max: angle("slope_down_max_deg"),
        cross_slope_max: angle("cross_slope_max_deg"),
        step_max_m: number("step_max_m"),
        roughness_max_m: number("roughness_max_m"),
        wheelbase_m: number("wheelbase_m"),
        turn_s_per_deg: stated("turn_s_per_deg", 0.0),
        neighbours: neighbours.and_then(Neighbours::of_count).unwrap_or_default(),
        rolling_resistance: stated("rolling_resistance", 0.0),
        efficiency: stated("drive_efficiency", 1.0),
        idle_power_w: stated("idle_power_w", 0.0),
        slip: entries.slip("drive", "slip").unwrap_or_default(),
        failure_per_m: stated("failure_per_m", 0.0),
        heading_sigma: Angle::from_degrees(stated("heading_sigma_deg", 0.0)),
        length_sigma_fraction: stated("length_sigma_fraction", 0.0),
        ..RoverLimits::new(speed_m_s, slope_up_max)
    };
    let travel = super::read::find(&Travel::ALL, Travel::name, entries.text("drive", "travel")).unwrap_or_default();
    if neighbours.is_some_and(|count| Neighbours::of_count(count).is_none()) {
        let message = format!("drive.neighbours is {}, expected 8, 16 or 32", neighbours.unwrap_or(0));
        let help = "give one of these: more neighbours find shorter ways and take more time";
        entries.problem(("drive", "neighbours"), ProblemKind::Value, message, help);
    }
    match Rover::new(limits, hopper.mass_kg) {
        Ok(rover) => Some(DriveKeys { rover, travel }),
        Err(InvalidRover(problems)) => {
            for problem in problems {
                refuse(entries, &problem);
            }
            None
        }
    }
}

/// A limit that does not hold.
fn refuse(entries: &mut Entries, problem: &RoverProblem) {
    let help = match problem.key {
        "wheelbase_m" => "add wheelbase_m, or remove step_max_m and roughness_max_m",
        "idle_power_w" => "add hopper.mass_kg, or remove idle_power_w",
        _ => "give a value in that range",
    };
    let given = ["step_max_m", "roughness_max_m"].into_iter().find(|key| entries.value("drive", key).is_some());
    let place = entries.place("drive", problem.key).or_else(|| entries.place("drive", given?)).unwrap_or(super::Place::Nowhere);
    entries.problem_at(place, ("drive", problem.key), ProblemKind::Conflict, problem.to_string(), help);
}

/// Reports the keys without which nothing drives.
fn missing(entries: &mut Entries) {
    for (key, example) in [("speed_m_s", "0.1"), ("slope_up_max_deg", "20.0")] {
        // A value of the wrong kind has been reported already.
        if entries.value("drive", key).is_none() && !entries.has_refused("drive", &[key]) {
            let message = format!("[drive] is given without drive.{key}, without which nothing is known of its driving");
            let help = format!("add {key} = {example}, or remove [drive]");
            entries.problem(("drive", key), ProblemKind::Missing, message, help);
        }
    }
}

/// Reports wheels where nothing drives.
fn misplaced(entries: &mut Entries, terrain: Option<&TerrainSource>, route: Route) {
    let place = ["travel", "speed_m_s", "slope_up_max_deg"].into_iter().find_map(|key| entries.place("drive", key));
    let (found, help) = match terrain {
        None => return,
        Some(TerrainSource::Dem { .. }) if route == Route::Free => return,
        Some(TerrainSource::Dem { .. }) => ("a transect", "add route = \"free\" to [terrain], or remove [drive]"),
        Some(_) => ("no dem", "remove [drive], or give terrain.dem with route = \"free\""),
    };
    let message = format!("[drive] is for free routes over a dem, and the terrain of this scenario is {found}");
    entries.problem_at(place.unwrap_or(super::Place::Nowhere), ("drive", "speed_m_s"), ProblemKind::Misplaced, message, help);
}
