//! Slices a file without reading the whole raster.

use std::path::Path;

use super::Transect;
use super::facet::Ground;
use crate::quantity::MapPoint;
use crate::terrain::window::Part;
use crate::terrain::{DemFile, Profile, TerrainError, Window, open_dem};

/// Number of posts read at once, at most (unless one segment needs more): along a row some thousand columns, along a diagonal
/// a square of 128.
const POSTS_AT_ONCE: usize = 1 << 14;

/// Slices a terrain file with the same result, bit by bit, as [`slice`](super::slice()) for a DEM, but reads only the tiles,
/// strips or lines that the transect crosses if the format allows it ([`open_dem`]).
///
/// # Errors
/// As [`open_dem`] and [`slice`](super::slice()), with the name of the file. Problems of posts off the transect are not
/// detected.
///
/// # Examples
/// ```
/// use chta::quantity::MapPoint;
/// use chta::terrain::{SyntheticTerrain, geotiff_bytes, slice, slice_file, synthesise};
/// let dem = synthesise(&SyntheticTerrain { rows: 40, cols: 60, ..SyntheticTerrain::default() })?;
/// let file = tempfile::NamedTempFile::new().unwrap();
/// std::fs::write(file.path(), geotiff_bytes(&dem)?).unwrap();
/// let (from, to) = (MapPoint::new(2.0, 10.0), MapPoint::new(50.0, 30.0));
/// assert_eq!(slice_file(file.path(), from, to)?, slice(&dem, from, to)?);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn slice_file(path: &Path, from: MapPoint, to: MapPoint) -> Result<Profile, TerrainError> {
    let file = open_dem(path)?;
    slice_parts(file.as_ref(), from, to, POSTS_AT_ONCE).map_err(|error| error.in_file(path))
}

/// Slices an open terrain along a polyline: one slice per leg, from `from` through the points `via` to `to`.
///
/// # Errors
/// As [`slice`](super::slice()), for the first leg with an error; two equal consecutive points give
/// [`TerrainError::SamePoint`].
pub fn slice_legs(file: &dyn DemFile, from: MapPoint, via: &[MapPoint], to: MapPoint) -> Result<Vec<Profile>, TerrainError> {
    let ends = via.iter().copied().chain([to]);
    let begins = [from].into_iter().chain(via.iter().copied());
    begins.zip(ends).map(|(begin, end)| slice_parts(file, begin, end, POSTS_AT_ONCE)).collect()
}

/// Slices window by window along the transect.
pub(super) fn slice_parts(file: &dyn DemFile, from: MapPoint, to: MapPoint, posts_at_once: usize) -> Result<Profile, TerrainError> {
    let nothing = Part::none_of(file);
    let lattice = Ground::of(&nothing);
    let transect = Transect::of(&lattice, from, to)?;
    let mut profile = transect.empty_profile();
    let mut first = 0;
    while first < transect.crossings.len() {
        let (end, window) = next_window(&lattice, &transect, first, posts_at_once);
        let part = Part::of(file, window)?;
        transect.cut(&Ground::of(&part), first, end, &mut profile)?;
        first = end;
    }
    Ok(profile)
}

/// The end of the vertices from `first` on that one window of at most this many posts serves, and that window.
fn next_window(lattice: &Ground<'_>, transect: &Transect, first: usize, posts_at_once: usize) -> (usize, Window) {
    let crossings = &transect.crossings;
    let mut from = first.saturating_sub(1);
    let mut reached = lattice.reach(crossings[from].lattice, crossings[first].lattice);
    let mut end = first + 1;
    while let Some(next) = crossings.get(end) {
        from = end - 1;
        let [low_row, high_row, low_col, high_col] = lattice.reach(crossings[from].lattice, next.lattice);
        let wider = [reached[0].min(low_row), reached[1].max(high_row), reached[2].min(low_col), reached[3].max(high_col)];
        if (wider[1] - wider[0] + 1).saturating_mul(wider[3] - wider[2] + 1) > posts_at_once {
            break;
        }
        reached = wider;
        end += 1;
    }
    let [low_row, high_row, low_col, high_col] = reached;
    (end, Window { first_row: low_row, first_col: low_col, rows: high_row - low_row + 1, cols: high_col - low_col + 1 })
}
