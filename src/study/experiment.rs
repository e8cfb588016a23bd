//! The experiments on a planned path.

use serde::Serialize;

use super::{Planned, SimulateError, sensitivity::sensitivity};
#[cfg(feature = "plot")]
use crate::figure::{
    ConeWidthFigure, FigureError, LandingErrorFigure, Picture, SensitivityFigure, draw_cone_width, draw_landing_errors,
    draw_sensitivity,
};
use crate::{
    chain::{ConstrainedChain, ConstraintProblems, InvalidChain},
    graph::{self, Outcome, SearchError, search_most_reliable},
    hop::HopTest,
    path::{Hop, PathError, generate},
    progress::Progress,
    report::{ConeWidthAnswer, SensitivityAnswer, WorstDriftAnswer},
    scenario::Route,
    uncertainty::experiments::{
        CONE_SHARES, DriftExperiment, DriftLaw, DriftReading, Experiment, cone_width, narrowed, worst_drift,
    },
    world::Direction,
};

/// Why there is no experiment.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The search for a path.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// A path that is not generated.
    #[error(transparent)]
    Path(#[from] PathError),
    /// Cones of another width.
    #[error("cones at {share} of their width: {problem}")]
    Cones {
        /// The share of their width.
        share: f64,
        /// The problem.
        problem: ConeProblem,
    },
    /// An experiment in the vertical plane of a transect, on a free route.
    #[error(
        "{experiment} {why}, and terrain.route is \"free\": set terrain.route = \"transect\" for it; sensitivity takes free routes"
    )]
    TransectOnly {
        /// The experiment.
        experiment: Experiment,
        /// What it needs of a transect, with its verb.
        why: &'static str,
    },
    /// Trials of a scenario without errors.
    #[error("{experiment} flies trials, but the scenario has no [uncertainty]: add its deviations and goal_tolerance_m")]
    NoUncertainty {
        /// The experiment.
        experiment: Experiment,
    },
    /// No error to take away.
    #[error(
        "sensitivity takes each error away in turn, but [uncertainty] has no error above 0: give it one, such as takeoff_angle_sigma_deg = 0.5"
    )]
    NoErrors,
    /// The trials.
    #[error(transparent)]
    Trials(#[from] SimulateError),
}

/// Why a chain with cones of another width gives no path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConeProblem {
    /// The chain.
    #[error(transparent)]
    Chain(#[from] InvalidChain),
    /// Its constraints.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblems),
    /// The path.
    #[error(transparent)]
    Path(#[from] PathError),
}

/// The answer of an experiment as plain data.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum ExperimentAnswer {
    /// Of [`Experiment::WorstDrift`].
    WorstDrift(WorstDriftAnswer),
    /// Of [`Experiment::ConeWidth`].
    ConeWidth(ConeWidthAnswer),
    /// Of [`Experiment::Sensitivity`].
    Sensitivity(SensitivityAnswer),
}

impl ExperimentAnswer {
    /// The answer for reading.
    pub fn text(&self) -> String {
        match self {
            Self::WorstDrift(answer) => answer.text(),
            Self::ConeWidth(answer) => answer.text(),
            Self::Sensitivity(answer) => answer.text(),
        }
    }

    /// The picture with a title; `None` for an experiment without one.
    ///
    /// # Errors
    /// [`FigureError`].
    #[cfg(feature = "plot")]
    pub fn picture(&self, title: &str) -> Option<Result<Picture, FigureError>> {
        match self {
            Self::WorstDrift(answer) => Some(draw_landing_errors(&LandingErrorFigure::of_worst_drift(answer, title))),
            Self::ConeWidth(answer) => Some(draw_cone_width(&ConeWidthFigure::of(answer, title))),
            Self::Sensitivity(answer) => Some(draw_sensitivity(&SensitivityFigure::of(answer, title))),
        }
    }
}

/// Runs an experiment on a plan. `reading`: how [`Experiment::WorstDrift`] interprets the paper; the others ignore it.
///
/// # Returns
/// The answer as plain data; `None` without hops to experiment with.
///
/// # Errors
/// [`ExperimentError`].
pub fn experiment(
    planned: &Planned,
    which: Experiment,
    reading: DriftReading,
    progress: &dyn Progress,
) -> Result<Option<ExperimentAnswer>, ExperimentError> {
    if let Some(why) = in_plane(which).filter(|_| planned.case.scenario.route == Route::Free) {
        return Err(ExperimentError::TransectOnly { experiment: which, why });
    }
    let Some(path) = planned.path.as_ref().filter(|path| !path.hops.is_empty()) else {
        return Ok(None);
    };
    let seed = planned.case.scenario.uncertainty.clone().unwrap_or_default().seed;
    let answer = match which {
        Experiment::WorstDrift => {
            let numbers = DriftExperiment::of_the_paper(reading, seed);
            let landings = worst_drift(planned.test.chain(), &path.hops, &numbers);
            ExperimentAnswer::WorstDrift(WorstDriftAnswer::new(&numbers, &landings))
        }
        Experiment::ConeWidth => ExperimentAnswer::ConeWidth(cone_widths(planned, &path.hops, seed, progress)?),
        Experiment::Sensitivity => ExperimentAnswer::Sensitivity(sensitivity(planned, path, progress)?),
    };
    Ok(Some(answer))
}

/// What an experiment of the paper needs of the vertical plane of a transect; `None` if it takes paths in any direction.
const fn in_plane(which: Experiment) -> Option<&'static str> {
    match which {
        Experiment::WorstDrift => {
            Some("follows every flight along the ground ahead of it, in one plane, and a free route turns where it lands")
        }
        Experiment::ConeWidth => {
            Some("plans again with narrower cones of the segments of one slice, and a free route is planned over the whole dem")
        }
        Experiment::Sensitivity => None,
    }
}

/// Plans and flies with successively narrower cones, on the same draws.
fn cone_widths(planned: &Planned, widest: &[Hop], seed: u64, progress: &dyn Progress) -> Result<ConeWidthAnswer, ExperimentError> {
    let derated = planned.case.scenario.derated();
    let scenario = derated.as_ref().unwrap_or(&planned.case.scenario);
    let numbers = DriftExperiment::of_the_paper(DriftReading::default(), seed);
    let reference_m_s = widest.first().map_or(1.0, Hop::horizontal_speed_m_s);
    let mut answer = ConeWidthAnswer::new(&numbers, reference_m_s);
    for share in CONE_SHARES {
        let failed = |problem: ConeProblem| ExperimentError::Cones { share, problem };
        let geometry = narrowed(&planned.case.planning().chain, share).map_err(|problem| failed(problem.into()))?;
        let chain = ConstrainedChain::new(geometry, &scenario.hopper, scenario.body.gravity, &scenario.surface)
            .map_err(|problem| failed(problem.into()))?;
        let width_deg = mean_takeoff_width_deg(&chain);
        let test = HopTest::new(chain);
        // Another chain than that of the DEM: hops are judged along it.
        let found = match scenario.reliability(None) {
            None => graph::search(&test, planned.ends.0, planned.ends.1, &scenario.search, progress)?,
            Some(reliability) => {
                search_most_reliable(&test, planned.ends.0, planned.ends.1, &scenario.search, &reliability, progress)?.0
            }
        };
        let Outcome::Path { legs, .. } = &found.outcome else {
            answer.add_none((share, width_deg));
            continue;
        };
        let path =
            generate(&test, legs, scenario.search.takeoff, scenario.search.split).map_err(|problem| failed(problem.into()))?;
        let [fixed, with_speed] = DriftLaw::ALL.map(|law| cone_width(test.chain(), &path.hops, &numbers, (law, reference_m_s)));
        answer.add((share, width_deg), &path.hops, &fixed, &with_speed);
    }
    Ok(answer)
}

/// Mean width of the segments' take-off cones for travel towards +x, degrees; 0 if no segment has one.
#[expect(clippy::cast_precision_loss, reason = "at most a million segments")]
fn mean_takeoff_width_deg(chain: &ConstrainedChain) -> f64 {
    let stated = chain.segments().iter().filter_map(|segment| segment.stated(Direction::Forward));
    let widths: Vec<f64> =
        stated.map(|line| line.takeoff.angles()).map(|angles| angles.max.degrees() - angles.min.degrees()).collect();
    widths.iter().sum::<f64>() / widths.len().max(1) as f64
}
