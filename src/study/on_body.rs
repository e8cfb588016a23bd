//! Terrain read for the body of a scenario: whatever reads it here compares it with the body, so that no check can be forgotten.

use std::path::Path;

use super::{
    DemReading, PipelineError, Transect,
    physics::{Extent, body_warnings, check_extent, escape_warnings},
};
use crate::{
    chain::{PolygonalChain, csv::ChainFile},
    scenario::{BodyChoice, Scenario},
    terrain::{Dem, Ellipsoid, TerrainError},
};

/// What a terrain says of the body that it lies on.
pub trait OfBody {
    /// The figure of the body that its map states.
    fn figure(&self) -> Option<Ellipsoid>;

    /// Its horizontal extent, where it is known.
    fn extent(&self) -> Option<Extent>;
}

impl OfBody for Dem {
    fn figure(&self) -> Option<Ellipsoid> {
        self.georeference().ellipsoid()
    }

    fn extent(&self) -> Option<Extent> {
        Some(Extent::of_dem(self.bounds(), self.georeference().projection().is_ok()))
    }
}

impl OfBody for Transect {
    fn figure(&self) -> Option<Ellipsoid> {
        self.figure
    }

    fn extent(&self) -> Option<Extent> {
        Some(self.extent)
    }
}

impl OfBody for ChainFile {
    fn figure(&self) -> Option<Ellipsoid> {
        self.projection.as_ref().map(|projection| projection.definition().ellipsoid)
    }

    /// Unknown: a chain has lengths along the ground, not a place on the map.
    fn extent(&self) -> Option<Extent> {
        None
    }
}

/// Compares the outcome of reading a terrain with the body that it is said to lie on.
///
/// # Returns
/// The terrain, and a warning if its extent likely contradicts the size of the body.
///
/// # Errors
/// The error of the reader, with the body's radius in commands that mend it; [`TerrainError::OtherBody`] if the map is of another
/// body; [`PipelineError::TooLarge`] if the body has no room for the terrain.
pub fn on_body<T: OfBody>(body: &BodyChoice, read: Result<T, TerrainError>) -> Result<(T, Option<String>), PipelineError> {
    let terrain = read.map_err(|error| match body.radius_m() {
        Some(radius_m) => error.for_body(&body.spoken(), radius_m),
        None => error,
    })?;
    check_figure(body, terrain.figure())?;
    let warning = terrain.extent().map(|extent| check_extent(body, &extent)).transpose()?.flatten();
    Ok((terrain, warning))
}

/// Reads the elevation raster of a whole map for a scenario.
///
/// # Returns
/// The raster, and the warnings about it, about the scenario's body, and about the two together.
///
/// # Errors
/// As [`on_body`].
pub fn dem_on_body(scenario: &Scenario, path: &Path) -> Result<(Dem, Vec<String>), PipelineError> {
    refuse_mesh_keys(scenario)?;
    let (dem, of_extent) = on_body(&scenario.body, DemReading::of(scenario).options.read(path))?;
    let mut warnings = dem.warnings();
    warnings.extend(dem.georeference().doubts());
    warnings.extend(contradictions(scenario, None));
    warnings.extend(of_extent);
    Ok((dem, warnings))
}

/// Refuses the keys that only hops over a mesh obey: a ball, where others keep a clearance, and groups of faces.
pub(super) fn refuse_mesh_keys(scenario: &Scenario) -> Result<(), PipelineError> {
    match scenario.hopper.limits().radius_m {
        Some(radius_m) if radius_m > 0.0 => Err(PipelineError::BallOffMesh { radius_m }),
        _ if !scenario.groups.is_empty() => Err(PipelineError::GroupsOffMesh),
        _ => Ok(()),
    }
}

/// Warnings where a scenario contradicts itself about its body: gravity and radius, and speeds above escape, those of the chain's
/// segments included.
pub(super) fn contradictions(scenario: &Scenario, chain: Option<&PolygonalChain>) -> Vec<String> {
    let mut warnings = body_warnings(&scenario.body);
    warnings.extend(escape_warnings(scenario, chain));
    warnings
}

/// Checks that a map is of the scenario's body; a body without a radius may be any.
fn check_figure(body: &BodyChoice, figure: Option<Ellipsoid>) -> Result<(), TerrainError> {
    match (body.radius_m(), figure) {
        (Some(radius_m), Some(figure)) if !figure.may_be_of(body.name.as_deref(), radius_m) => {
            Err(TerrainError::OtherBody { figure, body: body.spoken(), radius_m })
        }
        _ => Ok(()),
    }
}
