//! The frame that every JSON result stands in.

use serde::Serialize;

/// A result as one JSON document: what it is, what made it, from what, and the answer.
///
/// No clock and no absolute path, so that the same run gives the same bytes.
#[derive(Clone, Debug, Serialize)]
pub struct Document<T: Serialize> {
    /// Kind and version of the document, such as `chta/plan/1`.
    pub schema: String,
    /// The program's version.
    pub chta_version: &'static str,
    /// The scenario as used, in SI units and degrees.
    pub scenario: serde_json::Value,
    /// The files it was made from.
    pub inputs: Vec<InputFile>,
    /// What the analyst should know.
    pub warnings: Vec<String>,
    /// The answer.
    #[serde(flatten)]
    pub answer: T,
}

/// A file that a result was made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct InputFile {
    /// Its name, relative to the working folder.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

impl<T: Serialize> Document<T> {
    /// A document of a kind (`hop`, `check`, `plan`, `run`).
    pub fn new(kind: &str, scenario: serde_json::Value, inputs: Vec<InputFile>, warnings: Vec<String>, answer: T) -> Self {
        Self { schema: format!("chta/{kind}/1"), chta_version: env!("CARGO_PKG_VERSION"), scenario, inputs, warnings, answer }
    }

    /// As indented JSON with a final line end.
    ///
    /// # Errors
    /// What the serialiser says, which for plain data is nothing.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|json| json + "\n")
    }
}
