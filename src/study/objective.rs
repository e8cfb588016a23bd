//! Plans by an objective, within budgets.

use super::{Case, JourneyError, dem_ground::dem_ground};
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    graph::{Answer, NodeSet, Outcome, ReliabilityOptions},
    hop::HopTest,
    planner::{Amount, Budgets, ChainQuestion, LabelCap, Objective, roadmap::RoadmapQuestion, search_on_chain},
    progress::Progress,
    report::ObjectiveRecord,
    scenario::Scenario,
};

/// What a plan by objective found.
#[derive(Clone, Debug)]
pub(super) struct ByObjective {
    pub(super) found: Answer,
    pub(super) record: ObjectiveRecord,
    pub(super) warnings: Vec<String>,
}

/// What the roadmap of a scenario is searched for, with its whole objective and budgets.
pub(super) fn roadmap_question<'a>(scenario: &Scenario, objective: &'a Objective, budgets: &'a Budgets) -> RoadmapQuestion<'a> {
    let (commands, takeoff) = (scenario.commands, scenario.search.takeoff);
    RoadmapQuestion { objective, budgets, commands, takeoff, cap: LabelCap::default() }
}

/// Plans by the objective of a scenario, within its budgets; `None` if it has neither.
pub(super) fn by_objective(
    test: &HopTest,
    ends: (Station, Station),
    case: &Case,
    progress: &dyn Progress,
) -> Result<Option<ByObjective>, JourneyError> {
    let scenario = &case.scenario;
    if !scenario.plans_by_objective() {
        return Ok(None);
    }
    let (objective, budgets) = (scenario.full_objective(), scenario.total_budgets());
    let reliability = reliability(case, objective.amounts().contains(&Amount::Risk))?;
    let question = ChainQuestion {
        objective: &objective,
        budgets: &budgets,
        commands: scenario.commands,
        reliability: reliability.as_ref(),
        cap: LabelCap::default(),
    };
    let searched = search_on_chain(test, ends, &scenario.search, &question, progress)?;
    let said = (searched.totals, searched.unmet.as_slice(), searched.capped);
    let record = ObjectiveRecord::new(&objective, &scenario.budget.totals(&scenario.hopper), said);
    let warnings = warnings(scenario, spanned_nodes(test, ends, &searched.answer));
    Ok(Some(ByObjective { found: searched.answer, record, warnings }))
}

/// What risk is judged by, where it counts or chooses the commands.
pub(super) fn reliability(case: &Case, counts: bool) -> Result<Option<ReliabilityOptions>, JourneyError> {
    let scenario = &case.scenario;
    let chooses = scenario.search.takeoff == TakeoffChoice::MostReliable;
    if scenario.uncertainty.is_none() || !(counts || chooses) {
        return Ok(None);
    }
    let ground = dem_ground(case).map_err(Box::new)?;
    Ok(Some(scenario.reliability_with(None, ground.as_ref()).flown_under(case.whole_test().as_ref())))
}

/// What is to be known about a path by objective, whose hops span so many nodes on average.
pub(super) fn warnings(scenario: &Scenario, spanned: Option<f64>) -> Vec<String> {
    let mut warnings = Vec::new();
    let objective = scenario.full_objective();
    let has_errors = scenario.uncertainty.as_ref().is_some_and(|keys| !keys.errors.is_none());
    if has_errors && !objective.amounts().contains(&Amount::Risk) {
        warnings.push(format!(
            "the plan is by the objective {objective}, not by reliability: a path of least amounts stands on the edge of its limits; simulate \
             shows how reliably it is flown, and a robot that replans there goes on by hops and effort"
        ));
    }
    warnings.extend(spanned.and_then(|spanned| short_hops(scenario, "hops of this path", spanned)));
    warnings
}

/// A warning where the nodes decide how short the hops of least energy are.
///
/// # Arguments
/// `spanned`: how many nodes a hop spans on average.
pub(super) fn short_hops(scenario: &Scenario, which: &str, spanned: f64) -> Option<String> {
    /// The least number of nodes at which they do not decide the length of a hop.
    const SPANNED: f64 = 3.0;
    let is_energy = scenario.full_objective().first() == Amount::Energy;
    let is_prepared = scenario.hopper.limits().preparation_energy_j.is_some_and(|energy_j| energy_j != 0.0);
    (is_energy && !is_prepared && spanned < SPANNED).then(|| {
        format!(
            "{which} span {spanned:.1} nodes on average, expected at least {SPANNED}: without an energy to prepare a hop the least \
             energy is nearly the same whatever the hops, so that the nodes decide how short they are; put hops first, or give \
             hopper.preparation_energy_j"
        )
    })
}

/// How many nodes a hop of a path spans on average; `None` without hops.
fn spanned_nodes(test: &HopTest, (start, goal): (Station, Station), answer: &Answer) -> Option<f64> {
    let Outcome::Path { legs, cost } = &answer.outcome else { return None };
    let nodes = NodeSet::new(test.chain(), start, goal, answer.spacing).ok()?;
    let span = |leg: &crate::graph::Leg| Some(nodes.find(&leg.takeoff)?.index().abs_diff(nodes.find(&leg.landing)?.index()));
    #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
    let mean = |spanned: usize| spanned as f64 / cost.hops() as f64;
    let spanned: usize = legs.iter().filter_map(span).sum();
    (cost.hops() > 0).then(|| mean(spanned))
}
