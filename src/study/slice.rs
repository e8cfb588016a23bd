//! Terrain along a vertical plane as a chain.

use std::path::{Path, PathBuf};

use super::{DemReading, Overlays, PipelineError, Transect, on_body, sha256_of};
use crate::{
    chain::{InvalidChain, PolygonalChain},
    quantity::MapPoint,
    report::CrsRecord,
    scenario::Scenario,
    terrain::{MapPlace, MapProjection, Profile, TerrainError, looks_like_mesh},
};

/// A question about a slice.
#[derive(Clone, Debug)]
pub struct SliceQuestion<'a> {
    /// The file of an elevation raster or a mesh.
    pub terrain: &'a Path,
    /// Where the slice begins.
    pub from: MapPlace,
    /// Where it ends.
    pub to: MapPlace,
    /// Where it bends, in the order of travel.
    pub via: Vec<MapPlace>,
    /// Metres per unit of a mesh; `None`: 1, and a raster has no scale.
    pub mesh_scale: Option<f64>,
    /// How the file is read.
    pub reading: DemReading,
    /// The scenario whose friction and keep-out zones are laid over the slice and whose body is compared with it, and the folder that its
    /// paths start from; its own terrain is ignored.
    pub scenario: Option<(&'a Scenario, &'a Path)>,
}

/// Why a question about a slice has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SliceStudyError {
    /// The terrain, its body, or its chain under the overlays.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An overlay.
    #[error(transparent)]
    Overlay(#[from] TerrainError),
    /// The slice does not form a chain.
    #[error(transparent)]
    Chain(#[from] InvalidChain),
    /// Longitude and latitude on a mesh.
    #[error("a mesh has no projection, so that longitude and latitude have no place on it: give positions in metres")]
    LonLatOnMesh,
    /// The scale of a mesh for a raster.
    #[error("{} is an elevation raster, expected a mesh, whose unit a scale of {scale} is for: omit the scale", file.display())]
    ScaleOfRaster {
        /// The raster.
        file: PathBuf,
        /// The scale.
        scale: f64,
    },
}

/// The answer to a question about a slice.
#[derive(Clone, Debug)]
pub struct SliceStudy {
    /// The chain, with friction and zones where a scenario gives them.
    pub chain: PolygonalChain,
    /// The profiles of the legs, without overlays.
    pub legs: Vec<Profile>,
    /// The projection of the map.
    pub projection: Option<MapProjection>,
    /// Where the chain comes from, line by line, for its file.
    pub comments: Vec<String>,
    /// Warnings about the terrain and the overlays.
    pub warnings: Vec<String>,
}

/// Slices an elevation raster or a mesh, and lays a scenario's overlays over it.
///
/// # Errors
/// [`SliceStudyError`].
pub fn slice(question: &SliceQuestion<'_>) -> Result<SliceStudy, SliceStudyError> {
    let (transect, of_extent) = transect(question)?;
    let mut comments = comments(question, &transect)?;
    let Transect { legs, coordinates, projection, extent, warnings: of_terrain, .. } = transect;
    let mut warnings: Vec<String> = of_terrain.into_iter().chain(of_extent).collect();
    let chain = match question.scenario {
        Some((scenario, base)) => {
            for file in Overlays::files(scenario).map(|file| base.join(file)) {
                comments.push(format!("under {}, sha256 {}", name_of(&file), sha256_of(&file)?));
            }
            let overlays = Overlays::read(scenario, base, coordinates.as_ref(), extent.bounds)?;
            let (chain, without_effect) = overlays.chain_with_warnings(legs.clone())?;
            comments.extend(without_effect.iter().map(|warning| format!("warning: {warning}")));
            warnings.extend(without_effect);
            warnings.extend((!scenario.layers.is_empty()).then(|| {
                "the chain has no columns for layers, which a path along it will not obey: plan over the DEM with them".to_owned()
            }));
            chain
        }
        None => PolygonalChain::from_legs(&legs, None)?,
    };
    Ok(SliceStudy { chain, legs, projection, comments, warnings })
}

/// The ground along the slice, and a warning about its extent on the body.
fn transect(question: &SliceQuestion<'_>) -> Result<(Transect, Option<String>), SliceStudyError> {
    let SliceQuestion { terrain, from, to, via, mesh_scale, reading, .. } = question;
    let checked = |read: Result<Transect, TerrainError>| match question.scenario {
        Some((scenario, _)) => Ok(on_body(&scenario.body, read)?),
        None => Ok((read.map_err(PipelineError::from)?, None)),
    };
    let of_mesh = || {
        let between: Option<Vec<MapPoint>> = via.iter().map(MapPlace::metres).collect();
        let (Some(from), Some(to), Some(between)) = (from.metres(), to.metres(), between) else {
            return Err(SliceStudyError::LonLatOnMesh);
        };
        let units = (mesh_scale.unwrap_or(1.0), reading.options.no_data_rule());
        checked(Transect::of_mesh(terrain, units, [from, to], &between))
    };
    if looks_like_mesh(terrain) {
        return of_mesh();
    }
    let transect = match Transect::of_dem(terrain, [from, to], via, *reading) {
        // A damaged mesh is reported by the mesh readers, which know the reason.
        Err(_) if named_as_mesh(terrain) => return of_mesh(),
        transect => checked(transect)?,
    };
    match mesh_scale {
        Some(scale) => Err(SliceStudyError::ScaleOfRaster { file: terrain.to_path_buf(), scale: *scale }),
        None => Ok(transect),
    }
}

/// Whether a file's extension is that of a mesh.
fn named_as_mesh(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["obj", "stl", "ply"].iter().any(|mesh| extension.eq_ignore_ascii_case(mesh))
}

/// Where the chain comes from: the terrain, the ends and bends of the slice, the reference system and the warnings about it.
fn comments(question: &SliceQuestion<'_>, transect: &Transect) -> Result<Vec<String>, PipelineError> {
    let terrain = question.terrain;
    let (version, sha256) = (env!("CARGO_PKG_VERSION"), sha256_of(terrain)?);
    let mut comments = vec![format!("chta {version} slice of {}, sha256 {sha256}", name_of(terrain))];
    comments.push(format!("of {}", transect.size));
    comments.extend(ends(&transect.legs));
    comments.extend(question.via.iter().map(|place| match place {
        MapPlace::Metres(point) => format!("via ({}, {}) m", point.x, point.y),
        MapPlace::LonLat(place) => format!("via longitude {}, latitude {} deg", place.lon_deg, place.lat_deg),
    }));
    comments.extend(transect.projection.as_ref().map(|projection| CrsRecord::from(projection).comments()).unwrap_or_default());
    comments.extend(transect.warnings.iter().map(|warning| format!("warning: {warning}")));
    Ok(comments)
}

/// A file's own name, for a comment.
fn name_of(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The ends of a slice, for its comments.
fn ends(legs: &[Profile]) -> Option<String> {
    let (from, to) = (legs.first()?.points.first()?.map, legs.last()?.points.last()?.map);
    Some(format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y))
}
