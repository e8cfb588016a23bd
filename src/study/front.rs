//! The front of hops against success: every path estimated by fixed trials, and the one to fly.

use std::sync::Arc;

use crate::{
    chain::Station,
    graph::{self, CostToGo, NodeSet, NodesError, Outcome, ReliablePath, SearchError, preferred_path},
    ground::{DemGround, Surface},
    hop::HopTest,
    path::{HopPath, PathError, generate},
    progress::Progress,
    scenario::Scenario,
    uncertainty::{Mission, Policy, Simulation, SimulationError},
};

/// Why the success of a path is not estimated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FrontError {
    /// The costs-to-go of its nodes.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// The nodes.
    #[error(transparent)]
    Nodes(#[from] NodesError),
    /// The trials.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// A journey whose paths are flown in trials.
#[derive(Clone, Copy, Debug)]
pub struct Journey<'a> {
    /// The scenario, with its errors.
    pub scenario: &'a Scenario,
    /// The hop test over its chain.
    pub test: &'a HopTest,
    /// Start and goal.
    pub ends: (Station, Station),
    /// The whole DEM, if the chain was sliced from one.
    pub ground: Option<&'a DemGround>,
}

impl Journey<'_> {
    /// The mission along a path; replanned by these costs, if there are any.
    pub fn mission(&self, path: &HopPath, to_go: Option<&Arc<CostToGo>>) -> Mission {
        let (start, goal) = self.ends;
        let mission = match self.ground {
            None => Mission::along_chain(self.test.clone(), path.clone(), start, goal),
            Some(ground) => {
                let chain = self.test.chain();
                Mission::over_dem(ground.clone(), path.clone(), chain.contact_point(&start), chain.contact_point(&goal))
            }
        };
        match to_go {
            Some(to_go) => mission.with_replanning(self.test.clone(), Arc::clone(to_go)),
            None => mission,
        }
    }

    /// The costs by which its trials replan over the nodes of an answer; `None` if they fly open loop.
    ///
    /// # Errors
    /// [`FrontError`].
    pub fn costs_to_go(&self, found: &graph::Answer, progress: &dyn Progress) -> Result<Option<Arc<CostToGo>>, FrontError> {
        if self.scenario.uncertainty.unwrap_or_default().policy != Policy::Replan {
            return Ok(None);
        }
        let (start, goal) = self.ends;
        let nodes = NodeSet::new(self.test.chain(), start, goal, found.spacing)?;
        let options = &self.scenario.search;
        let to_go = match self.scenario.reliability(self.ground) {
            Some(reliability) => CostToGo::with_reliability(self.test, nodes, options, &reliability, progress)?,
            None => CostToGo::of(self.test, nodes, options, progress).map_err(SearchError::from)?,
        };
        Ok(Some(Arc::new(to_go)))
    }

    /// Estimates the success of the paths of a front, and takes the one to fly: [`preferred_path`].
    ///
    /// Under replanning a robot that may take more hops is another robot: every path is estimated with the hops that it has.
    ///
    /// # Errors
    /// [`FrontError`].
    pub fn estimate(
        &self,
        found: &mut graph::Answer,
        front: &mut [ReliablePath],
        progress: &dyn Progress,
    ) -> Result<(), FrontError> {
        let Some(keys) = self.scenario.uncertainty.filter(|_| matches!(found.outcome, Outcome::Path { .. })) else { return Ok(()) };
        let to_go = self.costs_to_go(found, progress)?;
        let Some(fewest) = front.first().map(|path| path.cost.hops()) else { return Ok(()) };
        for path in front.iter_mut() {
            // A path of too many hops to list, or without commands of the machine, is not flown.
            let Ok(hops) = self.generated(path) else { continue };
            let to_go = to_go.as_ref().map(|to_go| Arc::new(to_go.with_fewer_extra_hops(path.cost.hops() - fewest)));
            let simulation = Simulation::new(&self.mission(&hops, to_go.as_ref()), keys.errors)?;
            path.success = Some(simulation.estimated_success(&keys.options(), progress)?);
        }
        if let Some(path) = preferred_path(front).and_then(|preferred| front.get(preferred)) {
            found.follow(path);
        }
        Ok(())
    }

    fn generated(&self, path: &ReliablePath) -> Result<HopPath, PathError> {
        generate(self.test, &path.legs, self.scenario.search.takeoff, self.scenario.search.split)
    }
}
