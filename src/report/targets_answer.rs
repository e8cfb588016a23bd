//! The answer of a plan over several targets, as plain data.

use std::io::{self, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    AmountRecord, DeratingRecord, HopRecord, MapKnowledge, ObjectiveRecord, OutageRecord, PropellantShortage, RouteGapRecord,
    SimulationRecord, SuccessRequirement, TotalsRecord, write_path_csv,
};
use crate::{
    graph::proof::ProofVerdict,
    planner::{Amount, Amounts, VisitOrder},
};

/// The answer of `chta plan` for a scenario with `[mission]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetsAnswer {
    /// Where the mission begins, [x, y, z], m.
    pub start_m: [f64; 3],
    /// In which order targets may be visited.
    pub order: VisitOrder,
    /// Whether the mission ends at its start.
    pub return_to_start: bool,
    /// `traversable` if all targets are visited within the budgets, else `no-path-found`; other nodes may have a path where these have none.
    pub verdict: ProofVerdict,
    /// The targets as listed.
    pub targets: Vec<TargetRecord>,
    /// How many of them are visited: no mission over these nodes within the budgets visits more, unless `best_over_nodes` is false.
    pub targets_visited: usize,
    /// Whether the mission is the best over these nodes and commands: false where the search left out labels.
    pub best_over_nodes: bool,
    /// The hops of the mission; null if no target is visited.
    pub hops: Option<u64>,
    /// What no mission over all targets takes fewer hops than, over whatever nodes; null where that is not known.
    pub hops_lower_bound: Option<u64>,
    /// What the mission was planned for, and what it takes of its budgets.
    #[serde(flatten)]
    pub objective: ObjectiveRecord,
    /// Under layers that may be left for a while: the longest outage of each over the whole mission; if one is too long, the verdict is
    /// `no-path-found`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outages: Vec<OutageRecord>,
    /// Under layers with a cost: what each costs the whole mission, in its own unit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layer_costs: Vec<AmountRecord>,
    /// The shares of the limits that this answer and all margins are for; absent if they are for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// If the mission takes more propellant than the machine has; the verdict is then `no-path-found`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub propellant_shortage: Option<PropellantShortage>,
    /// How it was searched.
    pub search: TargetsSearchRecord,
    /// Whether the path was flown again by the independent checker and passed; null without a path.
    pub verified: Option<bool>,
    /// The visits in their order, with what the mission takes to each of them.
    pub visits: Vec<VisitRecord>,
    /// The hops in the order of flight; empty if no target is visited.
    pub path: Vec<TargetHopRecord>,
    /// The sums over the path; null without one.
    pub totals: Option<TotalsRecord>,
}

/// A target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetRecord {
    /// Its number in the list, from 1.
    pub target: usize,
    /// Its place, [x, y, z], m.
    pub at_m: [f64; 3],
    /// Which visit it is, from 1; null if it is not visited.
    pub visit: Option<usize>,
    /// Why it is not visited; null if it is.
    pub left_out: Option<LeftOutRecord>,
}

/// Why a target is not visited.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeftOutRecord {
    /// The reason.
    pub why: WhyRecord,
    /// Of one that is not reached: the reached place nearest to it, [x, y, z], m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nearest_m: Option<[f64; 3]>,
    /// Of one that is not reached: what lies between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<RouteGapRecord>,
    /// Of one beyond the budgets: by how much the best mission exceeds them that visits it beside those that are visited.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub over: Vec<OverBudgetRecord>,
}

/// A reason for which a target is not visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhyRecord {
    /// The start does not reach it over these nodes.
    NotReached,
    /// From it the start is not reached over these nodes, where the mission ends.
    NoWayBack,
    /// No order of legs over these nodes visits it together with those that are visited.
    NotTogether,
    /// The mission would be outside the condition of a layer for too long.
    Outages,
    /// The mission would exceed the budgets.
    Budgets,
}

impl WhyRecord {
    /// All reasons.
    pub const ALL: [Self; 5] = [Self::NotReached, Self::NoWayBack, Self::NotTogether, Self::Outages, Self::Budgets];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotReached => "not-reached",
            Self::NoWayBack => "no-way-back",
            Self::NotTogether => "not-together",
            Self::Outages => "outages",
            Self::Budgets => "budgets",
        }
    }
}

crate::quantity::by_name!(WhyRecord, WhyRecord::ALL);

/// A budget that a mission exceeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OverBudgetRecord {
    /// Of which amount.
    pub amount: Amount,
    /// What the mission takes, in the unit of the amount.
    pub total: f64,
    /// The greatest total.
    pub max: f64,
}

/// How a mission over targets was searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetsSearchRecord {
    /// Nodes for each spacing of the posts.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes.
    pub node_spacing_m: f64,
    /// All nodes, start and targets included.
    pub nodes: usize,
    /// Pairs of stops between which a leg was searched, each direction by itself.
    pub legs: usize,
    /// Pairs of nodes tested for a hop.
    pub pairs_tested: u64,
}

/// A visit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VisitRecord {
    /// Its number in the order of visits, from 1.
    pub visit: usize,
    /// The target that its leg begins at; null for the start.
    pub from_target: Option<usize>,
    /// The target; null for the return to the start.
    pub target: Option<usize>,
    /// Its place, [x, y, z], m.
    pub at_m: [f64; 3],
    /// The horizontal distance from the stop before.
    pub straight_line_m: f64,
    /// What no path of this leg takes fewer hops than; null where that is not known.
    pub hops_lower_bound: Option<u64>,
    /// What the leg takes.
    pub leg: TripRecord,
    /// What the mission has taken when it arrives.
    pub arrival: TripRecord,
}

/// What a leg, or a mission up to a visit, takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TripRecord {
    /// Hops.
    pub hops: u64,
    /// Time in flight.
    pub flight_time_s: f64,
    /// Flights, preparations, and settling before every hop but the first of the mission.
    pub mission_time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// Delta-v.
    pub delta_v_m_s: f64,
    /// Horizontal distance.
    pub distance_m: f64,
    /// The greatest take-off speed.
    pub peak_takeoff_speed_m_s: f64,
}

impl TripRecord {
    /// Of the amounts of a path.
    pub fn new(amounts: &Amounts) -> Self {
        Self {
            hops: super::hops_of(amounts),
            flight_time_s: amounts.of(Amount::FlightTime),
            mission_time_s: amounts.of(Amount::MissionTime),
            energy_j_kg: amounts.of(Amount::Energy),
            delta_v_m_s: amounts.of(Amount::DeltaV),
            distance_m: amounts.of(Amount::Distance),
            peak_takeoff_speed_m_s: amounts.of(Amount::PeakSpeed),
        }
    }
}

/// A hop of a mission over targets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetHopRecord {
    /// The visit that it leads to, from 1.
    pub visit: usize,
    /// The target of that visit; null for the return to the start.
    pub target: Option<usize>,
    /// The hop; its number is among all hops, and its x counts the horizontal distance travelled.
    #[serde(flatten)]
    pub hop: HopRecord,
}

impl TargetsAnswer {
    /// Whether all targets are visited, within all limits.
    pub fn is_traversable(&self) -> bool {
        self.verdict == ProofVerdict::Traversable
    }
}

/// Writes hops as CSV: `visit` and `target`, empty for the return to the start, then the columns of a path.
///
/// # Errors
/// [`io::Error`] from `out`.
pub fn write_target_hops_csv(hops: &[TargetHopRecord], map: MapKnowledge, out: &mut dyn Write) -> io::Result<()> {
    let rows: Vec<HopRecord> = hops.iter().map(|row| row.hop.clone()).collect();
    let mut text = Vec::new();
    write_path_csv(&rows, map, &mut text)?;
    let text = String::from_utf8_lossy(&text);
    let mut lines = text.lines();
    writeln!(out, "visit,target,{}", lines.next().unwrap_or_default())?;
    for (line, row) in lines.zip(hops) {
        let target = row.target.map_or(String::new(), |target| target.to_string());
        writeln!(out, "{},{target},{line}", row.visit)?;
    }
    Ok(())
}

/// The answer of `chta simulate` for a scenario with `[mission]`: the plan, and its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TargetsSimulateAnswer {
    /// The plan.
    #[serde(flatten)]
    pub plan: TargetsAnswer,
    /// The trials under the policy of the scenario, each over the whole mission; null without a path. A trial reaches the goal if it has
    /// visited every planned target, one after the other, and returned where that is asked for.
    pub simulation: Option<SimulationRecord>,
    /// By visit, how many of these trials reached it and all before it, each within the goal tolerance.
    pub visited: Vec<VisitedRecord>,
    /// The trials under both policies on the same draws, where that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compare: Vec<SimulationRecord>,
    /// The success that was to be shown.
    #[serde(flatten)]
    pub requirement: Option<SuccessRequirement>,
}

/// How many trials reach a stop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VisitedRecord {
    /// The target; null for the return to the start.
    pub target: Option<usize>,
    /// How many trials.
    pub trials: u64,
    /// Their share.
    pub reached_share: f64,
    /// Its 95 % interval (Wilson).
    pub reached_share_ci95: [f64; 2],
}

impl TargetsSimulateAnswer {
    /// Whether the trials show the success that was to be shown.
    pub fn shows_success(&self) -> bool {
        self.requirement.is_none_or(|requirement| requirement.success_min_shown)
    }
}
