//! Errors of the library as the exceptions of `chta._errors`.

use chta::{
    ground::MapError,
    scenario::{Place, ScenarioProblem, ScenarioProblems},
    study::{
        ArenaError, CaseError, CheckError, FreeRouteError, JourneyError, LegsMapError, LegsRouteError, MeshHopError,
        MeshRouteError, PipelineError, PlanError, RequireError, SimulateError, StanceError,
        fan::FanStudyError,
        map::MapStudyError,
        open::{AskError, OpenError},
    },
};
use pyo3::{prelude::*, types::PyDict};

/// The classes of exceptions.
#[derive(Clone, Copy)]
pub(crate) enum Class {
    /// Anything else: a defect.
    Other,
    /// A value that is not taken.
    Input,
    /// A file.
    Terrain,
    /// More memory than allowed.
    TooLarge,
    /// Work that the caller ended.
    Cancelled,
}

impl Class {
    const fn name(self) -> &'static str {
        match self {
            Self::Other => "ChtaError",
            Self::Input => "InputError",
            Self::Terrain => "TerrainError",
            Self::TooLarge => "TooLarge",
            Self::Cancelled => "Cancelled",
        }
    }

    fn of(error: &AskError) -> Self {
        match error {
            AskError::Open(OpenError::File(error)) | AskError::Fan(FanStudyError::Dem(error)) => Self::of_pipeline(error),
            AskError::Open(OpenError::Case(error)) | AskError::Require(RequireError::Case(error)) => Self::of_case(error),
            AskError::Journey(error)
            | AskError::Check(CheckError::Journey(error))
            | AskError::Plan(PlanError::Journey(error))
            | AskError::Require(RequireError::Journey(error)) => Self::of_journey(error),
            AskError::Map(error) | AskError::LegsMap(LegsMapError::Map(error)) => Self::of_map(error),
            AskError::Simulate(SimulateError::Dem { .. })
            | AskError::MeshHop(MeshHopError::Terrain(_))
            | AskError::MeshRoute(MeshRouteError::Mesh(MeshHopError::Terrain(_)))
            | AskError::Legs(LegsRouteError::Terrain(_) | LegsRouteError::Mesh(MeshRouteError::Mesh(MeshHopError::Terrain(_)))) => {
                Self::Terrain
            }
            AskError::Fan(FanStudyError::TooMuchMemory { .. }) => Self::TooLarge,
            AskError::Stance(StanceError::Terrain(_)) => Self::Terrain,
            AskError::Legs(LegsRouteError::Pipeline(error)) => Self::of_pipeline(error),
            AskError::Plan(PlanError::Defect(_))
            | AskError::Arena(ArenaError::Defect(_))
            | AskError::MeshRoute(MeshRouteError::Defect(_) | MeshRouteError::Lost)
            | AskError::Legs(LegsRouteError::Defect { .. })
            | AskError::Json(_) => Self::Other,
            _ => Self::Input,
        }
    }

    fn of_case(error: &CaseError) -> Self {
        if let CaseError::Prepare(error) = error { Self::of_pipeline(error) } else { Self::Input }
    }

    fn of_pipeline(error: &PipelineError) -> Self {
        match error {
            PipelineError::Terrain(_) | PipelineError::Csv(_) | PipelineError::Read { .. } => Self::Terrain,
            _ => Self::Input,
        }
    }

    fn of_journey(error: &JourneyError) -> Self {
        match error {
            JourneyError::Case(error) => Self::of_case(error),
            JourneyError::Free(FreeRouteError::TooMuchMemory { .. }) => Self::TooLarge,
            JourneyError::Free(FreeRouteError::Dem(_)) => Self::Terrain,
            _ => Self::Input,
        }
    }

    fn of_map(error: &MapStudyError) -> Self {
        match error {
            MapStudyError::TooMuchMemory { .. } | MapStudyError::MissionsTooLarge { .. } => Self::TooLarge,
            MapStudyError::Terrain(_) => Self::Terrain,
            MapStudyError::Pipeline(error) => Self::of_pipeline(error),
            MapStudyError::Defect(_) => Self::Other,
            _ => Self::Input,
        }
    }
}

/// An exception of a class.
fn made<'py>(py: Python<'py>, class: &str, message: String, attributes: &Bound<'py, PyDict>) -> PyErr {
    let instance = py.import("chta._errors").and_then(|module| module.getattr(class)?.call1((message,))).and_then(|instance| {
        for (name, value) in attributes {
            instance.setattr(name.extract::<String>()?.as_str(), value)?;
        }
        Ok(instance)
    });
    instance.map_or_else(|error| error, PyErr::from_value)
}

/// An exception of a class, with a message alone.
pub(crate) fn plain(py: Python<'_>, class: Class, message: impl ToString) -> PyErr {
    made(py, class.name(), message.to_string(), &PyDict::new(py))
}

/// A value that is not taken, with its name, what was found and what was expected.
pub(crate) fn input(py: Python<'_>, key: &str, found: impl ToString, expected: &str) -> PyErr {
    let found = found.to_string();
    let attributes = PyDict::new(py);
    let set = [("key", key), ("found", &found), ("expected", expected)];
    match set.into_iter().try_for_each(|(name, value)| attributes.set_item(name, value)) {
        Ok(()) => made(py, "InputError", format!("{key} is {found}, expected {expected}"), &attributes),
        Err(error) => error,
    }
}

/// Problems of a scenario.
pub(crate) fn problems(py: Python<'_>, problems: &ScenarioProblems) -> PyErr {
    let rows: Vec<_> = problems.problems.iter().map(|problem| row(problems, problem)).collect();
    let attributes = PyDict::new(py);
    match attributes.set_item("problems", rows) {
        Ok(()) => made(py, "ScenarioError", problems.to_string(), &attributes),
        Err(error) => error,
    }
}

/// Line and column from 1, or 0 outside a text; the key; the message; how to mend it.
fn row(problems: &ScenarioProblems, problem: &ScenarioProblem) -> (usize, usize, String, String, String) {
    let (line, column) = match &problem.place {
        Place::File(span) => {
            let before = problems.source.get(..span.start).unwrap_or_default();
            let line_start = before.rfind('\n').map_or(0, |at| at + 1);
            (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
        }
        _ => (0, 0),
    };
    let key = format!("{}.{}", problem.key.table, problem.key.name);
    (line, column, key.trim_matches('.').to_owned(), problem.message.clone(), problem.help.clone())
}

/// The exception for an error of the library.
pub(crate) fn raised(py: Python<'_>, error: &AskError) -> PyErr {
    match error {
        AskError::Open(OpenError::Problems(found)) => problems(py, found),
        AskError::Value { what, found, expected } => input(py, what, found, expected),
        other => plain(py, Class::of(other), other),
    }
}

/// The exception for an error of a map.
pub(crate) fn of_map(py: Python<'_>, error: &MapError) -> PyErr {
    plain(py, Class::Input, error)
}
