//! The triangulated surface in memory.

use nalgebra::{Point3, Vector3};

use super::FaceKinds;
use crate::quantity::MapPoint;
use crate::terrain::{ELEVATION_LIMIT_M, MapBounds, TerrainError};

/// The largest absolute x and y of a vertex, m, the same as for map points of a scenario.
const COORDINATE_LIMIT_M: f64 = 1.0e12;

/// A triangle is dropped if its least height is below this fraction of its longest edge: its normal is then undefined in
/// double precision.
const FLATTEST: f64 = 1.0e-12;

/// A surface of triangles, z up, in m. Only the numbers have to be valid: the surface may be open, closed, overhanging or in
/// pieces, and its triangles may have either orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    faces: FaceKinds,
    dropped: usize,
    bounds: MeshBounds,
    median_edge_m: f64,
}

/// The smallest box around a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshBounds {
    /// The rectangle on the map.
    pub map: MapBounds,
    /// Lowest vertex, m.
    pub low_m: f64,
    /// Highest vertex, m.
    pub high_m: f64,
}

impl MeshBounds {
    /// The longest edge of the box, m.
    pub fn size_m(&self) -> f64 {
        (self.map.max - self.map.min).amax().max(self.high_m - self.low_m)
    }
}

impl Mesh {
    /// A mesh from its vertices, m, and its triangles, each three indices of vertices from 0.
    ///
    /// Triangles without area (two vertices at the same position, or three on a line) are dropped and counted.
    ///
    /// # Errors
    /// [`TerrainError::InvalidMesh`] for an index beyond the vertices, for a coordinate that is not finite or too large, and
    /// if no triangle with an area is left.
    ///
    /// # Examples
    /// ```
    /// use chta::terrain::Mesh;
    /// use nalgebra::Point3;
    /// let corners = vec![Point3::new(0.0, 0.0, 0.0), Point3::new(3.0, 0.0, 0.0), Point3::new(0.0, 4.0, 0.0)];
    /// let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 1, 1]])?;
    /// assert_eq!((mesh.triangle_count(), mesh.dropped_triangles(), mesh.median_edge_m()), (1, 1, 4.0));
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn new(vertices: Vec<Point3<f64>>, triangles: Vec<[u32; 3]>) -> Result<Self, TerrainError> {
        Self::with_faces(vertices, triangles, FaceKinds::default())
    }

    /// The same with what is stated of the triangles beside their shape.
    pub(in crate::terrain) fn with_faces(
        vertices: Vec<Point3<f64>>,
        triangles: Vec<[u32; 3]>,
        faces: FaceKinds,
    ) -> Result<Self, TerrainError> {
        let mut mesh = Self { vertices, triangles, faces, dropped: 0, bounds: MeshBounds::EMPTY, median_edge_m: 0.0 };
        mesh.check_numbers()?;
        let whole = mesh.triangles.len();
        let vertices = &mesh.vertices;
        let sound = |corners: &[u32; 3]| has_area(corners.map(|corner| vertices[corner as usize]));
        let triangles = &mesh.triangles;
        mesh.faces.retain(|triangle| sound(&triangles[triangle]));
        mesh.triangles.retain(sound);
        mesh.dropped = whole - mesh.triangles.len();
        if mesh.triangles.is_empty() {
            return Err(TerrainError::InvalidMesh(match whole {
                0 => "the mesh has no faces, expected triangles; export it with its faces, not as points or lines alone".to_owned(),
                _ => format!("all {whole} triangles of the mesh have no area, expected a surface; check the scale of the export"),
            }));
        }
        for corner in mesh.triangles.iter().flatten() {
            mesh.bounds.include(mesh.vertices[*corner as usize]);
        }
        mesh.median_edge_m = mesh.median_of_edges();
        Ok(mesh)
    }

    fn check_numbers(&self) -> Result<(), TerrainError> {
        for (index, vertex) in self.vertices.iter().enumerate() {
            let far = vertex.x.abs().max(vertex.y.abs()) >= COORDINATE_LIMIT_M || vertex.z.abs() >= ELEVATION_LIMIT_M;
            if far || !vertex.iter().all(|coordinate| coordinate.is_finite()) {
                return Err(TerrainError::InvalidMesh(format!(
                    "vertex {} lies at ({}, {}, {}) m, expected finite numbers, x and y within {COORDINATE_LIMIT_M:e} m and z within \
                     {ELEVATION_LIMIT_M:e} m; mend the mesh, or its mesh_scale",
                    index + 1,
                    vertex.x,
                    vertex.y,
                    vertex.z
                )));
            }
        }
        for (index, corners) in self.triangles.iter().enumerate() {
            if let Some(corner) = corners.iter().find(|corner| **corner as usize >= self.vertices.len()) {
                return Err(TerrainError::InvalidMesh(format!(
                    "triangle {} names vertex {}, expected 1 to {}; the file is cut short or was not written as one mesh",
                    index + 1,
                    u64::from(*corner) + 1,
                    self.vertices.len()
                )));
            }
        }
        Ok(())
    }

    /// The median length of the edges; the scale of the geometric tolerances.
    fn median_of_edges(&self) -> f64 {
        let edges = self.triangles().flat_map(|[a, b, c]| [b - a, c - b, a - c]);
        let mut lengths: Vec<f64> = edges.map(|edge| edge.norm()).collect();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The vertices, m, including those without a triangle.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// Indices of the vertices of every triangle.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of every triangle.
    pub fn triangles(&self) -> impl Iterator<Item = [Point3<f64>; 3]> + '_ {
        self.triangles.iter().map(|corners| corners.map(|corner| self.vertices[corner as usize]))
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// What the file states of the triangles beside their shape.
    pub const fn faces(&self) -> &FaceKinds {
        &self.faces
    }

    /// Number of triangles without area that were dropped.
    pub fn dropped_triangles(&self) -> usize {
        self.dropped
    }

    /// The box around the triangles.
    pub fn bounds(&self) -> MeshBounds {
        self.bounds
    }

    /// The median length of the triangles' edges, m.
    pub fn median_edge_m(&self) -> f64 {
        self.median_edge_m
    }
}

/// The normal of a triangle with a length of twice its area, oriented by the order of its corners.
pub(super) fn normal_of([a, b, c]: [Point3<f64>; 3]) -> Vector3<f64> {
    (b - a).cross(&(c - a))
}

fn has_area(corners: [Point3<f64>; 3]) -> bool {
    let [a, b, c] = corners;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    normal_of(corners).norm() > FLATTEST * longest * longest
}

impl MeshBounds {
    const EMPTY: Self = Self {
        map: MapBounds {
            min: MapPoint::new(f64::INFINITY, f64::INFINITY),
            max: MapPoint::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
        },
        low_m: f64::INFINITY,
        high_m: f64::NEG_INFINITY,
    };

    fn include(&mut self, vertex: Point3<f64>) {
        self.map.min = self.map.min.inf(&vertex.xy());
        self.map.max = self.map.max.sup(&vertex.xy());
        self.low_m = self.low_m.min(vertex.z);
        self.high_m = self.high_m.max(vertex.z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Vec<Point3<f64>> {
        vec![Point3::new(0.0, 0.0, 1.0), Point3::new(2.0, 0.0, 1.0), Point3::new(0.0, 1.0, -3.0), Point3::new(1.0, 0.0, 1.0)]
    }

    #[test]
    fn triangles_without_area_are_dropped_and_counted() {
        // A repeated corner, three corners on a line, and a valid triangle.
        let mesh = Mesh::new(corners(), vec![[0, 0, 2], [0, 3, 1], [0, 1, 2]]).unwrap();
        assert_eq!((mesh.indices(), mesh.dropped_triangles()), (&[[0, 1, 2]][..], 2));
        assert_eq!((mesh.bounds().low_m, mesh.bounds().high_m), (-3.0, 1.0));
        assert_eq!((mesh.bounds().map.min, mesh.bounds().map.max), (MapPoint::new(0.0, 0.0), MapPoint::new(2.0, 1.0)));
    }

    #[test]
    fn invalid_meshes_are_refused_with_the_index_of_the_fault() {
        let refusal = |vertices, triangles| Mesh::new(vertices, triangles).unwrap_err().to_string();
        assert!(refusal(corners(), vec![[0, 1, 2], [0, 1, 4]]).contains("triangle 2 names vertex 5, expected 1 to 4"));
        assert!(refusal(corners(), vec![[u32::MAX, 1, 2]]).contains("vertex 4294967296"));
        assert!(refusal(corners(), vec![]).contains("no faces"));
        assert!(refusal(corners(), vec![[0, 1, 3]]).contains("all 1 triangles of the mesh have no area"));
        for bad in [f64::NAN, f64::INFINITY, 1.0e300, -2.0e9] {
            let mut vertices = corners();
            vertices[1].z = bad;
            assert!(refusal(vertices, vec![[0, 1, 2]]).contains("vertex 2 lies at"));
        }
    }
}
