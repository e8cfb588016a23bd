//! One hop as commanded, and the path of all hops: plain data.

use crate::{
    ballistics::{Arc, LineOfSight},
    graph::Effort,
    ground::ContactPoint,
    hop::HopMargins,
    planner::LayerTotals,
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint, VertexId},
    world::{Direction, Limit},
};

/// One hop, with everything an operator needs to command and check it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hop {
    /// Direction of travel along the chain; forward if there is no chain.
    pub direction: Direction,
    /// Where it takes off.
    pub takeoff: ContactPoint,
    /// Where it lands.
    pub landing: ContactPoint,
    /// Direction of flight on the map, clockwise from grid north, 0 to 360 degrees. For a chain without a map, 90 forward and 270
    /// in reverse.
    pub heading_deg: f64,
    /// Take-off angle above the horizontal, in the direction of travel.
    pub takeoff_angle: Angle,
    /// Take-off speed, m/s.
    pub takeoff_speed_m_s: f64,
    /// Landing angle, negative on the way down.
    pub landing_angle: Angle,
    /// Landing speed, m/s.
    pub landing_speed_m_s: f64,
    /// Flight time, s.
    pub flight_time_s: f64,
    /// Height of the highest point of the flight, m, in the height reference of the ground.
    pub apex_z_m: f64,
    /// Delta-v, m/s: of the take-off, of the brakes if the hopper has some, and its overhead.
    pub delta_v_m_s: f64,
    /// The propellant of the hop, if the specific impulse is known; [`HopPath::of_hops`] states it.
    pub propellant: Option<Propellant>,
    /// The window of feasible take-off angles that contains the one flown: all of them, unless the machine cannot be commanded every
    /// take-off speed.
    pub takeoff_angles: AngleInterval,
    /// The smaller of the margins of take-off and landing speed to their limits, m/s; with brakes that of the take-off.
    pub speed_margin_m_s: f64,
    /// The limit that sets the least feasible take-off angle.
    pub lower_limit: Limit,
    /// The vertex of the profile that sets it, if that limit is the terrain.
    pub lower_vertex: Option<VertexId>,
    /// The limit that sets the greatest feasible take-off angle.
    pub upper_limit: Limit,
    /// By how much it keeps each limit.
    pub margins: HopMargins,
    /// What the command was aimed at, for a machine that takes its commands in steps.
    pub aim: Option<Aim>,
    /// How it bounces on from its landing; `None` for a hopper that stays where it lands.
    pub roll_out: Option<RollOut>,
}

/// The bounces after the planned landing of a hop that is flown without errors, over the chain that it was planned on, in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollOut {
    /// How many bounces.
    pub bounces: u32,
    /// How far beyond the landing it comes to rest, in the direction of travel, m; negative before it.
    pub distance_m: f64,
    /// Time from the landing to rest, s.
    pub time_s: f64,
    /// Whether it comes to rest on ground that holds it.
    pub rests: bool,
}

/// The point that a hop with a command in steps is aimed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The planned landing.
    pub point: ContactPoint,
    /// By how much the landing lies beyond it along the profile, m; negative short of it.
    pub miss_m: f64,
    /// By how much the landing lies to the left of it, as seen along the planned hop, m; `None` for a hop that stays on its chain.
    pub across_m: Option<f64>,
}

impl Aim {
    /// Horizontal distance from the aim to the landing, m.
    pub fn distance_m(&self) -> f64 {
        self.across_m.map_or(self.miss_m.abs(), |across_m| libm::hypot(self.miss_m, across_m))
    }
}

impl Hop {
    /// Take-off and landing on the map; `None` for a chain without a map.
    pub fn map_ends(&self) -> Option<(MapPoint, MapPoint)> {
        self.takeoff.map().zip(self.landing.map())
    }

    /// Whether it flies beside the line of its path, on which its distances along the journey are projections.
    pub fn is_beside_line(&self) -> bool {
        self.aim.is_some_and(|aim| aim.across_m.is_some())
    }

    /// Horizontal distance from take-off to landing, m.
    pub fn run_m(&self) -> f64 {
        if self.is_beside_line() {
            return (self.landing.point_m - self.takeoff.point_m).xy().norm();
        }
        (self.landing.along_m - self.takeoff.along_m).abs()
    }

    /// Its line of sight.
    pub fn line_of_sight(&self) -> LineOfSight {
        LineOfSight::new(self.run_m(), self.landing.point_m.z - self.takeoff.point_m.z)
    }

    /// Horizontal speed, constant over the flight, m/s: `v cos(theta) = v / sqrt(1 + m^2)`.
    pub fn horizontal_speed_m_s(&self) -> f64 {
        self.takeoff_speed_m_s / libm::hypot(1.0, self.takeoff_angle.slope())
    }

    /// At least two points of the flight at equal horizontal distances, including take-off and landing: `(fraction of the run,
    /// point)`.
    pub fn flight_points(&self, gravity_m_s2: f64, count: u32) -> Vec<(f64, ChainPoint)> {
        let (from, to) = (self.takeoff.in_profile(), self.landing.in_profile());
        let sight = self.line_of_sight();
        let arc = Arc::new(sight, self.takeoff_angle.slope() - sight.slope(), gravity_m_s2);
        let last = count.max(2) - 1;
        (0..=last)
            .map(|i| {
                let fraction = f64::from(i) / f64::from(last);
                let height_m = arc.height_at_m(sight.run_m() * fraction);
                (fraction, ChainPoint::new(from.x_m + (to.x_m - from.x_m) * fraction, from.z_m + height_m))
            })
            .collect()
    }
}

/// The direction from one horizontal point to another, clockwise from the second axis (on a map: grid north), 0 to 360 degrees.
///
/// # Examples
/// ```
/// use chta::{path::heading_deg, quantity::MapPoint};
/// assert_eq!(heading_deg(MapPoint::new(0.0, 0.0), MapPoint::new(-3.0, 0.0)), 270.0);
/// ```
pub fn heading_deg(from: MapPoint, to: MapPoint) -> f64 {
    let along = to - from;
    let degrees = libm::atan2(along.x, along.y).to_degrees();
    if degrees < 0.0 { degrees + 360.0 } else { degrees }
}

/// A path of hops from start to goal.
#[derive(Clone, Debug, PartialEq)]
pub struct HopPath {
    /// The hops in the order of travel; empty if start and goal are the same position.
    pub hops: Vec<Hop>,
    /// The totals of the hops.
    pub totals: Totals,
}

impl HopPath {
    /// The effort of its hops, in the unit of the kind of effort.
    pub fn effort(&self, effort: Effort) -> f64 {
        let speeds = self.hops.iter().map(|hop| hop.takeoff_speed_m_s);
        match effort {
            Effort::TakeoffSpeed => speeds.sum(),
            Effort::Energy => speeds.map(|speed_m_s| 0.5 * speed_m_s * speed_m_s).sum(),
            Effort::Time => self.hops.iter().map(|hop| hop.flight_time_s).sum(),
            Effort::PeakSpeed => speeds.fold(0.0, f64::max),
        }
    }
}

/// The totals of the hops of a path.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Totals {
    /// Time in flight, s.
    pub flight_time_s: f64,
    /// Energy from the store per unit mass: the sum of `v_t^2 / 2` over the efficiency, and of the preparations, J/kg.
    pub energy_j_kg: f64,
    /// The greatest take-off speed, m/s.
    pub peak_takeoff_speed_m_s: f64,
    /// The sum of the hops' horizontal distances, m.
    pub ground_distance_m: f64,
    /// Energy, J, if the mass is known.
    pub energy_j: Option<f64>,
    /// Time of bounces, s, for a hopper that bounces.
    pub bounce_time_s: Option<f64>,
    /// Time of flights, of bounces, of preparations before hops and of settling between hops, s, if one of the last three is known.
    pub mission_time_s: Option<f64>,
    /// Delta-v, m/s.
    pub delta_v_m_s: f64,
    /// Propellant and the mass at the end, if the specific impulse is known.
    pub propellant: Option<Propellant>,
    /// The propellant that the machine has, kg, if it is given.
    pub propellant_max_kg: Option<f64>,
    /// Whether the machine has brakes, an overhead or a specific impulse.
    pub propulsive: bool,
    /// Whether the energies are more than those of motion.
    pub of_store: bool,
    /// What the layers of the map cost that have a cost.
    pub layers: LayerTotals,
}

impl Totals {
    /// Propellant beyond what the machine has, kg; `None` if it suffices or no amount is given.
    pub fn propellant_short_kg(&self) -> Option<f64> {
        /// Propellant beyond the greatest by less than this share is within it: the tolerance of speeds.
        const ROUNDING: f64 = 1e-9;
        let max_kg = self.propellant_max_kg?;
        Some(self.propellant?.used_kg - max_kg).filter(|short_kg| *short_kg > ROUNDING * max_kg)
    }
}

/// Propellant used, and the mass left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Propellant {
    /// Propellant used, kg.
    pub used_kg: f64,
    /// Mass after it, kg.
    pub mass_end_kg: f64,
}
