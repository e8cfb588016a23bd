//! What can be wrong with terrain: one enum, one sentence per variant.

use std::fmt;
use std::path::PathBuf;

use super::{LonLat, MapBounds, NoProjection, ScaleMend};
use crate::quantity::{MapPoint, format_number};

/// Why a DEM could not be read, written, sliced or made up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TerrainError {
    /// A problem of one file, named.
    #[error("terrain '{}': {problem}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: Box<Self>,
    },
    /// A problem of an overlay: keep-out zones or a friction raster.
    #[error("{what} '{}': {problem}", path.display())]
    Overlay {
        /// "keep-out zones" or "friction raster".
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and how to mend it.
        problem: String,
    },
    /// The operating system refused to read or write.
    #[error("cannot be {action}: {reason}")]
    Io {
        /// "read" or "written".
        action: &'static str,
        /// The system's words.
        reason: std::io::Error,
    },
    /// No reader knows the content.
    #[error("the content is no known elevation format (it begins with {found}), expected one of: {expected}")]
    NotRecognised {
        /// The first bytes, printable.
        found: String,
        /// Names of the formats that can be read.
        expected: String,
    },
    /// Bytes that are not what the format promises.
    #[error("the {format} is damaged: {reason}; expected a whole file, so copy or download it again")]
    Damaged {
        /// The format.
        format: &'static str,
        /// What did not fit.
        reason: String,
    },
    /// A sound file of a kind that holds no usable elevations; the text says what was found, what was expected and how to mend it.
    #[error("{found}, expected {expected}; mend it with: {mend}")]
    Unsuitable {
        /// What the file holds.
        found: String,
        /// What a DEM holds.
        expected: &'static str,
        /// A command that makes a usable file.
        mend: String,
    },
    /// A map whose coordinates are no lengths: degrees, or places in space.
    #[error("{found}, expected a projected map in metres; mend it with: {mend}")]
    NotProjected {
        /// What the file holds.
        found: String,
        /// A command that makes a usable file.
        mend: String,
    },
    /// Every problem found in the text of an ASCII or XYZ grid.
    #[error("{}", list_problems(problems, *further))]
    AsciiGrid {
        /// The first problems, in the file's order.
        problems: Vec<AsciiProblem>,
        /// How many more there were.
        further: usize,
    },
    /// Numbers that make no raster.
    #[error("{0}")]
    InvalidDem(String),
    /// Numbers that make no profile.
    #[error("{0}")]
    InvalidProfile(String),
    /// A transect without a direction.
    #[error("the transect starts and ends at the same point ({} m, {} m), expected two different points", format_number(at.x), format_number(at.y))]
    SamePoint {
        /// The point.
        at: MapPoint,
    },
    /// A point that the DEM does not cover.
    #[error("the {which} point ({} m, {} m) is off the map, expected {bounds} (the outermost posts)", format_number(at.x), format_number(at.y))]
    OffTheMap {
        /// "from" or "to".
        which: &'static str,
        /// The point.
        at: MapPoint,
        /// What the DEM covers.
        bounds: MapBounds,
    },
    /// Longitude and latitude on a map without a known projection.
    #[error(
        "the {which} point is given as longitude and latitude, but {reason}, expected a GeoTIFF with a projection in metres; give map \
         coordinates in metres, or state the projection with: gdal_translate -a_srs 'PROJ STRING' in.tif out.tif"
    )]
    NoProjection {
        /// "from" or "to".
        which: &'static str,
        /// What is known of the map.
        reason: NoProjection,
    },
    /// A place on the body that the DEM does not cover.
    #[error("the {which} point ({place}) {}, expected {bounds} (the outermost posts)", lies(*at))]
    LonLatOffTheMap {
        /// "from" or "to".
        which: &'static str,
        /// The place.
        place: LonLat,
        /// Where on the map that is, if anywhere.
        at: Option<MapPoint>,
        /// What the DEM covers.
        bounds: MapBounds,
    },
    /// A map whose scale along the transect is not 1.
    #[error("{found}, expected 1 within 1 %; mend it with: {mend}; or take it as it is with terrain.accept_map_scale = true")]
    MapScale {
        /// The factor and its place.
        found: String,
        /// What makes a map that is true along the transect.
        mend: ScaleMend,
    },
    /// A line that leaves what its projection shows of the body.
    #[error(
        "the line from ({} m, {} m) to ({} m, {} m) leaves the part of the map that shows the body, expected longitude and latitude all \
         the way; choose another line, or cut the map to the part that is needed (gdalwarp -te)",
        format_number(from.x), format_number(from.y), format_number(to.x), format_number(to.y)
    )]
    OffTheBody {
        /// Where it begins.
        from: MapPoint,
        /// Where it ends.
        to: MapPoint,
    },
    /// The plane of a slice meets posts without elevation.
    #[error(
        "the plane meets no-data {distance_m:.3} m from the start, at map point ({:.3} m, {:.3} m), expected elevations all the way; choose another \
         transect or fill the gap with: gdal_fillnodata.py in.tif filled.tif", at.x, at.y
    )]
    NoData {
        /// Where on the map.
        at: MapPoint,
        /// How far from the first point.
        distance_m: f64,
    },
    /// No reader of meshes knows the content.
    #[error("the content is no known mesh format (it begins with {found}), expected one of: {expected}")]
    NotAMesh {
        /// The first bytes, printable.
        found: String,
        /// Names of the formats that can be read.
        expected: String,
    },
    /// A line of a mesh's text.
    #[error("the {format} has a fault in line {line}: {problem}")]
    MeshText {
        /// The format.
        format: &'static str,
        /// Line of the file, from 1.
        line: usize,
        /// What stands there, and what was expected.
        problem: String,
    },
    /// Numbers that make no surface.
    #[error("{0}")]
    InvalidMesh(String),
    /// The plane of a slice meets no triangle for a stretch.
    #[error(
        "the plane meets no triangle of the mesh from x = {begin_m} m to {end_m} m along the transect, map ({:.6}, {:.6}) m to ({:.6}, {:.6}) m{}, expected \
         ground all the way; choose another transect, or close the hole in the mesh (narrow cracks: weld its vertices)",
        begin.x, begin.y, end.x, end.y, further_gaps(*further)
    )]
    MeshGap {
        /// Where the stretch begins along the transect, m.
        begin_m: f64,
        /// Where it ends, m.
        end_m: f64,
        /// Where it begins on the map.
        begin: MapPoint,
        /// Where it ends on the map.
        end: MapPoint,
        /// How many more stretches there are.
        further: usize,
    },
    /// An option of the synthetic terrain that makes no sense.
    #[error("synthetic terrain: {option} is {found}, expected {expected}")]
    InvalidOption {
        /// The option's name.
        option: &'static str,
        /// Its value.
        found: String,
        /// What is allowed.
        expected: String,
    },
}

impl TerrainError {
    /// The same problem with the name of its file.
    pub(super) fn in_file(self, path: &std::path::Path) -> Self {
        Self::InFile { path: path.to_path_buf(), problem: Box::new(self) }
    }

    pub(super) fn reading(reason: std::io::Error) -> Self {
        Self::Io { action: "read", reason }
    }

    pub(super) fn writing(reason: std::io::Error) -> Self {
        Self::Io { action: "written", reason }
    }
}

/// One problem in the text of an ASCII or XYZ grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AsciiProblem {
    /// Line of the file, from 1.
    pub line: usize,
    /// Character of the line, from 1.
    pub column: usize,
    /// What stands there.
    pub found: String,
    /// What was expected, and how to mend it.
    pub expected: String,
}

impl fmt::Display for AsciiProblem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "line {}, column {}: found {}, expected {}", self.line, self.column, self.found, self.expected)
    }
}

/// Where a place lies, for a sentence.
fn lies(at: Option<MapPoint>) -> String {
    at.map_or_else(
        || "lies nowhere on the map".to_owned(),
        |at| format!("is off the map, at map point ({:.3} m, {:.3} m)", at.x, at.y),
    )
}

fn further_gaps(further: usize) -> String {
    if further == 0 { String::new() } else { format!(" (and {further} more such stretches)") }
}

fn list_problems(problems: &[AsciiProblem], further: usize) -> String {
    let mut lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
    if further > 0 {
        lines.push(format!("and {further} more like these"));
    }
    lines.join("\n")
}
