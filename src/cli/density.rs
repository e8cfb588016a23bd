//! The raster of where trials rest.

use std::path::Path;

use chta::{
    report::DensityRecord,
    study::{Case, Simulated, Trials},
    terrain::{Band, ResultBands, result_geotiff_bytes},
    uncertainty::RestDensity,
};

use super::{Failure, output::Pending, views::Files};

/// Refuses a raster that is no GeoTIFF or would lie on no map.
pub(crate) fn check(file: &Path, case: &Case) -> Result<(), Failure> {
    if !case.is_on_dem() {
        return Err(Failure::message("--density: the landings lie on no DEM; give the scenario [terrain] dem"));
    }
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    if !matches!(ending.as_deref(), Some("tif" | "tiff")) {
        let found = file.display();
        return Err(Failure::message(format!(
            "--density: '{found}' ends neither in .tif nor in .tiff: give the GeoTIFF one of the two names"
        )));
    }
    Ok(())
}

/// The file of the raster, and what is counted for it.
#[derive(Default)]
pub(crate) struct DensityFile<'a> {
    file: Option<Pending<'a>>,
    counted: Option<RestDensity>,
}

impl<'a> DensityFile<'a> {
    /// Opens it before the computation begins.
    pub(crate) fn begin(path: Option<&'a Path>) -> Result<Self, Failure> {
        Ok(Self { file: path.map(Pending::begin).transpose()?, counted: None })
    }

    /// What counts where trials rest, and the share of them inside an area.
    pub(crate) fn of(&mut self, trials: &Trials, within: Option<&Path>) -> Result<Option<&mut RestDensity>, Failure> {
        self.counted = self.file.as_ref().map(|_| trials.density(within)).transpose()?.flatten();
        Ok(self.counted.as_mut())
    }

    /// Adds the raster to the files of an answer, and its numbers to the answer. Without a path nothing was flown.
    pub(crate) fn add(self, files: &mut Files<'a>, simulated: &mut Simulated) -> Result<(), Failure> {
        let counted = self.counted.filter(|density| density.trials() > 0);
        let (Some(file), Some(density)) = (self.file, counted) else { return Ok(()) };
        #[expect(clippy::cast_possible_truncation, reason = "shares of a raster in single precision")]
        let single = |shares: Vec<f64>| shares.into_iter().map(|share| share as f32).collect::<Vec<f32>>();
        let of_hops =
            (1..=density.hops()).filter_map(|hop| Some((format!("share after hop {hop}"), single(density.after_hop(hop)?))));
        let rasters: Vec<_> = std::iter::once(("share of ends".to_owned(), single(density.ends()))).chain(of_hops).collect();
        let bands = rasters.iter().map(|(name, samples)| Band { name, unit: "", samples }).collect();
        let (dem, bands) = (density.dem(), ResultBands::Float32(bands));
        let bytes =
            result_geotiff_bytes(dem.rows(), dem.cols(), dem.georeference(), &bands).map_err(|error| Failure::of(&error))?;
        files.bytes(file, bytes);
        simulated.answer.density = Some(DensityRecord::new(&density));
        Ok(())
    }
}
