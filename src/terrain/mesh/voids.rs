//! Vertices of a mesh that mark missing data: a triangulated raster whose gaps became pits.

use std::collections::HashMap;

use nalgebra::Point3;

use super::model::Mesh;
use crate::terrain::stored::Scaling;
use crate::terrain::void::{Marks, find_void};
use crate::terrain::{TerrainError, VoidPlace};

/// Refuses a mesh with a block of usual marks that is no ground.
///
/// `scale` is the number of metres per unit of the file: marks are numbers of the file.
///
/// # Errors
/// [`TerrainError::Void`].
pub(super) fn refuse_voids(mesh: &Mesh, scale: f64) -> Result<(), TerrainError> {
    let bounds = mesh.bounds();
    let marks = Marks::within((bounds.low_m, bounds.high_m), Scaling { scale, offset_m: 0.0 });
    if !mesh.vertices().iter().any(|vertex| marks.find(vertex.z).is_some()) {
        return Ok(());
    }
    // STL repeats the vertices of every triangle: equal positions are one vertex, the first of them.
    let mut first_at = HashMap::new();
    let bits = |vertex: &Point3<f64>| [vertex.x, vertex.y, vertex.z].map(f64::to_bits);
    let welded: Vec<usize> =
        mesh.vertices().iter().enumerate().map(|(index, vertex)| *first_at.entry(bits(vertex)).or_insert(index)).collect();
    let mut neighbours: HashMap<usize, Vec<usize>> = HashMap::new();
    for corners in mesh.indices() {
        let [a, b, c] = corners.map(|corner| welded[corner as usize]);
        for (one, other) in [(a, b), (b, c), (c, a)] {
            neighbours.entry(one).or_default().push(other);
            neighbours.entry(other).or_default().push(one);
        }
    }
    // A vertex without a triangle is no ground, so it is a gap.
    let value = |index: usize| if neighbours.contains_key(&index) { mesh.vertices()[index].z } else { f64::NAN };
    let visit_all =
        |index: usize, visit: &mut dyn FnMut(usize)| neighbours.get(&index).into_iter().flatten().for_each(|near| visit(*near));
    let Some(void) = find_void(mesh.vertices().len(), &marks, mesh.median_edge_m(), value, visit_all) else { return Ok(()) };
    Err(void.taken(VoidPlace::Vertex { number: void.first + 1 }))
}
