//! The exact hop test of a pair, by its slice, where fast arithmetic does not decide.

use super::{Lofts, MapError, Post, PostHops, offsets::Offset};
use crate::{
    chain::ConstrainedChain,
    ground::{DemGround, SliceProblem, dem::end_to_end},
    terrain::TerrainError,
};

impl PostHops {
    /// The lofts of a hop by the slice and the hop test.
    #[cold]
    pub(super) fn exact(&self, from: Post, offset: &Offset) -> Result<Option<Lofts>, MapError> {
        let Some(to) = self.moved(from, offset.rows, offset.cols) else { return Ok(None) };
        let Some(chain) = self.chain(from, to)? else { return Ok(None) };
        Ok(end_to_end(chain).and_then(|(sight, lofts)| Some((sight, lofts?))))
    }

    /// The slice between two nodes with its constraints; `None` if an elevation on the line is missing.
    ///
    /// # Errors
    /// [`MapError::Ground`] and [`MapError::Terrain`].
    pub fn chain(&self, from: Post, to: Post) -> Result<Option<ConstrainedChain>, MapError> {
        let map = self.ground().terrain().dem().georeference();
        let [begin, end] = [from, to].map(|node| self.lattice().at(map, node));
        match self.ground().chain(begin, end) {
            Ok(chain) => Ok(Some(chain)),
            Err(SliceProblem::Terrain(TerrainError::NoData { .. })) => Ok(None),
            Err(reason) => Err(MapError::Ground { at: begin, reason: Box::new(reason) }),
        }
    }
}

/// Resolves the constraints of one slice, so that missing ones are reported before the search begins.
pub(super) fn probe(ground: &DemGround) -> Result<(), MapError> {
    let dem = ground.terrain().dem();
    let gap = |row: usize, col: usize| dem.elevation(row, col).is_none();
    let square = (0..dem.rows() - 1)
        .flat_map(|row| (0..dem.cols() - 1).map(move |col| (row, col)))
        .find(|&(row, col)| !(gap(row, col) || gap(row, col + 1) || gap(row + 1, col + 1)));
    let Some((row, col)) = square else { return Ok(()) };
    let (begin, end) = (dem.georeference().post(row, col), dem.georeference().post(row + 1, col + 1));
    ground.chain(begin, end).map(drop).map_err(|reason| MapError::Ground { at: begin, reason: Box::new(reason) })
}
