//! Trials that were flown in parts, by several processes or machines.

use crate::uncertainty::{MergeProblem, Tally};

/// Why tallies are not those of a run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PartsProblem {
    /// No tally at all.
    #[error("found no tally, expected those of all trials of the run")]
    None,
    /// A plan without a path.
    #[error("found tallies of trials, expected none: this scenario has no path to fly")]
    NoPath,
    /// Tallies of different runs, or trials that several have.
    #[error("the tallies do not merge: {0}")]
    Merge(#[from] MergeProblem),
    /// Tallies of another scenario.
    #[error("the tallies are those of another scenario ({0}): merge them under the scenario that they were flown for")]
    OtherRun(MergeProblem),
    /// Trials of the run that no tally has, or trials beyond it.
    #[error(
        "the tallies have the trials {found}, expected those from {first} to {last}: fly the missing ones, or give the number of trials that were flown"
    )]
    Trials {
        /// The ranges that they have.
        found: String,
        /// The first trial of the run.
        first: u64,
        /// The last one.
        last: u64,
    },
}

/// The tallies of all trials of a run, merged. `own`: some trials of the run, as they are flown now; `range`: its first trial and how many.
pub(in crate::study) fn merged(tallies: &[Tally], own: &Tally, (first, trials): (u64, u64)) -> Result<Tally, PartsProblem> {
    let (one, others) = tallies.split_first().ok_or(PartsProblem::None)?;
    let mut all = one.clone();
    for other in others {
        all.merge(other)?;
    }
    // Trials of the same run overlap; those of another one differ.
    match all.clone().merge(own) {
        Ok(()) | Err(MergeProblem::Overlap { .. }) => {}
        Err(differs) => return Err(PartsProblem::OtherRun(differs)),
    }
    let end = first.saturating_add(trials);
    if all.trials() != std::slice::from_ref(&(first..end)) {
        let range = |range: &std::ops::Range<u64>| format!("{} to {}", range.start, range.end.saturating_sub(1));
        let found = all.trials().iter().map(range).collect::<Vec<_>>().join(", ");
        return Err(PartsProblem::Trials { found, first, last: end.saturating_sub(1) });
    }
    Ok(all)
}
