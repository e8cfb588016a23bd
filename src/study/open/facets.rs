//! The terrain of a free route over facets, of a mesh or for legs of a DEM, and the scenario for it.

use std::path::PathBuf;

use serde::Serialize;

use super::{Draft, OpenError, Purpose};
use crate::{
    report::{CrsRecord, DocumentKind, InputFile},
    scenario::{Scenario, TerrainSource, scenario_document},
    study::{CaseRecord, checksums, scenario_files},
};

/// The scenario of a free route over facets, opened for a question.
#[derive(Clone, Debug)]
pub struct OpenFacets {
    /// The scenario, whose terrain is a mesh as it stands, or for a robot with legs a DEM.
    pub scenario: Scenario,
    /// The folder that its paths start from.
    pub base: PathBuf,
    /// The file of the terrain.
    pub mesh: PathBuf,
    /// The head of the document.
    pub record: CaseRecord,
}

impl OpenFacets {
    /// Whether a robot with legs stands on them.
    pub const fn is_of_legs(&self) -> bool {
        self.scenario.legs.file.is_some()
    }

    /// The files that are read, with their checksums.
    pub fn inputs(&self) -> &[InputFile] {
        &self.record.inputs
    }

    /// An answer as one document, with its warnings.
    ///
    /// # Errors
    /// An error of the serialiser; plain data causes none.
    pub fn document<T: Serialize>(&self, kind: DocumentKind, warnings: &[String], answer: T) -> Result<String, serde_json::Error> {
        self.record.document(kind, warnings, answer).to_json()
    }

    /// The same on a map, whose reference system is known or not.
    ///
    /// # Errors
    /// An error of the serialiser; plain data causes none.
    pub fn document_on_map<T: Serialize>(
        &self,
        kind: DocumentKind,
        crs: Option<&CrsRecord>,
        warnings: &[String],
        answer: T,
    ) -> Result<String, serde_json::Error> {
        let record = CaseRecord { crs: crs.cloned(), ..self.record.clone() };
        record.document(kind, warnings, answer).to_json()
    }
}

impl Draft {
    /// Whether the keys ask for a free route over facets.
    pub fn is_over_facets(&self) -> bool {
        !self.entries.is_unreadable() && (self.entries.ask_for_free_mesh() || self.entries.ask_for_legs_on_dem())
    }

    /// Whether a question about them is one over facets.
    pub fn asks_over_facets(&self, purpose: Purpose) -> bool {
        let is_of_legs = self.file_of("robot.file").is_some();
        match purpose {
            // Its nodes are those of a map over any DEM.
            Purpose::MapMesh => self.is_over_facets() && self.entries.ask_for_free_mesh(),
            // A point has no limbs and cones to compare.
            Purpose::Trade => self.is_over_facets() && is_of_legs,
            _ => self.is_over_facets(),
        }
    }

    /// Opens the scenario of a free route over a mesh, or of a robot with legs over a mesh or a DEM; `None` for any other scenario.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn facets(&self, purpose: Purpose) -> Result<Option<OpenFacets>, OpenError> {
        if !self.asks_over_facets(purpose) {
            return Ok(None);
        }
        let (base, wording) = (self.base.clone(), &self.wording);
        let scenario = self.validated(purpose.stands_on_legs())?;
        // Two terrains would have been refused.
        let Some(TerrainSource::MeshInSpace { path, .. } | TerrainSource::Dem { path, .. }) = &scenario.terrain else {
            return Ok(None);
        };
        let terrain = if matches!(scenario.terrain, Some(TerrainSource::Dem { .. })) { "a DEM" } else { "a mesh" };
        let mesh = base.join(path);
        let keys = lacking_without_robot(&scenario);
        if !keys.is_empty() {
            return Err(OpenError::Lacking { name: self.name.clone(), keys, terrain });
        }
        let unused = purpose.unused(&self.entries, &scenario, wording);
        let warnings: Vec<String> = unused.into_iter().chain(Purpose::replaced(&self.entries)).collect();
        let document = scenario_document(&scenario, &|path| (wording.file_name)(&base.join(path)));
        let inputs = checksums(&scenario_files(&scenario, &base), &wording.file_name)?;
        let record = CaseRecord { scenario: document, inputs, warnings, crs: None };
        Ok(Some(OpenFacets { scenario, base, mesh, record }))
    }
}

/// The keys that a scenario lacks for hops over a DEM or a mesh; a robot file may state the speeds.
pub(super) fn lacking_without_robot(scenario: &Scenario) -> Vec<crate::scenario::LackingKey> {
    let mut lacking = scenario.lacks_on_a_dem();
    lacking.retain(|key| scenario.legs.file.is_none() || key.key.starts_with("surface."));
    lacking
}
