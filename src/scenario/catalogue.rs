//! Every key that a scenario may have, with its kind, unit and meaning: the one list behind the reader, the help and the hints.

use super::{
    Route,
    kind::{Kind, MOST, SPEED_LEAST, SPEED_MOST},
};
use crate::{
    ballistics::{TakeoffChoice, stance::ConeKind},
    graph::{Effort, ReliabilityUse},
    ground::StandsUp,
    hop::Split,
    planner::{Travel, VisitOrder, roadmap::RoadmapPlanner},
    uncertainty::{Distribution, Policy},
    world::{ClearanceRule, LandingMode, RESTITUTION_MAX},
};

/// One key of a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// The table it belongs to.
    pub table: &'static str,
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// The kind of value that it takes.
    pub kind: Kind,
    /// What it means, in one line.
    pub help: &'static str,
}

impl Key {
    /// Whether its value is the path of a file.
    pub fn names_a_file(&self) -> bool {
        matches!(
            (self.table, self.name),
            ("robot", "file")
                | ("terrain", "dem" | "mesh" | "chain")
                | ("surface", "friction_raster" | "keep_out" | "keep_in")
                | ("uncertainty", "errors")
        )
    }

    /// `table.name`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.table, self.name)
    }

    /// The known key of this table and name.
    pub fn find(table: &str, name: &str) -> Option<&'static Self> {
        CATALOGUE.iter().find(|key| key.table == table && (key.name == name || (key.kind == Kind::Layer && !name.is_empty())))
    }
}

const fn key(table: &'static str, name: &'static str, kind: Kind, help: &'static str) -> Key {
    Key { table, name, kind, help }
}

const SPEED: Kind = Kind::Number { min: SPEED_LEAST, max: SPEED_MOST };
const LENGTH: Kind = Kind::Number { min: 1e-9, max: 1e9 };
const RESTITUTION: Kind = Kind::Number { min: 0.0, max: RESTITUTION_MAX };
const FROM_ZERO: Kind = Kind::Number { min: 0.0, max: 1e9 };
const STEP_ANGLE: Kind = Kind::Number { min: 1e-6, max: 90.0 };
const COORDINATE: Kind = Kind::Number { min: -1e12, max: 1e12 };
/// No working machine has a standard deviation beyond these bounds.
const SHARE: Kind = Kind::Number { min: 0.0, max: 100.0 };
const PROPORTION: Kind = Kind::Number { min: 0.0, max: 1.0 };
const DERATED: Kind = Kind::Number { min: 0.01, max: 1.0 };
const SIGMA_ANGLE: Kind = Kind::Number { min: 0.0, max: 180.0 };
const ELEVATION_ANGLE: Kind = Kind::Number { min: -90.0, max: 90.0 };

/// All pairs of so many contacts take minutes, and their windows tens of gigabytes.
const CONTACTS_MOST: u64 = 200_000;

const EFFORTS: [&str; 4] = [Effort::ALL[0].name(), Effort::ALL[1].name(), Effort::ALL[2].name(), Effort::ALL[3].name()];
const CHOICES: [&str; 4] =
    [TakeoffChoice::ALL[0].name(), TakeoffChoice::ALL[1].name(), TakeoffChoice::ALL[2].name(), TakeoffChoice::ALL[3].name()];
const RELIABILITY_USES: [&str; 3] = [ReliabilityUse::ALL[0].name(), ReliabilityUse::ALL[1].name(), ReliabilityUse::ALL[2].name()];
const POLICIES: [&str; 2] = [Policy::ALL[0].name(), Policy::ALL[1].name()];
const DISTRIBUTIONS: [&str; 2] = [Distribution::ALL[0].name(), Distribution::ALL[1].name()];
const HEADINGS: [&str; 2] = super::drift::HEADINGS;
const CONES: [&str; 6] = [
    ConeKind::ALL[0].name(),
    ConeKind::ALL[1].name(),
    ConeKind::ALL[2].name(),
    ConeKind::ALL[3].name(),
    ConeKind::ALL[4].name(),
    ConeKind::ALL[5].name(),
];
const UPS: [&str; 2] = [StandsUp::ALL[0].name(), StandsUp::ALL[1].name()];
const PLANNERS: [&str; 2] = [RoadmapPlanner::ALL[0].name(), RoadmapPlanner::ALL[1].name()];
const TRAVELS: [&str; 3] = [Travel::ALL[0].name(), Travel::ALL[1].name(), Travel::ALL[2].name()];
/// Orders of visits.
const ORDERS: [&str; VisitOrder::ALL.len()] = [VisitOrder::ALL[0].name(), VisitOrder::ALL[1].name()];
const ROUTES: [&str; 2] = [Route::ALL[0].name(), Route::ALL[1].name()];

const SPLITS: [&str; 2] = [Split::ALL[0].name(), Split::ALL[1].name()];

/// All keys, in the order in which a scenario is written.
pub const CATALOGUE: [Key; 131] = [
    key("body", "name", Kind::Text, "a known body, which gives gravity and radius"),
    key("body", "gravity_m_s2", Kind::Number { min: 1e-9, max: 1e3 }, "gravity, m/s^2; beside a name it replaces the body's"),
    key("body", "radius_m", LENGTH, "mean radius, m, for the escape speed, below which all speeds stay, and warnings of the model"),
    key("hopper", "takeoff_speed_max_m_s", SPEED, "greatest take-off speed, m/s"),
    key("hopper", "landing_speed_max_m_s", SPEED, "greatest landing speed, m/s"),
    key("hopper", "clearance_m", FROM_ZERO, "height to keep over the ground flown over, m; absent: 0"),
    key(
        "hopper",
        "clearance_rule",
        Kind::Word(&ClearanceRule::NAMES),
        "tapered: kept over all ground, less near take-off and landing; vertex: in full over every vertex (the paper's); absent: tapered",
    ),
    key(
        "hopper",
        "clearance_taper",
        Kind::Number { min: 1e-6, max: 1e6 },
        "clearance gained per metre from take-off and from landing, under the tapered rule; absent: 0.5",
    ),
    key("hopper", "takeoff_angle_min_deg", ELEVATION_ANGLE, "mechanical least take-off angle from the horizontal, degrees"),
    key("hopper", "takeoff_angle_max_deg", ELEVATION_ANGLE, "mechanical greatest take-off angle from the horizontal, degrees"),
    key("hopper", "apex_height_max_m", FROM_ZERO, "greatest height of the flight above its take-off, m"),
    key("hopper", "flight_time_max_s", LENGTH, "longest flight, s"),
    key("hopper", "takeoff_speed_min_m_s", SPEED, "least take-off speed that the machine can be commanded, m/s"),
    key(
        "hopper",
        "takeoff_speed_levels_m_s",
        Kind::Speeds,
        "the only take-off speeds that the machine can be commanded, m/s, ascending",
    ),
    key("hopper", "takeoff_angle_step_deg", STEP_ANGLE, "take-off angles are multiples of this, degrees; absent: any angle"),
    key("hopper", "takeoff_speed_step_m_s", SPEED, "take-off speeds are multiples of this, m/s; absent: any speed"),
    key("hopper", "heading_step_deg", STEP_ANGLE, "headings from grid north are multiples of this, degrees; absent: any heading"),
    key(
        "hopper",
        "radius_m",
        FROM_ZERO,
        "radius of the ball that the hopper is in flight, m, for hops over a mesh alone; absent or 0: a point",
    ),
    key(
        "hopper",
        "footprint_m",
        FROM_ZERO,
        "diameter of the ground stood on, m: the plane fitted over it is held against the rest slope; absent or 0: none",
    ),
    key(
        "hopper",
        "roughness_max_m",
        FROM_ZERO,
        "greatest distance of the ground under the footprint from the fitted plane, m; absent: not limited",
    ),
    key("hopper", "mass_kg", LENGTH, "mass at the start, kg, for the totals of energy and propellant"),
    key("hopper", "rest_time_s", FROM_ZERO, "older name of settling_time_s, s; not beside it or preparation_time_s"),
    key(
        "hopper",
        "landing",
        Kind::Word(&LandingMode::NAMES),
        "ballistic: the arc meets the ground; braked: it brakes to touch down straight down at touchdown_speed_m_s; absent: ballistic",
    ),
    key(
        "hopper",
        "touchdown_speed_m_s",
        Kind::Number { min: 0.0, max: 1e5 },
        "speed of a braked touchdown, m/s, at most landing_speed_max_m_s; needs landing = \"braked\"",
    ),
    key(
        "hopper",
        "hop_delta_v_overhead_m_s",
        Kind::Number { min: 0.0, max: 1e5 },
        "delta-v of every hop beyond its changes of velocity (gravity and steering losses), m/s; absent: 0",
    ),
    key("hopper", "isp_s", Kind::Number { min: 1e-3, max: 1e6 }, "specific impulse, s, for the propellant; needs mass_kg"),
    key(
        "hopper",
        "propellant_max_kg",
        LENGTH,
        "propellant at the start, kg, below mass_kg; a path that needs more is no; needs isp_s",
    ),
    key("hopper", "preparation_time_s", FROM_ZERO, "time to prepare each hop, s, for the mission time; absent: 0"),
    key("hopper", "settling_time_s", FROM_ZERO, "time to settle between hops, s, for the mission time; absent: 0"),
    key("hopper", "preparation_energy_j", FROM_ZERO, "energy to prepare each hop, J, for the totals of energy; needs mass_kg"),
    key(
        "hopper",
        "efficiency",
        Kind::Number { min: 1e-9, max: 1.0 },
        "share of the energy store that becomes motion, for the totals of energy; absent: 1",
    ),
    key("robot", "file", Kind::Text, "robot with legs, path from this file (docs/legs.md); [hopper] gives what it leaves open"),
    key(
        "robot",
        "cone",
        Kind::Word(&CONES),
        "of a robot with legs: the cone of the directions in which its feet push: exact, their sum; kc, the one of Campana and others inside it; kc-plus, \
         the widest about the same axis; pyramid-4, -8, -16, sums of pyramids of so many edges; absent: exact",
    ),
    key(
        "robot",
        "up",
        Kind::Word(&UPS),
        "of a robot with legs: up for its trunk where it stands: normal, along that of the ground; vertical; absent: normal",
    ),
    key(
        "robot",
        "headings",
        Kind::Count { min: 1, max: 360 },
        "of a map of a robot with legs: headings of its trunk at every node, evenly all around; absent: 8",
    ),
    key("surface", "friction_coefficient", Kind::Number { min: 0.0, max: 1e6 }, "cone about the surface normal"),
    key("surface", "takeoff_from_slope_deg", Kind::AngleRange, "take-off angles above the slope, degrees, instead of friction"),
    key("surface", "landing_from_slope_deg", Kind::AngleRange, "landing angles above the slope, degrees, instead of friction"),
    key(
        "surface",
        "rest_slope_max_deg",
        Kind::AngleOrUnlimited,
        "steepest surface to rest on, degrees; absent: atan(friction); inf: none",
    ),
    key(
        "surface",
        "friction_raster",
        Kind::Text,
        "raster of friction coefficients on the dem's map, path from this file; overrides friction_coefficient where it has data",
    ),
    key(
        "surface",
        "keep_out",
        Kind::Text,
        "GeoJSON polygons or mask raster on the dem's map, path from this file: no take-off, no landing",
    ),
    key(
        "surface",
        "keep_in",
        Kind::Text,
        "GeoJSON polygons or mask raster on the dem's map, path from this file: take-off and landing nowhere else",
    ),
    key(
        "surface",
        "group",
        Kind::FaceGroups,
        "friction, rest slope and keep-out of groups, objects or materials of an OBJ, [surface.group.NAME]; for hops over a mesh alone",
    ),
    key(
        "layer",
        "NAME",
        Kind::Layer,
        "raster on the dem's map whose condition restricts contacts or flights, [layer.NAME], any number of them; no data does not hold",
    ),
    key(
        "contact",
        "restitution_normal",
        RESTITUTION,
        "share of the speed along the ground's normal that a contact returns, for bounces after a landing in trials and estimates; 0: none",
    ),
    key(
        "contact",
        "restitution_tangential",
        RESTITUTION,
        "share of the speed along the ground that a contact leaves; beside restitution_normal",
    ),
    key(
        "contact",
        "settle_speed_m_s",
        SPEED,
        "a hopper that would bounce off more slowly than this is at rest, m/s; absent: sqrt(g x 1 cm), whose bounces are below 1 cm",
    ),
    key("terrain", "dem", Kind::Text, "elevation raster, path from this file"),
    key("terrain", "mesh", Kind::Text, "triangulated surface, z up, path from this file"),
    key("terrain", "mesh_scale", LENGTH, "metres per unit of the mesh; absent: 1"),
    key("terrain", "chain", Kind::Text, "chain CSV, path from this file"),
    key(
        "terrain",
        "no_data",
        Kind::NumberOrNone,
        "stored number that marks missing elevations, or \"none\"; absent: what the file states, and no usual mark as ground",
    ),
    key(
        "terrain",
        "start_m",
        Kind::MapOrSpacePoint,
        "start on the map, [x, y], m; of a free route over a mesh [x, y, z], moved to the nearest point of its surface",
    ),
    key(
        "terrain",
        "goal_m",
        Kind::MapOrSpacePoint,
        "goal on the map, [x, y], m; of a free route over a mesh [x, y, z], moved to the nearest point of its surface",
    ),
    key("terrain", "start_lonlat_deg", Kind::LonLat, "instead: start as [longitude, planetocentric latitude], degrees"),
    key("terrain", "goal_lonlat_deg", Kind::LonLat, "instead: goal as [longitude, planetocentric latitude], degrees"),
    key("terrain", "accept_map_scale", Kind::Flag, "accept a map whose scale is off by over 1 %, with its distances unchanged"),
    key(
        "terrain",
        "via_lonlat_deg",
        Kind::LonLats,
        "instead: intermediate points as [[longitude, planetocentric latitude], ...], degrees",
    ),
    key("terrain", "via_m", Kind::MapPoints, "intermediate points, [[x, y], ...], m, where the slice bends; no hop spans a bend"),
    key(
        "terrain",
        "route",
        Kind::Word(&ROUTES),
        "transect: the plane from start to goal; free: any way over the DEM or the mesh; absent: transect",
    ),
    key("terrain", "start_x_m", COORDINATE, "start along the chain, m"),
    key("terrain", "goal_x_m", COORDINATE, "goal along the chain, m"),
    key(
        "search",
        "points_per_segment",
        Kind::CountOrAuto,
        "points inside each segment, or \"auto\": the first of 0, 1, 2, 3, 7, 15, 31 with a path",
    ),
    key("search", "node_spacing_max_m", LENGTH, "instead: greatest spacing of neighbouring points along the ground, m"),
    key(
        "search",
        "planner",
        Kind::Word(&PLANNERS),
        "of a free route over a mesh: exact, all pairs of contacts by exact windows; prm, that of Campana and Laumond, by sampled angles; absent: \
         exact",
    ),
    key(
        "search",
        "contacts_max",
        Kind::Count { min: 2, max: CONTACTS_MOST },
        "of a free route over a mesh: most contacts of its roadmap, start and goal included; absent: 4000",
    ),
    key(
        "search",
        "stand_off_m",
        Kind::Number { min: 0.0, max: 1e3 },
        "of a free route over a mesh: how far contacts stand off the surface, along its normal, m; absent: 0, with planner = \"prm\" 0.021",
    ),
    key(
        "search",
        "bounds_m",
        Kind::SpaceBounds,
        "of a free route over a mesh: the box of all contacts, [[x, y, z], [x, y, z]], m; absent: the whole mesh",
    ),
    key("search", "seed", Kind::Count { min: 0, max: MOST }, "of a free route over a mesh: seed of its contacts; absent: 0"),
    key(
        "search",
        "time_max_s",
        LENGTH,
        "of a free route over a mesh: longest time for its roadmap to grow, judged before every round but the first, s; absent: any, so that \
         the answer does not depend on the machine",
    ),
    key("search", "effort", Kind::Word(&EFFORTS), "second criterion after hops; absent: takeoff-speed"),
    key(
        "search",
        "takeoff_angle",
        Kind::Word(&CHOICES),
        "which feasible take-off angle to fly; most-reliable: where most draws of [uncertainty] survive; absent: that where errors are given, else least-speed",
    ),
    key("search", "split", Kind::Word(&SPLITS), "how to divide many hops on a segment; absent: full-reach"),
    key(
        "search",
        "risk",
        Kind::Word(&RELIABILITY_USES),
        "how to weigh the probability to fail, or without [uncertainty] the slack: ignored; fewest-hops: the most reliable path of fewest hops; \
         traded: the fewest hops at 0.98 of the best success; absent: traded where errors are given, else ignored",
    ),
    key(
        "search",
        "risk_extra_hops_max",
        Kind::Count { min: 1, max: 1000 },
        "hops beyond the fewest that a more reliable path may take; absent: 10, or half the fewest if that is more",
    ),
    key(
        "search",
        "objective",
        Kind::Amounts,
        "instead of effort: what is to be least, and what breaks ties, over the distinct commands of every hop; absent: hops, then effort",
    ),
    key("drive", "travel", Kind::Word(&TRAVELS), "what the machine does of hopping and driving; absent: both"),
    key("drive", "speed_m_s", SPEED, "speed over level ground, m/s"),
    key("drive", "slope_up_max_deg", Kind::AngleOrUnlimited, "steepest climb along the way, degrees; inf: any"),
    key(
        "drive",
        "slope_down_max_deg",
        Kind::AngleOrUnlimited,
        "steepest descent along the way, degrees; inf: any; absent: as slope_up_max_deg",
    ),
    key(
        "drive",
        "cross_slope_max_deg",
        Kind::AngleOrUnlimited,
        "steepest slope across the way, degrees; inf: any; absent: as slope_up_max_deg",
    ),
    key(
        "drive",
        "step_max_m",
        FROM_ZERO,
        "greatest difference of height between two places a wheelbase apart along the way, m; needs wheelbase_m; absent: any",
    ),
    key(
        "drive",
        "roughness_max_m",
        FROM_ZERO,
        "greatest deviation from the plane fitted over a disc of the wheelbase at every node, m; needs wheelbase_m; absent: any",
    ),
    key("drive", "wheelbase_m", LENGTH, "distance between the axles, m"),
    key(
        "drive",
        "neighbours",
        Kind::Count { min: 8, max: 32 },
        "to how many nodes about a node it drives in straight lines, of a robot with legs to how many of its nearest stances it walks: 8, 16 or 32; absent: 16",
    ),
    key("drive", "turn_s_per_deg", FROM_ZERO, "time to turn on the spot between straight lines, s for each degree; absent: 0"),
    key(
        "drive",
        "slip",
        Kind::SlipCurve,
        "share of the speed lost by slip over the slope along the way, straight between the pairs; absent: none",
    ),
    key("drive", "rolling_resistance", FROM_ZERO, "force to roll over level ground, as a share of the weight; absent: 0"),
    key(
        "drive",
        "drive_efficiency",
        Kind::Number { min: 1e-6, max: 1.0 },
        "share of the energy from the store that moves it; absent: 1",
    ),
    key("drive", "idle_power_w", FROM_ZERO, "power from the store while it drives and turns, W; needs hopper.mass_kg; absent: 0"),
    key("drive", "failure_per_m", FROM_ZERO, "rate of failures that end the mission, for each metre driven; absent: 0"),
    key(
        "drive",
        "heading_sigma_deg",
        SIGMA_ANGLE,
        "standard deviation of the heading of a drive leg in trials, degrees; absent: 0",
    ),
    key(
        "drive",
        "length_sigma_fraction",
        SHARE,
        "standard deviation of the length of a drive leg in trials, as a fraction of it; absent: 0",
    ),
    key("budget", "hops_max", Kind::Count { min: 1, max: 1_000_000 }, "greatest number of hops of a path"),
    key(
        "budget",
        "mission_time_max_s",
        LENGTH,
        "greatest time from the first preparation to the last landing, s: flights, preparation, settling",
    ),
    key("budget", "flight_time_total_max_s", LENGTH, "greatest sum of flight times, s"),
    key("budget", "energy_max_j_kg", LENGTH, "greatest energy of a path per unit mass, from the store, J/kg"),
    key("budget", "energy_max_j", LENGTH, "instead: greatest energy of a path, J; needs hopper.mass_kg"),
    key("budget", "delta_v_max_m_s", LENGTH, "greatest delta-v of a path, m/s"),
    key(
        "budget",
        "estimated_success_min",
        PROPORTION,
        "least success, 0 to 1, that the fixed trials of a path estimate: the fewest hops that have it, in place of 0.98 of the best; without \
         any the answer is no; needs [uncertainty]",
    ),
    key(
        "derating",
        "takeoff_speed",
        DERATED,
        "share of the greatest take-off speed that planning may use; trials fly all of it; absent: 1",
    ),
    key("derating", "landing_speed", DERATED, "share of the greatest landing speed that planning may use; absent: 1"),
    key(
        "derating",
        "friction",
        DERATED,
        "share of the friction coefficients that planning may use, also for a rest slope that follows from them; absent: 1",
    ),
    key("uncertainty", "takeoff_speed_sigma_m_s", FROM_ZERO, "standard deviation of the take-off speed, m/s"),
    key(
        "uncertainty",
        "takeoff_speed_sigma_fraction",
        SHARE,
        "standard deviation of the take-off speed, as a fraction of the commanded one",
    ),
    key("uncertainty", "takeoff_angle_sigma_deg", SIGMA_ANGLE, "standard deviation of the take-off angle, degrees"),
    key("uncertainty", "heading_sigma_deg", SIGMA_ANGLE, "standard deviation of the heading, degrees; on a dem only"),
    key("uncertainty", "position_sigma_m", FROM_ZERO, "standard deviation of the position estimate, m; affects replan only"),
    key(
        "uncertainty",
        "drift_along_sigma_m",
        FROM_ZERO,
        "standard deviation of bounce and roll after a landing, along the flight, m",
    ),
    key("uncertainty", "drift_across_sigma_m", FROM_ZERO, "the same to the side, m"),
    key("uncertainty", "friction_sigma", SHARE, "standard deviation of the friction coefficient, one draw per trial"),
    key("uncertainty", "height_sigma_m", FROM_ZERO, "standard deviation of the terrain's height, m, one random field per trial"),
    key("uncertainty", "height_correlation_m", FROM_ZERO, "correlation length of the height error, m"),
    key(
        "uncertainty",
        "takeoff_speed_bias_sigma_fraction",
        SHARE,
        "standard deviation of an error of the take-off speed that lasts, as a fraction of the commanded one, one draw per trial",
    ),
    key(
        "uncertainty",
        "takeoff_angle_bias_sigma_deg",
        SIGMA_ANGLE,
        "standard deviation of an error of the take-off angle that lasts, degrees, one draw per trial",
    ),
    key(
        "uncertainty",
        "heading_bias_sigma_deg",
        SIGMA_ANGLE,
        "standard deviation of an error of the heading that lasts, degrees, one draw per trial; on a dem only",
    ),
    key(
        "uncertainty",
        "distribution",
        Kind::Word(&DISTRIBUTIONS),
        "of the errors of command, heading, position and drift, and of biases: normal, or uniform with the same deviation; friction and \
         height are normal; absent: normal",
    ),
    key(
        "uncertainty",
        "errors",
        Kind::Text,
        "path of a CSV of measured errors, one hop a row, resampled in place of the deviations of the same errors",
    ),
    key("uncertainty", "goal_tolerance_m", FROM_ZERO, "horizontal distance from the goal that counts as reached, m; absent: 0"),
    key(
        "uncertainty",
        "hop_limit",
        Kind::Count { min: 1, max: 1_000_000 },
        "hops of a trial at most; absent: twice the planned ones and ten more; where the heading is uncontrolled, the hops of every trial",
    ),
    key(
        "uncertainty",
        "policy",
        Kind::Word(&POLICIES),
        "open-loop: planned commands, wherever the robot is; replan: replanned after every landing; absent: replan",
    ),
    key(
        "uncertainty",
        "heading",
        Kind::Word(&HEADINGS),
        "uncontrolled: trials hop in any direction, each as likely as any other, without a plan or goal, on a dem; absent: controlled",
    ),
    key("uncertainty", "takeoff_speed_m_s", SPEED, "commanded take-off speed of every hop where the heading is uncontrolled, m/s"),
    key(
        "uncertainty",
        "takeoff_angle_deg",
        Kind::Number { min: 0.0, max: 90.0 },
        "commanded take-off angle over the horizontal of every hop where the heading is uncontrolled, degrees",
    ),
    key("uncertainty", "trials", Kind::Count { min: 1, max: MOST }, "how many trials; absent: 10000"),
    key("uncertainty", "seed", Kind::Count { min: 0, max: MOST }, "seed of all draws; absent: 0"),
    key("mission", "targets_m", Kind::MapPoints, "targets to visit, [[x, y], ...], m, at most 12; on a dem with route = \"free\""),
    key("mission", "targets_lonlat_deg", Kind::LonLats, "instead: targets as [[longitude, planetocentric latitude], ...], degrees"),
    key("mission", "order", Kind::Word(&ORDERS), "best: the best order by the objective; given: as listed; absent: best"),
    key("mission", "return_to_start", Kind::Flag, "the mission ends where it began; absent: at the last target"),
    key("report", "title", Kind::Text, "title of the picture; absent: the scenario's file name"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_written_in_the_usual_notation() {
        assert_eq!(ELEVATION_ANGLE.expected(), "a number from -90 to 90");
        assert_eq!(FROM_ZERO.expected(), "a number from 0 to 1e9");
        assert_eq!(SPEED.expected(), "a number from 1e-9 to 1e5");
    }

    #[test]
    fn every_number_ends_in_its_unit() {
        let units = ["_m", "_m_s", "_m_s2", "_s", "_kg", "_j", "_deg"];
        let pure = [
            "friction_coefficient",
            "clearance_taper",
            "efficiency",
            "restitution_normal",
            "restitution_tangential",
            "points_per_segment",
            "mesh_scale",
            "no_data",
            "risk_extra_hops_max",
            "estimated_success_min",
            "headings",
            "hops_max",
            "objective",
            "neighbours",
            "turn_s_per_deg",
            "slip",
            "rolling_resistance",
            "drive_efficiency",
            "idle_power_w",
            "failure_per_m",
            "length_sigma_fraction",
            "takeoff_speed",
            "landing_speed",
            "friction",
            "takeoff_speed_sigma_fraction",
            "takeoff_speed_bias_sigma_fraction",
            "friction_sigma",
            "contacts_max",
            "hop_limit",
            "trials",
            "seed",
        ];
        for key in &CATALOGUE {
            let number = !matches!(key.kind, Kind::Word(_) | Kind::Text | Kind::Flag | Kind::FaceGroups | Kind::Layer);
            assert!(
                !number || pure.contains(&key.name) || units.iter().any(|unit| key.name.ends_with(unit)),
                "{} has no unit",
                key.path()
            );
        }
    }
}
