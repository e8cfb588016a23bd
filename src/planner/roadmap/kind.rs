//! Which planner builds a roadmap over a mesh.

/// A planner of free routes over a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum RoadmapPlanner {
    /// All pairs of contacts by exact windows, grown about the best path: see [`grow_roadmap`](super::grow_roadmap).
    #[default]
    Exact,
    /// That of Campana and Laumond 2016, by sampled angles: see [`grow_one_by_one`](super::grow_one_by_one).
    Prm,
}

impl RoadmapPlanner {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Exact, Self::Prm];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Prm => "prm",
        }
    }
}

crate::quantity::by_name!(RoadmapPlanner, RoadmapPlanner::ALL);
