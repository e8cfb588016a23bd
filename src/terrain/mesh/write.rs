//! Meshes as files: OBJ, binary STL and text PLY.

use std::{fmt::Write as _, path::Path};

use super::{FaceKind, Mesh, model::normal_of};
use crate::world::{FrictionCone, RestSlope};

/// The formats that meshes are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormatWritten {
    /// Wavefront OBJ, with names of groups.
    Obj,
    /// Binary STL: 32-bit floats, shapes alone.
    Stl,
    /// Text PLY, with what is stated of the surface of faces.
    Ply,
}

impl MeshFormatWritten {
    /// That of the extension of a path, in letters of any case; `None` for another one.
    pub fn of_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            _ => None,
        }
    }
}

/// A mesh as a file. OBJ and PLY hold every coordinate exactly; STL rounds to 32-bit floats.
///
/// # Examples
/// ```
/// use chta::terrain::{MeshFormatWritten, mesh_bytes, read_mesh_bytes};
/// let mesh = read_mesh_bytes(b"g rock\nv 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n", 1.0)?.mesh;
/// assert_eq!(read_mesh_bytes(&mesh_bytes(&mesh, MeshFormatWritten::Obj), 1.0)?.mesh, mesh);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn mesh_bytes(mesh: &Mesh, format: MeshFormatWritten) -> Vec<u8> {
    match format {
        MeshFormatWritten::Obj => obj(mesh).into_bytes(),
        MeshFormatWritten::Stl => stl(mesh),
        MeshFormatWritten::Ply => ply(mesh).into_bytes(),
    }
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for corner in mesh.vertices() {
        let _ = writeln!(text, "v {} {} {}", corner.x, corner.y, corner.z);
    }
    let faces = mesh.faces();
    let mut current = 0;
    for (triangle, [a, b, c]) in mesh.indices().iter().enumerate() {
        let kind = faces.of(triangle);
        if kind != current {
            let _ = writeln!(text, "g {}", faces.kinds()[kind].names.join(" "));
            current = kind;
        }
        let _ = writeln!(text, "f {} {} {}", u64::from(*a) + 1, u64::from(*b) + 1, u64::from(*c) + 1);
    }
    text
}

#[expect(clippy::cast_possible_truncation, reason = "the format holds 32-bit floats")]
fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    let title = b"chta";
    bytes[..title.len()].copy_from_slice(title);
    bytes.extend(u32::try_from(mesh.triangle_count()).unwrap_or(u32::MAX).to_le_bytes());
    for corners in mesh.triangles() {
        let normal = normal_of(corners).normalize();
        let vectors = std::iter::once(normal).chain(corners.map(|corner| corner.coords));
        bytes.extend(vectors.flat_map(|vector| [vector.x, vector.y, vector.z]).flat_map(|number| (number as f32).to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

fn ply(mesh: &Mesh) -> String {
    let faces = mesh.faces();
    let states_surface = !faces.are_bare();
    let mut text = String::from("ply\nformat ascii 1.0\ncomment chta\n");
    let _ = writeln!(
        text,
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\n\
         property list uchar uint vertex_indices",
        mesh.vertices().len(),
        mesh.triangle_count()
    );
    if states_surface {
        text.push_str("property double friction_coefficient\nproperty double rest_slope_max_deg\nproperty uchar keep_out\n");
    }
    text.push_str("end_header\n");
    for corner in mesh.vertices() {
        let _ = writeln!(text, "{} {} {}", corner.x, corner.y, corner.z);
    }
    for (triangle, [a, b, c]) in mesh.indices().iter().enumerate() {
        let _ = write!(text, "3 {a} {b} {c}");
        if states_surface {
            let FaceKind { stated, .. } = &faces.kinds()[faces.of(triangle)];
            let rest_deg = match stated.rest {
                Some(RestSlope::AtMost(angle)) => angle.written_degrees(),
                Some(RestSlope::Unlimited) => f64::INFINITY,
                Some(RestSlope::AsFrictionHolds) | None => f64::NAN,
            };
            let friction = stated.friction.map_or(f64::NAN, FrictionCone::coefficient);
            let _ = write!(text, " {friction} {rest_deg} {}", u8::from(stated.keep_out));
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::read_mesh_bytes;

    #[test]
    fn what_is_written_reads_back() {
        let grouped = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.1 0.2 1\ng rock\nf 1 3 2\nf 1 2 4\ng sand rock\nf 1 4 3\nf 2 3 4\n";
        let mesh = read_mesh_bytes(grouped.as_bytes(), 1.0).unwrap().mesh;
        let again = |format| read_mesh_bytes(&mesh_bytes(&mesh, format), 1.0).unwrap().mesh;
        assert_eq!(again(MeshFormatWritten::Obj), mesh);
        assert_eq!(again(MeshFormatWritten::Ply).indices(), mesh.indices());
        let of_stl: Vec<_> = again(MeshFormatWritten::Stl).triangles().collect();
        for (one, other) in of_stl.iter().flatten().zip(mesh.triangles().flatten().collect::<Vec<_>>()) {
            assert!((one - other).norm() < 1e-7);
        }
        let surfaces = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
            element face 2\nproperty list uchar int vertex_indices\nproperty float friction\nproperty float rest_slope_max_deg\n\
            property uchar keep_out\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 inf 0\n3 0 2 1 nan 30 1\n";
        let mesh = read_mesh_bytes(surfaces.as_bytes(), 1.0).unwrap().mesh;
        assert_eq!(read_mesh_bytes(&mesh_bytes(&mesh, MeshFormatWritten::Ply), 1.0).unwrap().mesh, mesh);
        let stated: Vec<_> = (0..2).map(|triangle| mesh.faces().kinds()[mesh.faces().of(triangle)].stated).collect();
        assert_eq!((stated[0].friction, stated[0].rest), (FrictionCone::new(0.5).ok(), Some(RestSlope::Unlimited)));
        assert!(stated[1].keep_out && stated[1].friction.is_none(), "{stated:?}");
        for (bad, said) in [("0.5 inf 0", "-0.5 inf 0"), ("nan 30 1", "nan 95 1"), ("nan 30 1", "nan 30 2")].map(|(from, to)| {
            (surfaces.replace(from, to), ["friction coefficient -0.5", "rest_slope_max_deg of 95", "keep_out of 2"])
        }) {
            let message = read_mesh_bytes(bad.as_bytes(), 1.0).unwrap_err().to_string();
            assert!(message.contains("face") && said.iter().any(|said| message.contains(said)), "{message}");
        }
    }
}
