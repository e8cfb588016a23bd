//! Files that this crate does not read itself. They are recognised by content, so that the error can say what the file is and
//! what to do.
//!
//! The `gdal` feature reads those that GDAL reads (`src/terrain/gdal.rs`).

use std::path::Path;

use super::{TerrainError, VectorFormat, without_mark};

/// What kinds of file have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    /// A raster that GDAL converts.
    Raster,
    /// A picture, which seldom has elevations in it.
    Picture,
    /// A packed file, and the program that unpacks it.
    Packed(&'static str),
    /// A document or a program: nothing that could be terrain.
    Document,
    /// A mesh or a scene.
    Model,
    /// Points without faces.
    Points,
    /// Any other: its reader says best what is wrong with it.
    Other,
}

/// What makes a readable file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mend {
    /// GDAL converts it.
    Gdal,
    /// The program of a packed file unpacks it, with these arguments.
    Unpack(&'static str),
    /// Something else does.
    By(&'static str),
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Foreign {
    /// Its name with an article.
    pub(crate) name: &'static str,
    pub(crate) group: Group,
    mend: Mend,
}

const fn gdal(name: &'static str) -> Foreign {
    Foreign { name, group: Group::Raster, mend: Mend::Gdal }
}

const fn picture(name: &'static str) -> Foreign {
    Foreign { name, group: Group::Picture, mend: Mend::Gdal }
}

/// A picture that GDAL does not read.
const fn drawing(name: &'static str) -> Foreign {
    Foreign { name, group: Group::Picture, mend: Mend::By("the raster of elevations that it was drawn from") }
}

const fn packed(name: &'static str, program: &'static str, arguments: &'static str) -> Foreign {
    Foreign { name, group: Group::Packed(program), mend: Mend::Unpack(arguments) }
}

const fn document(name: &'static str, mend: &'static str) -> Foreign {
    Foreign { name, group: Group::Document, mend: Mend::By(mend) }
}

const fn model(name: &'static str) -> Foreign {
    Foreign { name, group: Group::Model, mend: Mend::By("an export of the model as OBJ, STL or PLY, with z up") }
}

const fn points(name: &'static str) -> Foreign {
    let mend = Mend::By("a grid of its ground points as a GeoTIFF, such as writers.gdal of PDAL makes");
    Foreign { name, group: Group::Points, mend }
}

const fn other(name: &'static str, mend: &'static str) -> Foreign {
    Foreign { name, group: Group::Other, mend: Mend::By(mend) }
}

const SAVE_AS_TEXT: &str = "saving the table as CSV UTF-8";
const UTF_16: Foreign = other("a text in UTF-16", "iconv -f UTF-16 -t UTF-8 in.txt > out.txt");

/// The first bytes of files of a kind. Texts may have white space before them.
const BEGINNINGS: [(&[u8], Foreign); 59] = [
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
    (b"\x89PNG", picture("a PNG picture")),
    (b"\xff\xd8\xff", picture("a JPEG picture")),
    (b"GIF8", picture("a GIF picture")),
    (b"8BPS", drawing("a Photoshop picture")),
    (b"%!PS", drawing("a PostScript picture")),
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
    (b"\x1f\x8b", packed("a file packed with gzip", "gunzip -k", "in.gz, or tar -xzf in.tar.gz if it holds several files")),
    (b"\x1f\x9d", packed("a file packed with compress", "gunzip -k", "in.Z")),
    (b"BZh", packed("a file packed with bzip2", "bunzip2 -k", "in.bz2")),
    (b"\xfd7zXZ\0", packed("a file packed with xz", "unxz -k", "in.xz")),
    (b"7z\xbc\xaf\x27\x1c", packed("a 7z archive", "7z x", "in.7z")),
    (b"\x28\xb5\x2f\xfd", packed("a file packed with Zstandard", "unzstd", "in.zst")),
    (b"\x04\x22\x4d\x18", packed("a file packed with LZ4", "unlz4", "in.lz4")),
    (b"Rar!\x1a\x07", packed("a RAR archive", "unrar x", "in.rar")),
    (b"version https://git-lfs.github.com", other("a pointer of Git LFS in place of the file", "git lfs pull")),
    (b"/annex/objects/", other("a pointer of git-annex in place of the file", "git annex get FILE")),
    (b"\x4c\0\0\0\x01\x14\x02\0", other("a Windows shortcut", "the path of the file that it points to")),
    (b"\0\x05\x16\x07", other("a companion file of macOS (its name begins with ._)", "the file of the same name without ._")),
    (b"XSym\n", other("a symbolic link stored as a file", "the path of the file that it points to")),
    (b"LASF", points("a LAS or LAZ point cloud")),
    (b"ASTM-E57", points("an E57 point cloud")),
    (b"# .PCD", points("a PCD point cloud")),
    (b"%PDF", document("a PDF document", "the file of the elevations themselves")),
    (b"\xd0\xcf\x11\xe0", document("an Office document", SAVE_AS_TEXT)),
    (b"PAR1", document("a Parquet table", SAVE_AS_TEXT)),
    (b"\x93NUMPY", other("a NumPy array", "gdal_translate after writing it as a GeoTIFF with its map (numpy has none)")),
    (b"MATLAB 5.0", other("a MATLAB file", "an export as GeoTIFF or XYZ text")),
    (b"glTF", model("a glTF model")),
    (b"Kaydara FBX", model("an FBX model")),
    (b"BLENDER", model("a Blender file")),
    (b"ISO-10303-21", model("a STEP model")),
    (b"OFF\n", model("an OFF mesh")),
    (b"OFF\r", model("an OFF mesh")),
    (b"# vtk DataFile", model("a VTK file")),
    (b"#VRML", model("a VRML model")),
    (b"\xff\xfe", UTF_16),
    (b"\xfe\xff", UTF_16),
    (b"MZ\x90\0", document("a Windows program", "the file of the elevations")),
    (b"\x7fELF", document("a program", "the file of the elevations")),
];

/// The kind of file that begins like this, if it is one of these.
pub(crate) fn name(beginning: &[u8]) -> Option<Foreign> {
    let text = without_mark(beginning).trim_ascii_start();
    let begins = |start: &[u8]| beginning.starts_with(start) || text.starts_with(start);
    if let Some((_, known)) = BEGINNINGS.iter().find(|(start, _)| begins(start)) {
        return Some(*known);
    }
    if let Some(known) = short(beginning) {
        return Some(known);
    }
    if beginning.starts_with(b"PK\x03\x04") || beginning.starts_with(b"PK\x05\x06") {
        return Some(zip(beginning));
    }
    if beginning.starts_with(b"SQLite format 3\0") {
        return Some(if beginning.get(68..72) == Some(b"GPKG") { gdal("a GeoPackage") } else { gdal("an SQLite database") });
    }
    if beginning.starts_with(b"RIFF") && beginning.get(8..12) == Some(b"WEBP") {
        return Some(picture("a WebP picture"));
    }
    if beginning.get(257..262) == Some(b"ustar") {
        return Some(packed("a tar archive", "tar -xf", "in.tar"));
    }
    if is_utf_16(beginning) {
        return Some(UTF_16);
    }
    if let Some(shapes) = VectorFormat::of(beginning, Path::new("")) {
        return Some(other(
            shapes.name(),
            "an elevation raster or mesh; zones go into keep_out as GeoJSON (ogr2ogr -f GeoJSON out.geojson in)",
        ));
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

/// Pictures that begin with two letters, as many texts do: what follows them has to be as in the format.
fn short(beginning: &[u8]) -> Option<Foreign> {
    let mark = beginning.get(..2)?;
    // Behind the size of the file stand four bytes of zeros.
    if mark == b"BM" && beginning.get(6..10) == Some(&[0; 4]) {
        return Some(picture("a BMP picture"));
    }
    let numbers = beginning.get(2).is_some_and(u8::is_ascii_whitespace)
        && beginning.get(3).is_some_and(|byte| byte.is_ascii_digit() || *byte == b'#');
    match mark {
        b"P5" if numbers => Some(picture("a PGM picture")),
        b"P6" if numbers => Some(picture("a PPM picture")),
        _ => None,
    }
}

fn zip(beginning: &[u8]) -> Foreign {
    if contains(beginning, b"[Content_Types].xml") || contains(beginning, b"opendocument") {
        if contains(beginning, b"3D/") {
            return model("a 3MF model");
        }
        return document("an Office document", SAVE_AS_TEXT);
    }
    packed("a zip archive", "unzip", "in.zip")
}

/// How much of a text in angle brackets is examined.
const MARKUP_BYTES: usize = 4096;

/// Text in angle brackets, whose white space is skipped.
fn markup(text: &[u8]) -> Option<Foreign> {
    let lower = text[..text.len().min(MARKUP_BYTES)].to_ascii_lowercase();
    let has = |word: &[u8]| contains(&lower, word);
    let page = document("a web page", "another download, of the file itself");
    Some(if has(b"product_observational") || has(b"pds.nasa.gov/pds4") {
        gdal("a PDS4 label")
    } else if has(b"<vrtdataset") {
        gdal("a virtual raster of GDAL (VRT)")
    } else if lower.starts_with(b"<!doctype html") || lower.starts_with(b"<html") {
        page
    } else if has(b"<svg") {
        drawing("an SVG picture")
    } else if has(b"<html") {
        page
    } else if has(b"<pamdataset") {
        other("a sidecar file of GDAL (.aux.xml)", "the raster beside it")
    } else if has(b"<collada") {
        model("a COLLADA model")
    } else if has(b"<x3d") {
        model("an X3D model")
    } else if lower.get(1).is_some_and(|byte| byte.is_ascii_alphabetic() || b"?!".contains(byte)) {
        document("an XML text", "the file of the elevations; if a server sent this as its answer, read it and download again")
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

impl Foreign {
    /// What makes a readable file without GDAL; `None` if GDAL does.
    fn mend_without_gdal(self) -> Option<String> {
        match (self.mend, self.group) {
            (Mend::Gdal, _) => None,
            (Mend::Unpack(arguments), Group::Packed(program)) => Some(format!("{program} {arguments}")),
            (Mend::Unpack(mend) | Mend::By(mend), _) => Some(mend.to_owned()),
        }
    }
}

/// The error where an elevation raster was expected.
pub(super) fn refusal(foreign: Foreign) -> TerrainError {
    match foreign.mend_without_gdal() {
        None => TerrainError::Unsuitable {
            found: format!("{}, which this build does not read", foreign.name),
            expected: "GeoTIFF, ESRI ASCII grid, PDS3 image or XYZ grid, or a build with the feature gdal (cargo install chta --features gdal)",
            mend: "gdal_translate in out.tif".to_owned(),
        },
        Some(mend) => TerrainError::Unsuitable {
            found: foreign.name.to_owned(),
            expected: "GeoTIFF, ESRI ASCII grid, PDS3 image or XYZ grid",
            mend,
        },
    }
}

/// The error where a mesh was expected.
pub(super) fn not_a_mesh(foreign: Foreign) -> TerrainError {
    let mend = foreign.mend_without_gdal().unwrap_or_else(|| {
        "the file of a mesh; a raster goes where a DEM is asked for, after: gdal_translate in out.tif".to_owned()
    });
    TerrainError::Unsuitable { found: foreign.name.to_owned(), expected: "a mesh: OBJ, STL or PLY", mend }
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
            (b"\x1f\x8b\x08\0junk", Some("a file packed with gzip")),
            (b"PK\x03\x04\x14\0dem.tif", Some("a zip archive")),
            (b"PK\x03\x04\x14\0[Content_Types].xml", Some("an Office document")),
            (&tar, Some("a tar archive")),
            (b"BZh91AY", Some("a file packed with bzip2")),
            (b"\xfd7zXZ\0\0", Some("a file packed with xz")),
            (b"7z\xbc\xaf\x27\x1c\0", Some("a 7z archive")),
            (&package, Some("a GeoPackage")),
            (b"\n<!DOCTYPE html>\n<html>", Some("a web page")),
            (b"<HTML><head>", Some("a web page")),
            (b"<?xml version=\"1.0\"?><Error><Code>AccessDenied</Code>", Some("an XML text")),
            (b"<?xml version=\"1.0\"?><kml>", Some("a KML file")),
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
            (b"BM\x36\0\0\0\0\0\0\0\x36\0\0\0", Some("a BMP picture")),
            (b"BMW drives on, as long as there is a road\n", None),
            (b"P5\n2 2\n255\n....", Some("a PGM picture")),
            (b"P5 is a point\n", None),
            (b"<?xml version=\"1.0\"?>\n<svg width=\"1\"/>", Some("an SVG picture")),
            (b"<!DOCTYPE html><html><svg/></html>", Some("a web page")),
            (b"\0\0\x27\x0a\0", Some("an ESRI Shapefile")),
            (b"<x> <y> <z>\n", Some("an XML text")),
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
