//! The exact intersection of a vertical plane with the triangulated terrain.
//!
//! Every square of four posts consists of two triangles, divided from its north-west to its south-east post. In lattice
//! coordinates (u columns east, v rows south) the edges are u = i, v = j and u - v = k for integers i, j, k:
//!
//! ```text
//!   (i, j) o-----o u
//!          | \ n |        n: north-east triangle, u - i >= v - j
//!          | s \ |        s: south-west triangle, u - i <= v - j
//!        v o-----o
//! ```

mod crossings;
mod facet;
mod from_file;

use nalgebra::Vector2;

use self::crossings::{Crossing, crossings};
use self::facet::Ground;
pub use self::from_file::{slice_file, slice_legs};
use super::{Dem, Profile, ProfilePoint, TerrainError};
use crate::quantity::MapPoint;

/// Slices the terrain along the straight map line from one point to another.
///
/// Every crossing of a row, column or diagonal of posts is a vertex, even if the slope does not change. At a post the
/// elevation is that of the post; on a line between two posts it is interpolated from these two alone. Each segment gets the
/// facet that contains it. A segment along an edge (within 1e-9 post spacings at its middle) gets that of the two adjacent
/// facets with the larger cross-slope, which is also the steeper one since both contain the edge. On the DEM's border, and
/// next to a facet without elevations, there is only one.
///
/// # Units
/// Map coordinates in m; `x_m` is the horizontal distance from `from`.
///
/// # Returns
/// A profile from `from` at x = 0 to `to`. The reversed transect has the same points and facets.
///
/// # Degenerate
/// Crossings closer to a post than 1e-9 post spacings (or than the resolution of the map coordinates, if that is larger) are
/// moved to that post. A transect inside one facet has only its two ends as vertices.
///
/// # Errors
/// [`TerrainError::SamePoint`]; [`TerrainError::OffTheMap`] (also for coordinates that are not finite);
/// [`TerrainError::NoData`] with the first position where an elevation is missing.
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
    let transect = Transect::of(&ground, from, to)?;
    let mut profile = transect.empty_profile();
    transect.cut(&ground, 0, transect.crossings.len(), &mut profile)?;
    Ok(profile)
}

/// The straight line between two map points, with its vertices on the lattice.
struct Transect {
    crossings: Vec<Crossing>,
    heading: Vector2<f64>,
}

impl Transect {
    fn of(ground: &Ground<'_>, from: MapPoint, to: MapPoint) -> Result<Self, TerrainError> {
        let ends = [ground.lattice(from), ground.lattice(to)];
        for (which, at, lattice) in [("from", from, ends[0]), ("to", to, ends[1])] {
            if !ground.covers(lattice) {
                return Err(TerrainError::OffTheMap { which, at, bounds: ground.bounds() });
            }
        }
        let along = to - from;
        let length_m = libm::hypot(along.x, along.y);
        if length_m < f64::MIN_POSITIVE || ends[0] == ends[1] {
            return Err(TerrainError::SamePoint { at: from });
        }
        let heading = Vector2::new(along.x / length_m, along.y / length_m);
        Ok(Self { crossings: crossings(ground, from, to, length_m), heading })
    }

    fn empty_profile(&self) -> Profile {
        let vertices = self.crossings.len();
        Profile { points: Vec::with_capacity(vertices), facets: Vec::with_capacity(vertices), heading: self.heading }
    }

    /// Adds the vertices `first..end` and the segments that end at them; the first vertex of the transect ends no segment.
    fn cut(&self, ground: &Ground<'_>, first: usize, end: usize, profile: &mut Profile) -> Result<(), TerrainError> {
        let mut previous = first.checked_sub(1).and_then(|before| self.crossings.get(before));
        for crossing in &self.crossings[first..end] {
            if let Some(begin) = previous {
                let middle = (begin.lattice + crossing.lattice) * 0.5;
                let missing = || TerrainError::NoData {
                    at: nalgebra::center(&begin.map, &crossing.map),
                    distance_m: 0.5 * (begin.x_m + crossing.x_m),
                };
                profile.facets.push(ground.facet(middle, self.heading).ok_or_else(missing)?);
            }
            let missing = TerrainError::NoData { at: crossing.map, distance_m: crossing.x_m };
            let z_m = ground.elevation(crossing.lattice).ok_or(missing)?;
            profile.points.push(ProfilePoint { x_m: crossing.x_m, z_m, map: crossing.map });
            previous = Some(crossing);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
