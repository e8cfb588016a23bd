//! Why a study gives no answer, with the options that mend it: the studies name keys and facts.

use std::path::Path;

use chta::study::{
    CaseError, CheckError, ExperimentError, FreeRouteError, HopError, JourneyError, PlanError, RequireError, SimulateError,
    TradeError,
};

use super::{Failure, hints};

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        match error {
            CaseError::Prepare(error) => error.into(),
            other => Self::of(&other),
        }
    }
}

impl From<JourneyError> for Failure {
    fn from(error: JourneyError) -> Self {
        match error {
            JourneyError::Case(error) => error.into(),
            JourneyError::Free(error @ FreeRouteError::TooMuchMemory { needed_bytes, .. }) => Self::message(format!(
                "--memory-max-mib: {error}; the options for that: --node-spacing-max-m, or --memory-max-mib {}",
                needed_bytes.div_ceil(1 << 20)
            )),
            other => Self::of(&other),
        }
    }
}

impl From<CheckError> for Failure {
    fn from(error: CheckError) -> Self {
        match error {
            CheckError::Journey(error) => error.into(),
            other => Self::of(&other),
        }
    }
}

/// The failure for pairs of a file, which it names if a pair is at fault.
pub(crate) fn about(file: &Path) -> impl Fn(CheckError) -> Failure + '_ {
    move |error| match error {
        CheckError::OffChain { .. } => Failure::about(file, &error),
        other => other.into(),
    }
}

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Journey(error) => error.into(),
            PlanError::TooManyHops(error) => Self::of(&error),
            PlanError::Front(error) => Self::message(format!("--front: {error}")),
            other => Self::of(&other),
        }
    }
}

impl From<HopError> for Failure {
    fn from(error: HopError) -> Self {
        match error {
            HopError::Case(error) => error.into(),
            HopError::SamePoint { x_m } => {
                Self::message(format!("--from and --to are both x = {x_m} m, expected two different points of the chain"))
            }
            other => Self::of(&other),
        }
    }
}

impl From<SimulateError> for Failure {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Dem { file, problem } => Self::about(&file, &*problem),
            other => Self::of(&other),
        }
    }
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Self {
        match error {
            ExperimentError::Trials(error) => error.into(),
            ExperimentError::NoUncertainty { .. } | ExperimentError::NoErrors => Self::message(format!("--experiment: {error}")),
            other => Self::of(&other),
        }
    }
}

impl From<TradeError> for Failure {
    fn from(error: TradeError) -> Self {
        Self::message(format!("--vary: {}", hints::sentence(&error)))
    }
}

impl From<RequireError> for Failure {
    fn from(error: RequireError) -> Self {
        match error {
            RequireError::Case(error) => error.into(),
            RequireError::Search(error) => Self::of(&error),
            RequireError::Journey(error) => error.into(),
            RequireError::NoSuccessWanted { .. } => Self::message(format!("--vary {error}, or --success-min 0.9")),
            RequireError::Range(problem) => Self::message(format!("--from and --to: {problem}")),
            RequireError::Resolution { .. } => Self::message(format!("--{error}")),
            other => Self::message(format!("--vary {other}")),
        }
    }
}
