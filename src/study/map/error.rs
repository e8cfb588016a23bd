//! Why a question about a map has no answer.

use super::super::{CaseError, Defect, JourneyEnd, PipelineError};
use crate::{
    planner::{Amount, Objective, RouteError, TooManyNodes, TotalBudget},
    quantity::MapPoint,
    reach::map::MapError,
    terrain::{MapBounds, TerrainError},
    uncertainty::SimulationError,
};

/// Why a question about a map has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapStudyError {
    /// The terrain, or its body.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The terrain, its overlays or its map.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A scenario that does not drive, where it should.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The search for missions.
    #[error(transparent)]
    Mission(#[from] RouteError),
    /// No start.
    #[error("found no start, expected at least one: give terrain.start_m, or the longitude and latitude terrain.start_lonlat_deg")]
    NoStart,
    /// Trials without a target.
    #[error(
        "found trials of landing sites and no target, expected at least one: trials fly the path from a site to a target; give a target, or a \
         scenario with a goal or targets, or ask for no trials"
    )]
    NoTargetOfTrials,
    /// A start or goal off the map.
    #[error("{name} ({:.3}, {:.3}) m lies off the map, which covers {bounds}; choose a position there", at.x, at.y)]
    OffMap {
        /// What the caller calls it.
        name: String,
        /// Where it lies.
        at: MapPoint,
        /// What the map covers.
        bounds: MapBounds,
    },
    /// A start or goal whose nearest post has no elevation.
    #[error(
        "{name}: the nearest post, ({:.3}, {:.3}) m, has no elevation; choose a {} where the DEM has data",
        post.x, post.y, end.name()
    )]
    NoElevation {
        /// What the caller calls it.
        name: String,
        /// Start or goal.
        end: JourneyEnd,
        /// The nearest post.
        post: MapPoint,
    },
    /// A stride that merges two positions, which would give one answer for both.
    #[error(
        "with a stride of {stride}, ({:.3}, {:.3}) m and ({:.3}, {:.3}) m have the same nearest post, ({:.3}, {:.3}) m: take a smaller \
         stride", asked[0].x, asked[0].y, asked[1].x, asked[1].y, post.x, post.y
    )]
    SamePost {
        /// The stride.
        stride: usize,
        /// The two positions.
        asked: [MapPoint; 2],
        /// Their nearest post.
        post: MapPoint,
    },
    /// More memory than allowed.
    #[error(
        "the map needs up to {} MiB ({posts} posts of the DEM, {nodes} {} of the map), expected at most {} MiB: take {}, \
         a part of the DEM (gdal_translate -projwin) or a coarser one (gdalwarp -tr), ask for fewer maps at once, or allow more",
        needed_bytes.div_ceil(1 << 20), if nodes > posts { "nodes" } else { "posts" }, allowed_bytes >> 20,
        if nodes > posts { "a larger spacing of nodes" } else { "a greater stride" }
    )]
    TooMuchMemory {
        /// The bytes needed at most.
        needed_bytes: u64,
        /// The bytes allowed.
        allowed_bytes: u64,
        /// Posts of the DEM.
        posts: usize,
        /// Nodes of the map.
        nodes: usize,
    },
    /// Maps of missions that take more memory than allowed.
    #[error(
        "the maps of missions need at least {} MiB ({nodes} nodes), expected at most {} MiB: take a part of the DEM (gdal_translate -projwin) or a \
         coarser one (gdalwarp -tr), or allow more", needed_bytes.div_ceil(1 << 20), allowed_bytes >> 20
    )]
    MissionsTooLarge {
        /// The bytes needed at least.
        needed_bytes: u64,
        /// The bytes allowed.
        allowed_bytes: u64,
        /// Nodes of the maps.
        nodes: u64,
    },
    /// More nodes than can be numbered.
    #[error(transparent)]
    Nodes(#[from] TooManyNodes),
    /// A budget of another amount than the one that the map has least.
    #[error(
        "{} = {} limits the {}, but this map has the least {} first, and keeps a budget of that amount alone: put {} first in search.objective, \
         or leave the budget out; a path from a start to one goal keeps any", budget.key, budget.most, budget.amount.words(),
        first.words(), budget.amount
    )]
    OtherBudget {
        /// The budget.
        budget: TotalBudget,
        /// What the map has least.
        first: Amount,
    },
    /// A least effort among fewest hops beside an objective.
    #[error(
        "found an effort beside search.objective = {objective}, expected one of the two: an effort is the least among paths of fewest hops"
    )]
    EffortBesideObjective {
        /// The objective.
        objective: Objective,
    },
    /// Totals of risk, which no map counts.
    #[error("found the totals of {amount} along the paths of a map, expected an amount of a hop by itself: any other")]
    NoRisk {
        /// The amount.
        amount: Amount,
    },
    /// The search.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The trials.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A path that breaks a limit when it is flown again.
    #[error(transparent)]
    Defect(#[from] Defect),
}
