//! The mesh formats, recognised by content.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use super::build::MeshBuilder;
use super::{Mesh, obj, ply, stl, voids};
use crate::terrain::{NoDataRule, TerrainError, foreign, without_mark};

/// Number of bytes of a file that are examined to recognise a mesh: comments may precede the first statement.
const PROBE_BYTES: u64 = 1 << 16;

/// Names of the formats and one line about each, for help texts.
pub const MESH_FORMATS: [(&str, &str); 3] = [
    ("OBJ", "vertices and polygons, z up, with names of groups, objects and materials; normals and texture are not used"),
    ("STL", "binary or ASCII, z up"),
    (
        "PLY",
        "ascii, binary_little_endian or binary_big_endian, elements vertex (x, y, z) and face (with friction_coefficient, rest_slope_max_deg, keep_out), z up",
    ),
];

/// A mesh with the warnings of its reader.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The surface.
    pub mesh: Mesh,
    /// What was dropped or divided, one sentence each.
    pub warnings: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MeshFormat {
    Obj,
    BinaryStl,
    AsciiStl,
    Ply,
}

impl MeshFormat {
    /// The format of a file with this beginning and length. The title of a binary STL may begin with `solid`, so it is tested
    /// first.
    fn of(beginning: &[u8], length: u64) -> Option<Self> {
        let text = without_mark(beginning);
        if ply::recognises(text) {
            Some(Self::Ply)
        } else if !is_raster(beginning) && stl::recognises_binary(beginning, length) {
            Some(Self::BinaryStl)
        } else if stl::recognises_ascii(text) {
            Some(Self::AsciiStl)
        } else if obj::recognises(text) {
            Some(Self::Obj)
        } else {
            None
        }
    }
}

/// The name of the format of a file with this beginning and length, and whether it is text.
pub(crate) fn format_name(beginning: &[u8], length: u64) -> Option<(&'static str, bool)> {
    Some(match MeshFormat::of(beginning, length)? {
        MeshFormat::Obj => ("OBJ", true),
        MeshFormat::BinaryStl => ("STL", false),
        MeshFormat::AsciiStl => ("STL", true),
        MeshFormat::Ply => ("PLY", beginning.windows(12).take(200).any(|window| window == b"format ascii")),
    })
}

/// The length that a binary STL with this header has, bytes, if its first triangles are sane: junk of any length has a number where
/// an STL has the count of its triangles.
pub(crate) fn binary_stl_length(beginning: &[u8]) -> Option<u64> {
    let length = stl::binary_length(beginning)?;
    let first = beginning.get(stl::HEADER_BYTES..)?.chunks_exact(50).take(20);
    let sane = |number: &[u8]| {
        let number = f32::from_le_bytes([number[0], number[1], number[2], number[3]]);
        number == 0.0 || (1e-20..1e12).contains(&number.abs())
    };
    let all_sane = first.flat_map(|triangle| triangle[..48].chunks_exact(4)).all(sane);
    (length > stl::HEADER_BYTES as u64 && all_sane).then_some(length)
}

/// Whether a file begins like a raster or another known format, whose numbers must not be taken for triangles.
fn is_raster(beginning: &[u8]) -> bool {
    [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| beginning.starts_with(magic))
        || foreign::name(beginning).is_some()
}

/// Whether a file is a mesh by its content; false if it cannot be read.
pub fn looks_like_mesh(path: &Path) -> bool {
    let Ok(file) = File::open(path) else { return false };
    let Ok(length) = file.metadata().map(|metadata| metadata.len()) else { return false };
    let mut beginning = Vec::new();
    file.take(PROBE_BYTES).read_to_end(&mut beginning).is_ok() && MeshFormat::of(&beginning, length).is_some()
}

/// Reads a mesh file with any extension. `scale` is the number of metres per unit of the file.
///
/// # Errors
/// [`TerrainError::InFile`] with the cause: the file cannot be read, has no known format, is damaged, or holds no valid
/// surface.
pub fn read_mesh(path: &Path, scale: f64) -> Result<MeshFile, TerrainError> {
    read_mesh_with(path, scale, NoDataRule::AsStated)
}

/// Reads a mesh file as [`read_mesh`], with a rule for heights, in the file's unit, that mark missing data: triangles at a stated
/// mark are left out.
///
/// # Errors
/// As [`read_mesh`], and [`TerrainError::Void`] for a usual mark that is not stated and is no ground.
pub fn read_mesh_with(path: &Path, scale: f64, no_data: NoDataRule) -> Result<MeshFile, TerrainError> {
    let bytes = fs::read(path).map_err(|error| TerrainError::reading(error).in_file(path))?;
    read_bytes(&bytes, scale, no_data).map_err(|error| error.in_file(path))
}

/// Reads a whole mesh file from memory. Memory use is a small multiple of its length, whatever counts the file declares.
///
/// # Errors
/// [`TerrainError`] with what was found, what was expected, and how to correct it; also if the scale is not a finite number
/// above 0.
///
/// # Examples
/// ```
/// use chta::terrain::read_mesh_bytes;
/// // A shape in kilometres.
/// let file = read_mesh_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n", 1000.0)?;
/// assert_eq!((file.mesh.bounds().high_m, file.warnings.len()), (500.0, 0));
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn read_mesh_bytes(bytes: &[u8], scale: f64) -> Result<MeshFile, TerrainError> {
    read_bytes(bytes, scale, NoDataRule::AsStated)
}

fn read_bytes(bytes: &[u8], scale: f64, no_data: NoDataRule) -> Result<MeshFile, TerrainError> {
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(TerrainError::InvalidMesh(format!("mesh_scale is {scale}, expected metres per unit of the file, more than 0")));
    }
    let mut builder = MeshBuilder::new(scale);
    let text = without_mark(bytes);
    let format = MeshFormat::of(bytes, bytes.len() as u64);
    match format {
        Some(MeshFormat::Obj) => obj::read(text, &mut builder),
        Some(MeshFormat::BinaryStl) => stl::read_binary(bytes, &mut builder),
        Some(MeshFormat::AsciiStl) => stl::read_ascii(text, &mut builder),
        Some(MeshFormat::Ply) => ply::read(text, &mut builder),
        None => Err(not_recognised(bytes)),
    }?;
    // The other formats state where they end. A last number that was cut short is a number as well.
    if format == Some(MeshFormat::Obj) && !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r") {
        builder.warn(format!(
            "the OBJ ends within a line, after {} vertices and {} triangles: make sure that it is whole",
            builder.vertex_count(),
            builder.triangle_count()
        ));
    }
    if let NoDataRule::Value(mark) = no_data {
        builder.remove_missing(mark)?;
    }
    let (mesh, warnings) = builder.finish()?;
    if no_data != NoDataRule::Nothing {
        voids::refuse_voids(&mesh, scale)?;
    }
    Ok(MeshFile { mesh, warnings })
}

fn not_recognised(bytes: &[u8]) -> TerrainError {
    if let Some(other) = foreign::name(bytes) {
        return foreign::not_a_mesh(other);
    }
    if let Some(length) = stl::binary_length(bytes).filter(|_| stl::is_titled_like_text(bytes)) {
        let triangles = (length - stl::HEADER_BYTES as u64) / stl::TRIANGLE_BYTES;
        let reason = format!("it declares {triangles} triangles in {length} bytes, but the file has {} bytes", bytes.len());
        return TerrainError::Damaged { format: stl::BINARY, reason };
    }
    let shown: String = bytes.iter().take(24).flat_map(|&byte| std::ascii::escape_default(byte)).map(char::from).collect();
    let mut found = if bytes.is_empty() { "nothing: the file is empty".to_owned() } else { format!("'{shown}'") };
    if let Some(length) = stl::binary_length(bytes).filter(|_| bytes.contains(&0)) {
        let triangles = (length - stl::HEADER_BYTES as u64) / stl::TRIANGLE_BYTES;
        let claim = format!("as a binary STL it would claim {triangles} triangles in {length} bytes");
        found = format!("{found}; {claim}, but the file has {} bytes", bytes.len());
    }
    let expected = MESH_FORMATS.map(|(name, _)| name).join(", ");
    TerrainError::NotAMesh { found, expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_content_and_junk_is_refused_with_its_first_bytes() {
        let format = |bytes: &[u8]| MeshFormat::of(bytes, bytes.len() as u64);
        assert_eq!(format(b"ply\nformat ascii 1.0\n"), Some(MeshFormat::Ply));
        assert_eq!(format(b"solid\nfacet normal 0 0 1"), Some(MeshFormat::AsciiStl));
        assert_eq!(format(b"####\n# shape\n\nv 0.1 2 3\n"), Some(MeshFormat::Obj));
        assert_eq!(format(&[0; 84]), Some(MeshFormat::BinaryStl));
        for junk in [
            &b""[..],
            b"\x00\x01junk",
            b"II*\0",
            b"ncols 4\nnrows 5\n",
            b"x_m,z_m\n0,1\n",
            b"solid ground is here",
            b"0 1 2\n",
            &[7; 500],
        ] {
            assert!(format(junk).is_none() || junk.starts_with(b"solid"), "{junk:?}");
            assert!(read_mesh_bytes(junk, 1.0).is_err());
        }
        let message = read_mesh_bytes(b"", 1.0).unwrap_err().to_string();
        assert!(message.contains("empty") && message.contains("OBJ, STL, PLY"), "{message}");
        let mut cut = vec![0; 84];
        cut[80] = 2;
        cut.extend([0; 99]);
        let message = read_mesh_bytes(&cut, 1.0).unwrap_err().to_string();
        assert!(message.contains("2 triangles in 184 bytes, but the file has 183 bytes"), "{message}");
    }

    #[test]
    fn invalid_scales_are_refused() {
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(read_mesh_bytes(b"v 0 0 0\n", scale).unwrap_err().to_string().contains("mesh_scale"));
        }
    }

    #[test]
    fn files_are_named_in_every_problem() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("rock.obj");
        assert!(!looks_like_mesh(&path) && read_mesh(&path, 1.0).unwrap_err().to_string().contains("rock.obj"));
        fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n").unwrap();
        assert!(looks_like_mesh(&path) && !looks_like_mesh(directory.path()));
        let message = read_mesh(&path, 1.0).unwrap_err().to_string();
        assert!(message.contains("rock.obj") && message.contains("line 4"), "{message}");
    }
}
