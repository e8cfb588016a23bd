//! From the command line to a scenario of which keys are varied.

use chta::{
    scenario::{Entries, ScenarioProblem},
    study::{Case, CellError, Variation},
};

use super::{EndOptions, Loaded, OwnKey, Source, Target, recorded, refused, typed, unprepared, validate_and_prepare};
use crate::cli::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    effects::Purpose,
};

/// A scenario of which keys are varied: the first case, loaded, and the source of all others.
#[derive(Debug)]
pub(crate) struct ToVary {
    /// The first case.
    pub(crate) first: Loaded,
    /// The keys as typed, and the terrain.
    pub(crate) variation: Variation,
    purpose: Purpose,
    name: String,
    text: String,
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
    let Source { mut entries, name, text, base } = typed(&target, common, Some(search), ends)?;
    for (option, table, key, value) in own {
        entries.set_by_option(option, table, key, value.clone());
    }
    let mut refused = None;
    for first in firsts(&entries)? {
        let source = Source { entries: first, name: name.clone(), text: text.clone(), base: base.clone() };
        let mut kept = None;
        let first = validate_and_prepare(&target, source, common.quiet, (ends, purpose, &entries), &mut |scenario, base| {
            Ok(kept.insert(Variation::new(entries.clone(), scenario, base)?).first.clone())
        });
        match (first, kept) {
            (Ok(first), Some(variation)) => return Ok(ToVary { first, variation, purpose, name, text }),
            (Ok(_), None) => {}
            (Err(failure), _) => refused = refused.or(Some(failure)),
        }
    }
    Err(refused.unwrap_or_else(|| Failure::message(format!("{}: found no terrain", target.input.given.display()))))
}

impl ToVary {
    /// The failure for problems of a varied scenario.
    pub(crate) fn refused(&self, problems: Vec<ScenarioProblem>) -> Failure {
        refused(problems, &self.name, &self.text)
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
    pub(crate) fn loaded(&self, mut case: Case, entries: &Entries) -> Result<Loaded, Failure> {
        case.prepared.warnings.extend(self.purpose.unused(&self.variation.entries, &case.scenario));
        case.prepared.warnings.extend(Purpose::replaced(entries));
        Ok(Loaded { record: recorded(&case)?, case, ends: self.first.ends })
    }
}
