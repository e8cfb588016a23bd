//! Reads all raster formats of GDAL through its C library (feature `gdal`).
//!
//! Position, units and projection pass the same checks as those of a GeoTIFF: GDAL writes them into the tags of an empty one.

use std::io::Write;
use std::path::Path;

use gdal::raster::{GdalDataType, ResampleAlg};
use gdal::{Dataset, DriverManager};

use super::dem::Posts;
use super::format::ReadContext;
use super::geotiff::{Placed, place_by_tags};
use super::parts::{CheckedParts, StoredParts};
use super::stored::{Scaling, StoredRaster, StoredStep, convert_heights};
use super::window::turn_round;
use super::{Dem, DemFile, DemReader, NoDataRule, PostLattice, TerrainError, Window};
use crate::quantity::{metres_or_kilometres, metres_per};

/// The reader of GDAL's formats.
pub(super) struct GdalReader;

impl DemReader for GdalReader {
    fn name(&self) -> &'static str {
        "GDAL raster"
    }

    /// GDAL is tried last, so it accepts any file.
    fn recognises(&self, _beginning: &[u8]) -> bool {
        true
    }

    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError> {
        let mut file = tempfile::NamedTempFile::new().map_err(TerrainError::writing)?;
        file.write_all(&bytes).map_err(TerrainError::writing)?;
        self.read_path(file.path(), context)
    }

    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError> {
        let open = OpenRaster::open(path, context)?;
        let (rows, cols) = (open.lattice.rows(), open.lattice.cols());
        let posts = Posts::Double(open.window(Window { first_row: 0, first_col: 0, rows, cols })?);
        let georeference = open.lattice.georeference().clone();
        let OpenRaster { states_metres, south_up, .. } = open;
        let (scaling, step) = (open.scaling(), open.step());
        StoredRaster { rows, cols, posts, georeference, states_metres, south_up, scaling, step }.finish(&gdal_context(context))
    }

    fn open_path(&self, path: &Path, context: ReadContext) -> Result<Box<dyn DemFile>, TerrainError> {
        let open = OpenRaster::open(path, &context)?;
        if !open.states_metres && open.lattice.bounds().may_be_degrees() {
            return Ok(Box::new(self.read_path(path, &context)?));
        }
        Ok(Box::new(CheckedParts::new(open, gdal_context(&context))))
    }
}

/// GDAL reads sidecar files itself.
fn gdal_context(context: &ReadContext) -> ReadContext {
    ReadContext { no_data: context.no_data, ..ReadContext::default() }
}

/// Whether GDAL can open this file as a raster.
pub(super) fn can_open(path: &Path) -> bool {
    let options = gdal::DatasetOptions { open_flags: gdal::GdalOpenFlags::GDAL_OF_RASTER, ..gdal::DatasetOptions::default() };
    Dataset::open_ex(path, options).is_ok()
}

struct OpenRaster {
    dataset: Dataset,
    lattice: PostLattice,
    south_up: bool,
    states_metres: bool,
    scale: f64,
    offset: f64,
    /// 1, or 1000 if the band is in km.
    metres_per_unit: f64,
    no_data: NoDataRule,
    step: StoredStep,
}

impl OpenRaster {
    fn open(path: &Path, context: &ReadContext) -> Result<Self, TerrainError> {
        let dataset = Dataset::open(path).map_err(|error| refused(&error))?;
        if dataset.raster_count() != 1 {
            return Err(unsuitable(
                format!("{} bands", dataset.raster_count()),
                "one band of elevations",
                "gdal_translate -b 1 in out.tif",
            ));
        }
        let (cols, rows) = dataset.raster_size();
        let band = dataset.rasterband(1).map_err(|error| refused(&error))?;
        if matches!(band.band_type(), GdalDataType::Unknown) {
            return Err(unsuitable(
                "samples of an unsupported type".to_owned(),
                "integers or reals",
                "gdal_translate -ot Float32 in out.tif",
            ));
        }
        let (scale, offset) = (band.scale().unwrap_or(1.0), band.offset().unwrap_or(0.0));
        let unit = band.unit();
        let in_metres = if unit.is_empty() { Some(1.0) } else { metres_or_kilometres(&unit) };
        let metres_per_unit = in_metres.ok_or_else(|| {
            let mend = convert_heights(None, Scaling { scale, offset_m: offset }, metres_per(&unit));
            unsuitable(format!("elevations in '{unit}'"), "elevations in metres", &mend)
        })?;
        let Placed { georeference, south_up, states_metres } = place_by_tags(skeleton(&dataset)?, rows)?;
        let lattice = PostLattice::new(rows, cols, georeference)?;
        let scaling = Scaling { scale: scale * metres_per_unit, offset_m: offset * metres_per_unit };
        let step = match band.band_type() {
            GdalDataType::Float32 => StoredStep::Single(scaling),
            GdalDataType::Float64 => StoredStep::Fine,
            _ => StoredStep::Fixed(scaling.scale.abs()),
        };
        let no_data = context.no_data;
        Ok(Self { dataset, lattice, south_up, states_metres, scale, offset, metres_per_unit, no_data, step })
    }
}

/// A GeoTIFF of one post with the raster's transform and projection.
fn skeleton(dataset: &Dataset) -> Result<Vec<u8>, TerrainError> {
    let folder = tempfile::tempdir().map_err(TerrainError::writing)?;
    let path = folder.path().join("place.tif");
    let written = || -> gdal::errors::Result<()> {
        let mut tags = DriverManager::get_driver_by_name("GTiff")?.create_with_band_type::<u8, _>(&path, 1, 1, 1)?;
        // If GDAL reports no transform, the tags have none, and the checks refuse them.
        if let Ok(transform) = dataset.geo_transform() {
            tags.set_geo_transform(&transform)?;
        }
        if let Ok(system) = dataset.spatial_ref() {
            tags.set_spatial_ref(&system)?;
        }
        tags.close()
    };
    written().map_err(|error| refused(&error))?;
    std::fs::read(&path).map_err(TerrainError::reading)
}

fn refused(error: &gdal::errors::GdalError) -> TerrainError {
    TerrainError::Damaged { format: "raster (read by GDAL)", reason: error.to_string() }
}

fn unsuitable(found: String, expected: &'static str, mend: &str) -> TerrainError {
    TerrainError::Unsuitable { found, expected, mend: mend.to_owned() }
}

impl StoredParts for OpenRaster {
    fn lattice(&self) -> &PostLattice {
        &self.lattice
    }

    fn south_up(&self) -> bool {
        self.south_up
    }

    fn scaling(&self) -> Scaling {
        Scaling { scale: self.scale * self.metres_per_unit, offset_m: self.offset * self.metres_per_unit }
    }

    fn step(&self) -> StoredStep {
        self.step
    }

    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError> {
        let Window { first_row, first_col, rows, cols } = window.stored(self.lattice.rows(), self.south_up);
        let place = |value: usize| isize::try_from(value).unwrap_or(isize::MAX);
        let read = || -> gdal::errors::Result<(Vec<f64>, Vec<u8>)> {
            let band = self.dataset.rasterband(1)?;
            let corner = (place(first_col), place(first_row));
            let nearest = Some(ResampleAlg::NearestNeighbour);
            let posts = band.read_as::<f64>(corner, (cols, rows), (cols, rows), nearest)?;
            let shown = band.open_mask_band()?.read_as::<u8>(corner, (cols, rows), (cols, rows), nearest)?;
            Ok((posts.data().to_vec(), shown.data().to_vec()))
        };
        let (mut posts, shown) = read().map_err(|error| refused(&error))?;
        for (post, shown) in posts.iter_mut().zip(shown) {
            let gap = match self.no_data {
                NoDataRule::AsStated => shown == 0,
                NoDataRule::Nothing => false,
                NoDataRule::Value(mark) => mark.is_double(*post),
            };
            *post = if gap { f64::NAN } else { (*post * self.scale + self.offset) * self.metres_per_unit };
        }
        turn_round(&mut posts, cols, self.south_up);
        Ok(posts)
    }
}
