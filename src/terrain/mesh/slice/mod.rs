//! The exact intersection of a vertical plane with a mesh, and its upper envelope.
//!
//! ```text
//!   z      ___c___                 every triangle that meets the plane gives a segment (cut.rs);
//!         /       \                of several above one another the upper envelope counts (envelope.rs);
//!   --a--/----b----\----d---- x    vertices: edges crossed, and where the uppermost changes; walls get a run (envelope_profile.rs)
//! ```

mod cut;
mod envelope;
mod envelope_profile;

use nalgebra::Vector2;

use self::cut::{Cut, Plane};
use self::envelope::{Side, envelope};
use self::envelope_profile::EnvelopeProfile;
use super::Mesh;
use crate::quantity::MapPoint;
use crate::terrain::{Profile, TerrainError};

/// The run of a segment that replaces a wall, m; at most a quarter of the segment at its foot. It lies on the lower side of
/// the wall, so that the upper envelope is never below the surface and the upper edge does not move.
pub const WALL_RUN_M: f64 = 1.0e-3;

/// Points closer than this many median edges are the same; the plane runs along an edge within this distance.
const SAME_PLACE: f64 = 1.0e-9;

/// A tolerance of this many units in the last place of the largest coordinate is used instead if it is larger.
const RESOLUTION: f64 = 16.0;

/// A step of fewer tolerances in height is not a wall: surfaces that join within the tolerance on a steep slope have such
/// steps.
const NO_WALL: f64 = 100.0;

/// The number of walls that a warning lists.
const WALLS_LISTED: usize = 20;

/// The upper envelope of a mesh along a vertical plane, and where the surface is not a single sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSlice {
    /// The ground, in the form of a DEM's profile.
    pub profile: Profile,
    /// The stretches where the plane meets several surfaces.
    pub layers: Layers,
    /// The jumps of the upper envelope, in the order of travel.
    pub walls: Vec<Wall>,
}

/// The extent of several surfaces one above another along a transect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Number of separate stretches.
    pub places: usize,
    /// Total length of these stretches, m.
    pub length_m: f64,
}

/// A wall: a vertical step of the upper envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Position of its upper edge along the transect, m.
    pub x_m: f64,
    /// Position on the map.
    pub map: MapPoint,
    /// Elevation at its foot, m.
    pub foot_m: f64,
    /// Elevation of its upper edge, m.
    pub top_m: f64,
    /// The run of its segment, on the lower side, m.
    pub run_m: f64,
    /// Whether triangles cover it from foot to top. If not, the upper surface overhangs and nothing can stand on the step:
    /// its segment has a cross-slope of 90 degrees.
    pub closed: bool,
}

/// Intersects a mesh with the vertical plane through two map points and returns its upper envelope.
///
/// Every edge of the upper surface that the plane crosses gives a vertex, and so does every change of the uppermost surface.
/// A segment gets the facet below it, with its normal turned upward; if the plane runs along an edge (within 1e-9 median
/// edges of the mesh, or the resolution of its coordinates), the facet of the edge with the larger cross-slope. A triangle in
/// the plane has 90 degrees. Where the upper envelope jumps, at a wall or at the rim of an overhang, the step becomes a
/// segment of [`WALL_RUN_M`] on its lower side, with the cross-slope of the wall's own triangles; a thin wall on the ground
/// becomes a spike.
///
/// # Units
/// Map coordinates in m; `x_m` is the horizontal distance from `from`.
///
/// # Returns
/// A profile from `from` at x = 0 to `to`. The reversed transect has the same points, facets and walls. A mesh that
/// triangulates a DEM as [`slice`](crate::terrain::slice()) does gives the slice of that DEM.
///
/// # Degenerate
/// Points closer than the tolerance above are merged. A plane that only touches a corner of a triangle does not intersect it.
///
/// # Errors
/// [`TerrainError::SamePoint`]; [`TerrainError::OffTheMap`] for coordinates that are not finite; [`TerrainError::MeshGap`] if
/// the plane meets no triangle over part of the transect.
///
/// # Examples
/// ```
/// use chta::quantity::MapPoint;
/// use chta::terrain::{Mesh, slice_mesh};
/// use nalgebra::Point3;
/// // One triangle; the plane crosses it half-way between its base and its apex, which is 2 m up.
/// let corners = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(4.0, 0.0, 0.0), Point3::new(2.0, 2.0, 2.0)];
/// let mesh = Mesh::new(corners, vec![[0, 1, 2]])?;
/// let slice = slice_mesh(&mesh, MapPoint::new(1.0, 1.0), MapPoint::new(3.0, 1.0))?;
/// assert!(slice.profile.points.iter().all(|point| point.z_m == 1.0));
/// assert!((slice.profile.facets[0].cross_slope.degrees() - 45.0).abs() < 1e-12);
/// assert!(slice_mesh(&mesh, MapPoint::new(0.0, 1.0), MapPoint::new(3.0, 1.0)).is_err(), "no ground from 0 to 1 m");
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn slice_mesh(mesh: &Mesh, from: MapPoint, to: MapPoint) -> Result<MeshSlice, TerrainError> {
    for (which, at) in [("from", from), ("to", to)] {
        if !(at.x.is_finite() && at.y.is_finite()) {
            return Err(TerrainError::OffTheMap { which, at, bounds: mesh.bounds().map });
        }
    }
    // The ends are used in one order for both directions of travel, so that both give the same points.
    let backwards = (to.x, to.y) < (from.x, from.y);
    let (first, last) = if backwards { (to, from) } else { (from, to) };
    let tolerance_m = tolerance_m(mesh, first, last);
    let along = last - first;
    let length_m = libm::hypot(along.x, along.y);
    if length_m.is_nan() || length_m <= 2.0 * tolerance_m {
        return Err(TerrainError::SamePoint { at: from });
    }
    let heading = Vector2::new(along.x / length_m, along.y / length_m);
    let plane = Plane { first, last, heading, length_m, tolerance_m };
    let cut = Cut::new(mesh, &plane);
    let upper = envelope(&cut.segments, Side::Upper, tolerance_m);
    if let Some(gap) = envelope_profile::first_gap(mesh, &upper, &plane, backwards) {
        return Err(gap);
    }
    let lower = envelope(&cut.segments, Side::Lower, tolerance_m);
    let layers = envelope_profile::layers(&cut.segments, &upper, &lower, NO_WALL * tolerance_m);
    let profile = EnvelopeProfile::new(&plane, &cut, &upper, NO_WALL * tolerance_m);
    Ok(profile.oriented(&plane, backwards, layers))
}

/// Points within this distance are the same, m.
fn tolerance_m(mesh: &Mesh, first: MapPoint, last: MapPoint) -> f64 {
    let map = mesh.bounds().map;
    let largest = [map.min, map.max, first, last].iter().map(|point| point.coords.amax()).fold(0.0, f64::max);
    (SAME_PLACE * mesh.median_edge_m()).max(RESOLUTION * f64::EPSILON * largest)
}

impl MeshSlice {
    /// Warnings for users of the profile, one sentence each; empty if the mesh is a single sheet.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let length_m = self.profile.length_m();
        if self.layers.places > 0 {
            warnings.push(format!(
                "the plane meets several surfaces of the mesh one above another in {} places, over {:.3} of {:.3} m ({:.1} %): the \
                 uppermost counts there",
                self.layers.places,
                self.layers.length_m,
                length_m,
                100.0 * self.layers.length_m / length_m
            ));
        }
        if !self.walls.is_empty() {
            let listed: Vec<String> = self.walls.iter().take(WALLS_LISTED).map(ToString::to_string).collect();
            let more = match self.walls.len().saturating_sub(WALLS_LISTED) {
                0 => String::new(),
                more => format!("; and {more} more"),
            };
            warnings.push(format!(
                "the upper surface jumps in {} places; each became a segment of {WALL_RUN_M} m run or less on its lower side: {}{more}",
                self.walls.len(),
                listed.join("; ")
            ));
        }
        warnings
    }
}

impl std::fmt::Display for Wall {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = if self.closed { "wall" } else { "overhang" };
        let Self { x_m, map, foot_m, top_m, .. } = self;
        write!(f, "{kind} of {:.3} m at x = {x_m:.3} m, map ({:.3}, {:.3}), from z = {foot_m:.3} m", top_m - foot_m, map.x, map.y)
    }
}

#[cfg(test)]
mod tests;
