//! How a free route over a mesh is searched.

use std::time::Duration;

use nalgebra::Point3;

use super::{Entries, ProblemKind, TerrainSource};
use crate::planner::roadmap::{PROBE_STAND_OFF_M, RoadmapLimits, RoadmapPlanner, SpaceBounds};

/// The keys of a search over a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MeshSearch {
    /// Which planner builds its roadmap.
    pub planner: RoadmapPlanner,
    /// The most contacts of its roadmap, if the scenario gives it.
    pub contacts_max: Option<u32>,
    /// How far contacts stand off the surface, m, if the scenario gives it.
    pub stand_off_m: Option<f64>,
    /// The box of all contacts; `None`: the whole mesh.
    pub bounds: Option<SpaceBounds>,
    /// The seed of the contacts, if the scenario gives it.
    pub seed: Option<u64>,
    /// The longest time for its roadmap to grow, s; `None`: as long as it takes.
    pub time_max_s: Option<f64>,
}

impl MeshSearch {
    /// The most contacts where the scenario gives no number: seconds on scenes of some ten thousand facets.
    pub const CONTACTS: usize = 4000;

    /// When the roadmap stops growing.
    pub fn limits(&self) -> RoadmapLimits {
        RoadmapLimits {
            contacts_max: self.contacts_max.map_or(Self::CONTACTS, |most| most as usize),
            time_max: self.time_max_s.map(|time_s| Duration::try_from_secs_f64(time_s).unwrap_or(Duration::MAX)),
        }
    }

    /// How far contacts stand off the surface, m: as given, else what the planner takes.
    pub fn contacts_stand_off_m(&self) -> f64 {
        let of_planner = match self.planner {
            RoadmapPlanner::Exact => 0.0,
            RoadmapPlanner::Prm => PROBE_STAND_OFF_M,
        };
        self.stand_off_m.unwrap_or(of_planner)
    }
}

/// The keys, all of which only a free route over a mesh has, or of a robot with legs over a DEM.
pub(super) fn mesh_search(entries: &mut Entries, terrain: Option<&TerrainSource>) -> MeshSearch {
    if !matches!(terrain, Some(TerrainSource::MeshInSpace { .. })) {
        // Of a mesh whose ends are wrong, that is the problem; a scenario without terrain may be laid over one.
        if terrain.is_some() && !entries.ask_for_free_mesh() && !entries.ask_for_legs_on_dem() {
            for name in ["planner", "contacts_max", "stand_off_m", "bounds_m", "seed", "time_max_s"] {
                if entries.value("search", name).is_some() {
                    let message =
                        format!("search.{name} is for free routes over a mesh, and the terrain of this scenario is another one");
                    let help = "remove it, or give terrain.mesh = \"file.obj\", or robot.file, with route = \"free\"";
                    entries.problem(("search", name), ProblemKind::Misplaced, message, help);
                }
            }
        }
    }
    let corners = entries.corners("search", "bounds_m");
    MeshSearch {
        planner: super::mesh_planner::planner(entries),
        contacts_max: entries.count("search", "contacts_max").and_then(|most| u32::try_from(most).ok()),
        stand_off_m: entries.number("search", "stand_off_m"),
        bounds: corners.map(|[min, max]| SpaceBounds { min: Point3::from(min), max: Point3::from(max) }),
        seed: entries.count("search", "seed"),
        time_max_s: entries.number("search", "time_max_s"),
    }
}
