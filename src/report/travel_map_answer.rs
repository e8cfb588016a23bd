//! The answer of a map of a machine that may drive, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    DeratingRecord,
    text::{Sheet, place},
    travel_answer::TravelSumsRecord,
};
use crate::{
    planner::{Amount, Travel},
    quantity::format_number,
};

/// The answer of `chta map` for a scenario with `[drive]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelMapAnswer {
    /// Whether the machine drives, hops or does both.
    pub travel: Travel,
    /// The nodes of the starts, [x, y], m.
    pub starts_m: Vec<[f64; 2]>,
    /// Nodes for each spacing of the posts.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes.
    pub node_spacing_m: f64,
    /// Nodes with an elevation.
    pub nodes: usize,
    /// Nodes without one.
    pub no_data_nodes: usize,
    /// To how many neighbours of a node drive legs lead.
    pub neighbours: usize,
    /// By which share drive legs over flat ground without obstacles are longer than the straight line at most.
    pub elongation_max: f64,
    /// What each mission takes least of, then of others among equals.
    pub objective: Vec<Amount>,
    /// Whether labels were left out, so that a node may have a better mission.
    pub labels_capped: bool,
    /// What each means of travel reaches over these nodes, within the budgets.
    pub reached: Vec<TravelReachRecord>,
    /// Nodes that both together reach, and neither alone; absent where the machine does not do both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only_together_nodes: Option<usize>,
    /// Nodes from which a mission leads back to a start, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub return_nodes: Option<usize>,
    /// Nodes that are reached and from which a mission leads back, if that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub there_and_back_nodes: Option<usize>,
    /// The shares of the limits that the map is for; absent if it is for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// One record for each goal, in the order given.
    pub goals: Vec<TravelGoalRecord>,
}

/// What a means of travel reaches.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelReachRecord {
    /// By what it travels.
    pub travel: Travel,
    /// Nodes reached, starts included.
    pub reached_nodes: usize,
    /// Their share of the nodes with an elevation.
    pub reached_share: f64,
    /// The greatest mission time to any of them.
    pub mission_time_max_s: f64,
    /// Half of them take less mission time.
    pub mission_time_median_s: f64,
}

/// A goal of a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelGoalRecord {
    /// The node nearest to the goal, easting.
    pub x_m: f64,
    /// And northing.
    pub y_m: f64,
    /// Whether a mission leads to it over these nodes.
    pub reached: bool,
    /// What it takes, settling after a landing there included; null without one.
    pub totals: Option<TravelSumsRecord>,
}

impl TravelMapAnswer {
    /// Whether every goal is reached.
    pub fn reaches_all_goals(&self) -> bool {
        self.goals.iter().all(|goal| goal.reached)
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let starts: Vec<String> = self.starts_m.iter().map(|[x_m, y_m]| format!("({}, {}) m", place(*x_m), place(*y_m))).collect();
        sheet.line(format_args!(
            "from {} over {} nodes {} m apart, {} of them without elevation",
            starts.join(", "),
            self.nodes + self.no_data_nodes,
            format_number(self.node_spacing_m),
            self.no_data_nodes
        ));
        let objective = self.objective.iter().map(|amount| amount.name()).collect::<Vec<_>>().join(", then ");
        sheet.line(format_args!("least {objective}; other nodes may give better missions"));
        if self.travel.drives() {
            sheet.line(format_args!("{}", super::travel_answer::neighbours_in_words(self.neighbours, self.elongation_max)));
        }
        if let Some(derating) = &self.derating {
            sheet.line(format_args!("{}", derating.sentence()));
        }
        sheet.line(format_args!(
            "\n{:<8}{:>10}{:>12}{:>22}{:>22}",
            "travel", "reached", "share (%)", "median time (s)", "greatest time (s)"
        ));
        for row in &self.reached {
            sheet.line(format_args!(
                "{:<8}{:>10}{:>12.2}{:>22.1}{:>22.1}",
                row.travel.name(),
                row.reached_nodes,
                100.0 * row.reached_share,
                row.mission_time_median_s,
                row.mission_time_max_s
            ));
        }
        if let Some(nodes) = self.only_together_nodes {
            sheet.line(format_args!("{nodes} nodes are reached by driving and hopping together, and by neither alone"));
        }
        if let (Some(back), Some(both)) = (self.return_nodes, self.there_and_back_nodes) {
            sheet.line(format_args!("a mission leads back to a start from {back} nodes; {both} nodes are reached and lead back"));
        }
        if self.labels_capped {
            sheet.line(format_args!("the search left out labels because there were too many: nodes may have better missions"));
        }
        for (number, goal) in self.goals.iter().enumerate() {
            let to = format!("goal {} at ({}, {}) m", number + 1, place(goal.x_m), place(goal.y_m));
            match &goal.totals {
                Some(sums) => sheet.line(format_args!(
                    "{to}: {} hops, mission time {:.3} s, energy {:.4} J/kg, {:.3} m over the map",
                    sums.hops, sums.mission_time_s, sums.energy_j_kg, sums.distance_m
                )),
                None => sheet.line(format_args!("{to}: not reached over these nodes; other nodes may give a mission")),
            }
        }
        sheet.into_text()
    }
}
