//! Friction from a raster.

use std::path::{Path, PathBuf};

use super::{
    cells::{borders_of, cells_at, cells_on, has_cell},
    keep_out::{name_of, of_raster},
    line::{Line, Stretch},
    same_map::{self, SameMap},
};
use crate::{
    quantity::MapPoint,
    terrain::{CoordinateSystem, Dem, DemOptions, MapBounds, Profile, TerrainError},
    world::FrictionCone,
};

/// The name of the file's role in messages.
const WHAT: &str = "friction raster";

/// A raster of friction coefficients on the terrain's map.
#[derive(Clone, Debug)]
pub struct FrictionRaster {
    path: PathBuf,
    raster: Dem,
    /// The share of its coefficients that counts.
    share: f64,
    /// Why its map could not be compared with the terrain's.
    not_compared: Option<String>,
}

/// Reads a raster of friction coefficients (`GeoTIFF`, ESRI ASCII grid) on the terrain's map; `coordinates` is the terrain's
/// own description of its map, if it has one.
///
/// # Errors
/// [`TerrainError::Overlay`]: the file cannot be read, is not a raster on a map in metres, has another map, or contains a
/// negative number.
pub fn read_friction_raster(path: &Path, coordinates: Option<&CoordinateSystem>) -> Result<FrictionRaster, TerrainError> {
    let failed = |problem: String| TerrainError::Overlay { what: WHAT, path: path.to_path_buf(), problem };
    let raster = DemOptions::default().of_any_unit().read(path).map_err(|error| failed(of_raster(error)))?;
    let same = same_map::of_raster(&raster.georeference().coordinate_system, coordinates).map_err(|difference| {
        failed(format!("the raster lies on another map ({difference}); {}", same_map::mend_raster(coordinates)))
    })?;
    let not_compared = match same {
        SameMap::Agreed => None,
        SameMap::NotCompared(reason) => Some(format!("{WHAT} '{}': {reason}", name_of(path))),
    };
    let negative = raster.elevations().position(|value| value.is_some_and(|value| value < 0.0));
    if let Some((index, value)) = negative.and_then(|index| Some((index, raster.elevations().nth(index)??))) {
        return Err(failed(format!(
            "row {}, column {} (from 0, from the north-west) holds {value}, expected friction coefficients of at least 0; if it marks missing \
             data, say so with: gdal_translate -a_nodata {value} in.tif out.tif",
            index / raster.cols(),
            index % raster.cols()
        )));
    }
    Ok(FrictionRaster { path: path.to_path_buf(), raster, share: 1.0, not_compared })
}

impl FrictionRaster {
    /// The same raster, of whose coefficients a share counts.
    pub(crate) fn with_share(&self, share: f64) -> Self {
        Self { share: self.share * share, ..self.clone() }
    }

    /// Its content, whatever file it comes from.
    pub(crate) const fn content(&self) -> &dyn std::fmt::Debug {
        &self.raster
    }

    /// The share of its coefficients that counts.
    pub(crate) const fn share(&self) -> f64 {
        self.share
    }

    /// Calls `visit` with rectangles that together contain all borders between different coefficients, including the border of
    /// the raster.
    pub(crate) fn borders(&self, visit: &mut dyn FnMut(MapBounds)) {
        borders_of(&self.raster, &|value: Option<f64>| value, visit);
    }

    /// The warning if its map could not be compared with the terrain's.
    pub(crate) fn not_compared(&self) -> Option<&str> {
        self.not_compared.as_deref()
    }

    /// The warning if it has no data along `on`, such as "the transect".
    pub(crate) fn without_effect(&self, on: &str) -> String {
        let name = name_of(&self.path);
        format!("{WHAT} '{name}' has no data on {on}, so it has no effect there: friction_coefficient applies everywhere")
    }

    /// Whether it has data in a rectangle of the map.
    pub(crate) fn covers(&self, bounds: MapBounds) -> bool {
        has_cell(&self.raster, bounds, &|_| true)
    }

    /// The friction at a position: that of its pixel, the smaller one on a border; `None` if the raster has no data there or
    /// does not extend that far.
    pub fn at(&self, place: MapPoint) -> Option<FrictionCone> {
        let least = cells_at(place, &self.raster).flatten().reduce(f64::min)?;
        FrictionCone::new(self.share * least).ok()
    }

    /// Gives every segment of a profile its friction, and adds vertices where its line enters a pixel with another
    /// coefficient.
    ///
    /// A segment has the coefficient of the pixel at its middle: a pixel's value applies to its cell, half a spacing in every
    /// direction from its centre, without interpolation. Along a border of two cells the smaller coefficient applies. Where
    /// the raster has no data, or does not extend that far, `constant` applies. Returns whether the raster has data for any
    /// part of the profile.
    ///
    /// # Errors
    /// [`TerrainError::Overlay`] with the position where there is neither data nor a constant.
    pub fn lay(&self, profile: &mut Profile, constant: Option<FrictionCone>) -> Result<bool, TerrainError> {
        let Some(line) = Line::of(profile) else { return Ok(false) };
        let mut stretches = Vec::new();
        let mut says_any = false;
        for cell in cells_on(&line, &self.raster) {
            let least = cell.value.iter().flatten().copied().reduce(f64::min);
            says_any |= least.is_some();
            let cone = match least {
                Some(coefficient) => FrictionCone::new(self.share * coefficient).ok(),
                None => constant,
            };
            let Some(cone) = cone else {
                let at = line.map_point(0.5 * (cell.from_m + cell.to_m));
                let problem = format!(
                    "the raster has no data at map point ({:.3} m, {:.3} m), expected a friction coefficient all the way; give the \
                     scenario a friction_coefficient for where it has none",
                    at.x, at.y
                );
                return Err(TerrainError::Overlay { what: WHAT, path: self.path.clone(), problem });
            };
            stretches.push(Stretch { from_m: cell.from_m, to_m: cell.to_m, value: cone });
        }
        line.lay(profile, &stretches, |profile, segment, cone| profile.facets[segment].friction = Some(cone));
        Ok(says_any)
    }
}
