//! The raster and the picture of where trials rest.

use std::path::Path;

use chta::{
    report::DensityRecord,
    study::{Case, Drift, Drifted, Simulated, Trials},
    terrain::{Band, ResultBands, result_geotiff_bytes},
    uncertainty::RestDensity,
};

use super::{
    Failure,
    args::SimulateArgs,
    output::{self, Pending},
    views::Files,
};

/// Refuses a raster that is no GeoTIFF, and a raster or a picture that would lie on no map.
pub(crate) fn check(args: &SimulateArgs, case: &Case) -> Result<(), Failure> {
    let wanted = [("--density", &args.density), ("--plot-density", &args.plot_density)];
    if let Some((option, _)) = wanted.iter().find(|(_, file)| file.is_some() && !case.is_on_dem()) {
        return Err(Failure::message(format!("{option}: the landings lie on no DEM; give the scenario [terrain] dem")));
    }
    check_raster(args)
}

/// Refuses a raster that is no GeoTIFF.
pub(crate) fn check_raster(args: &SimulateArgs) -> Result<(), Failure> {
    let Some(file) = &args.density else { return Ok(()) };
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    if !matches!(ending.as_deref(), Some("tif" | "tiff")) {
        let found = file.display();
        return Err(Failure::message(format!(
            "--density: '{found}' ends neither in .tif nor in .tiff: give the GeoTIFF one of the two names"
        )));
    }
    Ok(())
}

/// The files of the raster and the picture, and what is counted for them.
#[derive(Default)]
pub(crate) struct DensityFiles<'a> {
    raster: Option<Pending<'a>>,
    picture: Option<Pending<'a>>,
    counted: Option<RestDensity>,
}

impl<'a> DensityFiles<'a> {
    /// Opens them before the computation begins.
    pub(crate) fn begin(args: &'a SimulateArgs) -> Result<Self, Failure> {
        let raster = args.density.as_deref().map(Pending::begin).transpose()?;
        Ok(Self { raster, picture: output::begin_picture("--plot-density", args.plot_density.as_deref())?, counted: None })
    }

    /// What counts where trials rest, and the share of them inside an area.
    pub(crate) fn of(&mut self, trials: &Trials, within: Option<&Path>) -> Result<Option<&mut RestDensity>, Failure> {
        let is_wanted = self.raster.is_some() || self.picture.is_some();
        self.counted = is_wanted.then(|| trials.density(within)).transpose()?.flatten();
        Ok(self.counted.as_mut())
    }

    /// The same for trials without a plan.
    pub(crate) fn of_drift(&mut self, trials: &Drift, within: Option<&Path>) -> Result<Option<&mut RestDensity>, Failure> {
        let is_wanted = self.raster.is_some() || self.picture.is_some();
        self.counted = is_wanted.then(|| trials.density(within)).transpose()?;
        Ok(self.counted.as_mut())
    }

    /// Adds both to the files of an answer, and their numbers to the answer. Without a path nothing was flown.
    pub(crate) fn add(mut self, files: &mut Files<'a>, simulated: &mut Simulated) -> Result<(), Failure> {
        let Some(density) = self.counted.take().filter(|density| density.trials() > 0) else { return Ok(()) };
        simulated.answer.density = Some(DensityRecord::new(&density));
        files.picture(self.picture.take(), || simulated.density_map(&density))?;
        self.write(files, &density)
    }

    /// The same for trials without a plan.
    pub(crate) fn add_drift(mut self, files: &mut Files<'a>, flown: Drifted) -> Result<Drifted, Failure> {
        let Some(density) = self.counted.take() else { return Ok(flown) };
        let flown = flown.with_density(&density);
        files.picture(self.picture.take(), || Some(flown.density_map(&density)))?;
        self.write(files, &density)?;
        Ok(flown)
    }

    /// Writes the raster.
    fn write(self, files: &mut Files<'a>, density: &RestDensity) -> Result<(), Failure> {
        let Some(raster) = self.raster else { return Ok(()) };
        #[expect(clippy::cast_possible_truncation, reason = "shares of a raster in single precision")]
        let single = |shares: Vec<f64>| shares.into_iter().map(|share| share as f32).collect::<Vec<f32>>();
        let of_hops =
            (1..=density.hops()).filter_map(|hop| Some((format!("share after hop {hop}"), single(density.after_hop(hop)?))));
        let rasters: Vec<_> = std::iter::once(("share of ends".to_owned(), single(density.ends()))).chain(of_hops).collect();
        let bands = rasters.iter().map(|(name, samples)| Band { name, unit: "", samples }).collect();
        let (dem, bands) = (density.dem(), ResultBands::Float32(bands));
        let bytes =
            result_geotiff_bytes(dem.rows(), dem.cols(), dem.georeference(), &bands).map_err(|error| Failure::of(&error))?;
        files.bytes(raster, bytes);
        Ok(())
    }
}
