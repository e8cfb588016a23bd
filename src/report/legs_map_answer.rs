//! The answer of a map of a robot with legs, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    DeratingRecord, LegsGroundRecord,
    text::{Sheet, place},
};
use crate::quantity::format_number;

/// The answer of `chta map` for a robot with legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsMapAnswer {
    /// The name of the robot.
    pub robot: String,
    /// Which cone stands for the directions in which its feet push.
    pub cone: String,
    /// Which way is up for its trunk: `normal` or `vertical`.
    pub up: String,
    /// The ground that it stands on.
    pub ground: LegsGroundRecord,
    /// How many limbs it has.
    pub limbs: usize,
    /// How many feet it needs on the ground.
    pub contacts_min: usize,
    /// Headings of the trunk at every node.
    pub headings: u32,
    /// Every so many posts are nodes.
    pub stride: usize,
    /// The distance of neighbouring nodes, m.
    pub node_spacing_m: f64,
    /// Nodes with an elevation.
    pub nodes: usize,
    /// Nodes without one.
    pub no_data_nodes: usize,
    /// Nodes at which it stands in a heading or more.
    pub standing_nodes: usize,
    /// By the most legs that find ground, from 0 on, how many nodes.
    pub nodes_by_legs: Vec<usize>,
    /// At how many nodes each limb finds ground in some pose, whether the robot stands there or not.
    pub nodes_by_limb: Vec<LimbNodesRecord>,
    /// The median of the widest beams of the nodes at which it stands, degrees; null without any.
    pub beam_median_deg: Option<f64>,
    /// The greatest of them, degrees.
    pub beam_max_deg: Option<f64>,
    /// The nodes of the starts, [x, y], m.
    pub starts_m: Vec<[f64; 2]>,
    /// What hops reach from them; absent without a start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reach: Option<LegsReachRecord>,
    /// The shares of the limits that the map is for; absent if it is for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// One record for each goal, in the order given.
    pub goals: Vec<LegsGoalRecord>,
}

/// Where a limb finds ground.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LimbNodesRecord {
    /// The name of the limb.
    pub limb: String,
    /// At how many nodes.
    pub nodes: usize,
}

/// What hops from stance to stance reach.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsReachRecord {
    /// Nodes reached, starts included.
    pub reached_nodes: usize,
    /// The most hops that were searched; absent if all were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hops_max: Option<i16>,
    /// By the fewest hops over these stances, from 0 on, how many nodes.
    pub hops_histogram: Vec<usize>,
    /// Stances at the nodes.
    pub stances: usize,
    /// Ordered pairs of them whose hop was tested.
    pub pairs_tested: u64,
}

/// A goal of a map of a robot with legs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsGoalRecord {
    /// The node nearest to the goal, easting.
    pub x_m: f64,
    /// And northing.
    pub y_m: f64,
    /// The fewest hops to it over these stances; null where none lead to it.
    pub hops: Option<u64>,
    /// The time in flight of one path of so many hops, s; null without one.
    pub flight_time_s: Option<f64>,
    /// Whether that path was flown again and passed; null without one.
    pub verified: Option<bool>,
}

impl LegsMapAnswer {
    /// Whether every goal is reached.
    pub fn reaches_all_goals(&self) -> bool {
        self.goals.iter().all(|goal| goal.hops.is_some())
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("{}: cone of its feet {}, up {}", self.robot, self.cone, self.up));
        sheet.line(format_args!("{}", self.ground.sentence()));
        sheet.line(format_args!(
            "{} nodes {} m apart, {} of them without elevation; {} headings of the trunk at each",
            self.nodes + self.no_data_nodes,
            format_number(self.node_spacing_m),
            self.no_data_nodes,
            self.headings
        ));
        if let Some(derating) = &self.derating {
            sheet.line(format_args!("{}", derating.sentence()));
        }
        let share = share(self.standing_nodes, self.nodes);
        let needed = self.contacts_min;
        sheet.line(format_args!(
            "stands on {needed} feet or more at {} nodes, {share:.2} % of those with an elevation",
            self.standing_nodes
        ));
        let legs: Vec<String> = self.nodes_by_legs.iter().enumerate().map(|(legs, nodes)| format!("{legs}: {nodes}")).collect();
        sheet.line(format_args!("nodes by the most legs that find ground: {}", legs.join(", ")));
        let limbs: Vec<String> = self.nodes_by_limb.iter().map(|row| format!("{} {}", row.limb, row.nodes)).collect();
        sheet.line(format_args!("nodes at which each limb finds ground: {}", limbs.join(", ")));
        if let (Some(median), Some(most)) = (self.beam_median_deg, self.beam_max_deg) {
            sheet.line(format_args!("widest beam of take-off angles: median {median:.2} deg, greatest {most:.2} deg"));
        }
        if let Some(reach) = &self.reach {
            let starts: Vec<String> =
                self.starts_m.iter().map(|[x_m, y_m]| format!("({}, {}) m", place(*x_m), place(*y_m))).collect();
            let share = self::share(reach.reached_nodes, self.nodes);
            sheet.line(format_args!(
                "from {}: {} nodes reached, {share:.2} %, over {} stances; other stances may reach more",
                starts.join(", "),
                reach.reached_nodes,
                reach.stances
            ));
            if let Some(most) = reach.hops_max {
                sheet.line(format_args!("no more than {most} hops were searched"));
            }
            let counts: Vec<String> =
                reach.hops_histogram.iter().enumerate().map(|(hops, nodes)| format!("{hops}: {nodes}")).collect();
            sheet.line(format_args!("nodes by the fewest hops over these stances: {}", counts.join(", ")));
        }
        for (number, goal) in self.goals.iter().enumerate() {
            let to = format!("goal {} at ({}, {}) m", number + 1, place(goal.x_m), place(goal.y_m));
            match goal.hops {
                Some(hops) => {
                    let flown =
                        goal.flight_time_s.map(|time_s| format!(", {time_s:.3} s in flight, flown again: it breaks no limit"));
                    sheet.line(format_args!("{to}: at most {hops} hops over these stances{}", flown.unwrap_or_default()));
                }
                None => sheet.line(format_args!("{to}: not reached over these stances; other stances may give a path")),
            }
        }
        sheet.into_text()
    }
}

/// A share of a count, percent.
#[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
fn share(of: usize, all: usize) -> f64 {
    100.0 * of as f64 / all.max(1) as f64
}
