//! The envelope of every JSON result.

use serde::Serialize;

use crate::terrain::MapProjection;

/// A result as one JSON document: its kind, the program's version, the inputs and the answer.
///
/// It holds no time and no absolute path, so that the same run gives the same bytes.
#[derive(Clone, Debug, Serialize)]
pub struct Document<T: Serialize> {
    /// Kind and version of the document, such as `chta/plan/1`.
    pub schema: String,
    /// The program's version.
    pub chta_version: &'static str,
    /// The scenario as used, in SI units and degrees.
    pub scenario: serde_json::Value,
    /// The input files.
    pub inputs: Vec<InputFile>,
    /// Warnings for the analyst.
    pub warnings: Vec<String>,
    /// The reference system of the map; absent if the chain is not on a map of a known projection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crs: Option<CrsRecord>,
    /// The answer.
    #[serde(flatten)]
    pub answer: T,
}

/// The reference system of a map.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CrsRecord {
    /// Its name, for the reader.
    pub name: String,
    /// Its proj string.
    pub proj: String,
    /// Authority and code, such as `IAU_2015:30135`; null if no code is known.
    pub code: Option<String>,
}

impl From<&MapProjection> for CrsRecord {
    fn from(projection: &MapProjection) -> Self {
        let code = projection.code().map(str::to_owned);
        Self { name: projection.name().to_owned(), proj: projection.proj_string(), code }
    }
}

impl CrsRecord {
    /// The same as comments for the head of a chain CSV.
    pub fn comments(&self) -> Vec<String> {
        let code = self.code.as_ref().map(|code| format!("crs_code: {code}"));
        [format!("crs_name: {}", self.name), format!("crs_proj: {}", self.proj)].into_iter().chain(code).collect()
    }
}

/// An input file of a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct InputFile {
    /// Its name, relative to the working folder.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

impl<T: Serialize> Document<T> {
    /// A document of the given kind (`hop`, `check`, `plan`, `run`).
    pub fn new(kind: &str, scenario: serde_json::Value, inputs: Vec<InputFile>, warnings: Vec<String>, answer: T) -> Self {
        Self {
            schema: format!("chta/{kind}/1"),
            chta_version: env!("CARGO_PKG_VERSION"),
            scenario,
            inputs,
            warnings,
            crs: None,
            answer,
        }
    }

    /// The same with the reference system of its map.
    #[must_use]
    pub fn on_map(mut self, projection: Option<&MapProjection>) -> Self {
        self.crs = projection.map(CrsRecord::from);
        self
    }

    /// As indented JSON with a final line end.
    ///
    /// # Errors
    /// An error of the serialiser; plain data causes none.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| json + "\n")
    }
}
