//! The planner of a free route over a mesh, and the keys that go with the exact one alone.

use super::{CATALOGUE, Entries, ProblemKind, read::find};
use crate::{
    planner::{
        Amount, Objective,
        roadmap::{PROBE_RADIUS_M, RoadmapPlanner},
    },
    quantity::format_number,
};

/// What makes a path shortest for Campana and Laumond.
pub(super) fn objective_of_prm() -> Objective {
    Objective::of(Amount::ArcLength)
}

/// The planner, with the problems of keys that do not go with it.
pub(super) fn planner(entries: &mut Entries) -> RoadmapPlanner {
    let planner = find(&RoadmapPlanner::ALL, RoadmapPlanner::name, entries.text("search", "planner")).unwrap_or_default();
    if planner == RoadmapPlanner::Prm {
        refuse_beside_prm(entries);
    }
    planner
}

/// Refuses the keys that the method of Campana and Laumond does not obey.
fn refuse_beside_prm(entries: &mut Entries) {
    const BUDGET: &str = "limits the search, and the planner stops at the first path";
    const SPEEDS: &str = "leaves several intervals of take-off angles, and the planner samples one";
    let always = [
        ("search", "effort", "breaks ties of hops, and the planner finds the shortest arcs"),
        ("search", "takeoff_angle", "chooses the angle, and the planner flies the first of seven that is free"),
        ("hopper", "takeoff_speed_min_m_s", SPEEDS),
        ("hopper", "takeoff_speed_levels_m_s", SPEEDS),
    ];
    let budgets = CATALOGUE.iter().filter(|key| key.table == "budget").map(|key| (key.table, key.name, BUDGET));
    let above_zero = [
        ("hopper", "radius_m", "is the ball that flies, and the planner checks its arcs by a ball of its own"),
        ("hopper", "clearance_m", "is kept by exact windows, and the planner checks its arcs by a ball"),
    ];
    let given = always.into_iter().chain(budgets).filter(|(table, name, _)| entries.value(table, name).is_some());
    let large = above_zero.into_iter().filter(|(table, name, _)| entries.number(table, name).is_some_and(|number| number > 0.0));
    let refused: Vec<_> = given.chain(large).collect();
    for (table, name, what) in refused {
        let message = format!("{table}.{name} {what}: it has no meaning beside search.planner = \"prm\"");
        entries.problem((table, name), ProblemKind::Conflict, message, "remove it, or use planner = \"exact\"");
    }
    if entries.objective("search", "objective").is_some_and(|objective| objective != objective_of_prm()) {
        let message =
            "search.objective is another than [\"arc-length\"], and search.planner = \"prm\" finds the shortest arcs".to_owned();
        let help = "give objective = [\"arc-length\"] or remove it, or use planner = \"exact\"";
        entries.problem(("search", "objective"), ProblemKind::Conflict, message, help);
    }
    if let Some(stand_off_m) = entries.number("search", "stand_off_m").filter(|stand_off_m| *stand_off_m <= PROBE_RADIUS_M) {
        let message = format!(
            "search.stand_off_m is {} m, expected more than {PROBE_RADIUS_M} m, the radius of the ball with which search.planner = \"prm\" checks \
             its arcs: it would touch the mesh at every contact",
            format_number(stand_off_m)
        );
        entries.problem(
            ("search", "stand_off_m"),
            ProblemKind::Conflict,
            message,
            "give more or remove it, or use planner = \"exact\"",
        );
    }
}
