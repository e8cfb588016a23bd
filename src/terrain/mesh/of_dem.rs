//! Part of a DEM as a mesh: its triangulated ground, for what walks and stands on facets.

use nalgebra::Point3;

use super::Mesh;
use crate::{
    quantity::MapPoint,
    terrain::{Dem, MapBounds, TerrainError},
};

/// The facets of a DEM whose posts lie within a rectangle of its map, and those that cross its border: two for each square, as slices cut them,
/// facing up. A facet with a missing elevation is left out, so the mesh ends where the ground is not known.
///
/// # Errors
/// [`TerrainError`], where no facet is within.
pub fn mesh_of_dem(dem: &Dem, within: MapBounds) -> Result<Mesh, TerrainError> {
    let map = dem.georeference();
    let first = map.north_west();
    // Rounded outwards, by one post more where a coordinate lies on a line of posts.
    let index = |steps: f64, last: usize| -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster")]
        let index = steps.clamp(0.0, f64::from(u32::MAX)) as usize;
        index.min(last)
    };
    let rows = [(first.y - within.max.y) / map.dy_m() - 1.0, (first.y - within.min.y) / map.dy_m() + 2.0];
    let cols = [(within.min.x - first.x) / map.dx_m() - 1.0, (within.max.x - first.x) / map.dx_m() + 2.0];
    let [north, south] = rows.map(|row| index(row, dem.rows() - 1));
    let [west, east] = cols.map(|col| index(col, dem.cols() - 1));
    let across = east - west + 1;
    let mut vertices = Vec::with_capacity((south - north + 1) * across);
    let mut known = Vec::with_capacity(vertices.capacity());
    for row in north..=south {
        for col in west..=east {
            let MapPoint { coords: at, .. } = map.post(row, col);
            let z_m = dem.elevation(row, col);
            known.push(z_m.is_some());
            vertices.push(Point3::new(at.x, at.y, z_m.unwrap_or(0.0)));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..south - north {
        for col in 0..east - west {
            let north_west = row * across + col;
            let (north_east, south_west, south_east) = (north_west + 1, north_west + across, north_west + across + 1);
            for corners in [[north_west, south_west, south_east], [north_west, south_east, north_east]] {
                if corners.iter().all(|corner| known[*corner]) {
                    triangles.push(corners.map(|corner| u32::try_from(corner).unwrap_or(u32::MAX)));
                }
            }
        }
    }
    // Posts without a facet would stretch the bounds.
    let mut numbers = vec![u32::MAX; vertices.len()];
    let mut used = Vec::new();
    for corner in triangles.iter_mut().flatten() {
        let number = &mut numbers[*corner as usize];
        if *number == u32::MAX {
            *number = u32::try_from(used.len()).unwrap_or(u32::MAX);
            used.push(vertices[*corner as usize]);
        }
        *corner = *number;
    }
    Mesh::new(used, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::GeoReference;

    /// A tilted DEM with a hole: every facet has the slope, faces up, and the hole has none.
    #[test]
    fn facets_are_those_of_the_slices_and_stop_at_missing_posts() {
        let z = |row: usize, col: usize| if (row, col) == (2, 3) { f64::NAN } else { 0.5 * f64::from(u8::try_from(col).unwrap()) };
        let heights = (0..6).flat_map(|row| (0..7).map(move |col| z(row, col))).collect();
        let dem = Dem::new(6, 7, heights, GeoReference::local(MapPoint::new(100.0, 50.0), 2.0, 3.0).unwrap()).unwrap();
        let whole = mesh_of_dem(&dem, dem.bounds()).unwrap();
        // Six facets meet at a post.
        assert_eq!(whole.triangle_count(), 2 * 5 * 6 - 6);
        for [a, b, c] in whole.triangles() {
            let normal = (b - a).cross(&(c - a)).normalize();
            assert!((normal.x + 0.25 * normal.z).abs() < 1e-12 && normal.z > 0.0, "{normal}");
        }
        let part = MapBounds { min: MapPoint::new(103.0, 44.0), max: MapPoint::new(103.5, 44.5) };
        let cut = mesh_of_dem(&dem, part).unwrap();
        assert!(cut.triangle_count() < whole.triangle_count());
        assert!(
            cut.triangles().flatten().any(|corner| corner.x <= 103.0) && cut.triangles().flatten().any(|corner| corner.x >= 103.5)
        );
    }
}
