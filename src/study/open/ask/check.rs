//! Whether a path exists.

use super::{
    super::{AskError, Draft, Purpose, Reply},
    OF_TARGETS, OVER_FACETS, refuse,
};
use crate::{
    progress::Progress,
    report::{DocumentKind, TargetsAnswer},
    study::{Proof, check, check_over_mesh, targets_plan},
};

impl Draft {
    /// Checks whether a path exists; of a result over a mesh, whether its path holds when it is flown again.
    ///
    /// # Errors
    /// [`AskError`]. That there is no path is an answer.
    pub fn check(&self, proof: Option<Proof>, progress: &dyn Progress) -> Result<Reply, AskError> {
        if let (Some(result), Some(open)) = (&self.result, self.facets(Purpose::Check)?) {
            refuse(&[(proof.is_some(), "a proof")], OVER_FACETS)?;
            let checked = check_over_mesh((&open.scenario, &open.base), result, open.inputs())?;
            let json = open.document(DocumentKind::CheckMesh, &checked.warnings, &checked.answer)?;
            return Ok(Reply::new(DocumentKind::CheckMesh, json, checked.answer.holds));
        }
        let open = self.case(Purpose::Check)?;
        if open.case.scenario.mission.is_some() {
            refuse(&[(proof.is_some(), "a proof")], OF_TARGETS)?;
            let planned = targets_plan(&open.case, progress)?;
            let answer = TargetsAnswer { path: Vec::new(), ..planned.answer.clone() };
            let json = open.document(DocumentKind::PlanTargets, &planned.warnings, answer)?;
            return Ok(Reply::new(DocumentKind::PlanTargets, json, planned.is_traversable()));
        }
        open.case.ends()?;
        let checked = check(&open.case, proof, progress)?;
        let json = match checked.answers().next() {
            Some(answer) => open.document(DocumentKind::Check, &checked.warnings, answer)?,
            None => open.document(DocumentKind::CheckPairs, &checked.warnings, checked.pairs_answer())?,
        };
        let reply = Reply::new(DocumentKind::Check, json, checked.is_traversable());
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || checked.picture());
        Ok(reply)
    }
}
