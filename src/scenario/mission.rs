//! `[mission]`: several targets to visit over a DEM.

use super::{Entries, Place, ProblemKind, Route, TerrainSource, read::find};
use crate::{
    planner::{TARGETS_MAX, VisitOrder},
    quantity::MapPoint,
    terrain::{LonLat, MapPlace},
};

/// What a mission visits.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionKeys {
    /// The targets as given, from 1 to [`TARGETS_MAX`], all different.
    pub targets: Vec<MapPlace>,
    /// In which order they are visited.
    pub order: VisitOrder,
    /// Whether the mission ends at its start.
    pub return_to_start: bool,
}

/// The targets in one of their two forms.
pub(super) fn targets(entries: &Entries) -> Vec<MapPlace> {
    let metres = entries.points("mission", "targets_m").into_iter().map(|[x, y]| MapPlace::Metres(MapPoint::new(x, y)));
    let degrees = entries.points("mission", "targets_lonlat_deg");
    metres.chain(degrees.into_iter().map(|[lon_deg, lat_deg]| MapPlace::LonLat(LonLat { lon_deg, lat_deg }))).collect()
}

/// The keys; `None` if the scenario has no `[mission]`. Reports what does not go with it.
pub(super) fn mission(entries: &mut Entries, terrain: Option<&TerrainSource>, route: Route, drives: bool) -> Option<MissionKeys> {
    if !entries.has_table("mission") {
        return None;
    }
    let key = ["targets_m", "targets_lonlat_deg"].into_iter().find(|name| entries.value("mission", name).is_some());
    let Some(key) = key else {
        if !entries.has_refused("mission", &["targets_m", "targets_lonlat_deg"]) {
            let at = ["order", "return_to_start"].into_iter().find_map(|name| entries.place("mission", name));
            let message = "[mission] has no targets".to_owned();
            let help = "add targets_m = [[x, y], ...], in map metres, or targets_lonlat_deg = [[longitude, latitude], ...]";
            entries.problem_at(at.unwrap_or(Place::Nowhere), ("mission", "targets_m"), ProblemKind::Missing, message, help);
        }
        return None;
    };
    let mut conflict = |(table, name): (&str, &str), message: String, help: &str| {
        entries.problem((table, name), ProblemKind::Conflict, message, help);
    };
    let found = match terrain {
        Some(TerrainSource::Dem { .. }) if route == Route::Free => None,
        Some(TerrainSource::Dem { .. }) => Some(("a transect", "add route = \"free\" to [terrain], or remove [mission]")),
        Some(_) => Some(("no dem", "remove [mission], or give terrain.dem with route = \"free\"")),
        None => None,
    };
    if let Some((found, help)) = found {
        let message = format!("[mission] is for free routes over a dem, and the terrain of this scenario is {found}");
        conflict(("mission", key), message, help);
    }
    if drives {
        let message = "[mission] visits its targets by hops alone, and this scenario drives".to_owned();
        conflict(("mission", key), message, "set drive.travel = \"hop\", or remove [drive] or [mission]");
    }
    refuse_beside(entries, key);
    let targets = targets(entries);
    if targets.is_empty() || targets.len() > TARGETS_MAX {
        let message = format!("mission.{key} has {} targets, expected 1 to {TARGETS_MAX}", targets.len());
        let help = "the best order is exact over all orders: divide longer lists into missions";
        entries.problem(("mission", key), ProblemKind::Value, message, help);
    }
    if let Some(number) = (1..targets.len()).find(|number| targets[..*number].contains(&targets[*number])) {
        let message = format!("mission.{key} has target {} twice, expected different places", number + 1);
        entries.problem(("mission", key), ProblemKind::Value, message, "remove one of them: a target is visited once");
    }
    let order = find(&VisitOrder::ALL, VisitOrder::name, entries.text("mission", "order")).unwrap_or_default();
    Some(MissionKeys { targets, order, return_to_start: entries.flag("mission", "return_to_start") })
}

/// Refuses what has no meaning beside targets.
fn refuse_beside(entries: &mut Entries, key: &str) {
    let beside = [
        ("mission", "targets_lonlat_deg", "gives the targets a second time", "remove one of the two"),
        (
            "terrain",
            "goal_m",
            "is where a journey ends, and a mission ends at its last target, or at its start",
            "add it to the targets, or remove it",
        ),
        (
            "terrain",
            "goal_lonlat_deg",
            "is where a journey ends, and a mission ends at its last target, or at its start",
            "add it to the targets, or remove it",
        ),
        (
            "budget",
            "estimated_success_min",
            "chooses among paths to one goal",
            "remove it: the trials of the whole mission show its success",
        ),
    ];
    for (table, name, what, help) in beside {
        if (table, name) != ("mission", key) && entries.value(table, name).is_some() {
            let message = format!("{table}.{name} {what}: it has no meaning beside mission.{key}");
            entries.problem((table, name), ProblemKind::Conflict, message, help);
        }
    }
}
