//! From a planned path to its trials.

use chta::{
    ballistics::HopTest,
    graph::{self, CostToGo, NodeSet},
    path::HopPath,
    scenario::{Covers, TerrainSource},
    terrain::{Dem, read_dem},
    uncertainty::{MapGround, Mission, Policy, Simulation, Summary, TrialOptions},
};

use super::listen::{Listener, RowFile};
use crate::cli::{Failure, load::Loaded, progress::Progress};

/// How many trials are kept with all their hops, for the pictures.
const KEPT_TRIALS: u64 = 300;

/// A planned path, and all that its trials need.
pub(super) struct Flyer<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) test: &'a HopTest<'a>,
    pub(super) path: &'a HopPath,
    /// The whole raster with what lies over it, for flights in three dimensions.
    terrain: Option<(Dem, Covers)>,
    to_go: Option<CostToGo>,
}

/// What the trials of one policy came to.
pub(super) struct Flown {
    pub(super) summary: Summary,
}

/// Whether the terrain is a raster, so that hops are flown in three dimensions.
pub(super) fn on_dem(loaded: &Loaded) -> bool {
    matches!(loaded.scenario.terrain, Some(TerrainSource::Dem { .. }))
}

impl<'a> Flyer<'a> {
    /// Reads the raster, and computes once what replanning needs.
    pub(super) fn new(
        loaded: &'a Loaded,
        test: &'a HopTest<'a>,
        path: &'a HopPath,
        found: &graph::Answer,
        policies: &[Policy],
        quiet: bool,
    ) -> Result<Self, Failure> {
        let terrain = match &loaded.scenario.terrain {
            Some(TerrainSource::Dem { path, .. }) => {
                let file = loaded.base.join(path);
                let dem = read_dem(&file).map_err(|error| Failure::about(&file, &error))?;
                let coordinates = &dem.georeference().coordinate_system;
                let covers = Covers::read(&loaded.scenario, &loaded.base, Some(coordinates), dem.bounds())
                    .map_err(|error| Failure::of(&error))?;
                Some((dem, covers))
            }
            Some(TerrainSource::Mesh { .. } | TerrainSource::Chain { .. }) | None => None,
        };
        let to_go = policies.contains(&Policy::Replan).then(|| -> Result<_, Failure> {
            let (start, goal) = loaded.ends()?;
            let nodes = NodeSet::new(test.chain(), start, goal, found.spacing).map_err(|error| Failure::of(&error))?;
            let options = &loaded.scenario.search;
            let progress = Progress::new(quiet);
            progress.say("ranking the ways on from every node".to_owned());
            Ok(match loaded.scenario.surety() {
                Some(surety) => CostToGo::surely(test, nodes, options, &surety),
                None => CostToGo::of(test, nodes, options),
            })
        });
        Ok(Self { loaded, test, path, terrain, to_go: to_go.transpose()? })
    }

    /// The raster, where there is one.
    pub(super) fn dem(&self) -> Option<&Dem> {
        self.terrain.as_ref().map(|(dem, _)| dem)
    }

    /// The mission along a path over this ground.
    fn mission<'b>(&'b self, path: &'b HopPath) -> Result<Mission<'b>, Failure> {
        let (start, goal) = self.loaded.ends()?;
        let map = self.terrain.as_ref().map(|(dem, covers)| MapGround {
            dem,
            friction: covers.friction_raster(),
            keep_out: covers.keep_out(),
        });
        let surface = &self.loaded.scenario.surface;
        Ok(Mission { test: self.test, surface, path, start, goal, map, to_go: self.to_go.as_ref() })
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
        let simulation = Simulation::new(self.mission(self.path)?, errors).map_err(|error| Failure::of(&error))?;
        let mut listener = Listener::new(rows, policies.first().copied().unwrap_or_default(), quiet);
        let mut flown = Vec::new();
        for &policy in policies {
            listener.begin(policy);
            let options = TrialOptions { policy, trajectories: KEPT_TRIALS, ..*options };
            match simulation.run(&options, &mut listener) {
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
        Simulation::new(self.mission(path)?, errors).map_err(failed)?.run(options, &mut ()).map_err(failed)
    }
}
