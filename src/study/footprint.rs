//! What is read of a DEM beside its slice: the ground under a scenario's footprint, and the whole of it for hops beside the line.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

use super::{DemReading, Overlays, PipelineError};
use crate::{
    ground::DemGround,
    path::heading_deg,
    quantity::format_number,
    scenario::Scenario,
    terrain::{Dem, GeoReference, Profile, Surroundings, TerrainError},
    world::Hopper,
};

/// The footprint of a hopper, m; `None` if it has none.
pub(super) fn footprint_m(hopper: &Hopper) -> Option<f64> {
    hopper.limits().footprint_m.filter(|footprint_m| *footprint_m > 0.0)
}

/// A warning where the posts of a DEM lie farther apart than the footprint is wide.
pub fn coarse_dem_warning(hopper: &Hopper, map: &GeoReference) -> Option<String> {
    let footprint_m = footprint_m(hopper)?;
    let spacing_m = map.dx_m().max(map.dy_m());
    (spacing_m > footprint_m).then(|| {
        format!(
            "the posts of the DEM lie {} m apart, farther than hopper.footprint_m of {} m: the slope at the scale of the vehicle is not \
             known, and the facets of the DEM stand for it; take a finer DEM",
            format_number(spacing_m),
            format_number(footprint_m)
        )
    })
}

/// A DEM that was sliced, of which the posts around the slice are read when a hopper has a footprint, and all of them when a hop may leave it.
#[derive(Clone, Debug)]
pub(super) struct SlicedDem {
    file: PathBuf,
    reading: DemReading,
    /// What was read for the first hopper, and its footprint, m.
    read: Option<(f64, Arc<Surroundings>)>,
    /// All posts, once they were read: by any clone, for all.
    whole: Arc<OnceLock<Arc<Dem>>>,
}

impl SlicedDem {
    /// The DEM of a file, with the posts around its slice for a hopper.
    pub(super) fn of(file: PathBuf, reading: DemReading, legs: &[Profile], hopper: &Hopper) -> Result<Self, PipelineError> {
        let mut sliced = Self { file, reading, read: None, whole: Arc::default() };
        sliced.read = footprint_m(hopper).zip(sliced.around(legs, hopper)?);
        Ok(sliced)
    }

    /// The whole ground, where the hopper takes its headings in steps and has not those of the slice, so that it leaves its line; else
    /// `None`.
    pub(super) fn beside_line(
        &self,
        legs: &[Profile],
        overlays: &Overlays,
        scenario: &Scenario,
    ) -> Result<Option<Arc<DemGround>>, PipelineError> {
        let steps = scenario.hopper.limits().steps;
        let has = |leg: &Profile| {
            let [Some(from), Some(to)] = [leg.points.first(), leg.points.last()] else { return true };
            [(from, to), (to, from)].into_iter().all(|(from, to)| steps.has_heading(heading_deg(from.map, to.map)))
        };
        if steps.heading.is_none() || legs.iter().all(has) {
            return Ok(None);
        }
        Ok(Some(Arc::new(overlays.ground(self.whole()?, scenario))))
    }

    /// Its file.
    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// All posts, which the first call reads. Calls at the same time do not wait for each other and may all read: a reader that works in
    /// several threads of the pool must not be waited for by one of them.
    ///
    /// # Errors
    /// As [`DemOptions::read`](crate::terrain::DemOptions::read); the next call tries again.
    pub(super) fn whole(&self) -> Result<Arc<Dem>, TerrainError> {
        if let Some(dem) = self.whole.get() {
            return Ok(Arc::clone(dem));
        }
        let dem = Arc::new(self.reading.options.read(&self.file)?);
        Ok(Arc::clone(self.whole.get_or_init(|| dem)))
    }

    /// The posts around the slice for a hopper; `None` if it has no footprint.
    pub(super) fn around(&self, legs: &[Profile], hopper: &Hopper) -> Result<Option<Arc<Surroundings>>, PipelineError> {
        let Some(footprint_m) = footprint_m(hopper) else { return Ok(None) };
        if let Some((_, read)) = self.read.as_ref().filter(|(of_m, _)| footprint_m <= *of_m) {
            return Ok(Some(Arc::clone(read)));
        }
        let dem = self.reading.options.open(&self.file)?;
        // A footprint beyond the DEM is refused as such, not read.
        let bounds = dem.lattice().bounds();
        let distance_m = footprint_m.min((bounds.max - bounds.min).norm());
        Ok(Some(Arc::new(Surroundings::along(dem.as_ref(), legs, distance_m)?)))
    }
}
