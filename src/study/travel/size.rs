//! What a search for a mission takes, known before it is made.

use super::super::{Case, JourneyError};
use super::search::TravelSearch;
use crate::{
    ground::DemGround,
    planner::{Budgets, LabelCap, Mission, MissionQuestion, Objective, SurfaceNodes, TravelField},
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
    pub(super) nodes: u64,
    pairs_max: u64,
    elevations_bytes: u64,
    states_bytes: u64,
    /// How many maps are kept: one by each means, and one back to a start.
    fields: usize,
    fields_bytes: u64,
    /// What a search may hold to be faster.
    kept_bytes: u64,
    bytes_per_label: u64,
}

impl TravelMemory {
    /// Of a plan by an objective within budgets.
    pub(super) fn of(
        (ground, nodes): (&DemGround, &SurfaceNodes),
        keys: &DriveKeys,
        (objective, budgets): (&Objective, &Budgets),
    ) -> Self {
        let dem = ground.terrain().dem();
        let neighbours = keys.rover.limits().neighbours.count();
        let drives = if keys.travel.drives() { (nodes.count() * neighbours) as u64 } else { 0 };
        let hops = if keys.travel.hops() { nodes.pairs_max(ground) } else { 0 };
        Self {
            posts: (dem.rows() * dem.cols()) as u64,
            nodes: nodes.count() as u64,
            pairs_max: hops.max(drives),
            elevations_bytes: dem.elevations_bytes(),
            states_bytes: Mission::bytes(ground, nodes, &keys.rover, keys.travel),
            fields: 0,
            fields_bytes: 0,
            kept_bytes: Mission::kept_bytes(ground, nodes, &keys.rover, keys.travel).min(MissionQuestion::KEPT_BYTES),
            bytes_per_label: LabelCap::bytes_per_label(objective, budgets),
        }
    }

    /// Of so many maps, searched one after the other.
    pub(super) fn of_maps(
        over: (&DemGround, &SurfaceNodes),
        keys: &DriveKeys,
        (objective, budgets): (&Objective, &Budgets),
        fields: usize,
    ) -> Self {
        let objective = TravelField::objective(objective);
        let fields_bytes = (fields * over.1.count() * objective.amounts().len() * size_of::<f64>()) as u64;
        Self { fields, fields_bytes, ..Self::of(over, keys, (&objective, budgets)) }
    }

    /// The labels that a search may keep within so much memory, and the bytes that it may hold to be faster. A search that leaves out labels says so.
    ///
    /// # Errors
    /// The bytes needed at least, where the elevations, the states and the maps alone take more.
    pub(super) fn within(&self, allowed_bytes: Option<u64>) -> Result<(LabelCap, u64), u64> {
        let (cap, kept) = (LabelCap::default(), self.kept_bytes);
        let Some(allowed_bytes) = allowed_bytes else { return Ok((cap, kept)) };
        let needed_bytes = self.elevations_bytes + self.states_bytes + self.fields_bytes;
        let left_bytes = allowed_bytes.saturating_sub(needed_bytes);
        let kept_bytes = (left_bytes / KEPT_PART).min(kept);
        let labels = (left_bytes - kept_bytes) / self.bytes_per_label;
        if labels == 0 {
            return Err(needed_bytes + 2 * self.bytes_per_label);
        }
        Ok((LabelCap { in_all: usize::try_from(labels).unwrap_or(usize::MAX).min(cap.in_all), ..cap }, kept_bytes))
    }

    pub(super) fn answer(&self, cap: LabelCap, kept_bytes: u64) -> SizeAnswer {
        let part = |part: String, bytes_max| SizeRecord { part, bytes_max };
        let mut memory = vec![
            part("elevations".to_owned(), self.elevations_bytes),
            part("states of the search".to_owned(), self.states_bytes),
            part("tables of hops and drive legs, and pairs kept".to_owned(), kept_bytes),
            part(format!("labels of the search, {} at most", cap.in_all), self.bytes_per_label * cap.in_all as u64),
        ];
        if self.fields > 0 {
            memory.insert(2, part(format!("totals of all nodes, {} times", self.fields), self.fields_bytes));
        }
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
