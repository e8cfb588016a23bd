//! The slice and the hop test on a pair, where quick arithmetic does not decide.

use super::{GroundOf, Lofts, PostHops};
use crate::{
    chain::ConstrainedChain,
    hop::HopTest,
    quantity::VertexId,
    reach::map::{MapError, MapRequest, lattice::Post, offsets::Offset},
    terrain::{TerrainError, slice},
};

impl PostHops<'_> {
    /// The slice and the hop test themselves.
    #[cold]
    pub(super) fn exact(&self, from: Post, offset: &Offset) -> Result<Option<Lofts>, MapError> {
        let Some(to) = self.moved(from, offset.rows, offset.cols) else { return Ok(None) };
        let Some(chain) = self.chain(from, to)? else { return Ok(None) };
        let test = HopTest::new(chain);
        let geometry = test.chain().geometry();
        let (start, end) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        Ok(test.line_of_sight(&start, &end).zip(test.lofts(&start, &end).ok()))
    }

    /// The slice between two nodes with its constraints; `None` where an elevation is missing on the way.
    ///
    /// # Errors
    /// [`MapError::Ground`] and [`MapError::Terrain`].
    pub fn chain(&self, from: Post, to: Post) -> Result<Option<ConstrainedChain>, MapError> {
        let map = self.request.dem.georeference();
        let [begin, end] = [from, to].map(|node| {
            let Post { row, col } = self.lattice.post(node);
            map.post(row, col)
        });
        let profile = match slice(self.request.dem, begin, end) {
            Ok(profile) => profile,
            Err(TerrainError::NoData { .. }) => return Ok(None),
            Err(other) => return Err(other.into()),
        };
        (self.ground_of)(profile).map(Some).map_err(|reason| MapError::Ground { at: begin, reason })
    }
}

/// Tries the constraints on one slice, so that what is missing is told before the work begins.
pub(super) fn probe(request: &MapRequest<'_>, ground_of: &GroundOf<'_>) -> Result<(), MapError> {
    let dem = request.dem;
    let gap = |row: usize, col: usize| dem.elevation(row, col).is_none();
    let place = (0..dem.rows() - 1)
        .flat_map(|row| (0..dem.cols() - 1).map(move |col| (row, col)))
        .find(|&(row, col)| !(gap(row, col) || gap(row, col + 1) || gap(row + 1, col + 1)));
    let Some((row, col)) = place else { return Ok(()) };
    let (begin, end) = (dem.georeference().post(row, col), dem.georeference().post(row + 1, col + 1));
    let profile = slice(dem, begin, end)?;
    ground_of(profile).map(drop).map_err(|reason| MapError::Ground { at: begin, reason })
}
