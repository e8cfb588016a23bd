//! The answer whether a path exists, as plain data.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{
    hop_answer::{BindingRecord, end_name},
    proof_record::ProofRecord,
};
use crate::{
    graph::{Answer, Effort, EndpointRefusal, Frontier, Outcome, PointSpacing, RefusalCounts, proof::Bounds},
    hop::HopTest,
};

/// What `chta check` answers for one pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckAnswer {
    /// Start, m.
    pub start_x_m: f64,
    /// Goal, m.
    pub goal_x_m: f64,
    /// `traversable`, `no-path-found`, or `untraversable` where that is proved.
    pub verdict: &'static str,
    /// The fewest hops over these nodes.
    pub hops: Option<u64>,
    /// The effort of that path, in the unit of the chosen effort.
    pub effort: Option<EffortRecord>,
    /// The greatest number of points inside one segment.
    pub points_per_segment: u32,
    /// The greatest node spacing asked for, where it was asked for so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_spacing_max_m: Option<f64>,
    /// How many nodes there were.
    pub nodes: usize,
    /// How many pairs were tested.
    pub pairs_tested: u64,
    /// How many of them each limit refused.
    pub refusals: BTreeMap<&'static str, u64>,
    /// Whether start or goal itself refuses, and why.
    pub endpoint_refusals: Vec<EndpointRecord>,
    /// Without a path: how far one gets over these nodes, and what stops it.
    pub frontier: Option<FrontierRecord>,
    /// What is proved of it; absent where that was not asked for.
    #[serde(flatten)]
    pub proof: Option<ProofRecord>,
}

/// An amount of effort.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EffortRecord {
    /// Which effort.
    pub name: &'static str,
    /// How much.
    pub value: f64,
    /// In which unit.
    pub unit: &'static str,
    /// What it is, for reading.
    #[serde(skip)]
    pub total: &'static str,
}

impl EffortRecord {
    /// So much of an effort.
    pub const fn new(effort: Effort, value: f64) -> Self {
        Self { name: effort.name(), value, unit: effort.unit(), total: effort.total() }
    }
}

/// A start or goal that refuses whatever the hop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EndpointRecord {
    /// `start` or `goal`.
    pub endpoint: &'static str,
    /// Where, m.
    pub x_m: f64,
    /// Which limit refuses.
    pub limit: &'static str,
    /// By how many degrees, where it is one of angles.
    pub excess_deg: Option<f64>,
    /// The same in words.
    pub reason: String,
    /// The nearest point of the chain that would do, m.
    pub nearest_usable_x_m: Option<f64>,
}

/// How far one gets from either end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrontierRecord {
    /// The reached node nearest to the goal, m.
    pub reached_x_m: f64,
    /// How many nodes the start reaches, itself included.
    pub reached_nodes: usize,
    /// The node nearest to the start from which the goal can be reached, m.
    pub leads_to_goal_from_x_m: f64,
    /// How many nodes lead to the goal, itself included.
    pub leads_to_goal_nodes: usize,
    /// What refused the hops out of the reached nodes.
    pub refusals: BTreeMap<&'static str, u64>,
    /// The refused hop that came closest.
    pub nearest_miss: Option<MissRecord>,
}

/// A refused hop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MissRecord {
    /// From here, m.
    pub from_x_m: f64,
    /// To there, m.
    pub to_x_m: f64,
    /// Why not.
    pub binding: BindingRecord,
}

impl CheckAnswer {
    /// From the search's answer between two places.
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
            verdict: verdict_name(answer),
            hops: answer.hops(),
            effort,
            points_per_segment: answer.points_per_segment,
            node_spacing_max_m: match answer.spacing {
                PointSpacing::AtMostM(spacing_m) => Some(spacing_m),
                PointSpacing::PerSegment(_) => None,
            },
            nodes: answer.nodes,
            pairs_tested: answer.pairs_tested,
            refusals: counts(&answer.refusals),
            endpoint_refusals,
            frontier,
            proof: None,
        }
    }

    /// The same with what bounds prove, whose answer it was made from.
    #[must_use]
    pub fn with_bounds(mut self, bounds: &Bounds, budget_cells: usize) -> Self {
        let proof = ProofRecord::new(bounds, budget_cells);
        self.verdict = proof.verdict();
        self.proof = Some(proof);
        self
    }

    /// Whether there is a path.
    pub fn is_traversable(&self) -> bool {
        self.hops.is_some()
    }
}

/// The verdict's name of a search alone, which proves no absence: "untraversable" is never said here.
pub fn verdict_name(answer: &Answer) -> &'static str {
    if answer.hops().is_some() { "traversable" } else { "no-path-found" }
}

/// Refusals by name.
pub(super) fn counts(refusals: &RefusalCounts) -> BTreeMap<&'static str, u64> {
    refusals.ranked().into_iter().map(|(limit, count)| (limit.name(), count)).collect()
}

impl EndpointRecord {
    fn new(refusal: &EndpointRefusal) -> Self {
        Self {
            endpoint: end_name(refusal.contact),
            x_m: refusal.station.point.x_m,
            limit: refusal.refusal.limit(refusal.contact).name(),
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
            refusals: counts(&frontier.refusals),
            nearest_miss: frontier.nearest_miss.map(|miss| MissRecord {
                from_x_m: miss.takeoff.point.x_m,
                to_x_m: miss.landing.point.x_m,
                binding: BindingRecord::of_conflict(test, &miss.conflict),
            }),
        }
    }
}
