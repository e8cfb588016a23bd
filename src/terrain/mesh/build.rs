//! The builder that all mesh readers use: it scales vertices and divides polygons into triangles.

use nalgebra::Point3;

use super::ears;
use super::faces::{FaceKind, FaceKindsBuilder};
use super::model::{Mesh, normal_of};
use crate::terrain::{NoData, TerrainError};

/// A mesh under construction.
#[derive(Debug)]
pub(super) struct MeshBuilder {
    scale: f64,
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    faces: FaceKindsBuilder,
    /// Number of polygons with more than three corners.
    polygons: usize,
    /// Number of those that are not convex.
    concave: usize,
    /// What the reader left out, one sentence each.
    warnings: Vec<String>,
}

impl MeshBuilder {
    pub(super) fn new(scale: f64) -> Self {
        Self {
            scale,
            vertices: Vec::new(),
            triangles: Vec::new(),
            faces: FaceKindsBuilder::default(),
            polygons: 0,
            concave: 0,
            warnings: Vec::new(),
        }
    }

    /// Adds a vertex in the file's units.
    ///
    /// # Errors
    /// What is wrong with it; the reader adds the position in the file.
    pub(super) fn vertex(&mut self, x: f64, y: f64, z: f64) -> Result<u32, String> {
        if !(x.is_finite() && y.is_finite() && z.is_finite()) {
            return Err(format!("found the vertex ({x}, {y}, {z}), expected three finite numbers"));
        }
        let index = u32::try_from(self.vertices.len()).map_err(|_| "found over 4294967295 vertices, expected fewer".to_owned())?;
        self.vertices.push(Point3::new(x * self.scale, y * self.scale, z * self.scale));
        Ok(index)
    }

    /// The kind of the faces that follow.
    pub(super) fn begin_faces(&mut self, kind: FaceKind) {
        self.faces.begin(kind);
    }

    /// Number of vertices so far.
    pub(super) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Adds a warning for the user.
    pub(super) fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Number of triangles so far.
    pub(super) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Adds a polygon, divided into a fan of triangles from its first corner, or into ears if the fan would fold over itself.
    ///
    /// # Errors
    /// What is wrong with it: fewer than three corners, a vertex that is not defined (yet), or a border that crosses itself.
    pub(super) fn polygon(&mut self, corners: &[u32]) -> Result<(), String> {
        if let Some(corner) = corners.iter().find(|corner| **corner as usize >= self.vertices.len()) {
            return Err(format!("found a face with vertex {}, expected 1 to {}", u64::from(*corner) + 1, self.vertices.len()));
        }
        let [first, middle @ .., _] = corners else {
            return Err("found a face without corners, expected three or more".to_owned());
        };
        if corners.len() < 3 {
            return Err(format!("found a face of {} corners, expected three or more", corners.len()));
        }
        let fan = middle.iter().zip(&corners[2..]).map(|(second, third)| [*first, *second, *third]);
        if corners.len() > 3 {
            self.polygons += 1;
            // All triangles of the fan of a convex polygon have the same orientation.
            let normals: Vec<_> =
                fan.clone().map(|corners| normal_of(corners.map(|corner| self.vertices[corner as usize]))).collect();
            let longest = normals.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
            if let Some(longest) = longest
                && normals.iter().any(|normal| normal.dot(longest) < -1.0e-9 * longest.norm_squared())
            {
                let points: Vec<_> = corners.iter().map(|corner| self.vertices[*corner as usize]).collect();
                let triangles = ears::cut(&points)?;
                self.concave += 1;
                self.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(|at| corners[at])));
                self.faces.fill(self.triangles.len());
                return Ok(());
            }
        }
        self.triangles.extend(fan);
        self.faces.fill(self.triangles.len());
        Ok(())
    }

    /// Removes the triangles that have a corner at a height which marks missing data.
    ///
    /// # Errors
    /// [`TerrainError::InvalidMesh`] if no triangle is left.
    pub(super) fn remove_missing(&mut self, mark: NoData) -> Result<(), TerrainError> {
        let scale = self.scale;
        let missing: Vec<bool> = self.vertices.iter().map(|vertex| mark.is_double(vertex.z / scale)).collect();
        let before = self.triangles.len();
        let known = |corners: &[u32; 3]| corners.iter().all(|corner| !missing[*corner as usize]);
        self.faces.retain(|triangle| known(&self.triangles[triangle]));
        self.triangles.retain(known);
        if self.triangles.is_empty() && before > 0 {
            return Err(TerrainError::InvalidMesh(format!(
                "every triangle of the mesh has a corner at {mark}, which terrain.no_data states as missing, expected triangles of ground; \
                 state another value"
            )));
        }
        // The vertices stay, so that indices stay, but their heights, which no triangle uses, may be beyond all limits.
        self.vertices.iter_mut().zip(&missing).filter(|(_, missing)| **missing).for_each(|(vertex, _)| vertex.z = 0.0);
        Ok(())
    }

    /// The mesh, and warnings for the user.
    pub(super) fn finish(self) -> Result<(Mesh, Vec<String>), TerrainError> {
        let whole = self.triangles.len();
        let mesh = Mesh::with_faces(self.vertices, self.triangles, self.faces.finish())?;
        let mut warnings = self.warnings;
        if self.polygons > 0 {
            warnings.push(format!(
                "{} faces of the mesh have more than three corners and were cut into triangles from their first corner",
                self.polygons
            ));
        }
        if self.concave > 0 {
            warnings.push(format!("{} of these faces are not convex and were cut along diagonals inside them", self.concave));
        }
        if mesh.dropped_triangles() > 0 {
            warnings.push(format!("{} of {whole} triangles of the mesh have no area and were dropped", mesh.dropped_triangles()));
        }
        Ok((mesh, warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> MeshBuilder {
        let mut builder = MeshBuilder::new(2.0);
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.25, 0.25)] {
            builder.vertex(x, y, 0.5).unwrap();
        }
        builder
    }

    #[test]
    fn polygons_become_fans_and_are_counted() {
        let mut builder = square();
        builder.polygon(&[0, 1, 2, 3]).unwrap();
        let (mesh, warnings) = builder.finish().unwrap();
        assert_eq!(mesh.indices(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.vertices()[2], Point3::new(2.0, 2.0, 1.0));
        assert_eq!(
            warnings,
            ["1 faces of the mesh have more than three corners and were cut into triangles from their first corner"]
        );
    }

    #[test]
    fn a_concave_face_is_cut_inside() {
        // An arrow head: from its wing, the fan folds over the notch.
        let mut builder = square();
        builder.polygon(&[3, 0, 1, 4]).unwrap();
        let (mesh, warnings) = builder.finish().unwrap();
        assert_eq!(mesh.indices(), [[4, 3, 0], [0, 1, 4]]);
        assert!(warnings[1].contains("1 of these faces are not convex"), "{warnings:?}");
    }

    #[test]
    fn faces_that_form_no_triangles_are_refused() {
        let mut builder = square();
        assert!(builder.polygon(&[0, 1]).unwrap_err().contains("2 corners"));
        assert!(builder.polygon(&[]).unwrap_err().contains("without corners"));
        assert!(builder.polygon(&[0, 1, 5]).unwrap_err().contains("vertex 6, expected 1 to 5"));
        // A bow tie has no inside.
        assert!(builder.polygon(&[0, 2, 1, 3]).is_err_and(|reason| reason.contains("crosses itself")));
        assert!(builder.vertex(0.0, f64::NAN, 0.0).is_err());
    }
}
