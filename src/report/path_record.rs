//! The path as rows: one set of columns for JSON and CSV.

use std::io::{self, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    hop_margins::HopMarginsRecord,
    limit_pair::LimitPair,
    propellant_record::{StoresRecord, stores_columns},
    reliability_record::SuccessEstimate,
    sigma_margins::SigmaMarginsRecord,
    stated::stated,
};
use crate::{
    path::{Aim, Hop, HopPath, RollOut, Totals},
    quantity::MapPoint,
    terrain::MapProjection,
    world::Direction,
};

/// One hop of a path, as plain data. The columns of path.csv and the keys of `path` in JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HopRecord {
    /// Number, from 1.
    pub hop: usize,
    /// Direction of travel.
    pub direction: Direction,
    /// Take-off, x along the chain.
    pub takeoff_x_m: f64,
    /// Its height.
    pub takeoff_z_m: f64,
    /// Landing, x along the chain.
    pub landing_x_m: f64,
    /// Its height.
    pub landing_z_m: f64,
    /// Take-off angle above the horizontal, as seen by the traveller.
    pub takeoff_angle_deg: f64,
    /// Take-off speed.
    pub takeoff_speed_m_s: f64,
    /// Landing angle, negative on the way down.
    pub landing_angle_deg: f64,
    /// Landing speed.
    pub landing_speed_m_s: f64,
    /// Flight time.
    pub flight_time_s: f64,
    /// Elevation of the highest point of the flight.
    pub apex_z_m: f64,
    /// The least feasible take-off angle.
    pub takeoff_angle_min_deg: f64,
    /// The greatest feasible take-off angle.
    pub takeoff_angle_max_deg: f64,
    /// The smaller of the margins of take-off and landing speed.
    pub speed_margin_m_s: f64,
    /// Which limits set the least and the greatest feasible angle, `lower/upper`.
    pub binding: LimitPair,
    /// Delta-v, propellant and mass.
    #[serde(flatten)]
    pub stores: StoresRecord,
    /// On a map: direction of flight, clockwise from grid north.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub map: Option<MapRecord>,
    /// By how much it keeps each limit.
    pub margins: HopMarginsRecord,
    /// The same in standard deviations, where errors are given and the estimate was wanted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margins_sigma: Option<SigmaMarginsRecord>,
    /// The share of 256 fixed draws of its errors (1024 where heights have errors) that this hop survives by itself, where errors are given and
    /// the estimate was wanted. The
    /// product over the hops is not the success of the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success_estimated: Option<f64>,
    /// For a machine that takes its commands in steps: what the command was aimed at.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub aim: Option<AimRecord>,
    /// For a hopper that bounces (`[contact]`): what follows its landing.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub roll_out: Option<RollOutRecord>,
}

/// The bounces after the landing of a hop flown without errors, in the plane of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RollOutRecord {
    /// How many bounces.
    pub bounces: u32,
    /// How far beyond the landing it comes to rest, in the direction of travel; negative before it.
    pub bounce_distance_m: f64,
    /// Time from the landing to rest.
    pub bounce_time_s: f64,
    /// Whether the ground where its bounces end holds it.
    pub bounce_rests: bool,
}

impl From<&RollOut> for RollOutRecord {
    fn from(roll_out: &RollOut) -> Self {
        let &RollOut { bounces, distance_m, time_s, rests } = roll_out;
        Self { bounces, bounce_distance_m: unsigned_zero(distance_m), bounce_time_s: unsigned_zero(time_s), bounce_rests: rests }
    }
}

impl From<&RollOutRecord> for RollOut {
    fn from(record: &RollOutRecord) -> Self {
        let &RollOutRecord { bounces, bounce_distance_m: distance_m, bounce_time_s: time_s, bounce_rests: rests } = record;
        Self { bounces, distance_m, time_s, rests }
    }
}

/// The point that a command in steps was aimed at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AimRecord {
    /// The planned landing, x along the chain.
    pub aim_x_m: f64,
    /// By how much the landing lies beyond it along the profile; negative short of it.
    pub landing_miss_m: f64,
    /// Of a hop beside the line.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub beside: Option<AimBesideRecord>,
}

/// The aim of a hop beside the line, and its miss to the side.
#[expect(clippy::struct_field_names, reason = "names of columns, which end in the unit")]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AimBesideRecord {
    /// By how much the landing lies to the left of the line through the aim.
    pub landing_miss_across_m: f64,
    /// The planned landing, easting.
    pub aim_map_x_m: f64,
    /// The planned landing, northing.
    pub aim_map_y_m: f64,
}

impl From<&Aim> for AimRecord {
    fn from(aim: &Aim) -> Self {
        let beside = aim.across_m.zip(aim.point.map()).map(|(across_m, at)| AimBesideRecord {
            landing_miss_across_m: unsigned_zero(across_m),
            aim_map_x_m: at.x,
            aim_map_y_m: at.y,
        });
        Self { aim_x_m: aim.point.along_m, landing_miss_m: unsigned_zero(aim.miss_m), beside }
    }
}

/// The columns of a hop on a map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapRecord {
    /// Direction of flight, clockwise from grid north.
    pub heading_deg: f64,
    /// Take-off, easting.
    pub takeoff_map_x_m: f64,
    /// Take-off, northing.
    pub takeoff_map_y_m: f64,
    /// Landing, easting.
    pub landing_map_x_m: f64,
    /// Landing, northing.
    pub landing_map_y_m: f64,
    /// On a map of a known projection: longitude and latitude of both ends.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub lon_lat: Option<LonLatRecord>,
    /// On a map of a known projection: direction of flight, clockwise from true north at the take-off; null at a pole.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub heading_true_deg: Option<Option<f64>>,
}

/// The columns of a hop on a map whose projection is known; planetocentric, east positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LonLatRecord {
    /// Take-off, longitude.
    pub takeoff_lon_deg: f64,
    /// Take-off, latitude.
    pub takeoff_lat_deg: f64,
    /// Landing, longitude.
    pub landing_lon_deg: f64,
    /// Landing, latitude.
    pub landing_lat_deg: f64,
}

impl LonLatRecord {
    fn new((takeoff, landing): (MapPoint, MapPoint), projection: &MapProjection) -> Option<Self> {
        let [takeoff, landing] = [takeoff, landing].map(|at| projection.lon_lat(at));
        let (takeoff, landing) = (takeoff?, landing?);
        Some(Self {
            takeoff_lon_deg: tenth_digit(takeoff.lon_deg),
            takeoff_lat_deg: tenth_digit(takeoff.lat_deg),
            landing_lon_deg: tenth_digit(landing.lon_deg),
            landing_lat_deg: tenth_digit(landing.lat_deg),
        })
    }
}

/// Degrees to ten digits (some micrometres on the ground): further digits differ between the mathematics libraries of platforms.
pub(super) fn tenth_digit(degrees: f64) -> f64 {
    libm::rint(degrees * 1.0e10) / 1.0e10
}

/// The heading of a hop from true north at its take-off, degrees; `None` at a pole.
pub(super) fn heading_true_deg(projection: &MapProjection, takeoff: MapPoint, heading_deg: f64) -> Option<f64> {
    /// Digits beyond are rounding of the projection, which differs between platforms.
    const DIGITS: f64 = 1.0e8;
    let degrees = projection.true_heading_deg(takeoff, heading_deg)?;
    Some(libm::rint(degrees * DIGITS) / DIGITS % 360.0)
}

/// What the energies of [`TotalsRecord`] are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyBasis {
    /// Taken from the store: of motion over the efficiency, and of the preparations.
    Store,
}

impl EnergyBasis {
    /// All of them.
    pub const ALL: [Self; 1] = [Self::Store];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Store => "store",
        }
    }
}

crate::quantity::by_name!(EnergyBasis, EnergyBasis::ALL);

/// The totals of a path's hops.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TotalsRecord {
    /// Time in flight.
    pub flight_time_s: f64,
    /// Energy from the store, per unit mass.
    pub energy_j_kg: f64,
    /// The greatest take-off speed.
    pub peak_takeoff_speed_m_s: f64,
    /// The sum of horizontal distances.
    pub ground_distance_m: f64,
    /// Energy, if the mass is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_j: Option<f64>,
    /// Time of bounces after landings, if the hopper bounces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounce_time_s: Option<f64>,
    /// Time in flight, of bounces, of preparations and of settling between hops, if one of the last three is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mission_time_s: Option<f64>,
    /// `store` where the energies are more than those of motion: with an efficiency or a preparation energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_basis: Option<EnergyBasis>,
    /// Delta-v.
    pub delta_v_m_s: f64,
    /// Propellant, if the specific impulse is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub propellant_kg: Option<f64>,
    /// Mass at the end, if the specific impulse is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_end_kg: Option<f64>,
    /// Propellant beyond what the machine has, if the path takes too much.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub propellant_short_kg: Option<f64>,
    /// How reliably the path is flown, where errors are given and the estimate was wanted.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<SuccessEstimate>,
    /// Whether the machine has a key of propulsion, so that text states the delta-v. The scenario says so, JSON does not: false after
    /// reading.
    #[serde(skip)]
    pub propulsive: bool,
}

impl HopRecord {
    /// The rows of a path; with a `projection`, map positions get their longitude and latitude.
    pub fn rows(path: &HopPath, projection: Option<&MapProjection>) -> Vec<Self> {
        path.hops.iter().enumerate().map(|(i, hop)| Self::new(i + 1, hop, projection)).collect()
    }

    fn new(number: usize, hop: &Hop, projection: Option<&MapProjection>) -> Self {
        Self {
            hop: number,
            direction: hop.direction,
            takeoff_x_m: hop.takeoff.along_m,
            takeoff_z_m: hop.takeoff.point_m.z,
            landing_x_m: hop.landing.along_m,
            landing_z_m: hop.landing.point_m.z,
            takeoff_angle_deg: hop.takeoff_angle.degrees(),
            takeoff_speed_m_s: hop.takeoff_speed_m_s,
            landing_angle_deg: hop.landing_angle.degrees(),
            landing_speed_m_s: hop.landing_speed_m_s,
            flight_time_s: hop.flight_time_s,
            apex_z_m: hop.apex_z_m,
            takeoff_angle_min_deg: hop.takeoff_angles.min.degrees(),
            takeoff_angle_max_deg: hop.takeoff_angles.max.degrees(),
            speed_margin_m_s: hop.speed_margin_m_s,
            binding: LimitPair { lower: hop.lower_limit, upper: hop.upper_limit },
            map: hop.map_ends().map(|ends @ (takeoff, landing)| MapRecord {
                heading_deg: hop.heading_deg,
                takeoff_map_x_m: takeoff.x,
                takeoff_map_y_m: takeoff.y,
                landing_map_x_m: landing.x,
                landing_map_y_m: landing.y,
                lon_lat: projection.and_then(|projection| LonLatRecord::new(ends, projection)),
                heading_true_deg: projection.map(|projection| heading_true_deg(projection, takeoff, hop.heading_deg)),
            }),
            margins: HopMarginsRecord(hop.margins),
            margins_sigma: None,
            success_estimated: None,
            stores: hop.into(),
            aim: hop.aim.as_ref().map(AimRecord::from),
            roll_out: hop.roll_out.as_ref().map(RollOutRecord::from),
        }
    }
}

impl From<&Totals> for TotalsRecord {
    fn from(totals: &Totals) -> Self {
        Self {
            flight_time_s: unsigned_zero(totals.flight_time_s),
            energy_j_kg: unsigned_zero(totals.energy_j_kg),
            peak_takeoff_speed_m_s: totals.peak_takeoff_speed_m_s,
            ground_distance_m: unsigned_zero(totals.ground_distance_m),
            energy_j: totals.energy_j.map(unsigned_zero),
            bounce_time_s: totals.bounce_time_s.map(unsigned_zero),
            mission_time_s: totals.mission_time_s.map(unsigned_zero),
            energy_basis: totals.of_store.then_some(EnergyBasis::Store),
            delta_v_m_s: unsigned_zero(totals.delta_v_m_s),
            propellant_kg: totals.propellant.map(|propellant| unsigned_zero(propellant.used_kg)),
            mass_end_kg: totals.propellant.map(|propellant| propellant.mass_end_kg),
            propellant_short_kg: totals.propellant_short_kg(),
            estimate: None,
            propulsive: totals.propulsive,
        }
    }
}

/// A number without negative zero, which a sum over no hops or a reversed level line of sight gives in floating point.
pub(super) fn unsigned_zero(number: f64) -> f64 {
    if number == 0.0 { 0.0 } else { number }
}

/// The columns of path.csv that every chain has.
const COLUMNS: [&str; 16] = [
    "hop",
    "direction",
    "takeoff_x_m",
    "takeoff_z_m",
    "landing_x_m",
    "landing_z_m",
    "takeoff_angle_deg",
    "takeoff_speed_m_s",
    "landing_angle_deg",
    "landing_speed_m_s",
    "flight_time_s",
    "apex_z_m",
    "takeoff_angle_min_deg",
    "takeoff_angle_max_deg",
    "speed_margin_m_s",
    "binding",
];

/// The additional columns of a chain on a map.
const MAP_COLUMNS: [&str; 5] = ["heading_deg", "takeoff_map_x_m", "takeoff_map_y_m", "landing_map_x_m", "landing_map_y_m"];

/// The additional columns of a map whose projection is known.
const PROJECTION_COLUMNS: [&str; 5] =
    ["takeoff_lon_deg", "takeoff_lat_deg", "landing_lon_deg", "landing_lat_deg", "heading_true_deg"];

/// How a chain is located on a map, which determines the columns of its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapKnowledge {
    /// No map.
    Nothing,
    /// A map in metres.
    Metres,
    /// And its projection.
    Projection,
}

/// Writes a path as CSV, with a header even without hops.
///
/// # Errors
/// An error of the writer.
pub fn write_path_csv(rows: &[HopRecord], known: MapKnowledge, out: impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let extra = ExtraColumns::of(rows.iter());
    writer.write_record(columns(known, extra))?;
    for row in rows {
        writer.write_record(row.fields(known, extra))?;
    }
    writer.flush()
}

/// Writes paths to several goals as one CSV, with a first column `goal` (from 1) before the columns of a path.
///
/// # Errors
/// An error of the writer.
pub fn write_paths_csv<'a>(
    paths: impl IntoIterator<Item = &'a [HopRecord]>,
    known: MapKnowledge,
    out: impl Write,
) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let paths: Vec<&[HopRecord]> = paths.into_iter().collect();
    let extra = ExtraColumns::of(paths.iter().copied().flatten());
    writer.write_record(std::iter::once("goal".to_owned()).chain(columns(known, extra)))?;
    for (index, rows) in paths.into_iter().enumerate() {
        let goal = (index + 1).to_string();
        for row in rows {
            writer.write_record(std::iter::once(goal.clone()).chain(row.fields(known, extra)))?;
        }
    }
    writer.flush()
}

/// The additional columns of commands in steps.
const AIM_COLUMNS: [&str; 2] = ["aim_x_m", "landing_miss_m"];

/// The additional columns of hops beside the line.
const BESIDE_COLUMNS: [&str; 3] = ["landing_miss_across_m", "aim_map_x_m", "aim_map_y_m"];

/// The additional columns of a hopper that bounces.
const BOUNCE_COLUMNS: [&str; 3] = ["bounces", "bounce_distance_m", "bounce_time_s"];

/// The columns that only some paths have.
#[derive(Clone, Copy)]
struct ExtraColumns {
    /// Of propellant, if some hop states it.
    stores: &'static [&'static str],
    /// Of commands in steps, if some hop has one.
    aims: bool,
    /// Of hops beside the line, if some hop is one.
    beside: bool,
    /// Of bounces, if the hopper bounces.
    bounces: bool,
}

impl ExtraColumns {
    fn of<'a>(mut rows: impl Iterator<Item = &'a HopRecord> + Clone) -> Self {
        let stores = stores_columns(rows.clone());
        let aims = rows.clone().any(|row| row.aim.is_some());
        let bounces = rows.clone().any(|row| row.roll_out.is_some());
        Self { stores, aims, bounces, beside: rows.any(|row| row.aim.is_some_and(|aim| aim.beside.is_some())) }
    }
}

/// The columns of a path.
fn columns(known: MapKnowledge, extra: ExtraColumns) -> Vec<String> {
    let map: &[&str] = if known >= MapKnowledge::Metres { &MAP_COLUMNS } else { &[] };
    let projection: &[&str] = if known >= MapKnowledge::Projection { &PROJECTION_COLUMNS } else { &[] };
    let aims: &[&str] = if extra.aims { &AIM_COLUMNS } else { &[] };
    let beside: &[&str] = if extra.beside { &BESIDE_COLUMNS } else { &[] };
    let bounces: &[&str] = if extra.bounces { &BOUNCE_COLUMNS } else { &[] };
    let own = COLUMNS.iter().chain(extra.stores).chain(map).chain(projection).chain(aims).chain(beside).chain(bounces);
    own.map(|&column| column.to_owned()).chain(HopMarginsRecord::columns()).collect()
}

impl HopRecord {
    /// The fields of a row of path.csv.
    fn fields(&self, known: MapKnowledge, extra: ExtraColumns) -> Vec<String> {
        let numbers = [
            self.takeoff_x_m,
            self.takeoff_z_m,
            self.landing_x_m,
            self.landing_z_m,
            self.takeoff_angle_deg,
            self.takeoff_speed_m_s,
            self.landing_angle_deg,
            self.landing_speed_m_s,
            self.flight_time_s,
            self.apex_z_m,
            self.takeoff_angle_min_deg,
            self.takeoff_angle_max_deg,
            self.speed_margin_m_s,
        ];
        let mut fields = vec![self.hop.to_string(), self.direction.to_string()];
        fields.extend(numbers.iter().map(ToString::to_string));
        fields.push(self.binding.to_string());
        fields.extend(self.stores.fields().into_iter().take(extra.stores.len()));
        if known >= MapKnowledge::Metres {
            let numbers = self
                .map
                .map(|map| [map.heading_deg, map.takeoff_map_x_m, map.takeoff_map_y_m, map.landing_map_x_m, map.landing_map_y_m]);
            fields.extend(texts(numbers));
        }
        if known >= MapKnowledge::Projection {
            let numbers = self
                .map
                .and_then(|map| map.lon_lat)
                .map(|place| [place.takeoff_lon_deg, place.takeoff_lat_deg, place.landing_lon_deg, place.landing_lat_deg]);
            fields.extend(texts(numbers));
            let heading = self.map.and_then(|map| map.heading_true_deg.flatten());
            fields.extend(texts(heading.map(|heading| [heading])));
        }
        if extra.aims {
            fields.extend(texts(self.aim.map(|aim| [aim.aim_x_m, aim.landing_miss_m])));
        }
        if extra.beside {
            let beside = self.aim.and_then(|aim| aim.beside);
            fields.extend(texts(beside.map(|aim| [aim.landing_miss_across_m, aim.aim_map_x_m, aim.aim_map_y_m])));
        }
        if extra.bounces {
            let bounces =
                self.roll_out.map(|bounces| [f64::from(bounces.bounces), bounces.bounce_distance_m, bounces.bounce_time_s]);
            fields.extend(texts(bounces));
        }
        fields.extend(self.margins.fields());
        fields
    }
}

/// Numbers as fields; an absent number is an empty field.
fn texts<const N: usize>(numbers: Option<[f64; N]>) -> [String; N] {
    numbers.map_or_else(|| std::array::from_fn(|_| String::new()), |numbers| numbers.map(|number| number.to_string()))
}
