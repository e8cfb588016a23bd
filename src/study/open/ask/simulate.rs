//! Trials of a path, and whole runs.

use std::sync::Arc;

use super::{
    super::{AskError, Draft, OpenCase, OpenFacets, Purpose, Reply},
    OF_DRIVES, OF_TARGETS, OVER_FACETS, refuse,
};
#[cfg(feature = "plot")]
use crate::figure::SeenFrom;
use crate::{
    progress::Progress,
    report::DocumentKind,
    study::{
        LegsRouteQuestion, MeshResultPath, MeshRouteQuestion, PlanOptions, Planned, SimulateOptions, TravelOptions, legs_route,
        mesh_route, plan, simulate, simulate_legs, simulate_over_mesh, targets_plan, targets_simulate, travel_plan,
        travel_simulate,
    },
};

/// Everything that a scenario asks for.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The path, proved by its own check.
    pub plan: Reply,
    /// Its trials, where the scenario has errors and there is a path.
    pub trials: Option<Reply>,
}

impl Draft {
    /// Flies a path many times under the errors of the scenario: that of a result as it stands, else a new one.
    ///
    /// # Errors
    /// [`AskError`]. That there is no path is an answer.
    pub fn simulate(&self, options: &SimulateOptions, progress: &dyn Progress) -> Result<Reply, AskError> {
        if let Some(found) = options.until_half_width.filter(|half| !(*half > 0.0 && *half < 0.5)) {
            let (what, expected) =
                ("until_half_width", "a number above 0 and below 0.5: 0.01 stops at a rate known to one in a hundred");
            return Err(AskError::Value { what, found: found.to_string(), expected });
        }
        if let Some(drift) = self.drift()? {
            refuse(
                &[(options.tally, "a tally"), (options.compare, "both policies"), (self.result.is_some(), "a result")],
                "a robot whose heading is not controlled follows no path",
            )?;
            let flown = drift.trials.fly(options, &mut (), progress)?;
            let json = drift.record.document(DocumentKind::SimulateDrift, &flown.warnings, &flown.answer).to_json()?;
            return Ok(Reply::new(DocumentKind::SimulateDrift, json, flown.answer.shows_success()));
        }
        if let Some(open) = self.facets(Purpose::Simulate)? {
            return self.simulate_over_facets(&open, options, progress);
        }
        let open = self.case(Purpose::Simulate)?;
        open.case.ends()?;
        if open.case.scenario.drives().is_some() {
            refuse(&[(options.tally, "a tally")], OF_DRIVES)?;
            return of_drives(&open, options, progress);
        }
        if open.case.scenario.mission.is_some() {
            refuse(&[(options.tally, "a tally")], OF_TARGETS)?;
            return of_targets(&open, options, progress);
        }
        let planned = match &self.result {
            Some(result) => Planned::read_back(&open.case, result, &open.record.inputs)?,
            None => plan(&open.case, PlanOptions::default(), progress)?,
        };
        along_chain(&open, &Arc::new(planned), options, progress)
    }

    fn simulate_over_facets(
        &self,
        open: &OpenFacets,
        options: &SimulateOptions,
        progress: &dyn Progress,
    ) -> Result<Reply, AskError> {
        if !open.is_of_legs() {
            let of_result = self.result.as_ref().map(|result| MeshResultPath::read(result, open.inputs())).transpose()?;
            return over_mesh(open, of_result.as_ref(), options, progress);
        }
        refuse(&[(options.tally, "a tally")], "a tally holds the landings of a point, and this robot has legs")?;
        let question = LegsRouteQuestion { scenario: &open.scenario, base: &open.base };
        let routed = legs_route(question, progress)?;
        let flown = simulate_legs(routed, &open.scenario, options, progress)?;
        let (kind, answer) = (DocumentKind::SimulateLegs, &flown.answer);
        let json = open.document_on_map(kind, flown.routed.crs().as_ref(), &flown.warnings, answer)?;
        let reply = Reply::new(kind, json, answer.plan.plan.is_traversable() && answer.shows_success());
        #[cfg(feature = "plot")]
        let reply = reply.drawn({
            let scenario = open.scenario.clone();
            move || Some(flown.routed.picture(&scenario, SeenFrom::default()))
        });
        Ok(reply)
    }

    /// Does everything that a scenario asks for: its path, and the trials of that where it has errors.
    ///
    /// # Errors
    /// [`AskError`]. That there is no path is an answer.
    pub fn run(&self, progress: &dyn Progress) -> Result<Ran, AskError> {
        if let Some(open) = self.facets(Purpose::Run)? {
            return if open.is_of_legs() { run_of_legs(&open, progress) } else { run_over_mesh(&open, progress) };
        }
        let options = SimulateOptions::default();
        let open = self.case(Purpose::Run)?;
        open.case.ends()?;
        let has_errors = open.case.scenario.uncertainty.is_some();
        if open.case.scenario.drives().is_some() {
            let planned = travel_plan(&open.case, TravelOptions { alternatives: true, front: None }, progress)?;
            let (answer, holds, mut warnings) = (planned.answer.clone(), planned.is_traversable(), planned.warnings.clone());
            let mut trials = None;
            if has_errors && holds {
                let flown = travel_simulate(planned, &options, progress)?;
                warnings.clone_from(&flown.warnings);
                trials = Some(open.document(DocumentKind::SimulateTravel, &flown.warnings, &flown.answer)?);
            }
            let kind = DocumentKind::PlanTravel;
            let plan = Reply::new(kind, open.document(kind, &warnings, answer)?, holds);
            return Ok(Ran { plan, trials: trials.map(|json| Reply::new(DocumentKind::SimulateTravel, json, holds)) });
        }
        if open.case.scenario.mission.is_some() {
            let planned = targets_plan(&open.case, progress)?;
            let (answer, holds, mut warnings) = (planned.answer.clone(), planned.is_traversable(), planned.warnings.clone());
            let mut trials = None;
            if has_errors && planned.path().is_some() {
                let flown = targets_simulate(planned, &options, &mut (), progress)?;
                warnings.clone_from(&flown.warnings);
                trials = Some(open.document(DocumentKind::SimulateTargets, &flown.warnings, &flown.answer)?);
            }
            let kind = DocumentKind::PlanTargets;
            let plan = Reply::new(kind, open.document(kind, &warnings, answer)?, holds);
            return Ok(Ran { plan, trials: trials.map(|json| Reply::new(DocumentKind::SimulateTargets, json, holds)) });
        }
        let asked = PlanOptions { verify: true, estimate: true, ..PlanOptions::default() };
        let planned = Arc::new(plan(&open.case, asked, progress)?);
        let json = open.document(DocumentKind::Run, &planned.warnings, &planned.answer)?;
        let reply =
            Reply::new(DocumentKind::Run, json, planned.is_traversable()).over(planned.case.prepared.chain.geometry().vertices());
        #[cfg(feature = "plot")]
        let reply = reply.drawn({
            let planned = Arc::clone(&planned);
            move || Some(planned.picture())
        });
        let flies = has_errors && planned.path.is_some();
        let trials = if flies { Some(along_chain(&open, &planned, &options, progress)?) } else { None };
        Ok(Ran { plan: reply, trials })
    }
}

/// Trials along a chain.
fn along_chain(
    open: &OpenCase,
    planned: &Arc<Planned>,
    options: &SimulateOptions,
    progress: &dyn Progress,
) -> Result<Reply, AskError> {
    let flown = simulate(planned, options, &mut (), progress)?;
    let json = open.document(DocumentKind::Simulate, &flown.warnings, &flown.answer)?;
    let reply = Reply::new(DocumentKind::Simulate, json, planned.is_traversable() && flown.answer.shows_success());
    #[cfg(feature = "plot")]
    let reply = reply.drawn(move || flown.picture());
    Ok(reply)
}

/// Trials of a mission that drives.
fn of_drives(open: &OpenCase, options: &SimulateOptions, progress: &dyn Progress) -> Result<Reply, AskError> {
    let planned = travel_plan(&open.case, TravelOptions::default(), progress)?;
    let flown = travel_simulate(planned, options, progress)?;
    let json = open.document(DocumentKind::SimulateTravel, &flown.warnings, &flown.answer)?;
    let holds = flown.answer.plan.is_traversable() && flown.answer.shows_success();
    let reply = Reply::new(DocumentKind::SimulateTravel, json, holds);
    #[cfg(feature = "plot")]
    let reply = reply.drawn(move || Some(flown.picture()));
    Ok(reply)
}

/// Trials of a mission over targets.
fn of_targets(open: &OpenCase, options: &SimulateOptions, progress: &dyn Progress) -> Result<Reply, AskError> {
    let flown = targets_simulate(targets_plan(&open.case, progress)?, options, &mut (), progress)?;
    let json = open.document(DocumentKind::SimulateTargets, &flown.warnings, &flown.answer)?;
    let holds = flown.answer.plan.is_traversable() && flown.answer.shows_success();
    let reply = Reply::new(DocumentKind::SimulateTargets, json, holds);
    #[cfg(feature = "plot")]
    let reply = reply.drawn(move || Some(flown.picture()));
    Ok(reply)
}

/// Trials of a point over a mesh, whose plan has to have the path of a result, if it is one.
fn over_mesh(
    open: &OpenFacets,
    of_result: Option<&MeshResultPath>,
    options: &SimulateOptions,
    progress: &dyn Progress,
) -> Result<Reply, AskError> {
    refuse(&[(options.tally && of_result.is_some(), "a tally of a result")], OVER_FACETS)?;
    let question = MeshRouteQuestion { scenario: &open.scenario, base: &open.base, front: None, roadmap: None };
    let routed = mesh_route(&question, progress)?;
    of_result.map_or(Ok(()), |path| path.check_planned(&routed.answer.path))?;
    let flown = simulate_over_mesh(routed, &open.scenario, options, &mut (), progress)?;
    let json = open.document(DocumentKind::SimulateMesh, &flown.warnings, &flown.answer)?;
    let holds = flown.answer.plan.is_traversable() && flown.answer.shows_success();
    let reply = Reply::new(DocumentKind::SimulateMesh, json, holds);
    #[cfg(feature = "plot")]
    let reply = reply.drawn({
        let scenario = open.scenario.clone();
        move || flown.picture(&scenario)
    });
    Ok(reply)
}

/// A path of a point over a mesh, and its trials.
fn run_over_mesh(open: &OpenFacets, progress: &dyn Progress) -> Result<Ran, AskError> {
    let question = MeshRouteQuestion { scenario: &open.scenario, base: &open.base, front: None, roadmap: None };
    let routed = mesh_route(&question, progress)?;
    let (answer, mut warnings) = (routed.answer.clone(), routed.warnings.clone());
    let (holds, mut trials) = (answer.is_traversable(), None);
    if open.scenario.uncertainty.is_some() && routed.path.is_some() {
        let flown = simulate_over_mesh(routed, &open.scenario, &SimulateOptions::default(), &mut (), progress)?;
        warnings.clone_from(&flown.warnings);
        trials = Some(open.document(DocumentKind::SimulateMesh, &flown.warnings, &flown.answer)?);
    }
    let kind = DocumentKind::RunMesh;
    let plan = Reply::new(kind, open.document(kind, &warnings, answer)?, holds);
    Ok(Ran { plan, trials: trials.map(|json| Reply::new(DocumentKind::SimulateMesh, json, holds)) })
}

/// A path of a robot with legs, and its trials.
fn run_of_legs(open: &OpenFacets, progress: &dyn Progress) -> Result<Ran, AskError> {
    let routed = legs_route(LegsRouteQuestion { scenario: &open.scenario, base: &open.base }, progress)?;
    let (answer, crs, mut warnings) = (routed.answer.clone(), routed.crs(), routed.warnings.clone());
    let (holds, mut trials) = (answer.plan.is_traversable(), None);
    if open.scenario.uncertainty.is_some() && routed.path.is_some() {
        let flown = simulate_legs(routed, &open.scenario, &SimulateOptions::default(), progress)?;
        warnings.clone_from(&flown.warnings);
        let kind = DocumentKind::SimulateLegs;
        trials = Some(Reply::new(kind, open.document_on_map(kind, crs.as_ref(), &flown.warnings, &flown.answer)?, holds));
    }
    let kind = DocumentKind::PlanLegs;
    let plan = Reply::new(kind, open.document_on_map(kind, crs.as_ref(), &warnings, &answer)?, holds);
    Ok(Ran { plan, trials })
}
