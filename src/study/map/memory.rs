//! The memory that a map needs, known before it is computed.

use super::{MapQuestion, MapStudyError};
use crate::{
    ground::DemGround,
    reach::map::{HopMap, LeastTotals, Mobility, NodeLattice, PostHops, PostHopsSize},
    report::{SizeAnswer, SizeRecord},
    uncertainty::Policy,
};

/// What replanning needs beside the maps and the search: the costs-to-go with their map; or the risks-to-go, with one batch of posts that is
/// first found in parts.
const REPLANNING_BYTES_PER_NODE: usize = 32;

/// Upper bounds on the posts, pairs and bytes of a map.
///
/// The bytes are those of the elevations, the tables of the hops, the maps with one layer of the search, and the rasters that are made of
/// the maps. Not counted: the program itself, the file while it is read, the paths to goals (some kilobytes per hop), trials, and pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapMemory {
    /// Posts of the DEM.
    pub posts: usize,
    /// Nodes of the map.
    pub nodes: usize,
    /// Pairs of posts that one hop may join, at most.
    pub pairs_max: u64,
    /// The elevations, bytes.
    pub elevations_bytes: u64,
    /// The tables of the hops and their preparation, bytes.
    pub tables_bytes: u64,
    /// The maps and the search, bytes.
    pub maps_bytes: u64,
    /// The rasters of the maps as they are written, bytes.
    pub rasters_bytes: u64,
}

impl MapMemory {
    /// That of a question over a ground.
    ///
    /// # Errors
    /// [`MapStudyError::Map`], if one hop reaches too many posts.
    pub(super) fn of(question: &MapQuestion<'_>, ground: &DemGround, lattice: NodeLattice) -> Result<Self, MapStudyError> {
        let dem = ground.terrain().dem();
        let posts = dem.rows() * dem.cols();
        let PostHopsSize { nodes, offsets, bytes, preparation_bytes } = PostHops::size(ground, lattice)?;
        let has_many = question.starts.len() > 1;
        let mut of_node = HopMap::bytes_per_node(question.effort, has_many);
        let objective = question.scenario.objective.as_ref();
        if let Some(objective) = objective {
            // The totals, and those of each amount by itself.
            let amounts = objective.amounts().len();
            of_node += LeastTotals::bytes_per_node(amounts, has_many) + amounts * size_of::<f64>();
        }
        // Each amount with what every last hop takes of it.
        of_node += (question.amounts.len() + usize::from(!question.amounts.is_empty())) * size_of::<f64>();
        if question.returns {
            of_node += HopMap::bytes_per_node(false, has_many);
        }
        let mut working = HopMap::search_bytes_per_node();
        if question.mobility {
            of_node += 2 * size_of::<f32>();
            working = working.max(Mobility::working_bytes_per_node());
        }
        if question.trials && question.scenario.uncertainty.as_ref().is_some_and(|keys| keys.policy == Policy::Replan) {
            of_node += REPLANNING_BYTES_PER_NODE;
        }
        // Each raster: its samples, and its file, which is no larger than they are by more than its header.
        let effort = if question.effort { 2 * size_of::<f32>() } else { 0 };
        let returns = if question.returns { size_of::<i16>() } else { 0 };
        let nearest = if has_many { 2 * size_of::<i32>() } else { 0 };
        let mobility = if question.mobility { 2 * size_of::<f32>() } else { 0 };
        let predecessors = if question.predecessors { 2 * size_of::<i32>() } else { 0 };
        let amounts = 2 * size_of::<f32>() * question.amounts.len();
        let of_rasters = size_of::<i16>() + amounts + effort + returns + nearest + mobility + predecessors;
        Ok(Self {
            posts,
            nodes,
            pairs_max: (nodes as u64).saturating_mul(offsets as u64),
            elevations_bytes: dem.elevations_bytes(),
            tables_bytes: bytes.saturating_add(preparation_bytes),
            maps_bytes: (nodes * (of_node + working) + objective.map_or(0, |_| LeastTotals::round_bytes(offsets))) as u64,
            rasters_bytes: (nodes * of_rasters) as u64,
        })
    }

    /// The sum of all bytes.
    pub const fn bytes(&self) -> u64 {
        let Self { elevations_bytes, tables_bytes, maps_bytes, rasters_bytes, .. } = *self;
        elevations_bytes.saturating_add(tables_bytes).saturating_add(maps_bytes).saturating_add(rasters_bytes)
    }

    /// As plain data.
    pub fn answer(&self) -> SizeAnswer {
        let part = |part: &str, bytes_max| SizeRecord { part: part.to_owned(), bytes_max };
        let memory = vec![
            part("elevations", self.elevations_bytes),
            part("tables of the hops", self.tables_bytes),
            part("maps and search", self.maps_bytes),
            part("rasters to write", self.rasters_bytes),
        ];
        SizeAnswer::new([self.posts as u64, self.nodes as u64, self.pairs_max], memory)
    }

    /// Checks it against the most that is allowed.
    ///
    /// # Errors
    /// [`MapStudyError::TooMuchMemory`].
    pub(super) fn check(&self, allowed_bytes: Option<u64>) -> Result<(), MapStudyError> {
        match allowed_bytes {
            Some(allowed_bytes) if self.bytes() > allowed_bytes => {
                let Self { posts, nodes, .. } = *self;
                Err(MapStudyError::TooMuchMemory { needed_bytes: self.bytes(), allowed_bytes, posts, nodes })
            }
            _ => Ok(()),
        }
    }

    /// Checks what a map of these rows and columns needs at least, which is known before its elevations are read.
    ///
    /// # Errors
    /// [`MapStudyError::TooMuchMemory`].
    pub(super) fn check_elevations((rows, cols): (usize, usize), stride: usize, allowed_bytes: u64) -> Result<(), MapStudyError> {
        let stride = stride.max(1);
        let (posts, nodes) = (rows.saturating_mul(cols), rows.div_ceil(stride).saturating_mul(cols.div_ceil(stride)));
        // The facets of every post, and the elevations as 32-bit floats at least.
        let at_least =
            posts.saturating_mul(3 + size_of::<f32>()).saturating_add(nodes.saturating_mul(HopMap::bytes_per_node(false, false)));
        if at_least as u64 > allowed_bytes {
            return Err(MapStudyError::TooMuchMemory { needed_bytes: at_least as u64, allowed_bytes, posts, nodes });
        }
        Ok(())
    }
}
