//! Trials in parts: ranges of them flown apart, and their tallies merged.

use std::{ops::Range, sync::Arc};

use super::{
    super::{AskError, Draft, OpenCase, OpenFacets, Purpose, Reply},
    OF_DRIVES, OF_TARGETS, refuse,
};
use crate::{
    progress::Progress,
    report::DocumentKind,
    study::{
        MeshResultPath, MeshRouteQuestion, MeshRouted, PlanOptions, Planned, SimulateOptions, Trials, merged_over_mesh, mesh_route,
        plan, tally_over_mesh,
    },
    uncertainty::Tally,
};

/// A plan whose trials are flown in parts.
enum Flown {
    Chain(Box<OpenCase>, Arc<Planned>),
    Mesh(Box<OpenFacets>, Box<MeshRouted>),
}

impl Draft {
    /// Flies the trials of a range of numbers: their tally as JSON, which merges with those of other ranges. `None` without a path.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn tally(&self, numbers: Range<u64>, progress: &dyn Progress) -> Result<Option<String>, AskError> {
        let tally = match self.planned_to_fly(progress)? {
            Flown::Chain(_, planned) => Trials::new(&planned, &SimulateOptions::default()).tally(numbers, progress)?,
            Flown::Mesh(open, routed) => tally_over_mesh(&routed, &open.scenario, numbers, progress)?,
        };
        Ok(tally.map(|tally| serde_json::to_string(&tally)).transpose()?)
    }

    /// The answer of trials that were flown in parts, by their tallies: to the byte the one of [`simulate`](Self::simulate) with the same
    /// options, of which neither a comparison of policies nor an early end has a meaning here.
    ///
    /// # Errors
    /// [`AskError`], also for trials that are missing or counted twice.
    pub fn merged(&self, tallies: &[String], options: &SimulateOptions, progress: &dyn Progress) -> Result<Reply, AskError> {
        let unwanted = [(options.compare, "a comparison of policies"), (options.until_half_width.is_some(), "a half-width")];
        refuse(&unwanted, "the trials were flown before")?;
        let read = |text: &String| {
            serde_json::from_str::<Tally>(text).map_err(|error| AskError::Value {
                what: "a tally",
                found: error.to_string(),
                expected: "one that this version of chta made",
            })
        };
        let tallies: Vec<Tally> = tallies.iter().map(read).collect::<Result<_, _>>()?;
        match self.planned_to_fly(progress)? {
            Flown::Chain(open, planned) => {
                let flown = Trials::new(&planned, options).merged(&tallies, progress)?;
                let json = open.document(DocumentKind::Simulate, &flown.warnings, &flown.answer)?;
                let reply = Reply::new(DocumentKind::Simulate, json, planned.is_traversable() && flown.answer.shows_success());
                #[cfg(feature = "plot")]
                let reply = reply.drawn(move || flown.picture());
                Ok(reply)
            }
            Flown::Mesh(open, routed) => {
                let flown = merged_over_mesh(*routed, &open.scenario, options, &tallies, progress)?;
                let json = open.document(DocumentKind::SimulateMesh, &flown.warnings, &flown.answer)?;
                let holds = flown.answer.plan.is_traversable() && flown.answer.shows_success();
                let reply = Reply::new(DocumentKind::SimulateMesh, json, holds);
                #[cfg(feature = "plot")]
                let reply = reply.drawn(move || flown.picture(&open.scenario));
                Ok(reply)
            }
        }
    }

    /// The path that trials in parts fly.
    fn planned_to_fly(&self, progress: &dyn Progress) -> Result<Flown, AskError> {
        if let Some(open) = self.facets(Purpose::Simulate)? {
            refuse(&[(open.is_of_legs(), "a tally")], "a tally holds the landings of a point, and this robot has legs")?;
            let of_result = self.result.as_ref().map(|result| MeshResultPath::read(result, open.inputs())).transpose()?;
            let question = MeshRouteQuestion { scenario: &open.scenario, base: &open.base, front: None, roadmap: None };
            let routed = mesh_route(&question, progress)?;
            of_result.map_or(Ok(()), |path| path.check_planned(&routed.answer.path))?;
            return Ok(Flown::Mesh(Box::new(open), Box::new(routed)));
        }
        let open = self.case(Purpose::Simulate)?;
        open.case.ends()?;
        refuse(&[(open.case.scenario.drives().is_some(), "a tally")], OF_DRIVES)?;
        refuse(&[(open.case.scenario.mission.is_some(), "a tally")], OF_TARGETS)?;
        let planned = match &self.result {
            Some(result) => Planned::read_back(&open.case, result, &open.record.inputs)?,
            None => plan(&open.case, PlanOptions::default(), progress)?,
        };
        Ok(Flown::Chain(Box::new(open), Arc::new(planned)))
    }
}
