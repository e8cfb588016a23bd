//! The whole ground of a scenario's DEM, for flights in three dimensions.

use std::path::Path;

use super::{DemReading, Overlays, PipelineError};
use crate::{
    ground::DemGround,
    scenario::{Scenario, TerrainSource},
};

/// Reads the DEM of a scenario with its overlays; `None` if its terrain is a mesh or a chain.
///
/// `base` is the folder that the scenario's paths start from.
///
/// # Errors
/// [`PipelineError`].
pub fn dem_ground(scenario: &Scenario, base: &Path) -> Result<Option<DemGround>, PipelineError> {
    let Some(TerrainSource::Dem { path, .. }) = &scenario.terrain else { return Ok(None) };
    let dem = DemReading::of(scenario).options.read(&base.join(path))?;
    let coordinates = &dem.georeference().coordinate_system;
    let overlays = Overlays::read(scenario, base, Some(coordinates), dem.bounds())?;
    Ok(Some(overlays.ground(dem, scenario)))
}
