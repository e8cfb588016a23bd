//! A scenario of which keys are varied.

use super::{Draft, OpenCase, OpenError, Purpose};
use crate::{
    scenario::Entries,
    study::{Case, CaseError, PipelineError, Variation},
};

/// A scenario of which keys are varied, with its terrain read once.
#[derive(Clone, Debug)]
pub struct OpenVariation {
    /// The first case.
    pub first: OpenCase,
    /// The keys as typed, and the terrain.
    pub variation: Variation,
    purpose: Purpose,
    wording: super::Wording,
}

impl Draft {
    /// Opens a scenario of which keys are varied. `firsts`: the keys of the first case, and of others that take its place if it is refused.
    ///
    /// # Errors
    /// Why the first case is refused.
    pub fn vary(&self, firsts: Vec<Entries>, purpose: Purpose) -> Result<OpenVariation, OpenError> {
        let mut refused = None;
        for entries in firsts {
            let first = Self { entries, ..self.clone() };
            let opened = first.validated(purpose.stands_on_legs()).map_err(OpenError::from).and_then(|scenario| {
                let variation = Variation::new(self.entries.clone(), scenario, &self.base)?;
                let case = variation.first.clone();
                Ok((OpenCase::new(case, purpose, [&self.entries, &first.entries], &self.wording)?, variation))
            });
            match opened {
                Ok((first, variation)) => return Ok(OpenVariation { first, variation, purpose, wording: self.wording }),
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        Err(refused.unwrap_or_else(|| CaseError::NoTerrain.into()))
    }
}

impl OpenVariation {
    /// A varied case, as if it had been opened.
    ///
    /// # Errors
    /// [`PipelineError::Read`], if a file is gone.
    pub fn opened(&self, case: Case, entries: &Entries) -> Result<OpenCase, PipelineError> {
        OpenCase::new(case, self.purpose, [&self.variation.entries, entries], &self.wording)
    }
}
