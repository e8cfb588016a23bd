//! The nodes of free routes in a question that varies a key: the same for every value, so that answers differ by the key alone.

use super::{
    Case, FreeRouteError, JourneyError,
    dem_ground::dem_ground,
    free_route::left_out,
    nodes::{coarse_nodes, nodes_per_post, planned_level_hop_m, post_spacing_m},
};
use crate::{
    graph::PointSpacing,
    planner::{NodesPerPost, SurfaceLattice},
    report::{QuestionRouteRecord, RouteKind},
    scenario::{Route, Scenario},
    terrain::Dem,
};

/// The most nodes of a lattice that is chosen by itself, where a question searches it for many values: some tens of searches of a million
/// nodes take minutes, and the shortest hops of a range of values often ask for many more.
const NODES_MOST: usize = 1 << 20;

/// The nodes of a question.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuestionNodes {
    pub(super) record: QuestionRouteRecord,
    /// How far a hop goes over level ground at most, at the value with the shortest hops, m.
    level_hop_m: f64,
}

impl QuestionNodes {
    /// The nodes for all these values of a key: those that the scenario gives, or else as many as the value with the shortest hops needs.
    ///
    /// # Returns
    /// `None` along a transect.
    ///
    /// # Errors
    /// Those of the raster.
    pub(super) fn resolved(case: &Case, scenarios: impl IntoIterator<Item = Scenario>) -> Result<Option<Self>, JourneyError> {
        if case.scenario.route == Route::Transect {
            return Ok(None);
        }
        let ground = dem_ground(case).map_err(Box::new)?.ok_or(FreeRouteError::NoDem)?;
        let dem = ground.terrain().dem();
        let spacing = case.scenario.search.spacing;
        let is_given = matches!(spacing, Some(PointSpacing::AtMostM(_)));
        let level_hop_m = scenarios.into_iter().map(|scenario| planned_level_hop_m(&scenario)).fold(f64::INFINITY, f64::min);
        let n = nodes_per_post(spacing, dem, level_hop_m);
        let lattice = if is_given { SurfaceLattice::new(dem, n) } else { at_most(dem, n) };
        let record = QuestionRouteRecord {
            kind: RouteKind::Free,
            nodes_per_post: lattice.nodes_per_post(),
            node_spacing_m: lattice.spacing_m(),
            shortest_level_hop_m: (!is_given).then_some(level_hop_m),
        };
        Ok(Some(Self { record, level_hop_m }))
    }

    /// What is to be known about the answer for a scenario of the question.
    pub(super) fn warnings(&self, scenario: &Scenario) -> Vec<String> {
        self.warnings_of(scenario, planned_level_hop_m(scenario), "the free route")
    }

    /// What is to be known about the answers for all values, of which this is one.
    pub(super) fn warnings_of_all(&self, scenario: &Scenario) -> Vec<String> {
        self.warnings_of(scenario, self.level_hop_m, "the free route (for the value with the shortest hops)")
    }

    fn warnings_of(&self, scenario: &Scenario, level_hop_m: f64, of: &str) -> Vec<String> {
        let mut warnings = left_out(scenario);
        warnings.extend(coarse_nodes(level_hop_m, of, self.record.node_spacing_m));
        warnings
    }

    /// A scenario of the question, over these nodes.
    pub(super) fn of(&self, mut scenario: Scenario) -> Scenario {
        if self.record.shortest_level_hop_m.is_some() {
            scenario.search.spacing = Some(PointSpacing::AtMostM(self.record.node_spacing_m));
        }
        scenario
    }
}

/// The lattice with at most so many nodes a post spacing, and at most [`NODES_MOST`] in all, down to the posts.
fn at_most(dem: &Dem, n: NodesPerPost) -> SurfaceLattice {
    let post_spacing_m = post_spacing_m(dem);
    let with = |n: u32| SurfaceLattice::new(dem, NodesPerPost::at_most_m(post_spacing_m / f64::from(n), post_spacing_m));
    let fits = (1..=n.get()).rev().map(with).find(|lattice| lattice.count() <= NODES_MOST);
    fits.unwrap_or_else(|| with(1))
}
