//! Robots with legs and kinds of cones side by side, as plain data, text and a table.

use std::io::{self, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{LegsGroundRecord, text::Sheet};

/// The answer of `chta trade` for robots with legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsTradeAnswer {
    /// The ground.
    pub ground: Option<LegsGroundRecord>,
    /// Poses for each robot beside start and goal, at most.
    pub poses_max: u32,
    /// Their seed.
    pub seed: u64,
    /// One row for each robot and cone.
    pub rows: Vec<LegsTradeRow>,
}

/// A robot with a kind of cone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsTradeRow {
    /// The name of the robot.
    pub robot: String,
    /// How many limbs it has.
    pub limbs: usize,
    /// The cone that stands for the directions in which its feet push.
    pub cone: String,
    /// Poses, start and goal included: those in which the robot stands by the exact cone.
    pub poses: usize,
    /// In how many of them it stands by this one.
    pub stances: usize,
    /// The mean over all poses and 36 directions of the interval of take-off angles, degrees; 0 counts where it does not stand.
    pub beam_mean_deg: f64,
    /// The share of poses and directions with such an interval.
    pub directions_mean: f64,
    /// Ordered pairs of stances that a hop joins.
    pub joined_pairs: u64,
    /// Windows of take-off angles of these hops.
    pub windows: usize,
    /// The hops of the best path from start to goal over these stances, within the budgets; null without one.
    pub hops: Option<u64>,
    /// Its time in flight, s; null without one.
    pub flight_time_s: Option<f64>,
}

impl LegsTradeAnswer {
    /// Whether every row has a path.
    pub fn is_traversable(&self) -> bool {
        self.rows.iter().all(|row| row.hops.is_some())
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        if let Some(ground) = &self.ground {
            sheet.line(format_args!("{}", ground.sentence()));
        }
        sheet.line(format_args!(
            "each robot over at most {} poses beside start and goal, the same for all cones (seed {}); other poses give other numbers",
            self.poses_max, self.seed
        ));
        sheet.line(format_args!(
            "\n{:<16}{:<12}{:>9}{:>11}{:>12}{:>9}{:>10}{:>7}{:>12}",
            "robot", "cone", "stances", "beam (deg)", "directions", "joined", "windows", "hops", "flight (s)"
        ));
        for row in &self.rows {
            let hops = row.hops.map_or_else(|| "-".to_owned(), |hops| hops.to_string());
            let time = row.flight_time_s.map_or_else(|| "-".to_owned(), |time_s| format!("{time_s:.3}"));
            sheet.line(format_args!(
                "{:<16}{:<12}{:>9}{:>11.3}{:>12.4}{:>9}{:>10}{:>7}{:>12}",
                row.robot, row.cone, row.stances, row.beam_mean_deg, row.directions_mean, row.joined_pairs, row.windows, hops, time
            ));
        }
        sheet.into_text()
    }

    /// The rows as CSV; absent values are blank.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        for row in &self.rows {
            writer.serialize(row)?;
        }
        writer.flush()
    }
}
