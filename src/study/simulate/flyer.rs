//! The ground and the policy of the trials of a plan.

use std::sync::Arc;

use super::SimulateError;
use crate::{
    graph::{self, CostToGo, NodeSet},
    ground::{DemGround, Surface},
    path::HopPath,
    progress::Progress,
    scenario::TerrainSource,
    study::{Case, DemReading, Overlays, Planned},
    uncertainty::{Mission, Policy, Simulation, Summary, TrialOptions},
};

/// A plan with everything that its trials need.
pub(in crate::study) struct Flyer<'a> {
    planned: &'a Planned,
    /// The whole raster with its overlays, for flights in three dimensions.
    ground: Option<DemGround>,
    to_go: Option<Arc<CostToGo>>,
}

impl<'a> Flyer<'a> {
    /// Reads the raster, and computes the replanning policy once.
    pub(in crate::study) fn new(
        planned: &'a Planned,
        found: &graph::Answer,
        policies: &[Policy],
        progress: &dyn Progress,
    ) -> Result<Self, SimulateError> {
        let ground = dem_ground(&planned.case)?;
        let replans = policies.contains(&Policy::Replan);
        let to_go = replans.then(|| cost_to_go(planned, found, progress)).transpose()?.map(Arc::new);
        Ok(Self { planned, ground, to_go })
    }

    /// The whole raster with its overlays, if the terrain is one.
    pub(super) fn into_ground(self) -> Option<DemGround> {
        self.ground
    }

    /// The trials along a path over this ground.
    pub(super) fn simulation(&self, path: &HopPath) -> Result<Simulation, SimulateError> {
        let Planned { case, test, ends: (start, goal), .. } = self.planned;
        let mission = match &self.ground {
            None => Mission::along_chain(test.clone(), path.clone(), *start, *goal),
            Some(ground) => {
                let chain = test.chain();
                Mission::over_dem(ground.clone(), path.clone(), chain.contact_point(start), chain.contact_point(goal))
            }
        };
        let mission = match &self.to_go {
            Some(to_go) => mission.with_replanning(test.clone(), Arc::clone(to_go)),
            None => mission,
        };
        Ok(Simulation::new(&mission, case.scenario.uncertainty.unwrap_or_default().errors)?)
    }

    /// Flies the trials of a path over this ground.
    pub(in crate::study) fn fly(
        &self,
        path: &HopPath,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<Summary, SimulateError> {
        Ok(self.simulation(path)?.run(options, &mut (), progress)?)
    }
}

/// The whole raster of a case with its overlays; `None` if its terrain is no raster.
fn dem_ground(case: &Case) -> Result<Option<DemGround>, SimulateError> {
    // Read for hops beside the line.
    if let Some(ground) = &case.prepared.beside_line {
        return Ok(Some(ground.as_ref().clone()));
    }
    let Some(TerrainSource::Dem { path, .. }) = &case.scenario.terrain else { return Ok(None) };
    let file = case.base.join(path);
    let read = DemReading::of(&case.scenario).options.read(&file);
    let dem = read.map_err(|problem| SimulateError::Dem { file, problem: Box::new(problem) })?;
    let coordinates = Some(&dem.georeference().coordinate_system);
    let overlays = Overlays::read(&case.scenario, &case.base, coordinates, dem.bounds())
        .map_err(|problem| SimulateError::Overlay(Box::new(problem)))?;
    Ok(Some(overlays.ground(dem, &case.scenario)))
}

/// The cost-to-go of every node of a search, with the reliability policy where the scenario weighs risk.
fn cost_to_go(planned: &Planned, found: &graph::Answer, progress: &dyn Progress) -> Result<CostToGo, SimulateError> {
    let Planned { case, test, ends: (start, goal), .. } = planned;
    let nodes = NodeSet::new(test.chain(), *start, *goal, found.spacing)?;
    let options = &case.scenario.search;
    Ok(match case.scenario.reliability() {
        Some(reliability) => CostToGo::with_reliability(test, nodes, options, &reliability, progress)?,
        None => CostToGo::of(test, nodes, options, progress)?,
    })
}
