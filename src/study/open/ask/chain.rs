//! A path along a chain that is no file.

use super::super::{AskError, Draft, Purpose, Reply, Wording};
use crate::{
    chain::PolygonalChain,
    progress::Progress,
    report::DocumentKind,
    scenario::scenario_document,
    study::{Case, CaseRecord, PlanOptions, Proof, plan},
};

/// What is wanted of a plan along a chain in memory.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ChainAsked {
    /// Where the path begins, m along the chain; absent: where the chain begins.
    pub start_x_m: Option<f64>,
    /// Where it ends; absent: where the chain ends.
    pub goal_x_m: Option<f64>,
    /// Bounds on the fewest hops, whatever the nodes.
    pub proof: Option<Proof>,
    /// The path flown again by direct simulation, against every limit.
    pub verify: bool,
}

impl Draft {
    /// Plans a path along a chain in memory, under the machine of this scenario, whose own terrain is left out: the document names no
    /// terrain.
    ///
    /// # Errors
    /// [`AskError`]. That there is no path is an answer.
    pub fn plan_along(&self, chain: PolygonalChain, asked: &ChainAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
        let mut draft = self.clone();
        draft.forget_terrain();
        let Wording { file_name, .. } = draft.wording;
        let mut scenario = draft.validated(false)?;
        scenario.start_x_m = asked.start_x_m;
        scenario.goal_x_m = asked.goal_x_m;
        let warnings = Purpose::Plan.unused(&self.entries, &scenario, &draft.wording).into_iter();
        let warnings: Vec<String> = warnings.chain(Purpose::replaced(&self.entries)).collect();
        let document = scenario_document(&scenario, &|path| file_name(&draft.base.join(path)));
        let mut case = Case::along(chain, scenario, &draft.base)?;
        case.prepared.warnings.extend(warnings);
        let record = CaseRecord { scenario: document, inputs: Vec::new(), warnings: case.prepared.warnings.clone(), crs: None };
        let options = PlanOptions { proof: asked.proof, verify: asked.verify, estimate: true, front: None };
        let planned = plan(&case, options, progress)?;
        let json = record.document(DocumentKind::Plan, &planned.warnings, &planned.answer).to_json()?;
        let reply =
            Reply::new(DocumentKind::Plan, json, planned.is_traversable()).over(planned.case.prepared.chain.geometry().vertices());
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(planned.picture()));
        Ok(reply)
    }
}
