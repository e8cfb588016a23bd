//! The search with its progress, shared by check, plan and run.

use chta::{
    ballistics::HopTest,
    chain::Station,
    graph::{self, PointSpacing, SurestPath, search_surest},
    scenario::Scenario,
};

use crate::cli::{Failure, progress::Progress};

/// Makes as many threads as asked for; 0: one for each core.
pub(super) fn use_threads(threads: usize) -> Result<(), Failure> {
    if threads == 0 {
        // As it is anyway, and small searches never start them.
        return Ok(());
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::message(format!("the threads cannot be started ({error}): ask for fewer with --threads")))
}

/// Searches for one pair, for the surest path where the scenario asks for it, and shows what is being tried on a terminal.
pub(super) fn search(
    test: &HopTest<'_>,
    start: Station,
    goal: Station,
    scenario: &Scenario,
    quiet: bool,
) -> Result<(graph::Answer, Vec<SurestPath>), Failure> {
    let options = &scenario.search;
    let found = match scenario.surety() {
        None => graph::search(test, start, goal, options, &mut told(quiet)).map(|answer| (answer, Vec::new())),
        Some(surety) => search_surest(test, start, goal, options, &surety, &mut told(quiet)),
    };
    found.map_err(|error| Failure::message(error.to_string()))
}

/// Searches for many pairs, once from each start; pair by pair where the surest paths are asked for.
pub(super) fn search_pairs(
    test: &HopTest<'_>,
    pairs: &[(Station, Station)],
    scenario: &Scenario,
    quiet: bool,
) -> Result<Vec<graph::Answer>, Failure> {
    if scenario.surety().is_some() {
        return pairs.iter().map(|&(start, goal)| Ok(search(test, start, goal, scenario, quiet)?.0)).collect();
    }
    graph::search_pairs(test, pairs, &scenario.search, &mut told(quiet)).map_err(|error| Failure::message(error.to_string()))
}

/// Tells what is being tried.
fn told(quiet: bool) -> impl FnMut(PointSpacing) {
    let progress = Progress::new(quiet);
    move |spacing| {
        progress.say(match spacing {
            PointSpacing::PerSegment(points) => format!("searching with {points} points inside each segment"),
            PointSpacing::AtMostM(spacing_m) => format!("searching with nodes at most {spacing_m} m apart"),
        });
    }
}
