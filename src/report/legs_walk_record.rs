//! How a robot with legs walks between the hops of a plan, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DriveRefusalRecord, TravelLegRecord, TravelTotalsRecord, travel_text::legs_and_totals};
use crate::planner::Travel;

/// The walking of a plan of a robot with legs, and its moves in the order of travel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsWalkRecord {
    /// Whether it walks (`drive`) or does both.
    pub travel: Travel,
    /// To how many of its nearest stances straight lines lead from each stance; from and to start and goal they lead from and to every stance.
    pub neighbours: usize,
    /// Straight lines between stances that were tested, each way by itself.
    pub lines_tested: u64,
    /// How many of these lines each limit of `[drive]` refuses, in descending order.
    pub refusals: Vec<DriveRefusalRecord>,
    /// The moves from each stance of the path to the next: `drive`, walked over the ground under the root, and `hop`; empty without a path. Numbers of
    /// hops, and rows of `path`, count hops alone.
    pub legs: Vec<TravelLegRecord>,
    /// The sums over walks and hops; null without a path. `totals` beside it are those of the hops.
    pub totals: Option<TravelTotalsRecord>,
}

impl LegsWalkRecord {
    /// The moves and their sums as text.
    pub fn text(&self) -> String {
        let mut found = format!(
            "walking: {} straight lines tested, to the {} nearest stances of each and to start and goal\n",
            self.lines_tested, self.neighbours
        );
        if !self.refusals.is_empty() {
            let rows: Vec<String> = self.refusals.iter().map(|row| format!("{} {}", row.limit, row.legs)).collect();
            found = found + "lines refused by " + &rows.join(", ") + "\n";
        }
        found + &legs_and_totals(&self.legs, self.totals.as_ref())
    }
}
