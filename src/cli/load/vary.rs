//! From the command line to a scenario of which keys are varied.

use chta::{
    scenario::{Entries, ScenarioProblem},
    study::{
        Case, CellError, Variation,
        open::{Draft, OpenCase},
    },
};

use super::{EndOptions, Loaded, OwnKey, Target, refused, stated, typed, unprepared, validate_and_prepare};
use crate::cli::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    effects::{Purpose, WORDING},
};

/// A scenario of which keys are varied: the first case, loaded, and the source of all others.
#[derive(Debug)]
pub(crate) struct ToVary {
    /// The first case.
    pub(crate) first: Loaded,
    /// The keys as typed, and the terrain.
    pub(crate) variation: Variation,
    purpose: Purpose,
    source: Draft,
}

/// Loads the same for keys that are varied, the terrain read once. `firsts`: the keys of the first case, and of others that take its
/// place if it is refused, from those as typed.
pub(crate) fn load_to_vary(
    JourneyArgs { chain, start, goal }: &JourneyArgs,
    common: &CommonArgs,
    search: &SearchArgs,
    (purpose, own): (Purpose, &[OwnKey<'_>]),
    firsts: &dyn Fn(&Entries) -> Result<Vec<Entries>, Failure>,
) -> Result<ToVary, Failure> {
    let ends = EndOptions::of_path(*start, *goal);
    let target = Target::chain(chain)?;
    let mut source = typed(&target, common, Some(search), ends)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let mut refused = None;
    for first in firsts(&source.entries)? {
        let entries = &source.entries;
        let first = Draft { entries: first, ..source.clone() };
        let mut kept = None;
        let first = validate_and_prepare(&target, first, common.quiet, (ends, purpose, entries), &mut |scenario, base| {
            Ok(kept.insert(Variation::new(entries.clone(), scenario, base)?).first.clone())
        });
        match (first, kept) {
            (Ok(first), Some(variation)) => return Ok(ToVary { first, variation, purpose, source }),
            (Ok(_), None) => {}
            (Err(failure), _) => refused = refused.or(Some(failure)),
        }
    }
    Err(refused.unwrap_or_else(|| Failure::message(format!("{}: found no terrain", target.input.given.display()))))
}

impl ToVary {
    /// The failure for problems of a varied scenario.
    pub(crate) fn refused(&self, problems: Vec<ScenarioProblem>) -> Failure {
        refused(self.source.refused(problems))
    }

    /// Why a cell has no answer, as a command for it alone would say.
    pub(crate) fn sentence(&self, error: CellError) -> String {
        let variation = &self.variation;
        let terrain = variation.first.scenario.terrain.as_ref().map(|terrain| variation.base().join(terrain.path()));
        let failure = match error {
            CellError::Scenario { problems } => self.refused(problems),
            CellError::Prepare(error) => unprepared(error, &terrain.unwrap_or_default(), self.first.ends),
            other => Failure::of(&other),
        };
        failure.sentence()
    }

    /// A varied case, as if it had been loaded; its warnings are not shown.
    pub(crate) fn loaded(&self, case: Case, entries: &Entries) -> Result<Loaded, Failure> {
        let opened = OpenCase::new(case, self.purpose, [&self.variation.entries, entries], &WORDING)?;
        Ok(stated(opened, self.first.ends))
    }
}
