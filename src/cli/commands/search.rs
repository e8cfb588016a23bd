//! The search with its progress, shared by check, plan and run.

use chta::{
    ballistics::HopTest,
    chain::Station,
    graph::{self, PointSpacing, SurestPath, search_surest},
    scenario::Scenario,
};

use crate::cli::{Failure, progress::Progress};

/// Searches, for the surest path where the scenario asks for it, and shows what is being tried on a terminal.
pub(super) fn search(
    test: &HopTest<'_>,
    start: Station,
    goal: Station,
    scenario: &Scenario,
    quiet: bool,
) -> Result<(graph::Answer, Vec<SurestPath>), Failure> {
    let progress = Progress::new(quiet);
    let mut tell = |spacing: PointSpacing| {
        progress.say(match spacing {
            PointSpacing::PerSegment(points) => format!("searching with {points} points inside each segment"),
            PointSpacing::AtMostM(spacing_m) => format!("searching with nodes at most {spacing_m} m apart"),
        });
    };
    let options = &scenario.search;
    let found = match scenario.surety() {
        None => graph::search(test, start, goal, options, &mut tell).map(|answer| (answer, Vec::new())),
        Some(surety) => search_surest(test, start, goal, options, &surety, &mut tell),
    };
    found.map_err(|error| Failure::message(error.to_string()))
}
