//! The documents of a page: one with a path, and what else is known of the same scenario.

use serde_json::Value;

use super::PageError;
use crate::{
    report::{DocumentKind, InputFile, PageDocument},
    study::{
        ReadBackError,
        read_back::{key, same_inputs},
    },
};

/// Why a document has no place in a page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentInPage {
    /// No JSON.
    #[error("this is no JSON ({0}): give a result that chta wrote")]
    Json(serde_json::Error),
    /// A kind of document that a page does not show.
    #[error(
        "found a document of {0}, expected one with a path (plan, run, simulate), or beside it a trade or the sensitivity to errors: a page \
         shows these alone"
    )]
    Kind(String),
    /// A second document of one kind.
    #[error("found a second document of the kind of {0}, expected one: leave one of them out")]
    Twice(&'static str),
    /// Another scenario.
    #[error(
        "{key} is {found} here and {expected} in the document with the path, expected one scenario: give documents that were made from the \
         same one"
    )]
    OtherScenario {
        /// The key.
        key: String,
        /// Its value here.
        found: Value,
        /// Its value in the document with the path.
        expected: Value,
    },
    /// Other input files.
    #[error("its inputs are not those of the document with the path, expected the same files: give documents of one scenario")]
    OtherInputs,
    /// Another path.
    #[error("its path is not that of the plan, expected trials of the same path: give those that were flown along it")]
    OtherPath,
    /// A version of the document without a needed key.
    #[error(transparent)]
    Key(ReadBackError),
}

/// What a document is to a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Plan,
    Trials,
    Sensitivity,
    Trade,
}

impl Role {
    fn of(document: &Value) -> Option<Self> {
        use DocumentKind as Kind;
        Some(match Kind::of_schema(document["schema"].as_str()?)? {
            Kind::Plan | Kind::PlanMesh | Kind::PlanLegs | Kind::PlanTravel | Kind::PlanTargets | Kind::Run | Kind::RunMesh => {
                Self::Plan
            }
            Kind::Simulate | Kind::SimulateMesh | Kind::SimulateLegs | Kind::SimulateTravel | Kind::SimulateTargets => Self::Trials,
            Kind::SimulateExperiment if document["experiment"] == "sensitivity" => Self::Sensitivity,
            Kind::Trade => Self::Trade,
            _ => return None,
        })
    }

    /// The name under which a page saves the document: that of a run's folder, where it has one.
    const fn file_name(self) -> &'static str {
        match self {
            Self::Plan => "result.json",
            Self::Trials => "simulation.json",
            Self::Sensitivity => "sensitivity.json",
            Self::Trade => "trade.json",
        }
    }
}

/// The documents of a page, which belong together.
#[derive(Clone, Debug)]
pub struct PageDocuments {
    read: Vec<(Role, String, Value)>,
    /// The number of the one with the path, among those given.
    main: usize,
}

/// Keys that may differ between documents of one scenario: they change neither path nor errors.
const MAY_DIFFER: [&str; 4] = ["report.title", "uncertainty.trials", "uncertainty.seed", "uncertainty.policy"];

impl PageDocuments {
    /// Reads texts of documents, and checks that they belong together.
    ///
    /// # Errors
    /// [`PageError::Document`] and [`PageError::NoPath`].
    pub fn read(texts: Vec<String>) -> Result<Self, PageError> {
        let mut read: Vec<(Role, String, Value)> = Vec::with_capacity(texts.len());
        for (number, text) in texts.into_iter().enumerate() {
            let refused = |problem| PageError::Document { number, problem };
            let value: Value = serde_json::from_str(&text).map_err(|error| refused(DocumentInPage::Json(error)))?;
            let kind = || value["schema"].as_str().map_or_else(|| "no schema".to_owned(), str::to_owned);
            let role = Role::of(&value).ok_or_else(|| refused(DocumentInPage::Kind(kind())))?;
            if read.iter().any(|(other, ..)| *other == role) {
                return Err(refused(DocumentInPage::Twice(role.file_name())));
            }
            read.push((role, text, value));
        }
        let with_path = |wanted| read.iter().position(|(role, _, value)| *role == wanted && value["path"].is_array());
        let main = with_path(Role::Plan).or_else(|| with_path(Role::Trials)).ok_or(PageError::NoPath)?;
        let documents = Self { read, main };
        for number in 0..documents.read.len() {
            documents.check_belongs(number).map_err(|problem| PageError::Document { number, problem })?;
        }
        Ok(documents)
    }

    /// The number of the document with the path, among those given.
    pub const fn main(&self) -> usize {
        self.main
    }

    /// The legs of the path.
    pub(super) fn path(&self) -> &[Value] {
        self.read[self.main].2["path"].as_array().map_or(&[], Vec::as_slice)
    }

    /// The documents as the page holds them: first the one with the path.
    pub fn of_page(&self) -> Vec<PageDocument> {
        let mut order: Vec<usize> = (0..self.read.len()).collect();
        // Sections of the page have their own order; that of the documents is the same however they are given.
        order.sort_by_key(|&number| (number != self.main, self.read[number].0 as u8));
        order
            .into_iter()
            .map(|number| {
                let (role, text, _) = &self.read[number];
                PageDocument { name: role.file_name(), text: text.clone() }
            })
            .collect()
    }

    /// Checks that the files that are read now are those of the documents.
    pub(super) fn check_inputs(&self, now: &[InputFile]) -> Result<(), ReadBackError> {
        same_inputs(&key::<Vec<InputFile>>(&self.read[self.main].2, "inputs")?, now)
    }

    fn check_belongs(&self, number: usize) -> Result<(), DocumentInPage> {
        let (main, (role, _, other)) = (&self.read[self.main].2, &self.read[number]);
        let inputs = |document: &Value| key::<Vec<InputFile>>(document, "inputs").map_err(DocumentInPage::Key);
        let [then, now] = [inputs(main)?, inputs(other)?];
        if then.iter().any(|file| now.iter().all(|now| now.sha256 != file.sha256)) || then.len() != now.len() {
            return Err(DocumentInPage::OtherInputs);
        }
        let varied: Vec<&str> = match role {
            Role::Trade => other["vary"].as_array().into_iter().flatten().filter_map(|vary| vary["key"].as_str()).collect(),
            _ => Vec::new(),
        };
        if let Some((key, found, expected)) = differing(&other["scenario"], &main["scenario"], &varied) {
            return Err(DocumentInPage::OtherScenario { key, found, expected });
        }
        let paths = [main, other].map(|document| document["path"].as_array());
        match paths {
            [Some(plan), Some(path)] if !same_commands(plan, path) => Err(DocumentInPage::OtherPath),
            _ => Ok(()),
        }
    }
}

/// The first key of two scenarios whose values differ, with both.
fn differing(found: &Value, expected: &Value, varied: &[&str]) -> Option<(String, Value, Value)> {
    let tables = |scenario: &Value| scenario.as_object().map(|tables| tables.keys().cloned().collect()).unwrap_or_default();
    let mut names: Vec<String> = tables(expected);
    names.extend(Vec::<String>::into_iter(tables(found)).filter(|name| !expected[name].is_object()));
    names.iter().find_map(|table| {
        let [here, there] = [&found[table], &expected[table]];
        let keys = [here, there].into_iter().filter_map(Value::as_object).flat_map(serde_json::Map::keys);
        keys.map(|key| (format!("{table}.{key}"), &here[key], &there[key]))
            .find(|(path, here, there)| here != there && !MAY_DIFFER.contains(&path.as_str()) && !varied.contains(&path.as_str()))
            .map(|(path, here, there)| (path, here.clone(), there.clone()))
    })
}

/// Whether two paths have the same legs with the same commands.
fn same_commands(plan: &[Value], path: &[Value]) -> bool {
    const COMMANDS: [&str; 6] =
        ["takeoff_x_m", "landing_x_m", "takeoff_angle_deg", "takeoff_speed_m_s", "heading_deg", "waypoints_m"];
    plan.len() == path.len() && plan.iter().zip(path).all(|(a, b)| COMMANDS.iter().all(|key| a[*key] == b[*key]))
}
