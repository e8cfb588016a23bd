//! The whole ground of a case's DEM, for flights in three dimensions.

use super::{Case, DemReading, Overlays, SimulateError};
use crate::{ground::DemGround, scenario::TerrainSource};

/// Reads the raster of a case with its overlays; `None` if its terrain is a mesh or a chain.
///
/// # Errors
/// [`SimulateError::Dem`] and [`SimulateError::Overlay`].
pub(super) fn dem_ground(case: &Case) -> Result<Option<DemGround>, SimulateError> {
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
