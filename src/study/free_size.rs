//! What a search for a free route takes, known before it is made.

use super::{Case, FreeRouteError, JourneyError, free_route::FreeSearch, free_route::free_alone};
use crate::{
    ground::DemGround,
    planner::{Budgets, FreeRoute, LabelCap, Objective, SurfaceNodes},
    report::{SizeAnswer, SizeRecord},
};

/// Upper bounds on the posts, pairs and bytes of a search for a free route.
///
/// Not counted: the program itself, the file while it is read, slices, and pictures.
pub(super) struct RouteSize {
    posts: u64,
    nodes: u64,
    pairs_max: u64,
    elevations_bytes: u64,
    nodes_bytes: u64,
    bytes_per_label: u64,
}

impl RouteSize {
    pub(super) fn of(ground: &DemGround, nodes: &SurfaceNodes, objective: &Objective, budgets: &Budgets) -> Self {
        let dem = ground.terrain().dem();
        Self {
            posts: (dem.rows() * dem.cols()) as u64,
            nodes: nodes.count() as u64,
            pairs_max: nodes.pairs_max(ground),
            elevations_bytes: dem.elevations_bytes(),
            nodes_bytes: FreeRoute::bytes_max(ground, nodes),
            bytes_per_label: LabelCap::bytes_per_label(objective, budgets),
        }
    }

    /// The labels that a search may keep within so much memory. A search that leaves out others says so.
    ///
    /// # Errors
    /// [`FreeRouteError::TooMuchMemory`], where the nodes alone take more.
    pub(super) fn cap(&self, allowed_bytes: Option<u64>) -> Result<LabelCap, FreeRouteError> {
        let cap = LabelCap::default();
        let Some(allowed_bytes) = allowed_bytes else { return Ok(cap) };
        let needed_bytes = self.elevations_bytes + self.nodes_bytes;
        let labels = allowed_bytes.saturating_sub(needed_bytes) / self.bytes_per_label;
        if labels == 0 {
            let nodes = self.nodes;
            return Err(FreeRouteError::TooMuchMemory { needed_bytes: needed_bytes + self.bytes_per_label, allowed_bytes, nodes });
        }
        Ok(LabelCap { in_all: usize::try_from(labels).unwrap_or(usize::MAX).min(cap.in_all), ..cap })
    }

    fn answer(&self, cap: LabelCap) -> SizeAnswer {
        let part = |part: String, bytes_max| SizeRecord { part, bytes_max };
        let memory = vec![
            part("elevations".to_owned(), self.elevations_bytes),
            part("nodes and levels of the search".to_owned(), self.nodes_bytes),
            part(format!("labels of the search, {} at most", cap.in_all), self.bytes_per_label * cap.in_all as u64),
        ];
        SizeAnswer::new([self.posts, self.nodes, self.pairs_max], memory)
    }
}

/// What the search for a free route takes at most, without the search.
///
/// # Errors
/// [`JourneyError`], as of the search; for a transect, whose nodes take little.
pub fn route_size(case: &Case) -> Result<SizeAnswer, JourneyError> {
    free_alone(&case.scenario, "the size of a search is stated")?;
    let search = FreeSearch::of(case)?;
    Ok(search.size().answer(search.cap))
}
