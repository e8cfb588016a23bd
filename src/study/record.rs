//! What a result says of its question: the scenario, the files that were read, the warnings, the map.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Overlays, PipelineError, sha256_of};
use crate::{
    report::{CompareAnswer, CrsRecord, Document, DocumentKind, InputFile},
    scenario::{Scenario, TerrainSource},
    terrain::sidecar_files,
};

/// The head of every document about one case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseRecord {
    /// The scenario as used, which reads back.
    pub scenario: serde_json::Value,
    /// The files that were read.
    pub inputs: Vec<InputFile>,
    /// The warnings about the input.
    pub warnings: Vec<String>,
    /// The reference system of the map, if the chain lies on a map of a known projection.
    pub crs: Option<CrsRecord>,
}

impl CaseRecord {
    /// The document of an answer, with the warnings about the input and then those about the answer, without repetition.
    pub fn document<T: Serialize>(&self, kind: DocumentKind, warnings: &[String], answer: T) -> Document<T> {
        let mut all = self.warnings.clone();
        for warning in warnings {
            if !all.contains(warning) {
                all.push(warning.clone());
            }
        }
        let mut document = Document::new(kind, self.scenario.clone(), self.inputs.clone(), all, answer);
        document.crs.clone_from(&self.crs);
        document
    }
}

/// The files that are read for a scenario: its terrain and its overlays, each raster with the files beside it, and its measured errors.
///
/// `base` is the folder that the scenario's paths start from.
pub fn scenario_files(scenario: &Scenario, base: &Path) -> Vec<PathBuf> {
    let mut files = match &scenario.terrain {
        Some(TerrainSource::Dem { path, .. }) => raster_files(&base.join(path)),
        Some(source @ (TerrainSource::Mesh { .. } | TerrainSource::MeshInSpace { .. } | TerrainSource::Chain { .. })) => {
            vec![base.join(source.path())]
        }
        None => Vec::new(),
    };
    files.extend(scenario.legs.file.as_ref().map(|path| base.join(path)));
    files.extend(Overlays::files(scenario).flat_map(|overlay| raster_files(&base.join(overlay))));
    files.extend(scenario.uncertainty.as_ref().and_then(|keys| keys.errors_file.as_ref()).map(|path| base.join(path)));
    files
}

/// A raster, or a vector file, and the files beside it that are read with it.
pub fn raster_files(path: &Path) -> Vec<PathBuf> {
    std::iter::once(path.to_path_buf()).chain(sidecar_files(path)).collect()
}

/// Files as a result lists them, each with its checksum. They are `name`d by the caller, such as relative to its working folder.
///
/// # Errors
/// [`PipelineError::Read`].
pub fn checksums(files: &[PathBuf], name: &dyn Fn(&Path) -> String) -> Result<Vec<InputFile>, PipelineError> {
    files.iter().map(|file| Ok(InputFile { name: name(file), sha256: sha256_of(file)? })).collect()
}

/// The document of scenarios side by side: their records, the warnings, the table. Files that several have are listed once.
///
/// # Errors
/// An error of the serialiser; plain data causes none.
pub fn comparison_document(
    records: &[&CaseRecord],
    warnings: Vec<String>,
    answer: &CompareAnswer,
) -> Result<String, serde_json::Error> {
    let scenarios = records.iter().map(|record| record.scenario.clone()).collect();
    let mut inputs: Vec<InputFile> = Vec::new();
    for input in records.iter().flat_map(|record| &record.inputs) {
        if !inputs.contains(input) {
            inputs.push(input.clone());
        }
    }
    Document::new(DocumentKind::Compare, serde_json::Value::Array(scenarios), inputs, warnings, answer).to_json()
}
