//! The answer whether a path exists, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    AmountRecord, derating_record::DeratingRecord, hop_answer::BindingRecord, limit_counts::LimitCounts,
    objective_record::ObjectiveRecord, outage_record::OutageRecord, proof_record::ProofRecord,
    propellant_record::PropellantShortage, route_record::RouteRecord, success_record::SuccessBudgetRecord,
};
use crate::{
    graph::{
        Answer, Effort, EffortUnit, EndpointRefusal, Frontier, Outcome, PointSpacing,
        proof::{Bounds, ProofVerdict},
    },
    hop::HopTest,
    path::{Hop, HopPath, NoCommand},
    world::{Contact, Limit},
};

/// The answer of `chta check` for one pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckAnswer {
    /// Start, m.
    pub start_x_m: f64,
    /// Goal, m.
    pub goal_x_m: f64,
    /// `traversable`, `no-path-found`, or `untraversable` if that is proved.
    pub verdict: ProofVerdict,
    /// The fewest hops over these nodes.
    pub hops: Option<u64>,
    /// The fewest hops of any path, over whatever nodes, by the greatest speeds alone; null if the ground allows no hop any speed.
    #[serde(default)]
    pub hops_lower_bound: Option<u64>,
    /// The effort of that path, in the unit of the chosen effort.
    pub effort: Option<EffortRecord>,
    /// Of a free route: how it was searched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub route: Option<RouteRecord>,
    /// The greatest number of points inside one segment.
    pub points_per_segment: u32,
    /// The greatest node spacing, if the search was given one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_spacing_max_m: Option<f64>,
    /// The number of vertices of the chain: a file that was cut short has fewer.
    pub vertices: usize,
    /// The number of nodes.
    pub nodes: usize,
    /// The number of pairs tested, over all spacings tried.
    pub pairs_tested: u64,
    /// The number of pairs refused by each limit.
    pub refusals: LimitCounts,
    /// Start or goal, if no hop can take off or land there, with the reason.
    pub endpoint_refusals: Vec<EndpointRecord>,
    /// Without a path: how far one gets over these nodes, and which limits refuse to go on.
    pub frontier: Option<FrontierRecord>,
    /// If the path takes more propellant than the machine has; the verdict is then `no-path-found`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub propellant_shortage: Option<PropellantShortage>,
    /// Of a scenario with a budget of success: whether the path has it; if not, the verdict is `no-path-found`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success_budget: Option<SuccessBudgetRecord>,
    /// Of a plan by objective or within budgets of totals: what it was planned for, and whether it keeps the budgets; if not, the verdict is
    /// `no-path-found`.
    #[serde(flatten)]
    pub objective: Option<ObjectiveRecord>,
    /// Of a free route under layers that may be left for a while: the longest outage of each; if one is too long, the verdict is
    /// `no-path-found`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outages: Vec<OutageRecord>,
    /// Of a free route under layers with a cost: what each costs the path, in its own unit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layer_costs: Vec<AmountRecord>,
    /// The shares of the limits that this answer, a proof and all margins are for; absent if they are for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// If no commands in the machine's steps fly the path; the verdict is then `no-path-found`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commands_refusal: Option<String>,
    /// With commands in steps: the greatest distance of a landing from its aim.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub landing_miss_max_m: Option<f64>,
    /// Whether hops of the path fly beside the line, in the headings that the machine has; a proof is about hops on the line. Absent if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub beside_line: bool,
    /// The bounds; absent if no proof was requested.
    #[serde(flatten)]
    pub proof: Option<ProofRecord>,
}

/// An amount of effort.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffortRecord {
    /// The kind of effort.
    pub name: Effort,
    /// The amount, in `unit`.
    pub value: f64,
    /// Its unit.
    pub unit: EffortUnit,
}

/// The answers for many pairs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PairsAnswer {
    /// One answer for each pair, in the order of the file.
    pub pairs: Vec<CheckAnswer>,
}

impl EffortRecord {
    /// An amount of the given effort.
    pub const fn new(effort: Effort, value: f64) -> Self {
        Self { name: effort, value, unit: effort.unit() }
    }
}

/// An end of a journey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JourneyEnd {
    /// The start.
    Start,
    /// The goal.
    Goal,
}

impl JourneyEnd {
    /// Both ends.
    pub const ALL: [Self; 2] = [Self::Start, Self::Goal];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Goal => "goal",
        }
    }
}

crate::quantity::by_name!(JourneyEnd, JourneyEnd::ALL);

impl From<Contact> for JourneyEnd {
    /// Hops take off from the start and land at the goal.
    fn from(contact: Contact) -> Self {
        match contact {
            Contact::Takeoff => Self::Start,
            Contact::Landing => Self::Goal,
        }
    }
}

/// A start or goal at which no hop at all can take off or land.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EndpointRecord {
    /// `start` or `goal`.
    pub endpoint: JourneyEnd,
    /// Where, m.
    pub x_m: f64,
    /// The limit that refuses.
    pub limit: Limit,
    /// By how many degrees, if it is a limit on an angle.
    pub excess_deg: Option<f64>,
    /// The reason as a sentence.
    pub reason: String,
    /// The nearest usable point of the chain, m.
    pub nearest_usable_x_m: Option<f64>,
}

/// How far one gets from either end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FrontierRecord {
    /// The reached node nearest to the goal, m.
    pub reached_x_m: f64,
    /// The number of nodes reachable from the start, itself included.
    pub reached_nodes: usize,
    /// The node nearest to the start from which the goal can be reached, m.
    pub leads_to_goal_from_x_m: f64,
    /// The number of nodes from which the goal can be reached, itself included.
    pub leads_to_goal_nodes: usize,
    /// The refusals of hops out of the reached nodes, by limit.
    pub refusals: LimitCounts,
    /// Of the hops refused by two conflicting limits, the one with the smallest gap in degrees.
    pub nearest_miss: Option<MissRecord>,
}

/// A refused hop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MissRecord {
    /// The take-off, m.
    pub from_x_m: f64,
    /// The landing, m.
    pub to_x_m: f64,
    /// The reason.
    pub binding: BindingRecord,
}

impl CheckAnswer {
    /// From the search's answer between two stations.
    pub fn new(test: &HopTest, start_x_m: f64, goal_x_m: f64, answer: &Answer, effort: Effort) -> Self {
        let (endpoint_refusals, frontier) = match &answer.outcome {
            Outcome::Path { .. } => (Vec::new(), None),
            Outcome::EndpointsRefuse(refusals) => (refusals.iter().map(EndpointRecord::new).collect(), None),
            Outcome::NoPath(frontier) => (Vec::new(), Some(FrontierRecord::new(test, frontier))),
        };
        let effort = match &answer.outcome {
            Outcome::Path { cost, .. } => Some(EffortRecord::new(effort, cost.effort())),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        };
        Self {
            start_x_m,
            goal_x_m,
            verdict: verdict_of(answer),
            hops: answer.hops(),
            hops_lower_bound: hops_lower_bound(test, start_x_m, goal_x_m),
            effort,
            route: None,
            points_per_segment: answer.points_per_segment,
            node_spacing_max_m: match answer.spacing {
                PointSpacing::AtMostM(spacing_m) => Some(spacing_m),
                PointSpacing::PerSegment(_) => None,
            },
            vertices: test.chain().geometry().vertices().len(),
            nodes: answer.nodes,
            pairs_tested: answer.pairs_tested,
            refusals: (&answer.refusals).into(),
            endpoint_refusals,
            frontier,
            propellant_shortage: None,
            success_budget: None,
            objective: None,
            outages: Vec::new(),
            layer_costs: Vec::new(),
            derating: None,
            commands_refusal: None,
            landing_miss_max_m: None,
            beside_line: false,
            proof: None,
        }
    }

    /// Adds the bounds of a proof whose search gave this answer, and replaces the verdict by that of the proof.
    #[must_use]
    pub fn with_bounds(mut self, bounds: &Bounds, budget_cells: usize) -> Self {
        let proof = ProofRecord::new(bounds, budget_cells);
        self.verdict = proof.verdict();
        self.proof = Some(proof);
        self
    }

    /// Adds what the path takes from the machine. A path that takes more propellant than there is answers no: another path may take
    /// less, which the search, and a proof about hops, do not know.
    #[must_use]
    pub fn with_path(mut self, path: Option<&HopPath>) -> Self {
        self.layer_costs = path.map_or_else(Vec::new, |path| AmountRecord::of_layers(&path.totals.layers));
        self.propellant_shortage = path.and_then(|path| PropellantShortage::of(&path.totals));
        let aims = path.into_iter().flat_map(|path| &path.hops).filter_map(|hop| hop.aim);
        self.landing_miss_max_m = aims.map(|aim| aim.distance_m()).reduce(f64::max);
        self.beside_line = path.is_some_and(|path| path.hops.iter().any(Hop::is_beside_line));
        if let (Some(path), Some(_), Some(effort)) = (path, self.landing_miss_max_m, &mut self.effort) {
            // Not that of the exact commands.
            effort.value = path.effort(effort.name);
        }
        if let (Some(path), Some(objective)) = (path, self.objective.take()) {
            self = self.with_objective(Some(objective.flown(&path.amounts())));
        }
        if self.propellant_shortage.is_some() { self.open() } else { self }
    }

    /// The answer where no commands in the machine's steps fly the path: no, since another path may have some, which the search for
    /// exact commands does not know.
    #[must_use]
    pub fn without_commands(mut self, problem: &NoCommand) -> Self {
        self.commands_refusal = Some(problem.to_string());
        self.effort = None;
        self.open()
    }

    /// Adds what a budget of success says of the path. A path with less answers no, which nothing proves: paths over other nodes may have
    /// more.
    #[must_use]
    pub fn with_success_budget(mut self, budget: Option<SuccessBudgetRecord>) -> Self {
        self.success_budget = budget;
        if budget.is_some_and(|budget| !budget.met) { self.open() } else { self }
    }

    /// Adds what a plan by objective takes of its budgets. A path that takes too much answers no, which nothing proves: paths over other
    /// nodes may take less.
    #[must_use]
    pub fn with_objective(mut self, objective: Option<ObjectiveRecord>) -> Self {
        let met = objective.as_ref().is_none_or(ObjectiveRecord::is_met);
        self.objective = objective;
        if met { self } else { self.open() }
    }

    /// Adds the longest outages of the path. One that is too long answers no, which nothing proves: paths over other nodes may keep it.
    #[must_use]
    pub fn with_outages(mut self, outages: Vec<OutageRecord>) -> Self {
        self.outages = outages;
        if self.keeps_outages() { self } else { self.open() }
    }

    /// Whether the path is outside the condition of no layer for too long.
    pub fn keeps_outages(&self) -> bool {
        self.outages.iter().all(|outage| outage.met)
    }

    /// Adds the shares of the limits that it is for.
    #[must_use]
    pub const fn with_derating(mut self, derating: Option<DeratingRecord>) -> Self {
        self.derating = derating;
        self
    }

    /// The answer no, which nothing proves.
    fn open(mut self) -> Self {
        self.verdict = ProofVerdict::Open;
        if let Some(proof) = &mut self.proof {
            (proof.upper_bound, proof.proved) = (None, false);
        }
        self
    }

    /// Whether there is a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        let is_reliable = !matches!(self.success_budget, Some(SuccessBudgetRecord { met: false, .. }));
        self.hops.is_some()
            && self.propellant_shortage.is_none()
            && self.commands_refusal.is_none()
            && is_reliable
            && self.objective.as_ref().is_none_or(ObjectiveRecord::is_met)
            && self.keeps_outages()
    }
}

/// The fewest hops of any path between two positions of a chain.
fn hops_lower_bound(test: &HopTest, start_x_m: f64, goal_x_m: f64) -> Option<u64> {
    let station = |x_m| test.chain().geometry().station(x_m).ok();
    test.chain().hops_lower_bound(&station(start_x_m)?, &station(goal_x_m)?)
}

/// The verdict of a search alone. A search cannot prove that there is no path, so the verdict is never "untraversable".
pub fn verdict_of(answer: &Answer) -> ProofVerdict {
    if answer.hops().is_some() { ProofVerdict::Traversable } else { ProofVerdict::Open }
}

impl EndpointRecord {
    fn new(refusal: &EndpointRefusal) -> Self {
        Self {
            endpoint: refusal.contact.into(),
            x_m: refusal.station.point.x_m,
            limit: refusal.refusal.limit(refusal.contact),
            excess_deg: refusal.refusal.excess_deg(),
            reason: refusal.refusal.to_string(),
            nearest_usable_x_m: refusal.nearest.map(|station| station.point.x_m),
        }
    }
}

impl FrontierRecord {
    fn new(test: &HopTest, frontier: &Frontier) -> Self {
        Self {
            reached_x_m: frontier.nearest_to_goal.point.x_m,
            reached_nodes: frontier.reached.len(),
            leads_to_goal_from_x_m: frontier.nearest_to_start.point.x_m,
            leads_to_goal_nodes: frontier.leads_to_goal.len(),
            refusals: (&frontier.refusals).into(),
            nearest_miss: frontier.nearest_miss.map(|miss| MissRecord {
                from_x_m: miss.takeoff.point.x_m,
                to_x_m: miss.landing.point.x_m,
                binding: BindingRecord::of_conflict(test, &miss.conflict),
            }),
        }
    }
}
