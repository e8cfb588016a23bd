//! What a file is, by its content; its extension decides only where the content leaves it open.

use std::{
    fs::File,
    io::{self, Read},
    path::Path,
};

use super::CATALOGUE;
use crate::chain::csv::MEASURED_COLUMNS;
use crate::terrain::{
    Foreign, ForeignGroup, VectorFormat, binary_stl_length, foreign_kind, mesh_format, raster_format, without_mark,
};

/// What a file is.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileKind {
    /// No bytes at all.
    Empty,
    /// An elevation raster in a format that is read, by the format's name.
    Raster(&'static str),
    /// A raster of another format; the name has an article.
    ForeignRaster(&'static str),
    /// A mesh in a format that is read, by the format's name, and whether it is text.
    Mesh(&'static str, bool),
    /// A mesh in another format; the name has an article.
    ForeignMesh(&'static str),
    /// Points without faces; the name has an article.
    Points(&'static str),
    /// A chain.
    ChainCsv,
    /// Pairs of start and goal.
    PairsCsv,
    /// Positions on a map.
    PositionsCsv,
    /// Measured errors of hops.
    MeasuredCsv,
    /// The hops of a path, as a plan writes them.
    PathCsv,
    /// A scenario.
    Scenario,
    /// A robot with legs.
    Robot,
    /// A result, which has a scenario in it.
    Result,
    /// `GeoJSON`.
    GeoJson,
    /// Other JSON.
    Json,
    /// Shapes in another format.
    Shapes(VectorFormat),
    /// A picture; the name has an article.
    Picture(&'static str),
    /// A packed file: its name with an article, and the program that unpacks it.
    Packed(&'static str, &'static str),
    /// A document; the name has an article.
    Document(&'static str),
    /// Text of another kind.
    Text,
    /// Bytes of another kind.
    Binary,
}

impl FileKind {
    /// How many bytes of a file are examined: comments may precede the first statement.
    pub const PROBE_BYTES: usize = 1 << 16;

    /// What a file is.
    ///
    /// # Errors
    /// An error of the file system; a folder gives one.
    pub fn of(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut beginning = Vec::new();
        file.take(Self::PROBE_BYTES as u64).read_to_end(&mut beginning)?;
        Ok(Self::of_beginning(&beginning, Some(length), path))
    }

    /// What a file with this beginning is, of this length if it is known. `path` gives the extension.
    pub fn of_beginning(beginning: &[u8], length: Option<u64>, path: &Path) -> Self {
        if beginning.is_empty() {
            return Self::Empty;
        }
        let extension = path.extension().unwrap_or_default();
        if let Some(format) = VectorFormat::of(beginning, path) {
            return Self::Shapes(format);
        }
        let text = text_of(beginning);
        if let Some(table) = text.and_then(of_table) {
            return table;
        }
        if let Some(format) = raster_format(beginning) {
            return Self::Raster(format);
        }
        if let Some(kind) = foreign_kind(beginning).and_then(Self::of_foreign) {
            return kind;
        }
        let length = length.or_else(|| binary_stl_length(beginning)).unwrap_or(0);
        if let Some((format, is_text)) = mesh_format(beginning, length) {
            return Self::Mesh(format, is_text);
        }
        match text {
            None => Self::Binary,
            Some(text) => of_text(text).unwrap_or(if extension.eq_ignore_ascii_case("toml") { Self::Scenario } else { Self::Text }),
        }
    }

    /// What a file is that is not read; `None` where its content or its reader says more.
    const fn of_foreign(Foreign { name, group, .. }: Foreign) -> Option<Self> {
        Some(match group {
            ForeignGroup::Raster => Self::ForeignRaster(name),
            ForeignGroup::Picture => Self::Picture(name),
            ForeignGroup::Packed(program) => Self::Packed(name, program),
            ForeignGroup::Document => Self::Document(name),
            ForeignGroup::Model => Self::ForeignMesh(name),
            ForeignGroup::Points => Self::Points(name),
            ForeignGroup::Other => return None,
        })
    }

    /// The name with an article, as in "this is a `GeoTIFF`".
    pub fn name(&self) -> String {
        match self {
            Self::Empty => "an empty file".to_owned(),
            Self::Raster("PDS3 image") => "a PDS3 label or image".to_owned(),
            Self::Raster(format) => format!("{} {format}", article(format)),
            Self::Mesh(format, _) => format!("{} {format} mesh", article(format)),
            Self::ForeignRaster(name)
            | Self::ForeignMesh(name)
            | Self::Points(name)
            | Self::Picture(name)
            | Self::Packed(name, _)
            | Self::Document(name) => (*name).to_owned(),
            Self::ChainCsv => "a chain CSV".to_owned(),
            Self::PairsCsv => "a CSV of pairs of start and goal".to_owned(),
            Self::PositionsCsv => "a CSV of positions on a map".to_owned(),
            Self::MeasuredCsv => "a CSV of measured errors of hops".to_owned(),
            Self::PathCsv => "a CSV of the hops of a path".to_owned(),
            Self::Scenario => "a scenario (TOML)".to_owned(),
            Self::Robot => "a robot file (TOML)".to_owned(),
            Self::Result => "a result (JSON)".to_owned(),
            Self::GeoJson => "a GeoJSON".to_owned(),
            Self::Json => "a JSON file without a scenario in it".to_owned(),
            Self::Shapes(format) => format.name().to_owned(),
            Self::Text => "a text of no known form".to_owned(),
            Self::Binary => "a file of no known format".to_owned(),
        }
    }
}

/// The article of a format's name, as it is spoken: an OBJ, an STL, an XYZ grid, an ESRI grid.
fn article(name: &str) -> &'static str {
    if name.starts_with(['A', 'E', 'O', 'S', 'X']) { "an" } else { "a" }
}

/// The beginning as text without its byte order mark; `None` if it is binary. The last letter may be cut.
fn text_of(beginning: &[u8]) -> Option<&str> {
    let bytes = without_mark(beginning);
    let valid = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) if error.error_len().is_none() => std::str::from_utf8(bytes.get(..error.valid_up_to())?).ok()?,
        Err(_) => return None,
    };
    let is_plain = |letter: char| !letter.is_control() || matches!(letter, '\n' | '\r' | '\t' | '\u{c}');
    valid.chars().all(is_plain).then_some(valid)
}

/// The lines that are neither blank nor comments.
fn statements(text: &str) -> impl Iterator<Item = &str> {
    text.split(['\n', '\r']).map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// What a table is by the names in its header.
fn of_table(text: &str) -> Option<FileKind> {
    let header = statements(text).next()?;
    let names: Vec<String> =
        header.split([',', ';', '\t']).map(|name| name.trim().trim_matches('"').to_ascii_lowercase()).collect();
    let has = |name: &str| names.iter().any(|own| own == name);
    let is_map = ["y", "y_m", "northing", "northing_m"].into_iter().any(has);
    match () {
        () if has("takeoff_x_m") && has("landing_x_m") => Some(FileKind::PathCsv),
        () if has("start_x_m") && has("goal_x_m") => Some(FileKind::PairsCsv),
        () if has("x_m") && has("z_m") && !is_map => Some(FileKind::ChainCsv),
        () if has("x_m") && has("y_m") && names.len() == 2 => Some(FileKind::PositionsCsv),
        () if MEASURED_COLUMNS.iter().any(|column| has(column.name)) => Some(FileKind::MeasuredCsv),
        () => None,
    }
}

/// What a text is by its first statements: JSON, or TOML with tables of a scenario.
fn of_text(text: &str) -> Option<FileKind> {
    let start = text.trim_start();
    if start.starts_with('{') {
        return Some(of_json(start));
    }
    // A scenario has a table [robot] too, and no lists of tables.
    if statements(text).any(|line| line.starts_with("[[limb]]") || line.starts_with("[[trunk]]")) {
        return Some(FileKind::Robot);
    }
    let is_table = |name: &str| CATALOGUE.iter().any(|key| key.table == name);
    let names_table = |line: &str| match line.strip_prefix('[') {
        Some(rest) => rest.split(']').next().is_some_and(|name| is_table(name.trim())),
        None => line.split_once('=').and_then(|(key, _)| key.split_once('.')).is_some_and(|(table, _)| is_table(table.trim())),
    };
    let inline =
        |line: &str| line.split_once('=').is_some_and(|(key, value)| is_table(key.trim()) && value.trim_start().starts_with('{'));
    statements(text).any(|line| names_table(line) || inline(line)).then_some(FileKind::Scenario)
}

/// What a JSON text is by its outermost keys; the text may be cut.
fn of_json(text: &str) -> FileKind {
    let keys = outermost_keys(text);
    let has = |name: &str| keys.iter().any(|(key, _)| key == name);
    let of_type = |names: &[&str]| keys.iter().any(|(key, value)| key == "type" && names.contains(&value.as_str()));
    let geometries = ["Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon", "GeometryCollection"];
    if has("scenario") {
        FileKind::Result
    } else if of_type(&["FeatureCollection", "Feature"]) || of_type(&geometries) || has("features") {
        FileKind::GeoJson
    } else {
        FileKind::Json
    }
}

/// The keys of the outermost object, each with the text that is its value, if it is one.
fn outermost_keys(text: &str) -> Vec<(String, String)> {
    let mut keys: Vec<(String, String)> = Vec::new();
    let (mut depth, mut literal, mut last) = (0_usize, None::<String>, String::new());
    let (mut escaped, mut after_colon) = (false, false);
    for letter in text.chars() {
        if let Some(open) = &mut literal {
            match letter {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '"' => {
                    last = std::mem::take(open);
                    literal = None;
                    if depth == 1
                        && after_colon
                        && let Some(key) = keys.last_mut()
                    {
                        key.1.clone_from(&last);
                    }
                }
                // A key or a type is short.
                letter if open.len() < 64 => open.push(letter),
                _ => {}
            }
            continue;
        }
        match letter {
            '"' => literal = Some(String::new()),
            '{' | '[' => depth += 1,
            '}' | ']' => depth = depth.saturating_sub(1),
            ':' if depth == 1 => {
                keys.push((std::mem::take(&mut last), String::new()));
                after_colon = true;
            }
            ',' if depth == 1 => after_colon = false,
            _ => {}
        }
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_content_and_their_extension_is_only_a_help() {
        const PAGE: &str = "a web page";
        let stl = {
            let mut bytes = vec![b' '; 80];
            bytes.extend(1_u32.to_le_bytes());
            bytes.extend([0_u8; 50]);
            bytes
        };
        let cases: [(&[u8], &str, FileKind, &str); 46] = [
            (b"", "a.tif", FileKind::Empty, "an empty file"),
            (b"II*\0rest", "a.csv", FileKind::Raster("GeoTIFF"), "a GeoTIFF"),
            (b"ncols 2\nnrows 2\n", "a.toml", FileKind::Raster("ESRI ASCII grid"), "an ESRI ASCII grid"),
            (b"PDS_VERSION_ID = PDS3\n", "a", FileKind::Raster("PDS3 image"), "a PDS3 label or image"),
            (b"x,y,z\n0,0,1\n", "a.csv", FileKind::Raster("XYZ grid"), "an XYZ grid"),
            (b"0 0 1\n1 0 2\n", "a.csv", FileKind::Raster("XYZ grid"), "an XYZ grid"),
            (b"Object = IsisCube\n", "a", FileKind::ForeignRaster("an ISIS cube"), "an ISIS cube"),
            (b"v 0 0 0\nv 1 0 0\n", "a.tif", FileKind::Mesh("OBJ", true), "an OBJ mesh"),
            (b"ply\nformat ascii 1.0\n", "a", FileKind::Mesh("PLY", true), "a PLY mesh"),
            (b"ply\nformat binary_little_endian 1.0\n", "a", FileKind::Mesh("PLY", false), "a PLY mesh"),
            (b"solid\nfacet normal 0 0 1\n", "a", FileKind::Mesh("STL", true), "an STL mesh"),
            (&stl, "a", FileKind::Mesh("STL", false), "an STL mesh"),
            (b"glTF\x02\0\0\0", "a.obj", FileKind::ForeignMesh("a glTF model"), "a glTF model"),
            (b"# by hand\n\nx_m,z_m\n0,1\n", "a.tif", FileKind::ChainCsv, "a chain CSV"),
            (b"\xef\xbb\xbf\"x_m\";\"z_m\"\n0;1\n", "a", FileKind::ChainCsv, "a chain CSV"),
            (b"start_x_m,goal_x_m\n0,1\n", "a", FileKind::PairsCsv, "a CSV of pairs of start and goal"),
            (b"x_m,y_m\n0,1\n", "a", FileKind::PositionsCsv, "a CSV of positions on a map"),
            (b"run,drift_along_m\n0,1\n", "a", FileKind::MeasuredCsv, "a CSV of measured errors of hops"),
            (b"hop,direction,takeoff_x_m,takeoff_z_m,landing_x_m\n", "a", FileKind::PathCsv, "a CSV of the hops of a path"),
            (b"# mars\n[body]\nname = \"mars\"\n", "a.csv", FileKind::Scenario, "a scenario (TOML)"),
            (b"body.name = \"mars\"\n", "a", FileKind::Scenario, "a scenario (TOML)"),
            (b"body = { name = \"mars\" }\n", "a", FileKind::Scenario, "a scenario (TOML)"),
            (b"junk", "a.toml", FileKind::Scenario, "a scenario (TOML)"),
            (b"{\"schema\": \"chta/run/1\", \"scenario\": {\"type\": \"Feature\"}}", "a.tif", FileKind::Result, "a result (JSON)"),
            (b"{\"features\": [{\"scenario\": 1}], \"type\": \"FeatureCollection\"", "a", FileKind::GeoJson, "a GeoJSON"),
            (b"{\"type\": \"Polygon\", \"coordinates\": []}", "a.csv", FileKind::GeoJson, "a GeoJSON"),
            (b"{\"type\": \"Topology\"}", "a.json", FileKind::Json, "a JSON file without a scenario in it"),
            (b"<?xml version=\"1.0\"?><kml xmlns=\"x\">", "a", FileKind::Shapes(VectorFormat::Kml), "a KML file"),
            (b"\x00\x00\x27\x0a\0", "a.shp", FileKind::Shapes(VectorFormat::Shapefile), "an ESRI Shapefile"),
            (b"\x89PNG\r\n\x1a\n", "a.tif", FileKind::Picture("a PNG picture"), "a PNG picture"),
            (b"BM\x36\0\0\0\0\0\0\0\x36\0\0\0", "a", FileKind::Picture("a BMP picture"), "a BMP picture"),
            (b"<?xml version=\"1.0\"?>\n<svg width=\"1\"/>", "a", FileKind::Picture("an SVG picture"), "an SVG picture"),
            (b"\x1f\x8b\x08", "a.tif", FileKind::Packed("a file packed with gzip", "gunzip -k"), "a file packed with gzip"),
            (b"%PDF-1.7", "a", FileKind::Document("a PDF document"), "a PDF document"),
            (b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a", FileKind::ForeignMesh("an OFF mesh"), "an OFF mesh"),
            (b"ASTM-E57\x01", "a", FileKind::Points("an E57 point cloud"), "an E57 point cloud"),
            (b"<html>", "a.tif", FileKind::Document(PAGE), PAGE),
            (b"# .PCD v.7\n", "a", FileKind::Points("a PCD point cloud"), "a PCD point cloud"),
            (b"<Envelope/>", "a", FileKind::Document("an XML text"), "an XML text"),
            (b"\x04\x22\x4d\x18", "a", FileKind::Packed("a file packed with LZ4", "unlz4"), "a file packed with LZ4"),
            (b"{\"message\": \"no\"}", "a", FileKind::Json, "a JSON file without a scenario in it"),
            (b"n\0c\0o\0l\0s\0 \0", "a", FileKind::Binary, "a file of no known format"),
            (b"BMW drives\n", "a", FileKind::Text, "a text of no known form"),
            (b"[package]\nname = \"x\"\n", "a.ini", FileKind::Text, "a text of no known form"),
            (b"y\ny\ny\n", "a", FileKind::Text, "a text of no known form"),
            (&[0; 200], "a", FileKind::Binary, "a file of no known format"),
        ];
        for (content, name, kind, named) in cases {
            let found = FileKind::of_beginning(content, Some(content.len() as u64), Path::new(name));
            assert_eq!((&found, found.name().as_str()), (&kind, named), "{}", String::from_utf8_lossy(content));
        }
        // The length of a stream is not known: zeros are no STL, a triangle is one.
        assert_eq!(FileKind::of_beginning(&[0; 4096], None, Path::new("-")), FileKind::Binary);
        assert_eq!(FileKind::of_beginning(&stl, None, Path::new("-")), FileKind::Mesh("STL", false));
        let noise: Vec<u8> = (0..65_536_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13).to_le_bytes()[0]).collect();
        assert_eq!(FileKind::of_beginning(&noise, None, Path::new("-")), FileKind::Binary);
    }
}
