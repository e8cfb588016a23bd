//! The front of hops against success: every path estimated by fixed trials, and the one to fly.

use std::sync::Arc;

use super::SimulateError;
use crate::{
    chain::Station,
    graph::{self, CostToGo, NodeSet, Outcome, ReliablePath, RiskModel, TakeoffScatter, preferred_path},
    ground::{DemGround, Surface},
    hop::HopTest,
    path::{HopPath, PathError, generate},
    progress::Progress,
    scenario::Scenario,
    uncertainty::{Mission, Policy, Simulation, TrialOptions, Uncertainty},
};

/// A journey whose paths are flown in trials.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlownJourney<'a> {
    /// The scenario, with its errors.
    pub(super) scenario: &'a Scenario,
    /// The hop test over its chain.
    pub(super) test: &'a HopTest,
    /// Start and goal.
    pub(super) ends: (Station, Station),
    /// The whole DEM, if the chain was sliced from one.
    pub(super) ground: Option<&'a DemGround>,
}

impl FlownJourney<'_> {
    /// The trials along a path; replanned by these costs, if there are any.
    pub(super) fn simulation(&self, path: &HopPath, to_go: Option<&Arc<CostToGo>>) -> Result<Simulation, SimulateError> {
        self.simulation_under(path, to_go, self.scenario.uncertainty.clone().unwrap_or_default().errors)
    }

    /// The same under other errors than those of the scenario.
    pub(super) fn simulation_under(
        &self,
        path: &HopPath,
        to_go: Option<&Arc<CostToGo>>,
        errors: Uncertainty,
    ) -> Result<Simulation, SimulateError> {
        let (start, goal) = self.ends;
        let mission = match self.ground {
            None => Mission::along_chain(self.test.clone(), path.clone(), start, goal),
            Some(ground) => {
                let chain = self.test.chain();
                Mission::over_dem(ground.clone(), path.clone(), chain.contact_point(&start), chain.contact_point(&goal))
            }
        };
        let mission = match to_go {
            Some(to_go) => mission.with_replanning(self.test.clone(), Arc::clone(to_go)),
            None => mission,
        };
        Ok(Simulation::new(&mission, errors)?)
    }

    /// The costs by which trials replan over the nodes of an answer, with as many hops more than the fewest as its path has.
    pub(super) fn costs_to_go(&self, found: &graph::Answer, progress: &dyn Progress) -> Result<CostToGo, SimulateError> {
        let to_go = self.costs_with_all_hops(found, progress)?;
        let fewest = to_go.of_node(to_go.nodes().start()).map(graph::Cost::hops);
        Ok(match found.hops().zip(fewest) {
            Some((hops, fewest)) => to_go.with_fewer_extra_hops(hops.saturating_sub(fewest)),
            None => to_go,
        })
    }

    /// The same with as many hops as the scenario allows.
    fn costs_with_all_hops(&self, found: &graph::Answer, progress: &dyn Progress) -> Result<CostToGo, SimulateError> {
        let nodes = NodeSet::new(self.test.chain(), self.ends.0, self.ends.1, found.spacing)?;
        let options = &self.scenario.search;
        let Some(mut reliability) = self.scenario.reliability(self.ground) else {
            return Ok(CostToGo::of(self.test, nodes, options, progress)?);
        };
        if let RiskModel::Flown { takeoffs, .. } = &mut reliability.model {
            *takeoffs = TakeoffScatter::OfPosition;
        }
        Ok(CostToGo::with_reliability(self.test, nodes, options, &reliability, progress)?)
    }

    /// The share of fixed trials of one path that reach the goal.
    pub(super) fn success_of(
        &self,
        found: &graph::Answer,
        path: &HopPath,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<f64, SimulateError> {
        let replans = options.policy == Policy::Replan;
        let to_go = replans.then(|| self.costs_to_go(found, progress)).transpose()?.map(Arc::new);
        Ok(self.simulation(path, to_go.as_ref())?.estimated_success(options, progress)?)
    }

    /// Estimates the success of the paths of a front, and takes the one to fly: [`preferred_path`].
    ///
    /// A robot that replans and may take more hops is another robot: every path is estimated with the hops that it has.
    pub(super) fn estimate(
        &self,
        found: &mut graph::Answer,
        front: &mut [ReliablePath],
        progress: &dyn Progress,
    ) -> Result<(), SimulateError> {
        let is_path = matches!(found.outcome, Outcome::Path { .. });
        let Some((keys, fewest)) =
            self.scenario.uncertainty.as_ref().filter(|_| is_path).zip(front.first().map(|path| path.cost.hops()))
        else {
            return Ok(());
        };
        let replans = keys.policy == Policy::Replan;
        let to_go = replans.then(|| self.costs_with_all_hops(found, progress)).transpose()?;
        for path in front.iter_mut() {
            // A path of too many hops to list, or without commands of the machine, is not flown.
            let Ok(hops) = self.generated(path) else { continue };
            let to_go = to_go.as_ref().map(|to_go| Arc::new(to_go.with_fewer_extra_hops(path.cost.hops() - fewest)));
            path.success = Some(self.simulation(&hops, to_go.as_ref())?.estimated_success(&keys.options(), progress)?);
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
