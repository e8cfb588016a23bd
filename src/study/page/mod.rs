//! What a page of an answer holds: its documents, checked against one another, and the ground of their inputs.
//!
//! Documents hold no terrain. It is read from the inputs that they name, whose checksums have to be those of the documents.

mod documents;
mod facets;
mod legs;
mod posts;

use std::path::Path;

pub use documents::{DocumentInPage, PageDocuments};

use self::{
    facets::{cuts_of, page_facets},
    legs::{on_map, pieces_over, places},
    posts::page_posts,
};
use super::{
    Case, LegsRouteError, LegsRouteQuestion, MeshRouteError, ReadBackError, SimulateError, dem_ground::dem_ground,
    legs_ends::legs_ends, mesh_ends::mesh_ends, stance::with_robot,
};
use crate::{
    report::{InputFile, PageGround, ProfilePiece},
    scenario::{Route, Scenario, read_robot},
    terrain::TerrainError,
};

/// Why an answer gives no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// One of the documents.
    #[error("{problem}")]
    Document {
        /// Which of those given, from 0.
        number: usize,
        /// The problem.
        problem: DocumentInPage,
    },
    /// No document with a path.
    #[error("found no document with a path, expected one of plan, run or simulate: give the JSON of one of these commands as well")]
    NoPath,
    /// Inputs that have changed.
    #[error(transparent)]
    Inputs(#[from] ReadBackError),
    /// The raster.
    #[error(transparent)]
    Dem(#[from] SimulateError),
    /// The ground of a leg.
    #[error("the ground under leg {} of the path: {problem}", leg + 1)]
    Leg {
        /// Its index.
        leg: usize,
        /// The problem.
        problem: TerrainError,
    },
    /// The mesh.
    #[error(transparent)]
    Mesh(#[from] MeshRouteError),
    /// The ground of a robot with legs.
    #[error(transparent)]
    Legs(#[from] LegsRouteError),
}

impl PageError {
    /// The document it is about, by its number among those given.
    pub const fn document(&self) -> Option<usize> {
        match self {
            Self::Document { number, .. } => Some(*number),
            _ => None,
        }
    }
}

/// The ground of an answer along a chain or over a DEM.
///
/// `inputs`: the files of the case with their checksums, which have to be those of the documents.
///
/// # Errors
/// [`PageError`].
pub fn page_ground(case: &Case, documents: &PageDocuments, inputs: &[InputFile]) -> Result<PageGround, PageError> {
    documents.check_inputs(inputs)?;
    let legs = places(documents.path());
    let ground = dem_ground(case)?;
    let Some(ground) = ground else {
        return Ok(PageGround { pieces: vec![whole_chain(case)], ..PageGround::default() });
    };
    let overlaid = ground.terrain();
    // A free route is unrolled leg by leg; a transect is one line, whose ground beyond the path says why the path is what it is.
    let pieces = match case.scenario.route {
        Route::Free => pieces_over(overlaid.dem(), &legs)?,
        Route::Transect => vec![whole_chain(case)],
    };
    let (posts, layers) = page_posts(overlaid, &on_map(&legs));
    Ok(PageGround { pieces, posts: Some(posts), layers, ..PageGround::default() })
}

/// The ground of an answer over facets: of a mesh, or of a robot with legs on a mesh or a DEM.
///
/// # Errors
/// [`PageError`].
pub fn page_ground_over_facets(
    (scenario, base): (&Scenario, &Path),
    documents: &PageDocuments,
    inputs: &[InputFile],
) -> Result<PageGround, PageError> {
    documents.check_inputs(inputs)?;
    let legs = places(documents.path());
    let (ground, map) = match &scenario.legs.file {
        None => (mesh_ends(scenario, base, 0.0)?.ground, None),
        Some(file) => {
            LegsRouteQuestion { scenario, base }.of_hops_alone("pages")?;
            let read = read_robot(&base.join(file)).map_err(LegsRouteError::from)?;
            let with_limits = Scenario { hopper: with_robot(&scenario.hopper, &read.robot), ..scenario.clone() };
            let ends = legs_ends(&with_limits, base, &read.robot)?;
            (ends.ground, ends.map)
        }
    };
    if let Some(map) = map {
        let pieces = pieces_over(map.dem(), &legs)?;
        let (posts, layers) = page_posts(&map, &on_map(&legs));
        return Ok(PageGround { pieces, posts: Some(posts), layers, ..PageGround::default() });
    }
    let tree = ground.tree();
    Ok(PageGround { cuts: cuts_of(tree, &legs), facets: Some(page_facets(tree.mesh(), &legs)), ..PageGround::default() })
}

/// The whole chain of a case.
fn whole_chain(case: &Case) -> ProfilePiece {
    let chain = case.prepared.chain.geometry();
    let map = chain.map_points();
    ProfilePiece {
        leg: None,
        x_m: chain.vertices().iter().map(|vertex| drawn(vertex.x_m)).collect(),
        z_m: chain.vertices().iter().map(|vertex| drawn(vertex.z_m)).collect(),
        map_x_m: map.map(|points| points.iter().map(|point| drawn(point.x)).collect()),
        map_y_m: map.map(|points| points.iter().map(|point| drawn(point.y)).collect()),
    }
}

/// A coordinate to a tenth of a millimetre: enough to be drawn, and a third of the bytes.
fn drawn(value_m: f64) -> f64 {
    (value_m * 1.0e4).round() / 1.0e4
}
