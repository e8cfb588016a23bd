//! The paths of a map, flown many times.

use std::sync::Arc;

use super::aim::Aim;
use super::{MapQuestion, MapStudyError, PreparedMap, Spot};
use crate::{
    graph::{PostCosts, PostRisks},
    path::HopPath,
    progress::Progress,
    reach::map::{HopMap, MapHop, MapObjective, PostHops, costs_to_go, path_hops, path_hops_by, risks_flown_over},
    report::{SimulationRecord, SuccessEstimate},
    scenario::UncertaintyKeys,
    uncertainty::{Mission, Policy, Simulation},
};

/// How reliably the path to a goal is flown.
#[derive(Clone, Debug)]
pub(super) struct FlownPath {
    pub(super) trials: SimulationRecord,
    pub(super) estimate: Option<SuccessEstimate>,
}

/// What a robot goes by after every landing on its way to a goal.
pub(in crate::study) enum GoesBy {
    /// Its plan.
    Plan,
    /// The most reliable ways to the goal.
    Risks(Arc<PostRisks>),
    /// The least hops and effort to the goal.
    Costs(Arc<PostCosts>),
}

impl MapQuestion<'_> {
    /// The hops of the path to a goal over a map that was searched, each on its own slice; `None` if it was not reached.
    ///
    /// # Errors
    /// [`MapStudyError::Map`].
    pub(in crate::study) fn hops_to(
        &self,
        goal: &Spot,
        (hops, out, objective): (&PostHops, &HopMap, &MapObjective),
    ) -> Result<Option<Vec<MapHop>>, MapStudyError> {
        let Some(nodes) = out.path(hops, goal.post) else { return Ok(None) };
        let takeoff = self.scenario.search.takeoff;
        let found = match self.aim()? {
            Aim::Hops(_) => path_hops(hops, &nodes, takeoff),
            Aim::Least(..) => path_hops_by(hops, &nodes, objective, takeoff),
        };
        Ok(Some(found?))
    }
}

impl PreparedMap {
    /// What a robot with these errors goes by to a goal: whatever others are nearer.
    ///
    /// # Errors
    /// [`MapStudyError::Map`].
    pub(in crate::study) fn goes_by(
        &self,
        question: &MapQuestion<'_>,
        (hops, goal): (&PostHops, &Spot),
        keys: &UncertaintyKeys,
        progress: &dyn Progress,
    ) -> Result<GoesBy, MapStudyError> {
        let options = &question.scenario.search;
        Ok(if keys.policy != Policy::Replan {
            GoesBy::Plan
        } else if question.weighs_risk(&keys.errors) {
            let risks = risks_flown_over(hops, &self.ground, goal.post, (&keys.errors, options.takeoff), progress)?;
            GoesBy::Risks(Arc::new(risks))
        } else {
            GoesBy::Costs(Arc::new(costs_to_go(hops, goal.post, (options.effort, options.takeoff), progress)?))
        })
    }

    /// The trials of a path; `None` if it has no hops.
    ///
    /// # Errors
    /// [`MapStudyError::Simulation`].
    pub(in crate::study) fn trials_of(
        &self,
        question: &MapQuestion<'_>,
        (path, goes_by): (&HopPath, &GoesBy),
        keys: &UncertaintyKeys,
    ) -> Result<Option<Simulation>, MapStudyError> {
        let (Some(first), Some(last)) = (path.hops.first(), path.hops.last()) else { return Ok(None) };
        let mission = Mission::over_dem(self.ground.clone(), path.clone(), first.takeoff, last.landing);
        let replans = |mission: Mission| {
            let derates = !question.scenario.derating.is_none();
            if derates { mission.planned_over(self.planning.clone()) } else { mission }
        };
        let mission = match goes_by {
            GoesBy::Plan => mission,
            GoesBy::Risks(risks) => replans(mission.with_reliable_replanning_over_posts(risks.clone())),
            GoesBy::Costs(costs) => replans(mission.with_replanning_over_posts(costs.clone())),
        };
        Ok(Some(Simulation::new(&mission, keys.errors.clone())?))
    }

    /// Flies the path to every reachable goal many times, and in the fixed trials of an estimate if there are errors.
    pub(super) fn flown(
        &self,
        question: &MapQuestion<'_>,
        paths: &[Option<HopPath>],
        keys: &UncertaintyKeys,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<FlownPath>>, MapStudyError> {
        let replans = keys.policy == Policy::Replan;
        let hops = replans.then(|| PostHops::over(self.planning.clone(), self.lattice)).transpose()?;
        let fly = |goal: &Spot, path: &HopPath| {
            if path.hops.is_empty() {
                return Ok(None);
            }
            let goes_by = match &hops {
                Some(hops) => self.goes_by(question, (hops, goal), keys, progress)?,
                None => GoesBy::Plan,
            };
            let Some(simulation) = self.trials_of(question, (path, &goes_by), keys)? else { return Ok(None) };
            let options = keys.options();
            let estimate = if keys.errors.is_none() {
                None
            } else {
                let success_estimated = simulation.estimated_success(&options, progress)?;
                Some(SuccessEstimate { success_estimated, success_policy: keys.policy })
            };
            let summary = simulation.run(&options, &mut (), progress)?;
            Ok(Some(FlownPath { trials: SimulationRecord::new(&summary, path.hops.len()), estimate }))
        };
        let goals = self.goals.iter().zip(paths);
        goals.map(|(goal, path)| path.as_ref().map_or(Ok(None), |path| fly(goal, path))).collect()
    }
}
