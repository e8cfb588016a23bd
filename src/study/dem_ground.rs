//! The whole ground of a case's DEM, for flights in three dimensions.

use super::{Case, SimulateError};
use crate::{
    ground::DemGround,
    scenario::{Route, Scenario},
};

/// The raster of a case with its overlays; `None` if its terrain is a mesh or a chain. The posts are read once for all cases over one terrain,
/// the overlays with the slice. A free route and its trials have exact commands.
///
/// # Errors
/// [`SimulateError::Dem`].
pub(super) fn dem_ground(case: &Case) -> Result<Option<DemGround>, SimulateError> {
    // That of hops beside the line, or of an earlier question.
    if let Some(ground) = case.prepared.beside_line.as_deref().or_else(|| case.ground.get()) {
        return Ok(Some(ground.clone()));
    }
    let Some((sliced, overlays)) = &case.sliced else { return Ok(None) };
    let dem = sliced.whole();
    let dem = dem.map_err(|problem| SimulateError::Dem { file: sliced.file().to_path_buf(), problem: Box::new(problem) })?;
    let exact = (case.scenario.route == Route::Free)
        .then(|| Scenario { hopper: case.scenario.hopper.with_any_command(), ..case.scenario.clone() });
    Ok(Some(case.ground.get_or_init(|| overlays.ground(dem, exact.as_ref().unwrap_or(&case.scenario))).clone()))
}
