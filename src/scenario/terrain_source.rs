//! The source of the ground: a DEM, a mesh or a chain, with the ends of the journey over it.

use std::path::{Path, PathBuf};

use nalgebra::Point3;

use super::{Entries, Place, ProblemKind, Route};
use crate::{
    quantity::MapPoint,
    terrain::{LonLat, MapPlace},
};

/// Where the ground comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum TerrainSource {
    /// A slice of an elevation raster between two map points.
    Dem {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
        /// Where the slice begins.
        start: MapPlace,
        /// Where it ends.
        goal: MapPlace,
    },
    /// A slice of a triangulated surface between two map points.
    Mesh {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
        /// Metres per unit of the file.
        scale: f64,
        /// Where the slice begins.
        start: MapPoint,
        /// Where it ends.
        goal: MapPoint,
    },
    /// A triangulated surface with two points near it, for a route in any direction.
    MeshInSpace {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
        /// Metres per unit of the file.
        scale: f64,
        /// Where the route begins, before it is moved to the surface, m.
        start_m: Point3<f64>,
        /// Where it ends, before it is moved to the surface, m.
        goal_m: Point3<f64>,
    },
    /// A chain CSV.
    Chain {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
    },
}

impl TerrainSource {
    /// The file's path, relative to the scenario's folder.
    pub fn path(&self) -> &Path {
        match self {
            Self::Dem { path, .. } | Self::Mesh { path, .. } | Self::MeshInSpace { path, .. } | Self::Chain { path } => path,
        }
    }

    /// The ends of the slice on the map; `None` for a chain, and for a mesh without a slice.
    pub fn map_ends(&self) -> Option<[MapPlace; 2]> {
        match self {
            Self::Dem { start, goal, .. } => Some([*start, *goal]),
            Self::Mesh { start, goal, .. } => Some([*start, *goal].map(MapPlace::Metres)),
            Self::MeshInSpace { .. } | Self::Chain { .. } => None,
        }
    }
}

/// The source of the ground: at most one file.
pub(super) fn terrain(entries: &mut Entries) -> Option<TerrainSource> {
    let kinds = ["dem", "mesh", "chain"];
    let given: Vec<(&str, PathBuf)> =
        kinds.iter().filter_map(|&kind| Some((kind, PathBuf::from(entries.text("terrain", kind)?)))).collect();
    let scale = entries.number("terrain", "mesh_scale");
    if scale.is_some() && !given.iter().any(|(kind, _)| *kind == "mesh") {
        let (message, help) = ("terrain.mesh_scale without a mesh".to_owned(), "add mesh = \"file.obj\", or remove it");
        entries.problem(("terrain", "mesh_scale"), ProblemKind::Misplaced, message, help);
    }
    match given.as_slice() {
        [] => {
            // A file with an invalid value, or an unknown key that may be a misspelling of it, is already reported.
            if entries.has_unknown("terrain") || entries.has_refused("terrain", &kinds) {
                return None;
            }
            let on_map = ["start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg"]
                .into_iter()
                .find_map(|name| Some((name, entries.place("terrain", name)?)));
            let along = ["start_x_m", "goal_x_m"].into_iter().find_map(|name| Some((name, entries.place("terrain", name)?)));
            if let Some((name, place)) = on_map {
                let (message, help) = (format!("terrain.{name} without a dem"), "add dem = \"file.tif\", or mesh = \"file.obj\"");
                entries.problem_at(place, ("terrain", "dem"), ProblemKind::Missing, message, help);
            } else if let Some((name, place @ Place::File(_))) = along {
                let (message, help) = (format!("terrain.{name} without a chain"), "add chain = \"file.csv\"");
                entries.problem_at(place, ("terrain", "chain"), ProblemKind::Missing, message, help);
            }
            None
        }
        [("chain", path)] => {
            refuse_map_points(entries);
            Some(TerrainSource::Chain { path: path.clone() })
        }
        [("mesh", path)] if entries.text("terrain", "route") == Some(Route::Free.name()) => {
            let [start_m, goal_m] = ends_in_space(entries)?.map(Point3::from);
            Some(TerrainSource::MeshInSpace { path: path.clone(), scale: scale.unwrap_or(1.0), start_m, goal_m })
        }
        [(kind, path)] => {
            for end in ["start_m", "goal_m"] {
                if entries.triple("terrain", end).is_some() {
                    let message =
                        format!("terrain.{end} has three numbers, expected two, [x, y], where terrain has a {kind} that is sliced");
                    let help =
                        "leave z out, or for a route over a mesh in any direction give mesh = \"file.obj\" with route = \"free\"";
                    entries.problem(("terrain", end), ProblemKind::Value, message, help);
                }
            }
            let [start, goal] = map_ends(entries, kind)?;
            let path = path.clone();
            Some(match *kind {
                "mesh" => {
                    let [start, goal] = on_mesh(entries, [start, goal])?;
                    TerrainSource::Mesh { path, scale: scale.unwrap_or(1.0), start, goal }
                }
                _ => TerrainSource::Dem { path, start, goal },
            })
        }
        [(first, _), .., (last, _)] => {
            let (message, help) = if given.len() == 2 {
                (format!("terrain has both {first} and {last}, expected one of the two"), "remove one of them")
            } else {
                ("terrain has all of dem, mesh and chain, expected one of the three".to_owned(), "remove two of them")
            };
            entries.problem(("terrain", last), ProblemKind::Conflict, message, help);
            None
        }
    }
}

/// Start and goal near a mesh, which a free route over it needs.
fn ends_in_space(entries: &mut Entries) -> Option<[[f64; 3]; 2]> {
    let mut of_end = |end: &str| {
        let (key, degrees) = (format!("{end}_m"), format!("{end}_lonlat_deg"));
        let help = format!(
            "give {key} = [x, y, z], in the mesh's own metres: the route begins and ends at the nearest points of its surface"
        );
        if entries.value("terrain", &degrees).is_some() {
            let message = "terrain gives longitude and latitude for a mesh, which has no projection".to_owned();
            entries.problem(("terrain", &degrees), ProblemKind::Conflict, message, help);
            return None;
        }
        let found = entries.triple("terrain", &key);
        if found.is_none() && entries.value("terrain", &key).is_some() {
            let message = format!("terrain.{key} has two numbers, expected three, [x, y, z], for a free route over a mesh");
            entries.problem(("terrain", &key), ProblemKind::Value, message, help);
        } else if found.is_none() && !entries.has_refused("terrain", &[&key]) {
            let at = entries.place("terrain", "mesh").unwrap_or(Place::Nowhere);
            let message = format!("terrain has a mesh and route = \"free\" but no {key}");
            entries.problem_at(at, ("terrain", &key), ProblemKind::Missing, message, help);
        }
        found
    };
    let (start, goal) = (of_end("start"), of_end("goal"));
    Some([start?, goal?])
}

/// Start and goal on the map, which a slice needs.
fn map_ends(entries: &mut Entries, kind: &str) -> Option<[MapPlace; 2]> {
    // If both are missing, one sentence is enough.
    let start = map_place(entries, "start", kind)?;
    let has_goal = ["goal_m", "goal_lonlat_deg"].into_iter().any(|name| entries.value("terrain", name).is_some());
    // A robot that cannot steer has no goal.
    if super::drift::is_uncontrolled(entries) && !has_goal {
        return Some([start, start]);
    }
    // A mission over targets has no goal: its first target stands for it.
    if let Some(target) = super::mission::targets(entries).first().filter(|_| !has_goal) {
        return Some([start, *target]);
    }
    Some([start, map_place(entries, "goal", kind)?])
}

/// The intermediate points, given in one of two forms.
pub(super) fn via(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Vec<MapPlace> {
    let metres = entries.points("terrain", "via_m").into_iter().map(|[x, y]| MapPlace::Metres(MapPoint::new(x, y)));
    let degrees = entries.points("terrain", "via_lonlat_deg");
    let degrees = degrees.into_iter().map(|[lon_deg, lat_deg]| MapPlace::LonLat(LonLat { lon_deg, lat_deg }));
    let (metres, degrees): (Vec<_>, Vec<_>) = (metres.collect(), degrees.collect());
    let key = ("terrain", "via_lonlat_deg");
    if !metres.is_empty() && !degrees.is_empty() {
        let message = "terrain has both via_m and via_lonlat_deg, expected one of the two".to_owned();
        entries.problem(key, ProblemKind::Conflict, message, "remove one of them");
    } else if !degrees.is_empty() && matches!(terrain, Some(TerrainSource::Mesh { .. })) {
        let message = "terrain gives longitude and latitude for a mesh, which has no projection".to_owned();
        entries.problem(key, ProblemKind::Conflict, message, "give via_m = [[x, y], ...], in the mesh's own metres");
    }
    if metres.is_empty() { degrees } else { metres }
}

/// The ends of a slice of a mesh, which has no projection.
fn on_mesh(entries: &mut Entries, ends: [MapPlace; 2]) -> Option<[MapPoint; 2]> {
    if let [MapPlace::Metres(start), MapPlace::Metres(goal)] = ends {
        return Some([start, goal]);
    }
    let given = ["start_lonlat_deg", "goal_lonlat_deg"].into_iter().find(|name| entries.value("terrain", name).is_some());
    let message = "terrain gives longitude and latitude for a mesh, which has no projection".to_owned();
    let help = "give start_m and goal_m = [x, y], in the mesh's own metres";
    entries.problem(("terrain", given.unwrap_or_default()), ProblemKind::Conflict, message, help);
    None
}

/// Map points beside a chain.
fn refuse_map_points(entries: &mut Entries) {
    for name in ["start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg"] {
        if entries.value("terrain", name).is_some() {
            let help = format!("for a chain give {}_x_m instead", name.split('_').next().unwrap_or(name));
            let message =
                format!("terrain.{name} is a map position, but terrain is a chain, whose positions are distances along it");
            entries.problem(("terrain", name), ProblemKind::Misplaced, message, help);
        }
    }
    for name in ["via_m", "via_lonlat_deg"] {
        if entries.value("terrain", name).is_some() {
            let message = format!("terrain.{name} adds a bend to a DEM or mesh slice, but terrain is a chain");
            entries.problem(("terrain", name), ProblemKind::Misplaced, message, "give the chain a column bend instead");
        }
    }
}

/// The start or goal of a transect: map coordinates, or longitude and latitude.
fn map_place(entries: &mut Entries, end: &str, kind: &str) -> Option<MapPlace> {
    let (metres, degrees) = (format!("{end}_m"), format!("{end}_lonlat_deg"));
    let point = entries.pair("terrain", &metres).map(|[x, y]| MapPoint::new(x, y));
    let place = entries.pair("terrain", &degrees).map(|[lon_deg, lat_deg]| LonLat { lon_deg, lat_deg });
    match (point, place) {
        (Some(point), None) => Some(MapPlace::Metres(point)),
        (None, Some(place)) => Some(MapPlace::LonLat(place)),
        (Some(_), Some(_)) => {
            let message = format!("terrain has both {metres} and {degrees}, expected one of the two");
            entries.problem(("terrain", &degrees), ProblemKind::Conflict, message, "remove one of them");
            None
        }
        (None, None) => {
            if !entries.has_refused("terrain", &[&metres, &degrees]) {
                let at = entries.place("terrain", kind).unwrap_or(Place::Nowhere);
                let instead = if kind == "dem" { format!(", or {degrees} = [longitude, latitude]") } else { String::new() };
                let help = format!("add {metres} = [x, y], in map metres{instead}");
                let message = format!("terrain has a {kind} but no {metres}");
                entries.problem_at(at, ("terrain", &metres), ProblemKind::Missing, message, help);
            }
            None
        }
    }
}
