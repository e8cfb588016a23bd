//! The whole ground of a case's DEM, for flights in three dimensions.

use super::{Case, DemReading, Overlays, SimulateError};
use crate::{ground::DemGround, scenario::TerrainSource};

/// The raster of a case with its overlays, read once for all questions about the case; `None` if its terrain is a mesh or a chain.
///
/// # Errors
/// [`SimulateError::Dem`] and [`SimulateError::Overlay`].
pub(super) fn dem_ground(case: &Case) -> Result<Option<DemGround>, SimulateError> {
    // That of hops beside the line, or of an earlier question.
    if let Some(ground) = case.prepared.beside_line.as_deref().or_else(|| case.raster.get()) {
        return Ok(Some(ground.clone()));
    }
    let Some(TerrainSource::Dem { path, .. }) = &case.scenario.terrain else { return Ok(None) };
    let file = case.base.join(path);
    let read = DemReading::of(&case.scenario).options.read(&file);
    let dem = read.map_err(|problem| SimulateError::Dem { file, problem: Box::new(problem) })?;
    let coordinates = Some(&dem.georeference().coordinate_system);
    let overlays = Overlays::read(&case.scenario, &case.base, coordinates, dem.bounds())
        .map_err(|problem| SimulateError::Overlay(Box::new(problem)))?;
    Ok(Some(case.raster.get_or_init(|| overlays.ground(dem, &case.scenario)).clone()))
}
