//! The answer of a plan that may drive, as plain data.

use std::io::{self, Write};

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{DeratingRecord, HopRecord, ObjectiveRecord, PropellantShortage};
use crate::{
    drive::{DriveLeg, DriveLimit, DriveRefusalCounts},
    graph::proof::ProofVerdict,
    planner::{Amount, Amounts, Travel},
    quantity::Angle,
    world::Rover,
};

/// The answer of `chta plan` for a scenario with `[drive]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelAnswer {
    /// Whether the machine drives, hops or does both.
    pub travel: Travel,
    /// Where the mission begins, [x, y, z], m.
    pub start_m: [f64; 3],
    /// Where it ends, [x, y, z], m.
    pub goal_m: [f64; 3],
    /// The horizontal distance between them, m.
    pub straight_line_m: f64,
    /// `traversable` or `no-path-found`; other nodes may have a path where these have none.
    pub verdict: ProofVerdict,
    /// The hops of the best path over these nodes; null without a path.
    pub hops: Option<u64>,
    /// A bound on the hops of every path, over whatever nodes: 0, since no bound is known where driving joins hops.
    pub hops_lower_bound: u64,
    /// What the path was planned for, and what it takes of its budgets.
    #[serde(flatten)]
    pub objective: ObjectiveRecord,
    /// The shares of the limits that this answer and all margins are for; absent if they are for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// If the path takes more propellant than the machine has; the verdict is then `no-path-found`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub propellant_shortage: Option<PropellantShortage>,
    /// How it was searched.
    pub search: TravelSearchRecord,
    /// Without a path: where the search stopped, and why.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<TravelStopRecord>,
    /// Whether the path was driven and flown again by the independent checker and passed; null without a path.
    pub verified: Option<bool>,
    /// The legs, in the order of travel; empty without a path.
    pub path: Vec<TravelLegRecord>,
    /// The sums over the path; null without one.
    pub totals: Option<TravelTotalsRecord>,
    /// The same journey by other means of travel over the same nodes, where that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alternatives: Option<Vec<TravelAlternativeRecord>>,
    /// The front of hops against an amount over these nodes, in ascending order of hops; absent if it was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<TravelFrontRecord>,
}

/// How a mission was searched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelSearchRecord {
    /// Nodes for each spacing of the posts.
    pub nodes_per_post: usize,
    /// The distance of neighbouring nodes.
    pub node_spacing_m: f64,
    /// All nodes.
    pub nodes: usize,
    /// To how many neighbours of a node drive legs lead.
    pub neighbours: usize,
    /// By which share drive legs over flat ground without obstacles are longer than the straight line at most.
    pub elongation_max: f64,
    /// Nodes that the search reached; without a path all that the start reaches.
    pub reached_nodes: usize,
    /// Pairs of nodes tested for a hop.
    pub hops_tested: u64,
    /// Pairs of nodes tested for a drive leg.
    pub drives_tested: u64,
}

/// Where a search without a path stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelStopRecord {
    /// The reached place nearest to the goal, [x, y, z], m.
    pub nearest_m: [f64; 3],
    /// The number of drive legs out of the reached nodes that each limit refuses, in descending order.
    pub drive_refusals: Vec<DriveRefusalRecord>,
}

/// How many drive legs a limit refuses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriveRefusalRecord {
    /// The limit.
    pub limit: DriveLimit,
    /// How many legs.
    pub legs: u64,
}

/// The front of hops against an amount.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelFrontRecord {
    /// Against which amount.
    pub amount: Amount,
    /// The most hops that were looked at: those of the plan.
    pub hops_max: u64,
    /// Whether labels were left out, so that better paths may be missing.
    pub labels_capped: bool,
    /// The paths, in ascending order of hops.
    pub paths: Vec<TravelSumsRecord>,
}

/// Says what the tag of [`TravelLegRecord`] is.
fn describe_kind(schema: &mut Schema) {
    let variants = schema.get_mut("oneOf").and_then(Value::as_array_mut).into_iter().flatten();
    for kind in variants.filter_map(|variant| variant.pointer_mut("/properties/kind")?.as_object_mut()) {
        kind.insert("description".to_owned(), "`drive`: driven without a stop; `hop`: one hop.".into());
    }
}

/// One leg of a mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[schemars(transform = describe_kind)]
pub enum TravelLegRecord {
    /// Driven without a stop, in straight lines.
    Drive(Box<DriveLegRecord>),
    /// One hop.
    Hop(Box<HopLegRecord>),
}

/// A drive leg: straight lines over waypoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriveLegRecord {
    /// Number among all legs, from 1.
    pub leg: usize,
    /// Where it begins, [x, y, z], m.
    pub takeoff_m: [f64; 3],
    /// Where it ends, [x, y, z], m.
    pub landing_m: [f64; 3],
    /// Direction from its beginning to its end, clockwise from grid north.
    pub heading_deg: f64,
    /// All places from its beginning to its end where it may turn, [x, y, z], m.
    pub waypoints_m: Vec<[f64; 3]>,
    /// Length over the ground, in three dimensions.
    pub length_m: f64,
    /// Horizontal length.
    pub distance_m: f64,
    /// All height gained.
    pub climb_m: f64,
    /// All height lost.
    pub descent_m: f64,
    /// Time to drive, turns included.
    pub time_s: f64,
    /// Of this, time to turn.
    pub turn_time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// The steepest slope along the way: up positive, down negative.
    pub steepest_deg: f64,
    /// Where, [x, y], m.
    pub steepest_at_m: [f64; 2],
    /// By how much it keeps each limit, at the worst place.
    pub margins: DriveMarginsRecord,
}

/// By how much a drive leg keeps each limit; absent without such a limit.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct DriveMarginsRecord {
    /// To the steepest climb.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope_up_deg: Option<f64>,
    /// To the steepest descent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope_down_deg: Option<f64>,
    /// To the steepest slope across the way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cross_slope_deg: Option<f64>,
    /// To the greatest step between the axles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_m: Option<f64>,
    /// To the greatest roughness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness_m: Option<f64>,
}

/// A hop of a mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HopLegRecord {
    /// Number among all legs, from 1.
    pub leg: usize,
    /// Where it takes off, [x, y, z], m.
    pub takeoff_m: [f64; 3],
    /// Where it lands, [x, y, z], m.
    pub landing_m: [f64; 3],
    /// Time of its preparation, of its flight, and to settle after it unless it lands at the goal.
    pub time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// The hop; its number is among the hops, and its x counts the horizontal distance travelled.
    #[serde(flatten)]
    pub hop: HopRecord,
}

/// What a mission takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelTotalsRecord {
    /// Hops.
    pub hops: u64,
    /// Drive legs: stretches without a hop.
    pub drive_legs: u64,
    /// From the first move to the last arrival: drives, turns, preparations, flights, settling after every landing but one at the goal.
    pub mission_time_s: f64,
    /// Of this, time to drive and to turn.
    pub drive_time_s: f64,
    /// Of this, time in flight.
    pub flight_time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// Energy, if the mass is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_j: Option<f64>,
    /// Delta-v of the hops.
    pub delta_v_m_s: f64,
    /// Propellant of the hops, if the specific impulse is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub propellant_kg: Option<f64>,
    /// The greatest take-off speed.
    pub peak_takeoff_speed_m_s: f64,
    /// Horizontal distance of all legs.
    pub distance_m: f64,
    /// Length of the drive legs over the ground, in three dimensions.
    pub drive_length_m: f64,
    /// Height gained while driving.
    pub climb_m: f64,
    /// Height lost while driving.
    pub descent_m: f64,
    /// The probability that no failure ends the driving, where a rate of failures is given; hops are not in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive_success: Option<f64>,
}

/// The same journey by other means.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelAlternativeRecord {
    /// By what it travels.
    pub travel: Travel,
    /// What was to be least.
    pub objective: Vec<Amount>,
    /// Whether there is a path over these nodes within the budgets.
    pub verdict: ProofVerdict,
    /// What the best path takes; null without one. Where it is over a budget, that path all the same.
    pub totals: Option<TravelSumsRecord>,
}

/// What a mission takes, in short.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TravelSumsRecord {
    /// Hops.
    pub hops: u64,
    /// Time of the mission.
    pub mission_time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// Horizontal distance of all legs.
    pub distance_m: f64,
}

impl TravelSumsRecord {
    /// Of the amounts of a path.
    pub fn new(totals: &Amounts) -> Self {
        Self {
            hops: super::hops_of(totals),
            mission_time_s: totals.of(Amount::MissionTime),
            energy_j_kg: totals.of(Amount::Energy),
            distance_m: totals.of(Amount::Distance),
        }
    }
}

/// The neighbours in words, with the longest detour that they cause.
pub(super) fn neighbours_in_words(neighbours: usize, elongation_max: f64) -> String {
    let percent = 100.0 * elongation_max;
    format!(
        "{neighbours} neighbours: drive legs over flat ground without obstacles are up to {percent:.1} % longer than the straight line"
    )
}

impl DriveMarginsRecord {
    /// Of the single straight lines of a leg, the least of each.
    pub fn of(legs: &[DriveLeg], rover: &Rover) -> Self {
        let limits = rover.limits();
        let worst = |of: &dyn Fn(&DriveLeg) -> f64| legs.iter().map(of).fold(0.0, f64::max);
        let degrees = |slope: f64| Angle::from_slope(slope).degrees();
        let margin_deg = |most: f64, found: f64| most.is_finite().then(|| degrees(most) - degrees(found));
        let [up, down, across] = rover.slopes();
        let height = |most_m: Option<f64>, of: &dyn Fn(&DriveLeg) -> Option<f64>| {
            let found = legs.iter().filter_map(of).fold(0.0, f64::max);
            most_m.map(|most_m| most_m - found)
        };
        Self {
            slope_up_deg: margin_deg(up, worst(&|leg| leg.steepest_up.value)),
            slope_down_deg: margin_deg(down, worst(&|leg| leg.steepest_down.value)),
            cross_slope_deg: margin_deg(across, worst(&|leg| leg.steepest_across.value)),
            step_m: height(limits.step_max_m, &|leg| leg.step.map(|step| step.value)),
            roughness_m: height(limits.roughness_max_m, &|leg| leg.roughness.map(|roughness| roughness.value)),
        }
    }
}

impl DriveRefusalRecord {
    /// Those of all limits that refuse any.
    pub fn rows(counts: &DriveRefusalCounts) -> Vec<Self> {
        counts.ranked().into_iter().map(|(limit, legs)| Self { limit, legs }).collect()
    }
}

impl TravelAnswer {
    /// Whether there is a path that the machine can travel.
    pub fn is_traversable(&self) -> bool {
        self.verdict == ProofVerdict::Traversable
    }
}

/// The columns of [`write_travel_csv`].
const COLUMNS: [&str; 16] = [
    "leg",
    "kind",
    "from_x_m",
    "from_y_m",
    "from_z_m",
    "to_x_m",
    "to_y_m",
    "to_z_m",
    "distance_m",
    "length_m",
    "time_s",
    "energy_j_kg",
    "steepest_deg",
    "heading_deg",
    "takeoff_angle_deg",
    "takeoff_speed_m_s",
];

/// Writes the legs of a mission as CSV, one row for each straight line that is driven and for each hop; a drive leg has several rows of its
/// number. What a row does not have is empty: of a driven line the numbers of the whole leg stand in its first row.
///
/// # Errors
/// An error of the writer.
pub fn write_travel_csv(legs: &[TravelLegRecord], out: impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    let place = |at: &[f64; 3]| at.map(|number| number.to_string());
    let absent = String::new;
    for leg in legs {
        match leg {
            TravelLegRecord::Drive(leg) => {
                for (number, pair) in leg.waypoints_m.windows(2).enumerate() {
                    let whole = [leg.distance_m, leg.length_m, leg.time_s, leg.energy_j_kg, leg.steepest_deg, leg.heading_deg];
                    let whole = whole.map(|value| if number == 0 { value.to_string() } else { absent() });
                    let row = [leg.leg.to_string(), "drive".to_owned()];
                    let [from, to] = [place(&pair[0]), place(&pair[1])];
                    writer.write_record(row.into_iter().chain(from).chain(to).chain(whole).chain([absent(), absent()]))?;
                }
            }
            TravelLegRecord::Hop(leg) => {
                let hop = &leg.hop;
                let heading = hop.map.map_or_else(absent, |map| map.heading_deg.to_string());
                let row = [leg.leg.to_string(), "hop".to_owned()];
                let distance_m = (hop.landing_x_m - hop.takeoff_x_m).to_string();
                let rest = [distance_m, absent(), leg.time_s.to_string(), leg.energy_j_kg.to_string(), absent(), heading];
                let command = [hop.takeoff_angle_deg, hop.takeoff_speed_m_s].map(|number| number.to_string());
                let ends = place(&leg.takeoff_m).into_iter().chain(place(&leg.landing_m));
                writer.write_record(row.into_iter().chain(ends).chain(rest).chain(command))?;
            }
        }
    }
    writer.flush()
}
