//! Trials of a robot whose heading is not controlled: from a start, without a plan or a goal.

use std::path::Path;

use super::{SimulateError, SimulateOptions, density_over};
use crate::{
    ground::{DemGround, FirstContact},
    progress::Progress,
    quantity::MapPoint,
    report::{CrsRecord, DensityRecord, DriftAnswer, SimulationRecord, SuccessRequirement},
    scenario::{Scenario, TerrainSource},
    study::{
        CaseError, Overlays, PipelineError, TrialGround, coarse_dem_warning, dem_on_body, free_route::without_layers_of_paths,
        with_measured_errors,
    },
    terrain::{TerrainError, check_map_scale},
    uncertainty::{DriftCommand, Observer, Policy, RestDensity, Simulation, SimulationError, TrialOptions},
};

/// The trials of a scenario whose heading is not controlled, before they are flown.
#[derive(Clone, Debug)]
pub struct Drift {
    scenario: Scenario,
    command: DriftCommand,
    ground: DemGround,
    start: MapPoint,
    crs: Option<CrsRecord>,
    warnings: Vec<String>,
}

/// The trials of such a scenario, flown.
#[derive(Clone, Debug)]
pub struct Drifted {
    /// The answer as plain data.
    pub answer: DriftAnswer,
    /// Warnings about the terrain, the command and the errors.
    pub warnings: Vec<String>,
    #[cfg_attr(not(feature = "plot"), expect(dead_code, reason = "pictures are of the feature"))]
    pub(super) scenario: Scenario,
    #[cfg_attr(not(feature = "plot"), expect(dead_code, reason = "pictures are of the feature"))]
    pub(super) start: MapPoint,
}

impl Drift {
    /// Reads the DEM of a scenario, whose paths start from the folder `base`, with its overlays.
    ///
    /// # Returns
    /// `None` if the heading is controlled.
    ///
    /// # Errors
    /// [`SimulateError`].
    pub fn of(scenario: &Scenario, base: &Path) -> Result<Option<Self>, SimulateError> {
        let Some(command) = scenario.uncertainty.as_ref().and_then(|keys| keys.drift) else { return Ok(None) };
        let Some(TerrainSource::Dem { path, start, .. }) = &scenario.terrain else { return Err(CaseError::NoTerrain.into()) };
        without_layers_of_paths(scenario, "trials in any direction follow no path")?;
        let (scenario, of_errors) = with_measured_errors(scenario.clone(), base).map_err(CaseError::from)?;
        let file = base.join(path);
        let in_file = |problem: TerrainError| CaseError::from(PipelineError::from(problem));
        let (dem, mut warnings) = dem_on_body(&scenario, &file).map_err(CaseError::from)?;
        let map = dem.georeference();
        let overlays = Overlays::read(&scenario, base, Some(&map.coordinate_system), dem.bounds()).map_err(in_file)?;
        let projection = map.projection();
        let start = start.on_map("start", projection.as_ref(), dem.bounds()).map_err(in_file)?;
        let scale = check_map_scale(&dem, projection.as_ref(), start, scenario.accept_map_scale, &file).map_err(in_file)?;
        warnings.extend(of_errors);
        warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
        warnings.extend(coarse_dem_warning(&scenario.hopper, map));
        warnings.extend(scale.warning());
        let most_m_s = scenario.hopper.limits().takeoff_speed_max_m_s;
        if command.takeoff_speed_m_s > most_m_s {
            warnings.push(format!(
                "uncertainty.takeoff_speed_m_s is {} m/s, over hopper.takeoff_speed_max_m_s of {most_m_s} m/s: the trials fly it all the same",
                command.takeoff_speed_m_s
            ));
        }
        let crs = projection.as_ref().ok().map(CrsRecord::from);
        let ground = overlays.ground(dem, &scenario);
        warnings.extend(scenario.drift_warnings(&TrialGround::of_map(&ground, command.hops as usize)));
        Ok(Some(Self { scenario, command, ground, start, crs, warnings }))
    }

    /// The warnings about them.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The reference system of the DEM, if it is known.
    pub const fn crs(&self) -> Option<&CrsRecord> {
        self.crs.as_ref()
    }

    /// Counts of where the trials rest, for an observer: none yet. `area`: a file of zones whose share is asked for.
    ///
    /// # Errors
    /// [`SimulateError::Area`].
    pub fn density(&self, area: Option<&Path>) -> Result<RestDensity, SimulateError> {
        density_over(&self.ground, self.command.hops as usize, area)
    }

    /// Flies them.
    ///
    /// # Errors
    /// [`SimulateError`].
    pub fn fly(
        self,
        options: &SimulateOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<Drifted, SimulateError> {
        let Self { scenario, command, ground, start, crs: _, warnings } = self;
        let keys = scenario.uncertainty.clone().unwrap_or_default();
        let simulation = Simulation::drifting(&ground, start, command, keys.errors.clone())?;
        let SimulateOptions { until_half_width, first_trial, success_min, .. } = *options;
        let trials = TrialOptions { policy: Policy::OpenLoop, first_trial, until_half_width, ..keys.options() };
        let summary = simulation.run(&trials, observer, progress)?;
        let trials = SimulationRecord::new(&summary, command.hops as usize);
        let start_m = ground.position(start).map(|from| ground.point(&from));
        let start_m = start_m.ok_or(SimulationError::NoGround {
            which: crate::uncertainty::MissionPoint::Start,
            x_m: start.x,
            y_m: start.y,
        })?;
        let DriftCommand { takeoff_speed_m_s, takeoff_angle, hops } = command;
        let answer = DriftAnswer {
            start_m: start_m.coords.into(),
            takeoff_speed_m_s,
            takeoff_angle_deg: takeoff_angle.written_degrees(),
            hops,
            requirement: success_min.map(|success_min| SuccessRequirement::of(success_min, Some(&trials))),
            trials,
            density: None,
        };
        Ok(Drifted { answer, warnings, scenario, start })
    }
}

impl Drifted {
    /// The same with the numbers of where the trials rest.
    #[must_use]
    pub fn with_density(mut self, density: &RestDensity) -> Self {
        self.answer.density = Some(DensityRecord::new(density));
        self
    }
}
