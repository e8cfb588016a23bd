//! The envelope of every JSON result.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;

use crate::terrain::MapProjection;

/// The kinds of documents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DocumentKind {
    /// One hop: [`HopAnswer`](super::HopAnswer).
    Hop,
    /// One hop over a mesh: [`MeshHopAnswer`](super::MeshHopAnswer).
    HopMesh,
    /// Whether a path exists: [`CheckAnswer`](super::CheckAnswer).
    Check,
    /// The same for several pairs of ends: [`PairsAnswer`](super::PairsAnswer).
    CheckPairs,
    /// The path of a result over a mesh, flown again: [`MeshCheckAnswer`](super::MeshCheckAnswer).
    CheckMesh,
    /// A path: [`PlanAnswer`](super::PlanAnswer).
    Plan,
    /// A path over a mesh: [`MeshPlanAnswer`](super::MeshPlanAnswer).
    PlanMesh,
    /// A path of a robot with legs: [`LegsPlanAnswer`](super::LegsPlanAnswer).
    PlanLegs,
    /// A path of a scenario that drives: [`TravelAnswer`](super::TravelAnswer).
    PlanTravel,
    /// A path over several targets: [`TargetsAnswer`](super::TargetsAnswer).
    PlanTargets,
    /// A path, beside the other files of a run: [`PlanAnswer`](super::PlanAnswer).
    Run,
    /// A path over a mesh, beside the other files of a run: [`MeshPlanAnswer`](super::MeshPlanAnswer).
    RunMesh,
    /// Trials along a path: [`SimulateAnswer`](super::SimulateAnswer).
    Simulate,
    /// Trials along a path over a mesh: [`MeshSimulateAnswer`](super::MeshSimulateAnswer).
    SimulateMesh,
    /// Trials of a robot with legs: [`LegsSimulateAnswer`](super::LegsSimulateAnswer).
    SimulateLegs,
    /// Trials of a mission of a scenario that drives: [`TravelSimulateAnswer`](super::TravelSimulateAnswer).
    SimulateTravel,
    /// Trials of a mission over several targets: [`TargetsSimulateAnswer`](super::TargetsSimulateAnswer).
    SimulateTargets,
    /// Trials of a robot whose heading is not controlled: [`DriftAnswer`](super::DriftAnswer).
    SimulateDrift,
    /// An experiment with trials: [`ExperimentAnswer`](super::ExperimentAnswer).
    SimulateExperiment,
    /// The least capability: [`RequireAnswer`](super::RequireAnswer).
    Require,
    /// Hops by one or two varied keys: [`TradeAnswer`](super::TradeAnswer).
    Trade,
    /// Robots with legs and kinds of cones side by side: [`LegsTradeAnswer`](super::LegsTradeAnswer).
    TradeLegs,
    /// Several scenarios side by side: [`CompareAnswer`](super::CompareAnswer).
    Compare,
    /// Slices in all directions: [`FanAnswer`](super::FanAnswer).
    Fan,
    /// Hops to all posts of a map: [`MapAnswer`](super::MapAnswer).
    Map,
    /// Hops to contacts all over a mesh: [`MeshMapAnswer`](super::MeshMapAnswer).
    MapMesh,
    /// Stances all over a map: [`LegsMapAnswer`](super::LegsMapAnswer).
    MapLegs,
    /// Missions to all nodes of a map, of a scenario that drives: [`TravelMapAnswer`](super::TravelMapAnswer).
    MapTravel,
    /// Landing sites ranked: [`SitesAnswer`](super::SitesAnswer).
    Sites,
    /// What an answer takes before it is computed: [`SizeAnswer`](super::SizeAnswer).
    Size,
    /// Where a robot with legs stands: [`StanceAnswer`](super::StanceAnswer).
    Stance,
    /// A path of a wheeled jumper among boxes: [`ArenaAnswer`](super::ArenaAnswer).
    Arena,
}

impl DocumentKind {
    /// All kinds.
    pub const ALL: [Self; 32] = [
        Self::Hop,
        Self::HopMesh,
        Self::Check,
        Self::CheckPairs,
        Self::CheckMesh,
        Self::Plan,
        Self::PlanMesh,
        Self::PlanLegs,
        Self::PlanTravel,
        Self::PlanTargets,
        Self::Run,
        Self::RunMesh,
        Self::Simulate,
        Self::SimulateMesh,
        Self::SimulateLegs,
        Self::SimulateTravel,
        Self::SimulateTargets,
        Self::SimulateDrift,
        Self::SimulateExperiment,
        Self::Require,
        Self::Trade,
        Self::TradeLegs,
        Self::Compare,
        Self::Fan,
        Self::Map,
        Self::MapMesh,
        Self::MapLegs,
        Self::MapTravel,
        Self::Sites,
        Self::Size,
        Self::Stance,
        Self::Arena,
    ];

    /// The name, as in `schema`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hop => "hop",
            Self::HopMesh => "hop-mesh",
            Self::Check => "check",
            Self::CheckPairs => "check-pairs",
            Self::CheckMesh => "check-mesh",
            Self::Plan => "plan",
            Self::PlanMesh => "plan-mesh",
            Self::PlanLegs => "plan-legs",
            Self::PlanTravel => "plan-travel",
            Self::PlanTargets => "plan-targets",
            Self::Run => "run",
            Self::RunMesh => "run-mesh",
            Self::Simulate => "simulate",
            Self::SimulateMesh => "simulate-mesh",
            Self::SimulateLegs => "simulate-legs",
            Self::SimulateTravel => "simulate-travel",
            Self::SimulateTargets => "simulate-targets",
            Self::SimulateDrift => "simulate-drift",
            Self::SimulateExperiment => "simulate-experiment",
            Self::Require => "require",
            Self::Trade => "trade",
            Self::TradeLegs => "trade-legs",
            Self::Compare => "compare",
            Self::Fan => "fan",
            Self::Map => "map",
            Self::MapMesh => "map-mesh",
            Self::MapLegs => "map-legs",
            Self::MapTravel => "map-travel",
            Self::Sites => "sites",
            Self::Size => "size",
            Self::Stance => "stance",
            Self::Arena => "arena",
        }
    }

    /// The value of `schema` in a document of this kind, which ends in its version.
    pub fn schema(self) -> String {
        format!("chta/{}/1", self.name())
    }

    /// The kind with this `schema`; `None` if it is unknown.
    pub fn of_schema(schema: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.schema() == schema)
    }
}

/// A result as one JSON document: its kind, the program's version, the inputs and the answer.
///
/// It holds no time and no absolute path, so that the same run gives the same bytes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Document<T> {
    /// Kind and version of the document, such as `chta/plan/1`.
    pub schema: String,
    /// The program's version.
    pub chta_version: String,
    /// The scenario as used, in SI units and degrees.
    pub scenario: Value,
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
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct InputFile {
    /// Its name, relative to the working folder.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

impl<T: Serialize> Document<T> {
    /// A document of the given kind.
    pub fn new(kind: DocumentKind, scenario: Value, inputs: Vec<InputFile>, warnings: Vec<String>, answer: T) -> Self {
        Self {
            schema: kind.schema(),
            chta_version: env!("CARGO_PKG_VERSION").to_owned(),
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

/// Why a text is no document of a kind of answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentProblem {
    /// No JSON, or a key is missing or has a value of another type.
    #[error("this is no such document: {0}: give the JSON that chta wrote, of this kind of answer")]
    Json(#[from] serde_json::Error),
    /// A key that such a document does not have, or a value that it cannot have beside the others.
    #[error(
        "{pointer} is not as documents of this kind have it: give the JSON as chta wrote it, or read it with the version that wrote it"
    )]
    Unexpected {
        /// The key, as a JSON pointer.
        pointer: String,
    },
}

impl<T: Serialize + DeserializeOwned> Document<T> {
    /// The document that [`to_json`](Self::to_json) wrote. No key is ignored: what is read says the same as the text.
    ///
    /// # Errors
    /// [`DocumentProblem`]: no such document.
    pub fn from_json(text: &str) -> Result<Self, DocumentProblem> {
        let read: Value = serde_json::from_str(text)?;
        let document: Self = serde_json::from_str(text)?;
        match first_difference(&read, &serde_json::to_value(&document)?) {
            Some(pointer) => Err(DocumentProblem::Unexpected { pointer }),
            None => Ok(document),
        }
    }
}

/// The JSON pointer of the first difference between two values; a whole number equals the same floating-point number.
fn first_difference(a: &Value, b: &Value) -> Option<String> {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            keys.find_map(|key| {
                let inner = match (a.get(key), b.get(key)) {
                    (Some(a), Some(b)) => first_difference(a, b)?,
                    _ => String::new(),
                };
                Some(format!("/{key}{inner}"))
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let mut pairs = a.iter().zip(b).enumerate();
            pairs.find_map(|(i, (a, b))| Some(format!("/{i}{}", first_difference(a, b)?)))
        }
        (Value::Number(a), Value::Number(b)) if a.as_f64() == b.as_f64() => None,
        _ => (a != b).then(String::new),
    }
}
