//! How a journey over a DEM may go.

use super::{Entries, ProblemKind, TerrainSource, read::find};

/// How a journey over a terrain may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Route {
    /// Along the vertical plane from start to goal.
    #[default]
    Transect,
    /// Any way over the DEM, in any direction.
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
    if matches!(terrain, Some(TerrainSource::Mesh { .. } | TerrainSource::Chain { .. })) {
        let message =
            "terrain.route is \"free\", but terrain is a mesh or a chain, expected a dem, over which every direction is known";
        entries.problem(
            key,
            ProblemKind::Conflict,
            message.to_owned(),
            "give dem = \"file.tif\" with start_m and goal_m, or remove route",
        );
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
    route
}
