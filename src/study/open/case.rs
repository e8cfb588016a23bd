//! A case, and what its documents say of it.

use serde::Serialize;

use super::{Purpose, SharedInputs, Wording};
use crate::{
    report::DocumentKind,
    scenario::Entries,
    study::{Case, CaseRecord, PipelineError},
};

/// A scenario over its terrain, opened for a question.
#[derive(Clone, Debug)]
pub struct OpenCase {
    /// The case, with all warnings about the input.
    pub case: Case,
    /// The head of its documents.
    pub record: CaseRecord,
}

impl OpenCase {
    /// Adds the warnings about keys to a case and records its files. `given`: the keys without those that a question varies; `typed`:
    /// with them.
    ///
    /// # Errors
    /// [`PipelineError::Read`], if a file is gone.
    pub fn new(case: Case, purpose: Purpose, keys: [&Entries; 2], wording: &Wording) -> Result<Self, PipelineError> {
        Self::sharing(case, purpose, keys, wording, &SharedInputs::default())
    }

    /// The same with checksums of files that other cases may have read.
    pub(super) fn sharing(
        mut case: Case,
        purpose: Purpose,
        [given, typed]: [&Entries; 2],
        wording: &Wording,
        shared: &SharedInputs,
    ) -> Result<Self, PipelineError> {
        let unused = purpose.unused(given, &case.scenario, wording);
        case.prepared.warnings.extend(unused.into_iter().chain(Purpose::replaced(typed)));
        let inputs = shared.checksums(&case.scenario, &case.base, &wording.file_name)?;
        Ok(Self { record: case.recorded(inputs, &wording.file_name), case })
    }

    /// An answer as one document, with its warnings.
    ///
    /// # Errors
    /// An error of the serialiser; plain data causes none.
    pub fn document<T: Serialize>(&self, kind: DocumentKind, warnings: &[String], answer: T) -> Result<String, serde_json::Error> {
        self.record.document(kind, warnings, answer).to_json()
    }
}
