//! Why a scenario cannot be opened, or a question has no answer.

use crate::{
    scenario::{LackingKey, RobotFileError, ScenarioProblems},
    study::{
        ArenaError, CaseError, CheckError, ContactsError, FrontProblem, HopError, JourneyError, LegsMapError, LegsRouteError,
        LegsTrialsError, MeshHopError, MeshReadBackError, MeshRouteError, MeshTrialsError, PipelineError, PlanError, ReadBackError,
        RequireError, SimulateError, StanceError, TradeError, fan::FanStudyError, map::MapStudyError,
    },
};

/// Why a scenario cannot be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// A file that is no scenario.
    #[error("{name}: cannot be read ({reason}), expected a scenario: {help}")]
    Unreadable {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
        /// How to mend it.
        help: &'static str,
    },
    /// Keys that are unknown, missing, or have values that they do not take.
    #[error(transparent)]
    Problems(#[from] ScenarioProblems),
    /// Keys that hops over a terrain without columns need.
    #[error("{name}: found no {}, expected in the scenario, since {terrain} has no columns for it", lacking(keys))]
    Lacking {
        /// The name of the scenario.
        name: String,
        /// The keys.
        keys: Vec<LackingKey>,
        /// The terrain, with its article.
        terrain: &'static str,
    },
    /// A scenario without the DEM of a map.
    #[error("{name}: found no terrain.dem, expected one for a map: add it, or over a mesh give terrain.mesh with route = \"free\"")]
    NoDem {
        /// The name of the scenario.
        name: String,
    },
    /// A terrain without a usable chain.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A file of the scenario.
    #[error(transparent)]
    File(#[from] PipelineError),
}

impl OpenError {
    pub(super) fn unreadable(name: &str, reason: String, help: &'static str) -> Self {
        Self::Unreadable { name: name.to_owned(), reason, help }
    }
}

/// Keys in words, each with those that can take its place.
fn lacking(keys: &[LackingKey]) -> String {
    let name = |LackingKey { key, instead, .. }: &LackingKey| match instead {
        [] => (*key).to_owned(),
        instead => format!("{key} (or {})", instead.join(" and ")),
    };
    keys.iter().map(name).collect::<Vec<_>>().join(", no ")
}

/// Why a question about a scenario has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AskError {
    /// The scenario cannot be opened.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// What is asked has no meaning for this scenario.
    #[error("found {what}, expected a question without it: {why}; leave it out")]
    NotHere {
        /// What is asked for.
        what: &'static str,
        /// Why it has no meaning.
        why: &'static str,
    },
    /// A value beside the scenario that a question does not take.
    #[error("{what} is {found}, expected {expected}")]
    Value {
        /// What it is.
        what: &'static str,
        /// The value.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// A search along a chain, over a DEM, of a mission or of a drive.
    #[error(transparent)]
    Journey(#[from] JourneyError),
    /// A check.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// A plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A front that a scenario does not have.
    #[error(transparent)]
    Front(#[from] FrontProblem),
    /// One hop.
    #[error(transparent)]
    Hop(#[from] HopError),
    /// Trials.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The path of a result.
    #[error(transparent)]
    ReadBack(#[from] ReadBackError),
    /// A least capability.
    #[error(transparent)]
    Require(#[from] RequireError),
    /// Keys that are varied.
    #[error(transparent)]
    Trade(#[from] TradeError),
    /// A map, or landing sites.
    #[error(transparent)]
    Map(#[from] MapStudyError),
    /// One hop over a mesh.
    #[error(transparent)]
    MeshHop(#[from] MeshHopError),
    /// A free route over a mesh.
    #[error(transparent)]
    MeshRoute(#[from] MeshRouteError),
    /// The path of a result over a mesh.
    #[error(transparent)]
    MeshReadBack(Box<MeshReadBackError>),
    /// Trials over a mesh.
    #[error(transparent)]
    MeshTrials(#[from] MeshTrialsError),
    /// A robot with legs.
    #[error(transparent)]
    Legs(#[from] LegsRouteError),
    /// A map of stances.
    #[error(transparent)]
    LegsMap(#[from] LegsMapError),
    /// Trials of a robot with legs.
    #[error(transparent)]
    LegsTrials(#[from] LegsTrialsError),
    /// A stance.
    #[error(transparent)]
    Stance(#[from] StanceError),
    /// A table of contacts.
    #[error(transparent)]
    Contacts(#[from] ContactsError),
    /// A path among boxes.
    #[error(transparent)]
    Arena(#[from] ArenaError),
    /// Slices in all directions.
    #[error(transparent)]
    Fan(#[from] FanStudyError),
    /// A robot file.
    #[error(transparent)]
    Robot(#[from] RobotFileError),
    /// The document cannot be written; plain data gives no such error.
    #[error("the result cannot be written as JSON ({0})")]
    Json(#[from] serde_json::Error),
}

impl From<MeshReadBackError> for AskError {
    fn from(error: MeshReadBackError) -> Self {
        Self::MeshReadBack(Box::new(error))
    }
}

impl From<CaseError> for AskError {
    fn from(error: CaseError) -> Self {
        Self::Open(error.into())
    }
}

impl From<PipelineError> for AskError {
    fn from(error: PipelineError) -> Self {
        Self::Open(error.into())
    }
}

impl From<ScenarioProblems> for AskError {
    fn from(problems: ScenarioProblems) -> Self {
        Self::Open(problems.into())
    }
}
