//! A path.

use super::{
    super::{AskError, Draft, OpenFacets, Purpose, Reply},
    OF_DRIVES, OF_TARGETS, OVER_FACETS, refuse,
};
#[cfg(feature = "plot")]
use crate::figure::SeenFrom;
use crate::{
    progress::Progress,
    report::DocumentKind,
    study::{
        Front, LegsRouteQuestion, MeshRouteQuestion, PlanOptions, Proof, TravelOptions, legs_route, mesh_route, plan, targets_plan,
        travel_plan,
    },
};

/// What is wanted beside the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PlanAsked {
    /// Bounds on the fewest hops along a transect, whatever the nodes.
    pub proof: Option<Proof>,
    /// The path along a transect flown again by direct simulation, against every limit; other paths always are.
    pub verify: bool,
    /// A front of hops against an amount.
    pub front: Option<Front>,
    /// Of a scenario that drives: the same mission by driving alone and by hops alone.
    pub alternatives: bool,
    /// The most memory that a search for a free route over a DEM may take, bytes.
    pub memory_max_bytes: Option<u64>,
}

impl Draft {
    /// Plans a path: of fewest hops, or by the objective of the scenario.
    ///
    /// # Errors
    /// [`AskError`]. That there is no path is an answer.
    pub fn plan(&self, asked: &PlanAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
        if let Some(open) = self.facets(Purpose::Plan)? {
            return over_facets(&open, asked, progress);
        }
        let mut open = self.case(Purpose::Plan)?;
        open.case = open.case.within_memory(asked.memory_max_bytes)?;
        open.case.ends()?;
        if open.case.scenario.drives().is_some() {
            refuse(&[(asked.proof.is_some(), "a proof")], OF_DRIVES)?;
            let options = TravelOptions { alternatives: asked.alternatives, front: asked.front.map(Front::amount) };
            let planned = travel_plan(&open.case, options, progress)?;
            let json = open.document(DocumentKind::PlanTravel, &planned.warnings, &planned.answer)?;
            let reply = Reply::new(DocumentKind::PlanTravel, json, planned.is_traversable());
            #[cfg(feature = "plot")]
            let reply = reply.drawn(move || Some(planned.picture()));
            return Ok(reply);
        }
        refuse(&[(asked.alternatives, "alternatives")], "this scenario does not drive")?;
        if open.case.scenario.mission.is_some() {
            refuse(&[(asked.proof.is_some(), "a proof"), (asked.front.is_some(), "a front")], OF_TARGETS)?;
            let planned = targets_plan(&open.case, progress)?;
            let json = open.document(DocumentKind::PlanTargets, &planned.warnings, &planned.answer)?;
            let reply = Reply::new(DocumentKind::PlanTargets, json, planned.is_traversable());
            #[cfg(feature = "plot")]
            let reply = reply.drawn(move || Some(planned.picture()));
            return Ok(reply);
        }
        let PlanAsked { proof, verify, front, .. } = *asked;
        let planned = plan(&open.case, PlanOptions { proof, verify, estimate: true, front }, progress)?;
        let json = open.document(DocumentKind::Plan, &planned.warnings, &planned.answer)?;
        let reply =
            Reply::new(DocumentKind::Plan, json, planned.is_traversable()).over(planned.case.prepared.chain.geometry().vertices());
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(planned.picture()));
        Ok(reply)
    }
}

/// Plans a free route over facets.
fn over_facets(open: &OpenFacets, asked: &PlanAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
    let PlanAsked { proof, front, alternatives, memory_max_bytes, .. } = *asked;
    let unwanted =
        [(proof.is_some(), "a proof"), (alternatives, "alternatives"), (memory_max_bytes.is_some(), "a limit of memory")];
    refuse(&unwanted, OVER_FACETS)?;
    if open.is_of_legs() {
        refuse(&[(front.is_some(), "a front")], "a robot with legs has paths of fewest hops")?;
        let routed = legs_route(LegsRouteQuestion { scenario: &open.scenario, base: &open.base }, progress)?;
        let json = open.document_on_map(DocumentKind::PlanLegs, routed.crs().as_ref(), &routed.warnings, &routed.answer)?;
        let reply = Reply::new(DocumentKind::PlanLegs, json, routed.answer.plan.is_traversable());
        #[cfg(feature = "plot")]
        let reply = reply.drawn({
            let scenario = open.scenario.clone();
            move || Some(routed.picture(&scenario, SeenFrom::default()))
        });
        return Ok(reply);
    }
    let question = MeshRouteQuestion { scenario: &open.scenario, base: &open.base, front, roadmap: None };
    let routed = mesh_route(&question, progress)?;
    let json = open.document(DocumentKind::PlanMesh, &routed.warnings, &routed.answer)?;
    let reply = Reply::new(DocumentKind::PlanMesh, json, routed.answer.is_traversable());
    #[cfg(feature = "plot")]
    let reply = reply.drawn({
        let scenario = open.scenario.clone();
        move || Some(routed.picture(&scenario, SeenFrom::default()))
    });
    Ok(reply)
}
