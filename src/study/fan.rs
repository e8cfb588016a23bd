//! How far in how few hops in all directions from one point of a DEM.

use std::path::Path;

use nalgebra::Vector2;

use super::{
    Extremes, Overlays, PipelineError, coarse_dem_warning, constant_gravity_warnings, dem_on_body, free_route::outages_not_counted,
};
use crate::{
    graph::PointSpacing,
    ground::DemGround,
    progress::Progress,
    quantity::{Angle, MapPoint},
    reach::{FanError, FanRay, FanRequest, FanSize, fan_size},
    report::{DeratingRecord, FanAnswer, SizeAnswer, SizeRecord},
    scenario::Scenario,
    terrain::{MapPlace, MapProjection, NoProjection, TerrainError, check_scale},
};

/// The meaning of `auto` here, where there is no single path to refine for.
const POINTS_PER_SEGMENT: PointSpacing = PointSpacing::PerSegment(1);

/// A question about the slices in all directions from a point.
#[derive(Clone, Copy, Debug)]
pub struct FanQuestion<'a> {
    /// The hopper, its body, its ground and the spacing of nodes; the terrain in it is ignored.
    pub scenario: &'a Scenario,
    /// The folder that the scenario's paths start from.
    pub base: &'a Path,
    /// The DEM's file.
    pub dem: &'a Path,
    /// Where all slices begin.
    pub from: MapPlace,
    /// How many there are, equally spaced clockwise from grid north.
    pub headings: u32,
    /// How long they are at most, m.
    pub length_m: f64,
    /// The most memory, bytes, that the fan may need.
    pub memory_max_bytes: Option<u64>,
}

/// Why a question about a fan has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FanStudyError {
    /// The DEM, or its body.
    #[error(transparent)]
    Dem(#[from] PipelineError),
    /// The start, or an overlay.
    #[error(transparent)]
    Place(TerrainError),
    /// The scale of the map along a slice.
    #[error(transparent)]
    Scale(TerrainError),
    /// The slices and their hops.
    #[error(transparent)]
    Fan(#[from] FanError),
    /// More memory than allowed.
    #[error(
        "the fan needs up to {} MiB ({nodes} nodes on all slices), expected at most {} MiB: take shorter slices, a wider spacing of nodes \
         or a part of the DEM (gdal_translate -projwin), or allow more", needed_bytes.div_ceil(1 << 20), allowed_bytes >> 20
    )]
    TooMuchMemory {
        /// The bytes needed at most.
        needed_bytes: u64,
        /// The bytes allowed.
        allowed_bytes: u64,
        /// The nodes of all slices.
        nodes: u64,
    },
}

/// The answer to a question about a fan.
#[derive(Clone, Debug)]
pub struct FanStudy {
    /// The answer.
    pub answer: FanAnswer,
    /// Warnings about the terrain and the hops.
    pub warnings: Vec<String>,
}

/// The terrain of a fan, before its hops are searched.
#[derive(Clone, Debug)]
pub struct PreparedFan {
    ground: DemGround,
    /// The projection of its map, or why it has none.
    pub projection: Result<MapProjection, NoProjection>,
    from: MapPoint,
    spacing: PointSpacing,
    /// Warnings about the terrain, before its overlays.
    pub warnings: Vec<String>,
    of_overlays: Vec<String>,
}

/// Answers a question about a fan.
///
/// The answer does not depend on the number of threads.
///
/// # Errors
/// [`FanStudyError`].
pub fn fan(question: &FanQuestion<'_>, progress: &impl Progress) -> Result<FanStudy, FanStudyError> {
    PreparedFan::new(question)?.answered(question, progress)
}

impl PreparedFan {
    /// Reads the terrain with its overlays and finds the start.
    ///
    /// # Errors
    /// [`FanStudyError`].
    pub fn new(question: &FanQuestion<'_>) -> Result<Self, FanStudyError> {
        let FanQuestion { scenario, base, dem, from, .. } = *question;
        let (dem, warnings) = dem_on_body(scenario, dem)?;
        let projection = dem.georeference().projection();
        let from = from.on_map("from", projection.as_ref(), dem.bounds()).map_err(FanStudyError::Place)?;
        let coordinates = &dem.georeference().coordinate_system;
        let overlays = Overlays::read(scenario, base, Some(coordinates), dem.bounds()).map_err(FanStudyError::Place)?;
        let mut of_overlays = overlays.without_effect_on_dem(dem.bounds());
        of_overlays.extend(coarse_dem_warning(&scenario.hopper, dem.georeference()));
        let spacing = scenario.search.spacing.unwrap_or(POINTS_PER_SEGMENT);
        Ok(Self { ground: overlays.planning_ground(dem, scenario), projection, from, spacing, warnings, of_overlays })
    }

    /// What the slices need, which takes a small part of the time of the answer.
    ///
    /// # Errors
    /// [`FanStudyError::Fan`], as of the answer.
    pub fn size(&self, question: &FanQuestion<'_>, progress: &dyn Progress) -> Result<SizeAnswer, FanStudyError> {
        let size = fan_size(&self.request(question), progress)?;
        let dem = self.ground.terrain().dem();
        let posts = (dem.rows() * dem.cols()) as u64;
        let FanSize { nodes, pairs_max, elevations_bytes, slices_bytes } = size;
        let part = |part: &str, bytes_max| SizeRecord { part: part.to_owned(), bytes_max };
        let memory = vec![part("elevations", elevations_bytes), part("slices and their search, one for each thread", slices_bytes)];
        Ok(SizeAnswer::new([posts, nodes, pairs_max], memory))
    }

    fn request(&self, question: &FanQuestion<'_>) -> FanRequest<'_> {
        let FanQuestion { headings, length_m, .. } = *question;
        FanRequest { ground: &self.ground, from: self.from, headings, length_m, spacing: self.spacing }
    }

    /// Answers the question that the fan was prepared for.
    ///
    /// # Errors
    /// [`FanStudyError`].
    pub fn answered(&self, question: &FanQuestion<'_>, progress: &dyn Progress) -> Result<FanStudy, FanStudyError> {
        if let Some(allowed_bytes) = question.memory_max_bytes {
            let SizeAnswer { bytes_max: needed_bytes, nodes, .. } = self.size(question, progress)?;
            if needed_bytes > allowed_bytes {
                return Err(FanStudyError::TooMuchMemory { needed_bytes, allowed_bytes, nodes });
            }
        }
        let rays = crate::reach::fan(&self.request(question), progress)?;
        let mut warnings = [&self.warnings[..], &self.of_overlays].concat();
        for warning in self.scale_warnings(question, &rays)? {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        // Some hop of the fewest to the end of a band is at least the mean of them.
        let bands = rays.iter().flat_map(|ray| &ray.bands);
        #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
        let range_m = bands.filter_map(|band| Some(band.to_m / band.hops.filter(|hops| *hops > 0)? as f64)).fold(0.0, f64::max);
        warnings.extend(constant_gravity_warnings(&question.scenario.body, Extremes { range_m, ..Extremes::default() }));
        warnings.extend(outages_not_counted(question.scenario));
        warnings.extend(DeratingRecord::of(&question.scenario.derating).map(|derating| derating.sentence()));
        let mut answer = FanAnswer::new(self.from, question.length_m, &rays, self.projection.as_ref().ok());
        match self.spacing {
            PointSpacing::PerSegment(points) => answer.points_per_segment = Some(points),
            PointSpacing::AtMostM(spacing_m) => answer.node_spacing_max_m = Some(spacing_m),
        }
        Ok(FanStudy { answer, warnings })
    }

    /// The warnings about the scale of the map along each slice.
    fn scale_warnings(&self, question: &FanQuestion<'_>, rays: &[FanRay]) -> Result<Vec<String>, FanStudyError> {
        let (dem, accepted) = (self.ground.terrain().dem(), question.scenario.accept_map_scale);
        let mut warnings = Vec::new();
        for ray in rays {
            let heading = Angle::from_degrees(ray.heading_deg).radians();
            let end = self.from + Vector2::new(libm::sin(heading), libm::cos(heading)) * ray.length_m;
            let ends = [self.from, end];
            let scale = check_scale(dem, self.projection.as_ref(), ends, accepted, question.dem).map_err(FanStudyError::Scale)?;
            warnings.extend(scale.warning());
        }
        Ok(warnings)
    }
}
