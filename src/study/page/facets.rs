//! The facets of a mesh for a page, and the cuts of the planes of its legs.

use std::ops::ControlFlow;

use nalgebra::Point3;

use super::{drawn, legs::Place};
use crate::{
    quantity::ChainPoint,
    report::{PageFacets, ProfileCut},
    terrain::{Mesh, MeshTree, VerticalPlane},
};

/// The most facets of a page: some 0.8 MB of base64.
const FACETS_MAX: usize = 30_000;

/// The facets nearest to the path, all of a small mesh.
pub(super) fn page_facets(mesh: &Mesh, legs: &[Vec<Place>]) -> PageFacets {
    let corners = mesh.indices();
    let mut kept: Vec<usize> = (0..corners.len()).collect();
    if kept.len() > FACETS_MAX {
        let path: Vec<Point3<f64>> = legs.iter().flatten().map(|place| Point3::new(place.at.x, place.at.y, place.z_m)).collect();
        let middle = |facet: &[Point3<f64>; 3]| Point3::from((facet[0].coords + facet[1].coords + facet[2].coords) / 3.0);
        let away =
            |facet: [Point3<f64>; 3]| path.iter().map(|at| (middle(&facet) - at).norm_squared()).fold(f64::INFINITY, f64::min);
        let distances: Vec<f64> = mesh.triangles().map(away).collect();
        kept.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]).then(a.cmp(&b)));
        kept.truncate(FACETS_MAX);
        kept.sort_unstable();
    }
    let bounds = mesh.bounds();
    let low = Point3::new(bounds.map.min.x, bounds.map.min.y, bounds.low_m);
    let mut numbers = vec![None; mesh.vertices().len()];
    let (mut vertices, mut of_page) = (Vec::new(), Vec::with_capacity(3 * kept.len()));
    for facet in kept {
        for &corner in &corners[facet] {
            let at = mesh.vertices()[corner as usize] - low;
            let next = u32::try_from(vertices.len() / 3).unwrap_or(u32::MAX);
            of_page.push(*numbers[corner as usize].get_or_insert_with(|| {
                #[expect(clippy::cast_possible_truncation, reason = "drawn in single precision, from the corner of the mesh")]
                vertices.extend([at.x as f32, at.y as f32, at.z as f32]);
                next
            }));
        }
    }
    PageFacets {
        origin_m: low.coords.into(),
        vertices,
        corners_count: of_page.len(),
        corners: of_page,
        of_facets: mesh.triangle_count(),
    }
}

/// The cuts of the mesh between the ends of every leg.
pub(super) fn cuts_of(tree: &MeshTree, legs: &[Vec<Place>]) -> Vec<ProfileCut> {
    legs.iter()
        .enumerate()
        .filter_map(|(leg, places)| {
            let [from, .., to] = places.as_slice() else { return None };
            let along = to.at - from.at;
            let heading = along.try_normalize(0.0)?;
            let plane = VerticalPlane { origin: Point3::new(from.at.x, from.at.y, from.z_m), heading };
            let length_m = along.norm();
            let mut segments_m = Vec::new();
            let _ = tree.cut(
                &plane,
                |[low, high]| high.x_m >= 0.0 && low.x_m <= length_m,
                |_, ends| {
                    if let Some([a, b]) = clipped(ends, length_m) {
                        segments_m.push([a.x_m, from.z_m + a.z_m, b.x_m, from.z_m + b.z_m].map(drawn));
                    }
                    ControlFlow::Continue(())
                },
            );
            // Leaves of the tree come in no particular order; pages of one answer are the same bytes.
            segments_m.sort_by(|a, b| {
                a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
            });
            Some(ProfileCut { leg, segments_m })
        })
        .collect()
}

/// The part of a segment between x = 0 and the length of a leg.
fn clipped([a, b]: [ChainPoint; 2], length_m: f64) -> Option<[ChainPoint; 2]> {
    let [a, b] = if a.x_m <= b.x_m { [a, b] } else { [b, a] };
    if b.x_m < 0.0 || a.x_m > length_m {
        return None;
    }
    let at = |x_m: f64| {
        let share = if b.x_m > a.x_m { (x_m - a.x_m) / (b.x_m - a.x_m) } else { 0.0 };
        ChainPoint::new(x_m, a.z_m + share * (b.z_m - a.z_m))
    };
    let start = if a.x_m < 0.0 { at(0.0) } else { a };
    let end = if b.x_m > length_m { at(length_m) } else { b };
    Some([start, end])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::MapPoint;

    /// A floor and a roof over it, each of two triangles, from (0, 0) to (10, 10).
    fn room() -> Mesh {
        let sheet = |z: f64| [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| Point3::new(x, y, z));
        let vertices = [sheet(0.0), sheet(4.0)].concat();
        Mesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]).unwrap()
    }

    #[test]
    fn the_cut_of_a_leg_has_floor_and_roof_between_its_ends() {
        let place = |x: f64, y: f64| Place { at: MapPoint::new(x, y), z_m: 0.0 };
        let cuts = cuts_of(&MeshTree::new(room()), &[vec![place(2.0, 5.0), place(8.0, 5.0)]]);
        let length_at = |z_m: f64| -> f64 {
            cuts[0].segments_m.iter().filter(|[_, za, _, zb]| (*za, *zb) == (z_m, z_m)).map(|[a, _, b, _]| b - a).sum()
        };
        assert_eq!((cuts.len(), length_at(0.0), length_at(4.0)), (1, 6.0, 6.0));
    }

    #[test]
    fn a_small_mesh_is_there_as_a_whole() {
        let facets = page_facets(&room(), &[]);
        assert_eq!((facets.vertices.len(), facets.corners_count, facets.of_facets), (24, 12, 4));
        assert_eq!(facets.corners[..3], [0, 1, 2]);
    }
}
