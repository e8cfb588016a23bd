//! What a search for a mission takes, known before it is made.

use super::super::{Case, FreeRouteError, JourneyError, free_route::FreeSearch};
use super::search::TravelSearch;
use crate::{
    planner::{LabelCap, Mission, MissionQuestion},
    report::{SizeAnswer, SizeRecord},
    scenario::DriveKeys,
};

/// Of the memory that elevations and states leave, tables and what is kept of pairs may take one part of so many.
const KEPT_PART: u64 = 4;

/// Upper bounds on the posts, pairs and bytes of a search for a mission.
///
/// Not counted: the program itself, the file while it is read, slices, trials, and pictures.
#[derive(Clone, Copy, Debug)]
pub(super) struct TravelMemory {
    posts: u64,
    nodes: u64,
    pairs_max: u64,
    elevations_bytes: u64,
    states_bytes: u64,
    /// What a search may hold to be faster.
    kept_bytes: u64,
    bytes_per_label: u64,
}

impl TravelMemory {
    pub(super) fn of(free: &FreeSearch, keys: &DriveKeys) -> Self {
        let dem = free.ground.terrain().dem();
        let neighbours = keys.rover.limits().neighbours.count();
        let drives = if keys.travel.drives() { (free.nodes.count() * neighbours) as u64 } else { 0 };
        let hops = if keys.travel.hops() { free.nodes.pairs_max(&free.ground) } else { 0 };
        Self {
            posts: (dem.rows() * dem.cols()) as u64,
            nodes: free.nodes.count() as u64,
            pairs_max: hops.max(drives),
            elevations_bytes: dem.elevations_bytes(),
            states_bytes: Mission::bytes(&free.ground, &free.nodes, &keys.rover, keys.travel),
            kept_bytes: Mission::kept_bytes(&free.ground, &free.nodes, &keys.rover, keys.travel).min(MissionQuestion::KEPT_BYTES),
            bytes_per_label: LabelCap::bytes_per_label(&free.objective, &free.budgets),
        }
    }

    /// The labels that a search may keep within so much memory, and the bytes that it may hold to be faster. A search that leaves out labels says so.
    ///
    /// # Errors
    /// [`FreeRouteError::TooMuchMemory`], where the elevations and the states alone take more.
    pub(super) fn within(&self, allowed_bytes: Option<u64>) -> Result<(LabelCap, u64), FreeRouteError> {
        let (cap, kept) = (LabelCap::default(), self.kept_bytes);
        let Some(allowed_bytes) = allowed_bytes else { return Ok((cap, kept)) };
        let needed_bytes = self.elevations_bytes + self.states_bytes;
        let left_bytes = allowed_bytes.saturating_sub(needed_bytes);
        let kept_bytes = (left_bytes / KEPT_PART).min(kept);
        let labels = (left_bytes - kept_bytes) / self.bytes_per_label;
        if labels == 0 {
            let needed_bytes = needed_bytes + 2 * self.bytes_per_label;
            return Err(FreeRouteError::TooMuchMemory { needed_bytes, allowed_bytes, nodes: self.nodes });
        }
        Ok((LabelCap { in_all: usize::try_from(labels).unwrap_or(usize::MAX).min(cap.in_all), ..cap }, kept_bytes))
    }

    pub(super) fn answer(&self, cap: LabelCap, kept_bytes: u64) -> SizeAnswer {
        let part = |part: String, bytes_max| SizeRecord { part, bytes_max };
        let memory = vec![
            part("elevations".to_owned(), self.elevations_bytes),
            part("states of the search".to_owned(), self.states_bytes),
            part("tables of hops and drive legs, and pairs kept".to_owned(), kept_bytes),
            part(format!("labels of the search, {} at most", cap.in_all), self.bytes_per_label * cap.in_all as u64),
        ];
        SizeAnswer::new([self.posts, self.nodes, self.pairs_max], memory)
    }
}

/// What the search for the mission of a scenario with `[drive]` takes at most, without the search.
///
/// # Errors
/// [`JourneyError`], as of the search.
pub fn travel_size(case: &Case) -> Result<SizeAnswer, JourneyError> {
    Ok(TravelSearch::of(case)?.size())
}
