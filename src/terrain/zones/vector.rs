//! Files of shapes that are not read, with the command that makes GeoJSON of them on the terrain's map.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::terrain::{CoordinateSystem, MapProjection, shell_word, without_mark};

/// A format of shapes other than `GeoJSON`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum VectorFormat {
    /// Keyhole markup, in longitude and latitude.
    Kml,
    /// Keyhole markup in a zip.
    Kmz,
    /// The shapes of an ESRI Shapefile.
    Shapefile,
    /// Its index, table or projection: a file beside the shapes.
    ShapefilePart,
    /// A `GeoPackage`.
    GeoPackage,
    /// A `FlatGeobuf`.
    FlatGeobuf,
    /// Geography markup.
    Gml,
    /// Tracks of a satellite receiver, in longitude and latitude.
    Gpx,
    /// A drawing of a CAD program.
    Dxf,
}

impl VectorFormat {
    /// The format of a file with this beginning and name.
    pub fn of(beginning: &[u8], path: &Path) -> Option<Self> {
        let has_extension =
            |names: &[&str]| path.extension().is_some_and(|own| names.iter().any(|name| own.eq_ignore_ascii_case(name)));
        let text = without_mark(beginning).trim_ascii_start();
        let contains = |word: &[u8]| text.windows(word.len()).any(|window| window == word);
        if beginning.starts_with(b"\x00\x00\x27\x0a") {
            return Some(if has_extension(&["shx"]) { Self::ShapefilePart } else { Self::Shapefile });
        }
        if has_extension(&["dbf"]) && matches!(beginning.first(), Some(0x03 | 0x30 | 0x83)) {
            return Some(Self::ShapefilePart);
        }
        let projection = [&b"PROJCS["[..], b"GEOGCS[", b"PROJCRS[", b"GEOGCRS[", b"LOCAL_CS["];
        if projection.iter().any(|word| text.starts_with(word)) {
            return Some(Self::ShapefilePart);
        }
        // A GeoPackage is a database whose application is named at byte 68; early ones have only their extension.
        if beginning.starts_with(b"SQLite format 3\0") {
            let named = beginning.get(68..70) == Some(b"GP") || has_extension(&["gpkg"]);
            return named.then_some(Self::GeoPackage);
        }
        if beginning.starts_with(b"fgb\x03") {
            return Some(Self::FlatGeobuf);
        }
        if beginning.starts_with(b"PK\x03\x04") {
            return has_extension(&["kmz"]).then_some(Self::Kmz);
        }
        if text.starts_with(b"<") {
            let formats = [(&b"<kml"[..], Self::Kml), (b"<gpx", Self::Gpx), (b"opengis.net/gml", Self::Gml)];
            return formats.into_iter().find(|(word, _)| contains(word)).map(|(_, format)| format);
        }
        let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
        (lines.next() == Some(b"0") && lines.next() == Some(b"SECTION")).then_some(Self::Dxf)
    }

    /// The name with an article.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kml => "a KML file",
            Self::Kmz => "a KMZ file (KML in a zip)",
            Self::Shapefile => "an ESRI Shapefile",
            Self::ShapefilePart => "a file beside an ESRI Shapefile (.shx, .dbf, .prj), which has no shapes in it",
            Self::GeoPackage => "a GeoPackage",
            Self::FlatGeobuf => "a FlatGeobuf",
            Self::Gml => "a GML file",
            Self::Gpx => "a GPX file",
            Self::Dxf => "a DXF drawing",
        }
    }

    /// Whether a file of the format may have several layers, such as the folders of KML.
    const fn may_have_layers(self) -> bool {
        matches!(self, Self::Kml | Self::Kmz | Self::GeoPackage | Self::Gml)
    }

    /// Whether its coordinates are longitude and latitude by definition.
    const fn is_in_degrees(self) -> bool {
        matches!(self, Self::Kml | Self::Kmz | Self::Gpx)
    }
}

/// Why zones in this format are refused: what the file is, what is expected, and the command that converts it to the terrain's map.
pub(super) fn refusal(format: VectorFormat, path: &Path, coordinates: Option<&CoordinateSystem>) -> String {
    let (path, format) = match format {
        VectorFormat::ShapefilePart => (path.with_extension("shp"), VectorFormat::Shapefile),
        format => (path.to_path_buf(), format),
    };
    let found = format!("this is {}; expected polygons as GeoJSON in the terrain's map coordinates", format.name());
    if format == VectorFormat::Gpx {
        return format!(
            "{found}: GPX holds tracks and points but no polygons, so draw the zones as polygons in another format, such as KML"
        );
    }
    let projection = coordinates.and_then(|system| MapProjection::of(system).ok());
    let systems = match (&projection, format.is_in_degrees()) {
        (None, true) => {
            return format!(
                "{found}: it holds longitude and latitude, which have no place on a terrain without a projection: state the projection \
                 of the terrain with: gdal_translate -a_srs 'PROJ STRING' in.tif out.tif, or draw the zones in its map coordinates"
            );
        }
        // Longitude and latitude of the terrain's body: these formats say they are the Earth's, whatever was drawn.
        (Some(map), true) => {
            format!(" -s_srs '+proj=longlat {} +no_defs' -t_srs '{}'", map.definition().ellipsoid.proj(), map.proj_string())
        }
        (Some(map), false) if states_its_map(format, &path) => format!(" -t_srs '{}'", map.proj_string()),
        (_, false) => String::new(),
    };
    let (out, own) = (shell_word(&path.with_extension("geojson")), shell_word(&path));
    // ogr2ogr writes the first layer alone into GeoJSON, and fails after it.
    let command = if format.may_have_layers() {
        format!("ogrmerge.py -single -f GeoJSON{systems} -o {out} {own}")
    } else {
        format!("ogr2ogr -f GeoJSON{systems} {out} {own}")
    };
    let then = format!("then give {} as keep_out", path.with_extension("geojson").display());
    let hint = match (format, systems.is_empty()) {
        (VectorFormat::Shapefile | VectorFormat::Dxf | VectorFormat::Gml, true) => {
            "; its coordinates must be those of the terrain's map already"
        }
        (VectorFormat::GeoPackage | VectorFormat::FlatGeobuf | VectorFormat::Gml, false) => {
            "; if it states no reference system and its coordinates are the map's already, leave -t_srs away"
        }
        _ => "",
    };
    format!("{found}: convert it with: {command}; {then}{hint}")
}

/// Whether a file states the reference system of its coordinates.
fn states_its_map(format: VectorFormat, path: &Path) -> bool {
    match format {
        VectorFormat::Shapefile => ["prj", "PRJ"].iter().any(|extension| path.with_extension(extension).is_file()),
        VectorFormat::Dxf => false,
        VectorFormat::Gml => names_a_system(path),
        _ => true,
    }
}

/// Whether a GML file names a reference system anywhere in its first megabyte.
fn names_a_system(path: &Path) -> bool {
    let mut beginning = Vec::new();
    let read = File::open(path).and_then(|file| file.take(1 << 20).read_to_end(&mut beginning));
    read.is_ok() && beginning.windows(7).any(|word| word.eq_ignore_ascii_case(b"srsName"))
}
