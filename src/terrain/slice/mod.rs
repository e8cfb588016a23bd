//! The exact cut of a vertical plane through the triangulated terrain.
//!
//! Every square of four posts is two triangles, split from its north-west to its south-east post. In lattice coordinates (u columns
//! east, v rows south) the terrain's lines are then u = i, v = j and u - v = k for whole i, j, k:
//!
//! ```text
//!   (i, j) o-----o u
//!          | \ n |        n: north-east triangle, u - i >= v - j
//!          | s \ |        s: south-west triangle, u - i <= v - j
//!        v o-----o
//! ```

mod crossings;
mod facet;

use nalgebra::Vector2;

use self::crossings::{Crossing, crossings};
use self::facet::Ground;
use super::{Dem, Profile, ProfilePoint, TerrainError};
use crate::quantity::MapPoint;

/// Cuts the terrain along the straight map line from one point to another.
///
/// Every crossing of a row, column or diagonal of posts is a vertex, even where the slope does not change. At a post the elevation is the
/// post's own; on a line between two posts, the interpolation of those two alone. Each segment takes the facet it lies in; where it runs
/// along an edge (within 1e-9 post spacings at its middle), that of the edge's two facets with the larger cross-slope, which is the
/// steeper one too since both contain the edge. On the DEM's border, and beside a facet without elevations, there is only one.
///
/// # Units
/// Map coordinates in m; `x_m` is the horizontal distance from `from`.
///
/// # Returns
/// A profile from `from` at x = 0 to `to`. The way back has the same points and facets.
///
/// # Degenerate
/// Crossings closer to a post than 1e-9 post spacings (or than the resolution of the map coordinates, where that is coarser) are that
/// post. A transect inside one facet has its two ends only.
///
/// # Errors
/// [`TerrainError::SamePoint`], [`TerrainError::OffTheMap`] (also for coordinates that are not finite), and [`TerrainError::NoData`] with
/// the first place where an elevation is missing.
///
/// # Examples
/// ```
/// use chta::quantity::MapPoint;
/// use chta::terrain::{Dem, GeoReference, slice};
/// // Elevation 1 at the north-east post, 0 at the others.
/// let dem = Dem::new(2, 2, vec![0.0, 1.0, 0.0, 0.0], GeoReference::local(MapPoint::new(0.0, 1.0), 1.0, 1.0)?)?;
/// let profile = slice(&dem, MapPoint::new(0.0, 0.5), MapPoint::new(1.0, 0.5))?;
/// let line: Vec<(f64, f64)> = profile.points.iter().map(|point| (point.x_m, point.z_m)).collect();
/// assert_eq!(line, [(0.0, 0.0), (0.5, 0.0), (1.0, 0.5)]);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn slice(dem: &Dem, from: MapPoint, to: MapPoint) -> Result<Profile, TerrainError> {
    let ground = Ground::of(dem);
    let ends = [ground.lattice(from), ground.lattice(to)];
    for (which, at, lattice) in [("from", from, ends[0]), ("to", to, ends[1])] {
        if !ground.covers(lattice) {
            return Err(TerrainError::OffTheMap { which, at, bounds: dem.bounds() });
        }
    }
    let along = to - from;
    let length_m = libm::hypot(along.x, along.y);
    if length_m < f64::MIN_POSITIVE || ends[0] == ends[1] {
        return Err(TerrainError::SamePoint { at: from });
    }
    let heading = Vector2::new(along.x / length_m, along.y / length_m);
    let crossings = crossings(&ground, from, to, length_m);
    let mut points: Vec<ProfilePoint> = Vec::with_capacity(crossings.len());
    let mut facets = Vec::with_capacity(crossings.len());
    let mut previous: Option<&Crossing> = None;
    for crossing in &crossings {
        if let Some(begin) = previous {
            let middle = (begin.lattice + crossing.lattice) * 0.5;
            let missing = || TerrainError::NoData {
                at: nalgebra::center(&begin.map, &crossing.map),
                distance_m: 0.5 * (begin.x_m + crossing.x_m),
            };
            facets.push(ground.facet(middle, heading).ok_or_else(missing)?);
        }
        let z_m = ground.elevation(crossing.lattice).ok_or(TerrainError::NoData { at: crossing.map, distance_m: crossing.x_m })?;
        points.push(ProfilePoint { x_m: crossing.x_m, z_m, map: crossing.map });
        previous = Some(crossing);
    }
    Ok(Profile { points, facets, heading })
}

/// Cuts the terrain along a polyline: one slice for each leg, from `from` over the points between to `to`.
///
/// # Errors
/// As [`slice`](slice()), of the first leg that has one; two equal points in a row are [`TerrainError::SamePoint`].
pub fn slice_legs(dem: &Dem, from: MapPoint, via: &[MapPoint], to: MapPoint) -> Result<Vec<Profile>, TerrainError> {
    let ends = via.iter().copied().chain([to]);
    let begins = [from].into_iter().chain(via.iter().copied());
    begins.zip(ends).map(|(begin, end)| slice(dem, begin, end)).collect()
}

#[cfg(test)]
mod tests;
