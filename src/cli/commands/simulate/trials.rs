//! From a planned path to its trials.

use std::sync::Arc;

use chta::{
    graph::{self, CostToGo, NodeSet},
    ground::{DemGround, Surface},
    hop::HopTest,
    path::HopPath,
    scenario::TerrainSource,
    study::{DemReading, Overlays},
    terrain::Dem,
    uncertainty::{Mission, Policy, Simulation, Summary, TrialOptions},
};

use super::listen::{Listener, RowFile, trials_line};
use crate::cli::{Failure, load::Loaded, progress::Progress};

/// How many trials are recorded with all their hops, for the pictures.
const KEPT_TRIALS: u64 = 300;

/// A planned path, with everything its trials need.
pub(super) struct Flyer<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) test: &'a HopTest,
    pub(super) path: &'a HopPath,
    /// The whole raster with its overlays, for flights in three dimensions.
    ground: Option<DemGround>,
    to_go: Option<Arc<CostToGo>>,
}

/// The results of the trials of one policy.
pub(super) struct Flown {
    pub(super) summary: Summary,
}

/// Whether the terrain is a raster, so that hops are flown in three dimensions.
pub(super) fn on_dem(loaded: &Loaded) -> bool {
    matches!(loaded.scenario.terrain, Some(TerrainSource::Dem { .. }))
}

impl<'a> Flyer<'a> {
    /// Reads the raster, and computes the replanning policy once.
    pub(super) fn new(
        loaded: &'a Loaded,
        test: &'a HopTest,
        path: &'a HopPath,
        found: &graph::Answer,
        policies: &[Policy],
        quiet: bool,
    ) -> Result<Self, Failure> {
        let ground = match &loaded.scenario.terrain {
            // Read for hops beside the line.
            Some(_) if loaded.prepared.beside_line.is_some() => loaded.prepared.beside_line.as_deref().cloned(),
            Some(TerrainSource::Dem { path, .. }) => {
                let file = loaded.base.join(path);
                let dem = DemReading::of(&loaded.scenario).options.read(&file).map_err(|error| Failure::about(&file, &error))?;
                let coordinates = &dem.georeference().coordinate_system;
                let overlays = Overlays::read(&loaded.scenario, &loaded.base, Some(coordinates), dem.bounds())
                    .map_err(|error| Failure::of(&error))?;
                Some(overlays.ground(dem, &loaded.scenario))
            }
            Some(TerrainSource::Mesh { .. } | TerrainSource::Chain { .. }) | None => None,
        };
        let to_go = policies.contains(&Policy::Replan).then(|| -> Result<_, Failure> {
            let (start, goal) = loaded.ends()?;
            let nodes = NodeSet::new(test.chain(), start, goal, found.spacing).map_err(|error| Failure::of(&error))?;
            let options = &loaded.scenario.search;
            let progress = Progress::new(quiet);
            progress.say("ranking the successors of every node".to_owned());
            let to_go = match loaded.scenario.reliability() {
                Some(reliability) => CostToGo::with_reliability(test, nodes, options, &reliability, &progress)
                    .map_err(|error| Failure::of(&error))?,
                None => CostToGo::of(test, nodes, options, &progress)?,
            };
            Ok(Arc::new(to_go))
        });
        Ok(Self { loaded, test, path, ground, to_go: to_go.transpose()? })
    }

    /// The raster, if the terrain is one.
    pub(super) fn dem(&self) -> Option<&Dem> {
        self.ground.as_ref().map(|ground| ground.terrain().dem())
    }

    /// The mission along a path over this ground.
    fn mission(&self, path: &HopPath) -> Result<Mission, Failure> {
        let (start, goal) = self.loaded.ends()?;
        let mission = match &self.ground {
            None => Mission::along_chain(self.test.clone(), path.clone(), start, goal),
            Some(ground) => {
                let chain = self.test.chain();
                Mission::over_dem(ground.clone(), path.clone(), chain.contact_point(&start), chain.contact_point(&goal))
            }
        };
        Ok(match &self.to_go {
            Some(to_go) => mission.with_replanning(self.test.clone(), Arc::clone(to_go)),
            None => mission,
        })
    }

    /// Flies the trials of every policy, on the same draws, and writes their landings.
    pub(super) fn fly(
        &self,
        policies: &[Policy],
        options: &TrialOptions,
        rows: Option<RowFile<'_>>,
        quiet: bool,
    ) -> Result<Vec<Flown>, Failure> {
        let errors = self.loaded.scenario.uncertainty.unwrap_or_default().errors;
        let simulation = Simulation::new(&self.mission(self.path)?, errors).map_err(|error| Failure::of(&error))?;
        let progress = Progress::new(quiet);
        let mut listener = Listener::new(rows, policies.first().copied().unwrap_or_default(), &progress);
        let mut flown = Vec::new();
        for &policy in policies {
            listener.begin(policy);
            let options = TrialOptions { policy, trajectories: KEPT_TRIALS, ..*options };
            match simulation.run(&options, &mut listener, &progress.with_lines(trials_line(policy))) {
                Ok(summary) => flown.push(Flown { summary }),
                Err(error) => return Err(listener.failure().unwrap_or_else(|| Failure::of(&error))),
            }
        }
        listener.finish()?;
        Ok(flown)
    }

    /// Flies the trials of another path over the same ground.
    pub(super) fn fly_along(&self, path: &HopPath, options: &TrialOptions) -> Result<Summary, Failure> {
        let errors = self.loaded.scenario.uncertainty.unwrap_or_default().errors;
        let failed = |error: chta::uncertainty::SimulationError| Failure::of(&error);
        Simulation::new(&self.mission(path)?, errors).map_err(failed)?.run(options, &mut (), &Progress::new(true)).map_err(failed)
    }
}
