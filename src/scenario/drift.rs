//! `uncertainty.heading`: a robot whose heading is not controlled.

use super::{Entries, Place, ProblemKind, TerrainSource};
use crate::{quantity::Angle, uncertainty::DriftCommand};

/// Whether the robot chooses the heading of its hops: the values of `uncertainty.heading`.
pub(super) const HEADINGS: [&str; 2] = ["controlled", UNCONTROLLED];

/// Hops in any direction, each as likely as any other.
const UNCONTROLLED: &str = "uncontrolled";

/// The keys of the command of a robot whose heading is not controlled.
const OF_COMMAND: [&str; 3] = ["takeoff_speed_m_s", "takeoff_angle_deg", "hop_limit"];

/// Whether the keys say that the heading is not controlled: such a robot has no goal.
pub(super) fn is_uncontrolled(entries: &Entries) -> bool {
    entries.text("uncertainty", "heading") == Some(UNCONTROLLED)
}

/// The command of every hop; `None` where the heading is controlled. Reports what is missing for it, and what does not go with it.
pub(super) fn drift(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Option<DriftCommand> {
    let [speed, angle, hops] = OF_COMMAND;
    if !is_uncontrolled(entries) {
        for key in [speed, angle] {
            if entries.value("uncertainty", key).is_some() {
                let message = format!("uncertainty.{key} is the command of a robot whose heading is not controlled");
                let help = "add heading = \"uncontrolled\", or remove it: a plan chooses its commands";
                entries.problem(("uncertainty", key), ProblemKind::Misplaced, message, help);
            }
        }
        return None;
    }
    if terrain.is_some_and(|source| !matches!(source, TerrainSource::Dem { .. })) {
        let message = "uncertainty.heading is \"uncontrolled\", but hops in any direction need a dem".to_owned();
        let help = "give terrain.dem with start_m, or remove it";
        entries.problem(("uncertainty", "heading"), ProblemKind::Conflict, message, help);
    }
    refuse_beside(entries);
    for (key, example) in [(speed, "1.0"), (angle, "45.0"), (hops, "5")] {
        if entries.value("uncertainty", key).is_none() && !entries.has_refused("uncertainty", &[key]) {
            let at = entries.place("uncertainty", "heading").unwrap_or(Place::Nowhere);
            let message = format!("uncertainty.heading is \"uncontrolled\", but there is no {key} for its hops");
            let help = format!("add {key} = {example}");
            entries.problem_at(at, ("uncertainty", key), ProblemKind::Missing, message, help);
        }
    }
    Some(DriftCommand {
        takeoff_speed_m_s: entries.number("uncertainty", speed)?,
        takeoff_angle: Angle::from_degrees(entries.number("uncertainty", angle)?),
        hops: entries.count("uncertainty", hops).and_then(|hops| u32::try_from(hops).ok())?,
    })
}

/// Refuses what has no meaning beside an uncontrolled heading.
fn refuse_beside(entries: &mut Entries) {
    const NO_GOAL: &str = "there is no goal: count the share of trials inside an area instead, or remove heading";
    const NO_HEADING: &str = "every heading is as likely as any other; remove it, or heading";
    const NO_PLAN: &str = "there is no plan to correct; remove it, or heading";
    let beside = [
        ("terrain", "goal_m", NO_GOAL),
        ("terrain", "goal_lonlat_deg", NO_GOAL),
        ("terrain", "via_m", NO_GOAL),
        ("terrain", "via_lonlat_deg", NO_GOAL),
        ("uncertainty", "goal_tolerance_m", NO_GOAL),
        ("mission", "targets_m", NO_GOAL),
        ("mission", "targets_lonlat_deg", NO_GOAL),
        ("uncertainty", "heading_sigma_deg", NO_HEADING),
        ("uncertainty", "heading_bias_sigma_deg", NO_HEADING),
        ("uncertainty", "policy", NO_PLAN),
        ("uncertainty", "position_sigma_m", NO_PLAN),
        ("budget", "estimated_success_min", NO_PLAN),
        ("robot", "file", "the trials are those of a point; remove it, or heading"),
        ("drive", "speed_m_s", "the robot hops; remove [drive], or heading"),
    ];
    for (table, name, help) in beside {
        if entries.value(table, name).is_some() {
            let message = format!("{table}.{name} has no meaning beside uncertainty.heading = \"uncontrolled\"");
            entries.problem((table, name), ProblemKind::Conflict, message, help);
        }
    }
}
