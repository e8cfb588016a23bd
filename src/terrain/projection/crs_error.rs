//! Why a text does not state a usable coordinate reference system.

/// Why a code, a PROJ string or well-known text (WKT) gives no map projection. Each message says what was found, what was expected
/// and how to correct it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CrsError {
    /// The text has none of the three forms.
    #[error(
        "'{found}' is not a coordinate reference system, expected a code (EPSG:32633, IAU_2015:30135), a PROJ string (+proj=...) or well-known \
         text (PROJCS[...], PROJCRS[...]); gdalsrsinfo -o proj4 FILE prints the PROJ string of a file"
    )]
    NotRecognised {
        /// The beginning of the text.
        found: String,
    },
    /// A code that is not in the tables of this library.
    #[error(
        "the code '{found}' is not supported, expected {expected}; give its PROJ string instead, which gdalsrsinfo -o proj4 {found} prints"
    )]
    UnknownCode {
        /// The code.
        found: String,
        /// The supported codes.
        expected: &'static str,
    },
    /// A system that is not a projected map: degrees, geocentric coordinates, heights alone, a local system.
    #[error(
        "{found}, expected a projected map in metres, such as '+proj=stere +lat_0=LATITUDE +lon_0=LONGITUDE +R=RADIUS_M +units=m' about the \
         middle of the area; gdalwarp -t_srs makes a raster on it"
    )]
    NotProjected {
        /// What the text states.
        found: String,
    },
    /// A unit other than the metre or the degree.
    #[error(
        "{what} in '{found}', expected {expected}; convert the values, or warp the raster with: gdalwarp -t_srs 'THE SAME PROJECTION WITH +units=m'"
    )]
    Unit {
        /// What is in that unit, such as "map coordinates".
        what: &'static str,
        /// The unit's name.
        found: String,
        /// The unit that was expected.
        expected: &'static str,
    },
    /// A projection method that is not supported.
    #[error(
        "the projection method '{found}' is not supported, expected one of: {expected}; warp the raster to one of them with: gdalwarp -t_srs"
    )]
    UnknownMethod {
        /// The method's name, as the text has it.
        found: String,
        /// The names of the supported methods.
        expected: String,
    },
    /// A parameter that is not supported, or not part of this projection. Ignoring it would give another map.
    #[error(
        "{item} is not supported or does not belong to this projection, expected {expected}; remove it if it has no effect on the map"
    )]
    UnknownParameter {
        /// The parameter, as the text has it.
        item: String,
        /// What is expected.
        expected: &'static str,
    },
    /// A required parameter that is missing.
    #[error("{item} is missing, expected {expected}; add it")]
    Missing {
        /// The parameter.
        item: &'static str,
        /// What it states.
        expected: &'static str,
    },
    /// A parameter that is given twice, or by two names.
    #[error("{item} is given twice, expected it once; remove one of them")]
    Repeated {
        /// The parameter.
        item: String,
    },
    /// A parameter whose value is not a finite number.
    #[error("{item} is not a number: found '{found}', expected a finite number; correct it")]
    NotANumber {
        /// The parameter.
        item: String,
        /// Its value.
        found: String,
    },
    /// Parameters that exclude one another.
    #[error("{found}, expected {expected}; remove or correct one of them")]
    Contradiction {
        /// What is contradictory.
        found: String,
        /// What is expected.
        expected: &'static str,
    },
    /// Text that breaks the grammar of WKT.
    #[error(
        "the well-known text has {found} at byte {at} (from 0), expected {expected}; copy the whole text again, from the first keyword to the last bracket"
    )]
    Syntax {
        /// Where, bytes from the start of the text.
        at: usize,
        /// What was found there.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// Numbers that make no valid projection, such as a negative radius.
    #[error("the projection has {fault}, expected numbers that make a map; correct them")]
    Invalid {
        /// What is wrong with its numbers.
        fault: String,
    },
}

impl CrsError {
    /// The beginning of a text, for an error message.
    pub(super) fn excerpt(text: &str) -> String {
        crate::quantity::excerpt(text, 60)
    }
}
