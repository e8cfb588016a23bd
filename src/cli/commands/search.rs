//! The search with its progress, shared by check, plan and run.

use chta::{
    ballistics::HopTest,
    chain::Station,
    graph::{self, PointSpacing, SearchOptions},
};

use crate::cli::{Failure, progress::Progress};

/// Searches, and shows what is being tried on a terminal.
pub(super) fn search(
    test: &HopTest<'_>,
    start: Station,
    goal: Station,
    options: &SearchOptions,
    quiet: bool,
) -> Result<graph::Answer, Failure> {
    let progress = Progress::new(quiet);
    let mut tell = |spacing: PointSpacing| {
        progress.say(match spacing {
            PointSpacing::PerSegment(points) => format!("searching with {points} points inside each segment"),
            PointSpacing::AtMostM(spacing_m) => format!("searching with nodes at most {spacing_m} m apart"),
        });
    };
    graph::search(test, start, goal, options, &mut tell).map_err(|error| Failure::message(error.to_string()))
}
