//! Files that this crate does not read itself. They are recognised by content, so that the error can say what the file is and
//! what to do.
//!
//! The `gdal` feature reads those that GDAL reads (`src/terrain/gdal.rs`).

use super::TerrainError;

/// What makes a readable file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mend {
    /// GDAL converts it.
    Gdal,
    /// Something else does.
    By(&'static str),
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Foreign {
    name: &'static str,
    mend: Mend,
}

const fn gdal(name: &'static str) -> Foreign {
    Foreign { name, mend: Mend::Gdal }
}

const fn other(name: &'static str, mend: &'static str) -> Foreign {
    Foreign { name, mend: Mend::By(mend) }
}

const GRID_POINTS: &str = "a grid of its ground points as a GeoTIFF, such as writers.gdal of PDAL makes";
const EXPORT_MESH: &str = "an export of the model as OBJ, STL or PLY, with z up";
const SAVE_AS_TEXT: &str = "saving the table as CSV UTF-8";
const UTF_16: Foreign = other("a text in UTF-16", "iconv -f UTF-16 -t UTF-8 in.txt > out.txt");

/// The first bytes of files of a kind. Texts may have white space before them.
const BEGINNINGS: [(&[u8], Foreign); 58] = [
    (b"Object = IsisCube", gdal("an ISIS cube")),
    (b"LBLSIZE=", gdal("a VICAR image")),
    (b"\x89HDF\r\n", gdal("an HDF5 or NetCDF-4 file")),
    (b"\x0e\x03\x13\x01", gdal("an HDF4 file")),
    (b"CDF\x01", gdal("a NetCDF file")),
    (b"CDF\x02", gdal("a NetCDF file")),
    (b"CDF\x05", gdal("a NetCDF file")),
    (b"\0\0\0\x0cjP  ", gdal("a JPEG 2000 picture")),
    (b"\xff\x4f\xff\x51", gdal("a JPEG 2000 picture")),
    (b"\0\0\0\x0cJXL ", gdal("a JPEG XL picture")),
    (b"\x89PNG", gdal("a PNG picture")),
    (b"\xff\xd8\xff", gdal("a JPEG picture")),
    (b"GIF8", gdal("a GIF picture")),
    (b"SIMPLE  =", gdal("a FITS file")),
    (b"DSAA", gdal("a Surfer grid")),
    (b"DSBB", gdal("a Surfer grid")),
    (b"DSRB", gdal("a Surfer grid")),
    (b"EHFA_HEADER_TAG", gdal("an Erdas Imagine image")),
    (b"UHL1", gdal("a DTED grid")),
    (b"NITF0", gdal("a NITF image")),
    (b"GRIB", gdal("a GRIB file")),
    (b"ENVI", other("an ENVI header", "gdal_translate in.img out.tif, with the image that stands beside the header")),
    (b"<VRTDataset", gdal("a virtual raster of GDAL (VRT)")),
    (b"north:", gdal("a GRASS ASCII grid")),
    (b"\x1f\x8b", other("a gzip archive", "gunzip -k in.gz, or tar -xzf in.tar.gz if it holds several files")),
    (b"\x1f\x9d", other("a compress archive", "gunzip -k in.Z")),
    (b"BZh", other("a bzip2 archive", "bunzip2 -k in.bz2")),
    (b"\xfd7zXZ\0", other("an xz archive", "unxz -k in.xz")),
    (b"7z\xbc\xaf\x27\x1c", other("a 7z archive", "7z x in.7z")),
    (b"\x28\xb5\x2f\xfd", other("a Zstandard archive", "unzstd in.zst")),
    (b"\x04\x22\x4d\x18", other("an LZ4 archive", "unlz4 in.lz4")),
    (b"Rar!\x1a\x07", other("a RAR archive", "unrar x in.rar")),
    (b"version https://git-lfs.github.com", other("a pointer of Git LFS in place of the file", "git lfs pull")),
    (b"/annex/objects/", other("a pointer of git-annex in place of the file", "git annex get FILE")),
    (b"\x4c\0\0\0\x01\x14\x02\0", other("a Windows shortcut", "the path of the file that it points to")),
    (b"\0\x05\x16\x07", other("a companion file of macOS (its name begins with ._)", "the file of the same name without ._")),
    (b"XSym\n", other("a symbolic link stored as a file", "the path of the file that it points to")),
    (b"LASF", other("a LAS or LAZ point cloud", GRID_POINTS)),
    (b"ASTM-E57", other("an E57 point cloud", GRID_POINTS)),
    (b"# .PCD", other("a PCD point cloud", GRID_POINTS)),
    (
        b"\0\0\x27\x0a",
        other(
            "a shapefile",
            "an elevation raster or mesh; zones go into keep_out as GeoJSON (ogr2ogr -f GeoJSON out.geojson in.shp)",
        ),
    ),
    (b"%PDF", other("a PDF document", "the file of the elevations themselves")),
    (b"\xd0\xcf\x11\xe0", other("an Office document", SAVE_AS_TEXT)),
    (b"PAR1", other("a Parquet table", SAVE_AS_TEXT)),
    (b"\x93NUMPY", other("a NumPy array", "gdal_translate after writing it as a GeoTIFF with its map (numpy has none)")),
    (b"MATLAB 5.0", other("a MATLAB file", "an export as GeoTIFF or XYZ text")),
    (b"glTF", other("a glTF model", EXPORT_MESH)),
    (b"Kaydara FBX", other("an FBX model", EXPORT_MESH)),
    (b"BLENDER", other("a Blender file", EXPORT_MESH)),
    (b"ISO-10303-21", other("a STEP model", EXPORT_MESH)),
    (b"OFF\n", other("an OFF mesh", EXPORT_MESH)),
    (b"OFF\r", other("an OFF mesh", EXPORT_MESH)),
    (b"# vtk DataFile", other("a VTK file", EXPORT_MESH)),
    (b"#VRML", other("a VRML model", EXPORT_MESH)),
    (b"\xff\xfe", UTF_16),
    (b"\xfe\xff", UTF_16),
    (b"MZ\x90\0", other("a Windows program", "the file of the elevations")),
    (b"\x7fELF", other("a program", "the file of the elevations")),
];

/// The name of the kind of file that begins like this, with an article, if GDAL reads it as a raster.
pub(crate) fn name_of(beginning: &[u8]) -> Option<&'static str> {
    name(beginning).filter(|foreign| foreign.mend == Mend::Gdal).map(|foreign| foreign.name)
}

/// The kind of file that begins like this, if it is one of these.
pub(super) fn name(beginning: &[u8]) -> Option<Foreign> {
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    let begins = |start: &[u8]| beginning.starts_with(start) || text.starts_with(start);
    if let Some((_, known)) = BEGINNINGS.iter().find(|(start, _)| begins(start)) {
        return Some(*known);
    }
    if beginning.starts_with(b"PK\x03\x04") || beginning.starts_with(b"PK\x05\x06") {
        return Some(zip(beginning));
    }
    if beginning.starts_with(b"SQLite format 3\0") {
        return Some(if beginning.get(68..72) == Some(b"GPKG") { gdal("a GeoPackage") } else { gdal("an SQLite database") });
    }
    if beginning.starts_with(b"RIFF") && beginning.get(8..12) == Some(b"WEBP") {
        return Some(gdal("a WebP picture"));
    }
    if beginning.get(257..262) == Some(b"ustar") {
        return Some(other("a tar archive", "tar -xf in.tar"));
    }
    if is_utf_16(beginning) {
        return Some(UTF_16);
    }
    match text.first() {
        Some(b'<') => markup(text),
        Some(b'{' | b'[') if contains(text, b"\"coordinates\"") || contains(text, b"\"FeatureCollection\"") => {
            Some(other("GeoJSON", "an elevation raster or mesh; zones go into keep_out"))
        }
        Some(b'{') => Some(other(
            "a JSON text",
            "the file of the elevations; if a server sent this as its answer, read it and download again",
        )),
        _ => None,
    }
}

fn zip(beginning: &[u8]) -> Foreign {
    if contains(beginning, b"[Content_Types].xml") || contains(beginning, b"opendocument") {
        if contains(beginning, b"3D/") {
            return other("a 3MF model", EXPORT_MESH);
        }
        return other("an Office document", SAVE_AS_TEXT);
    }
    other("a zip archive", "unzip in.zip")
}

/// Text in angle brackets, whose white space is skipped.
fn markup(text: &[u8]) -> Option<Foreign> {
    let lower = text.to_ascii_lowercase();
    let has = |word: &[u8]| contains(&lower, word);
    Some(if has(b"product_observational") || has(b"pds.nasa.gov/pds4") {
        gdal("a PDS4 label")
    } else if has(b"<vrtdataset") {
        gdal("a virtual raster of GDAL (VRT)")
    } else if lower.starts_with(b"<!doctype html") || has(b"<html") {
        other("a web page saved in place of the file", "another download, of the file itself")
    } else if has(b"<pamdataset") {
        other("a sidecar file of GDAL (.aux.xml)", "the raster beside it")
    } else if has(b"<kml") {
        other("KML", "an elevation raster or mesh; zones go into keep_out as GeoJSON (ogr2ogr -f GeoJSON out.geojson in.kml)")
    } else if has(b"<collada") {
        other("a COLLADA model", EXPORT_MESH)
    } else if has(b"<x3d") {
        other("an X3D model", EXPORT_MESH)
    } else if has(b"<?xml") || has(b"<error") {
        other("an XML text", "the file of the elevations; if a server sent this as its answer, read it and download again")
    } else {
        return None;
    })
}

/// Whether every second byte is zero and the others are text, as in UTF-16 without a byte order mark.
fn is_utf_16(beginning: &[u8]) -> bool {
    let head = &beginning[..beginning.len().min(64)];
    let half = |offset: usize| head.iter().skip(offset).step_by(2).copied();
    let is_text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    head.len() >= 8 && [(0, 1), (1, 0)].iter().any(|(text, zeros)| half(*text).all(is_text) && half(*zeros).all(|byte| byte == 0))
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

/// The error where an elevation raster was expected.
pub(super) fn refusal(foreign: Foreign) -> TerrainError {
    match foreign.mend {
        Mend::Gdal => TerrainError::Unsuitable {
            found: format!("{}, which this build does not read", foreign.name),
            expected: "GeoTIFF, ESRI ASCII grid, PDS3 image or XYZ grid, or a build with the feature gdal (cargo install chta --features gdal)",
            mend: "gdal_translate in out.tif".to_owned(),
        },
        Mend::By(mend) => TerrainError::Unsuitable {
            found: foreign.name.to_owned(),
            expected: "GeoTIFF, ESRI ASCII grid, PDS3 image or XYZ grid",
            mend: mend.to_owned(),
        },
    }
}

/// The error where a mesh was expected.
pub(super) fn not_a_mesh(foreign: Foreign) -> TerrainError {
    let mend = match foreign.mend {
        Mend::Gdal => "the file of a mesh; a raster goes where a DEM is asked for, after: gdal_translate in out.tif",
        Mend::By(mend) => mend,
    };
    TerrainError::Unsuitable { found: foreign.name.to_owned(), expected: "a mesh: OBJ, STL or PLY", mend: mend.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Magic numbers: the formats' definitions, as collected in file(1).
    #[test]
    fn foreign_files_are_known_by_content() {
        let mut tar = vec![0; 512];
        tar[..5].copy_from_slice(b"a.tif");
        tar[257..262].copy_from_slice(b"ustar");
        let mut package = b"SQLite format 3\0".to_vec();
        package.resize(68, 0);
        package.extend(b"GPKG");
        for (beginning, expected) in [
            (&b"Object = IsisCube\n  Object = Core"[..], Some("an ISIS cube")),
            (b"<?xml version=\"1.0\"?>\n<Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\">", Some("a PDS4 label")),
            (b"\x1f\x8b\x08\0junk", Some("a gzip archive")),
            (b"PK\x03\x04\x14\0dem.tif", Some("a zip archive")),
            (b"PK\x03\x04\x14\0[Content_Types].xml", Some("an Office document")),
            (&tar, Some("a tar archive")),
            (b"BZh91AY", Some("a bzip2 archive")),
            (b"\xfd7zXZ\0\0", Some("an xz archive")),
            (b"7z\xbc\xaf\x27\x1c\0", Some("a 7z archive")),
            (&package, Some("a GeoPackage")),
            (b"\n<!DOCTYPE html>\n<html>", Some("a web page saved in place of the file")),
            (b"<HTML><head>", Some("a web page saved in place of the file")),
            (b"<?xml version=\"1.0\"?><Error><Code>AccessDenied</Code>", Some("an XML text")),
            (b"<?xml version=\"1.0\"?><kml>", Some("KML")),
            (b"<PAMDataset>", Some("a sidecar file of GDAL (.aux.xml)")),
            (b"version https://git-lfs.github.com/spec/v1\noid sha256:00", Some("a pointer of Git LFS in place of the file")),
            (b"LASF\0\0", Some("a LAS or LAZ point cloud")),
            (b"\x4c\0\0\0\x01\x14\x02\0\0", Some("a Windows shortcut")),
            (b"\xff\xfen\0c\0o\0l\0s\0", Some("a text in UTF-16")),
            (b"n\0c\0o\0l\0s\0 \0x\0", Some("a text in UTF-16")),
            (b"\0n\0c\0o\0l\0s\0 \0x", Some("a text in UTF-16")),
            (b"{\"type\": \"FeatureCollection\", \"features\": []}", Some("GeoJSON")),
            (b"{\"message\": \"not found\"}", Some("a JSON text")),
            (b"glTF\x02\0\0\0", Some("a glTF model")),
            (b"", None),
            (b"x_m,z_m\n0,1\n", None),
            (b"v 0 0 0\n", None),
            (b"<", None),
            (&[0; 300], None),
        ] {
            let found = name(beginning);
            assert_eq!(found.map(|foreign| foreign.name), expected, "{}", beginning.escape_ascii());
            for message in found.into_iter().flat_map(|foreign| [refusal(foreign), not_a_mesh(foreign)]) {
                let text = message.to_string();
                assert!(text.contains("expected") && text.contains("mend it with: ") && !text.contains("damaged"), "{text}");
            }
        }
    }
}
