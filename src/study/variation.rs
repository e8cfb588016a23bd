//! A scenario of which keys are varied, over terrain that is read once.

use std::path::Path;

use super::{Case, CaseError, Commands, Survey, case::controlled};
use crate::scenario::{Entries, Scenario};

/// A scenario of which keys are varied. Its cases are for exact commands.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The keys as typed, without the varied ones.
    pub entries: Entries,
    /// The first case.
    pub first: Case,
    pub(super) survey: Survey,
}

impl Variation {
    /// Reads the terrain of the first scenario, whose paths start from the folder `base`. `entries` are the keys as typed, from which
    /// all other scenarios are made.
    ///
    /// # Errors
    /// [`CaseError::NoTerrain`] and [`CaseError::Prepare`].
    pub fn new(entries: Entries, first: Scenario, base: &Path) -> Result<Self, CaseError> {
        let survey = surveyed(&first, base)?;
        let first = Case::over(&survey, first, base, Commands::Exact)?;
        Ok(Self { entries, first, survey })
    }

    /// The folder that the scenario's paths start from.
    pub fn base(&self) -> &Path {
        &self.first.base
    }
}

/// The terrain of a scenario for exact commands.
fn surveyed(scenario: &Scenario, base: &Path) -> Result<Survey, CaseError> {
    controlled(scenario)?;
    let terrain = scenario.terrain.as_ref().ok_or(CaseError::NoTerrain)?;
    Ok(Survey::of(scenario, terrain, base)?)
}
