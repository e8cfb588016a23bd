//! From the command line to a scenario of which keys are varied.

use chta::{
    scenario::{Entries, ScenarioProblem},
    study::{Case, Variation},
};

use super::{EndOptions, Loaded, Target, recorded, refused, typed, validate_and_prepare};
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

/// Loads the same for keys that are varied, the terrain read once. `first`: the keys of the first case, from those as typed.
pub(crate) fn load_to_vary(
    JourneyArgs { chain, start, goal }: &JourneyArgs,
    common: &CommonArgs,
    search: &SearchArgs,
    purpose: Purpose,
    first: &dyn Fn(&Entries) -> Result<Entries, Failure>,
) -> Result<ToVary, Failure> {
    let ends = EndOptions::of_path(*start, *goal);
    let target = Target::chain(chain)?;
    let mut source = typed(&target, common, Some(search), ends)?;
    let entries = source.entries.clone();
    source.entries = first(&entries)?;
    let (name, text) = (source.name.clone(), source.text.clone());
    let mut kept = None;
    let first = validate_and_prepare(&target, source, common.quiet, (ends, purpose, &entries), &mut |scenario, base| {
        Ok(kept.insert(Variation::new(entries.clone(), scenario, base)?).first.clone())
    })?;
    let variation = kept.ok_or_else(|| Failure::message(format!("{}: found no terrain", target.input.given.display())))?;
    Ok(ToVary { first, variation, purpose, name, text })
}

impl ToVary {
    /// The failure for problems of a varied scenario.
    pub(crate) fn refused(&self, problems: Vec<ScenarioProblem>) -> Failure {
        refused(problems, &self.name, &self.text)
    }

    /// A varied case, as if it had been loaded; its warnings are not shown.
    pub(crate) fn loaded(&self, mut case: Case, entries: &Entries) -> Result<Loaded, Failure> {
        case.prepared.warnings.extend(self.purpose.unused(&self.variation.entries, &case.scenario));
        case.prepared.warnings.extend(Purpose::replaced(entries));
        Ok(Loaded { record: recorded(&case)?, case, ends: self.first.ends })
    }
}
