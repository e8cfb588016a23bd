//! The search and the proof with their progress, shared by check, plan, run and require.

use chta::{
    ballistics::HopTest,
    chain::Station,
    graph::{
        self, PointSpacing, SearchOptions,
        proof::{Bounds, BoundsOptions, ProofSummary, bounds},
    },
    report::CheckAnswer,
};

use crate::cli::{Failure, args::ProveArgs, progress::Progress};

/// What a search came to, with bounds where a proof was asked for.
#[derive(Debug)]
pub(super) struct Searched {
    pub(super) found: graph::Answer,
    proof: Option<(Bounds, usize)>,
}

impl Searched {
    /// Searches, and proves where that is asked for.
    pub(super) fn new(
        test: &HopTest<'_>,
        ends: (Station, Station),
        options: &SearchOptions,
        prove: Option<ProveArgs>,
        quiet: bool,
    ) -> Result<Self, Failure> {
        match prove.filter(|prove| prove.prove) {
            None => Ok(Self { found: search(test, ends, options, quiet)?, proof: None }),
            Some(ProveArgs { budget, .. }) => {
                let options =
                    BoundsOptions { budget_cells: budget, search: options.clone(), explain: true, ..BoundsOptions::default() };
                let bounds = proved(test, ends, &options, quiet)?;
                Ok(Self { found: bounds.answer.clone(), proof: Some((bounds, budget)) })
            }
        }
    }

    /// The answer as plain data.
    pub(super) fn answer(&self, test: &HopTest<'_>, (start, goal): (Station, Station), effort: graph::Effort) -> CheckAnswer {
        let answer = CheckAnswer::new(test, start.point.x_m, goal.point.x_m, &self.found, effort);
        match &self.proof {
            None => answer,
            Some((bounds, budget)) => answer.with_bounds(bounds, *budget),
        }
    }
}

/// Searches, and shows what is being tried on a terminal.
fn search(
    test: &HopTest<'_>,
    (start, goal): (Station, Station),
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

/// Bounds the fewest hops, and shows how far the proof is on a terminal.
pub(super) fn proved(
    test: &HopTest<'_>,
    (start, goal): (Station, Station),
    options: &BoundsOptions,
    quiet: bool,
) -> Result<Bounds, Failure> {
    let progress = Progress::new(quiet);
    let mut tell = |summary: ProofSummary| progress.say(format!("proving with {} cells, round {}", summary.cells, summary.rounds));
    bounds(test, start, goal, options, &mut tell).map_err(|error| Failure::message(error.to_string()))
}
