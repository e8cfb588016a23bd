//! The keys of an arena, as its file has them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An arena as its file states it, not yet checked: [`Arena::new`](super::Arena::new) does that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArenaKeys {
    /// The floor, and where the way begins and ends.
    pub arena: FloorKeys,
    /// The robot.
    pub jumper: JumperKeys,
    /// Jumps as flights; absent: jumps are rules, a rise and a time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<FlightKeys>,
    /// The nodes of the grid.
    #[serde(default)]
    pub grid: GridKeys,
    /// The boxes on the floor.
    #[serde(default, rename = "box", skip_serializing_if = "Vec::is_empty")]
    pub boxes: Vec<BoxKeys>,
}

/// The floor: from 0, 0 to `size_m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloorKeys {
    /// Its size along x and y, m.
    pub size_m: [f64; 2],
    /// Where the way begins, x and y, m.
    pub start_m: [f64; 2],
    /// Where it ends, x and y, m.
    pub goal_m: [f64; 2],
    /// The heading at the start, degrees clockwise from +y; absent: towards the goal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_heading_deg: Option<f64>,
    /// How far every box is inflated beyond its sides, m.
    #[serde(default)]
    pub inflation_m: f64,
}

/// A box, with its sides along the axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxKeys {
    /// Its centre, x and y, m.
    pub centre_m: [f64; 2],
    /// Its size along x and y, m.
    pub size_m: [f64; 2],
    /// Its height over the floor, m.
    pub height_m: f64,
}

/// The robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JumperKeys {
    /// Driving speed, m/s.
    pub speed_m_s: f64,
    /// Spacing of the wheels, m: turning on the spot at the driving speed takes `wheelbase_m / (2 speed_m_s)` a radian.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheelbase_m: Option<f64>,
    /// Time to turn on the spot, s/rad; absent: by the wheelbase, or 0 without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_s_per_rad: Option<f64>,
    /// The time of a jump, s.
    pub jump_time_s: f64,
    /// The greatest rise of a jump, m.
    pub rise_max_m: f64,
    /// What a landing keeps from the edges of the box, and driving from its faces, where the planner has such a ring, m.
    #[serde(default = "ring_m")]
    pub ring_m: f64,
    /// The longest jump or drop of RRT*, m.
    #[serde(default = "jump_edge_max_m")]
    pub jump_edge_max_m: f64,
    /// What each jump leaves of the driving speed: 1 takes nothing.
    #[serde(default = "one")]
    pub speed_factor_per_jump: f64,
    /// Energy of driving, J/m.
    #[serde(default)]
    pub drive_j_per_m: f64,
    /// Energy of a jump, J.
    #[serde(default)]
    pub jump_j: f64,
    /// Power drawn at all times, W.
    #[serde(default)]
    pub power_w: f64,
    /// The energy that there is, J; absent: no bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub battery_j: Option<f64>,
}

/// The flight of every jump, beside which `jump_time_s` is the time before the take-off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlightKeys {
    /// Its take-off speed, m/s.
    pub takeoff_speed_m_s: f64,
    /// Its take-off angle above the floor, degrees.
    pub takeoff_angle_deg: f64,
    /// Gravity, m/s^2.
    #[serde(default = "gravity_m_s2")]
    pub gravity_m_s2: f64,
}

/// The nodes of the grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridKeys {
    /// Their spacing, m.
    #[serde(default = "spacing_m")]
    pub spacing_m: f64,
    /// How far a jump goes along the grid, m; along a diagonal it goes as many nodes.
    #[serde(default = "jump_length_m")]
    pub jump_length_m: f64,
}

impl Default for GridKeys {
    fn default() -> Self {
        Self { spacing_m: spacing_m(), jump_length_m: jump_length_m() }
    }
}

const fn gravity_m_s2() -> f64 {
    9.81
}

const fn one() -> f64 {
    1.0
}

// The lengths of the paper on the Jumping Sumo: cells of a wheelbase, jumps of two cells, a ring of a cell about every edge.
const fn spacing_m() -> f64 {
    0.2
}

const fn jump_length_m() -> f64 {
    0.4
}

const fn ring_m() -> f64 {
    0.2
}

const fn jump_edge_max_m() -> f64 {
    1.0
}
