//! How a journey over a DEM may go.

use super::{Entries, ProblemKind, TerrainSource, read::find};
use crate::planner::Amount;

/// How a journey over a terrain may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Route {
    /// Along the vertical plane from start to goal.
    #[default]
    Transect,
    /// Any way over the DEM or the mesh, in any direction.
    Free,
}

impl Route {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Transect, Self::Free];

    /// The name in scenarios.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Transect => "transect",
            Self::Free => "free",
        }
    }
}

/// The route, with the problems of keys that a free one does not go with.
pub(super) fn route(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Route {
    let route = find(&Route::ALL, Route::name, entries.text("terrain", "route")).unwrap_or_default();
    if route == Route::Transect {
        return route;
    }
    let key = ("terrain", "route");
    if matches!(terrain, Some(TerrainSource::Chain { .. })) {
        let message =
            "terrain.route is \"free\", but terrain is a chain, expected a dem or a mesh, over which every direction is known";
        let help = "give dem = \"file.tif\" or mesh = \"file.obj\" with start_m and goal_m, or remove route";
        entries.problem(key, ProblemKind::Conflict, message.to_owned(), help);
    }
    let others = [
        ("terrain", "via_m", "a free route bends where it has to: remove it, or route"),
        ("terrain", "via_lonlat_deg", "a free route bends where it has to: remove it, or route"),
    ];
    for (table, name, help) in others {
        if entries.value(table, name).is_some() {
            entries.problem(
                (table, name),
                ProblemKind::Conflict,
                format!("{table}.{name} has no meaning beside terrain.route = \"free\""),
                help,
            );
        }
    }
    if entries.value("search", "points_per_segment").is_some_and(toml::Value::is_integer) {
        let message = "search.points_per_segment is for the segments of a slice, and terrain.route is \"free\"".to_owned();
        let help = "give node_spacing_max_m, or \"auto\", or remove it";
        entries.problem(("search", "points_per_segment"), ProblemKind::Conflict, message, help);
    }
    if matches!(terrain, Some(TerrainSource::MeshInSpace { .. })) {
        refuse_beside_mesh(entries);
    }
    route
}

/// Refuses the keys that have no meaning for a free route over a mesh.
fn refuse_beside_mesh(entries: &mut Entries) {
    let refused = [
        ("surface", "keep_out", "is laid over a map"),
        ("surface", "keep_in", "is laid over a map"),
        ("surface", "friction_raster", "is laid over a map"),
        ("hopper", "footprint_m", "is fitted over a DEM or a profile"),
        ("hopper", "roughness_max_m", "is measured over a DEM or a profile"),
        ("contact", "restitution_normal", "is for bounces over a DEM or a profile"),
        ("contact", "restitution_tangential", "is for bounces over a DEM or a profile"),
        ("contact", "settle_speed_m_s", "is for bounces over a DEM or a profile"),
        ("terrain", "start_x_m", "is a distance along a chain"),
        ("terrain", "goal_x_m", "is a distance along a chain"),
        ("terrain", "accept_map_scale", "is about the projection of a DEM"),
        ("search", "node_spacing_max_m", "spaces the nodes of a DEM or a profile (contacts_max is that of a mesh)"),
        ("search", "split", "divides hops along one segment of a profile"),
        ("search", "risk", "weighs hops over a DEM or a profile"),
        ("search", "risk_extra_hops_max", "weighs hops over a DEM or a profile"),
        ("budget", "estimated_success_min", "is estimated over a DEM or a profile"),
    ];
    for (table, name, what) in refused {
        // What a document of the scenario states by itself is no wish.
        let is_default = matches!(
            (table, name, entries.value(table, name)),
            ("search", "split", Some(value)) if value.as_str() == Some(crate::hop::Split::default().name())
        ) || matches!(
            (table, name, entries.value(table, name)),
            ("search", "risk", Some(value)) if value.as_str() == Some(crate::graph::ReliabilityUse::Ignored.name())
        );
        if entries.value(table, name).is_some() && !is_default {
            let message = format!("{table}.{name} {what}, and has no meaning for a free route over a mesh");
            entries.problem((table, name), ProblemKind::Conflict, message, "remove it, or route");
        }
    }
    if entries.objective("search", "objective").is_some_and(|objective| objective.amounts().contains(&Amount::Risk)) {
        let message = "search.objective has risk, which is estimated over a DEM or a profile, and not for a free route over a mesh"
            .to_owned();
        entries.problem(("search", "objective"), ProblemKind::Conflict, message, "remove risk from the objective");
    }
}
