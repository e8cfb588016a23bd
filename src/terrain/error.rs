//! The errors of terrain: one enum, one sentence per variant.

use std::fmt;
use std::path::PathBuf;

use super::{DegreesMend, Ellipsoid, LonLat, MapBounds, NoProjection, ScaleMend, VoidTaken};
use crate::quantity::{MapPoint, format_number};

/// Why a DEM or mesh could not be read, written, sliced or generated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TerrainError {
    /// A problem of one file, with its name.
    #[error("terrain '{}': {problem}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: Box<Self>,
    },
    /// A problem of an overlay: keep-out zones or a friction raster.
    #[error("{what} '{}': {problem}", path.display())]
    Overlay {
        /// "keep-out zones" or "friction raster".
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and how to correct it.
        problem: String,
    },
    /// A sidecar file that cannot be used with its raster.
    #[error("its sidecar file '{}': {problem}", path.display())]
    Sidecar {
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and how to correct it.
        problem: String,
    },
    /// A usual mark of missing data that nothing states and that is not ground either.
    #[error("{0}")]
    Void(Box<VoidTaken>),
    /// The operating system refused to read or write.
    #[error("cannot be {action}: {reason}")]
    Io {
        /// "read" or "written".
        action: &'static str,
        /// The message of the operating system.
        reason: std::io::Error,
    },
    /// The content is in none of the known formats.
    #[error("the content is not a known elevation format (it begins with {found}), expected one of: {expected}")]
    NotRecognised {
        /// The first bytes, printable.
        found: String,
        /// Names of the formats that can be read.
        expected: String,
    },
    /// The bytes do not follow the format.
    #[error("the {format} is damaged: {reason}; expected a whole file, so copy or download it again")]
    Damaged {
        /// The format.
        format: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// A valid file without usable elevations; the text says what was found, what was expected and how to correct it.
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
        mend: DegreesMend,
    },
    /// Every problem found in the text of an ASCII or XYZ grid.
    #[error("{}", list_problems(problems, *further))]
    AsciiGrid {
        /// The first problems, in the file's order.
        problems: Vec<AsciiProblem>,
        /// How many more there were.
        further: usize,
    },
    /// The numbers do not form a raster.
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
    /// A point outside the DEM.
    #[error("the {which} point ({} m, {} m) is off the map, expected {bounds} (the outermost posts)", format_number(at.x), format_number(at.y))]
    OffTheMap {
        /// "from" or "to".
        which: &'static str,
        /// The point.
        at: MapPoint,
        /// The area of the DEM.
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
        /// Why the map has no known projection.
        reason: NoProjection,
    },
    /// A point, given as longitude and latitude, outside the DEM.
    #[error("the {which} point ({place}) {}, expected {bounds} (the outermost posts)", lies(*at))]
    LonLatOffTheMap {
        /// "from" or "to".
        which: &'static str,
        /// The point.
        place: LonLat,
        /// Its position on the map, if it has one.
        at: Option<MapPoint>,
        /// The area of the DEM.
        bounds: MapBounds,
    },
    /// A map whose scale along the transect is not 1.
    #[error("{found}, expected 1 within 1 %; mend it with: {mend}; or take it as it is with terrain.accept_map_scale = true")]
    MapScale {
        /// The scale factor and its position.
        found: String,
        /// What makes a map that is true along the transect.
        mend: ScaleMend,
    },
    /// A map whose projection is stated and not supported, so that its scale cannot be worked out.
    #[error(
        "{reason}, expected a map whose scale can be worked out; mend it with: {mend}; or take it as it is with terrain.accept_map_scale = true"
    )]
    UnknownScale {
        /// What is not supported.
        reason: NoProjection,
        /// A command that makes a map of a supported projection.
        mend: String,
    },
    /// A map of another body than the user's.
    #[error(
        "the map is of a body with {}, but {body} has a radius of {radius_m} m, expected one body for both; where the map is wrong, make it again \
         from its source with +R={radius_m} in every PROJ string; where gravity alone is wanted, over this ground, give body.gravity_m_s2 without \
         body.name and body.radius_m",
        figure.described()
    )]
    OtherBody {
        /// The figure of the map.
        figure: Ellipsoid,
        /// The body that the user gives.
        body: String,
        /// Its radius, m.
        radius_m: f64,
    },
    /// A line that leaves the part of the map that shows the body.
    #[error(
        "the line from ({} m, {} m) to ({} m, {} m) leaves the part of the map that shows the body, expected longitude and latitude all \
         the way; choose another line, or cut the map to the part that is needed (gdalwarp -te)",
        format_number(from.x), format_number(from.y), format_number(to.x), format_number(to.y)
    )]
    OffTheBody {
        /// Its first end.
        from: MapPoint,
        /// Its second end.
        to: MapPoint,
    },
    /// The plane of a slice meets posts without elevation.
    #[error(
        "the plane meets no-data {distance_m:.3} m from the start, at map point ({:.3} m, {:.3} m), expected elevations all the way; choose another \
         transect or fill the gap with: gdal_fillnodata.py in.tif filled.tif", at.x, at.y
    )]
    NoData {
        /// The position on the map.
        at: MapPoint,
        /// The distance from the first point.
        distance_m: f64,
    },
    /// The content is in none of the known mesh formats.
    #[error("the content is not a known mesh format (it begins with {found}), expected one of: {expected}")]
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
        /// What was found, and what was expected.
        problem: String,
    },
    /// The numbers do not form a surface.
    #[error("{0}")]
    InvalidMesh(String),
    /// The plane of a slice meets no triangle over part of the transect.
    #[error(
        "the plane meets no triangle of the mesh from x = {begin_m} m to {end_m} m along the transect, map ({:.6}, {:.6}) m to ({:.6}, {:.6}) m{}, expected \
         ground all the way; {cause}",
        begin.x, begin.y, end.x, end.y, further_gaps(*further)
    )]
    MeshGap {
        /// Where this part begins along the transect, m.
        begin_m: f64,
        /// Where it ends, m.
        end_m: f64,
        /// Where it begins on the map.
        begin: MapPoint,
        /// Where it ends on the map.
        end: MapPoint,
        /// Number of further parts without triangles.
        further: usize,
        /// The likely cause.
        cause: GapCause,
    },
    /// An option of the synthetic terrain is out of range.
    #[error("synthetic terrain: {option} is {found}, expected {expected}")]
    InvalidOption {
        /// The option's name.
        option: &'static str,
        /// Its value.
        found: String,
        /// The allowed values.
        expected: String,
    },
}

impl TerrainError {
    /// The same problem with the name of the file.
    pub(super) fn in_file(self, path: &std::path::Path) -> Self {
        Self::InFile { path: path.to_path_buf(), problem: Box::new(self) }
    }

    /// The same with the body that the user gives, for a command that mends a map in degrees.
    #[must_use]
    pub fn for_body(self, name: &str, radius_m: f64) -> Self {
        match self {
            Self::InFile { path, problem } => Self::InFile { path, problem: Box::new(problem.for_body(name, radius_m)) },
            Self::NotProjected { found, mend } => Self::NotProjected { found, mend: mend.for_body(name, radius_m) },
            other => other,
        }
    }

    /// The same with the names that the ends of a journey have, instead of those of a slice: an end at neither of the two is an
    /// intermediate point.
    #[must_use]
    pub(crate) fn of_journey(self, start: Option<MapPoint>, goal: Option<MapPoint>) -> Self {
        let renamed = |which| match which {
            "from" => "start",
            "to" => "goal",
            other => other,
        };
        match self {
            Self::InFile { path, problem } => Self::InFile { path, problem: Box::new(problem.of_journey(start, goal)) },
            Self::OffTheMap { at, bounds, .. } => {
                let ends = [("start", start), ("goal", goal)];
                let which = ends.into_iter().find(|(_, end)| *end == Some(at)).map_or("via", |(which, _)| which);
                Self::OffTheMap { which, at, bounds }
            }
            Self::NoProjection { which, reason } => Self::NoProjection { which: renamed(which), reason },
            Self::LonLatOffTheMap { which, place, at, bounds } => {
                Self::LonLatOffTheMap { which: renamed(which), place, at, bounds }
            }
            other => other,
        }
    }

    pub(super) fn reading(reason: std::io::Error) -> Self {
        Self::Io { action: "read", reason }
    }

    pub(super) fn writing(reason: std::io::Error) -> Self {
        Self::Io { action: "written", reason }
    }
}

/// Why a plane meets no triangle of a mesh, as far as its numbers tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GapCause {
    /// The stretch is narrower than the triangles: vertices that should be one lie apart.
    Crack,
    /// Triangles are missing inside the mesh.
    Hole,
    /// The transect leaves the mesh.
    OffTheMesh {
        /// The area of the mesh.
        bounds: MapBounds,
        /// Whether the mesh is so much smaller than the transect that its unit may not be the metre.
        unit_in_doubt: bool,
    },
}

impl fmt::Display for GapCause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crack => formatter.write_str(
                "the stretch is narrower than the triangles beside it: close the crack (weld the mesh's vertices), or choose another transect",
            ),
            Self::Hole => formatter.write_str("choose another transect, or close the hole in the mesh"),
            Self::OffTheMesh { bounds, unit_in_doubt: true } => write!(
                formatter,
                "the mesh has only {bounds}: if its unit is not the metre, give mesh_scale, its metres per unit (1000 for km), else choose \
                 ends on it"
            ),
            Self::OffTheMesh { bounds, unit_in_doubt: false } => {
                write!(formatter, "the mesh has {bounds}: choose ends on it, or check mesh_scale, its metres per unit")
            }
        }
    }
}

/// One problem in the text of an ASCII or XYZ grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AsciiProblem {
    /// Line of the file, from 1.
    pub line: usize,
    /// Character of the line, from 1.
    pub column: usize,
    /// What was found.
    pub found: String,
    /// What was expected, and how to correct it.
    pub expected: String,
}

impl fmt::Display for AsciiProblem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "line {}, column {}: found {}, expected {}", self.line, self.column, self.found, self.expected)
    }
}

/// A phrase for the position of a point.
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
