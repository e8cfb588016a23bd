//! One hop as commanded, and the path of all hops: plain data.

use crate::{
    ballistics::{Arc, LineOfSight},
    chain::Station,
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint, VertexId},
    world::{Direction, Limit},
};

/// One hop, with everything an operator needs to command and check it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hop {
    /// Direction of travel along the chain.
    pub direction: Direction,
    /// Where it takes off.
    pub takeoff: Station,
    /// Where it lands.
    pub landing: Station,
    /// Where both ends lie on the map, for a chain that lies on one.
    pub map: Option<MapEnds>,
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
    /// Height of the highest point of the flight, m, in the chain's own heights.
    pub apex_z_m: f64,
    /// All feasible take-off angles between these two stations.
    pub takeoff_angles: AngleInterval,
    /// The smaller of the two margins that take-off and landing speed leave to their limits, m/s.
    pub speed_margin_m_s: f64,
    /// Which limit sets the least feasible take-off angle.
    pub lower_limit: Limit,
    /// The vertex that decides, where that limit is the terrain.
    pub lower_vertex: Option<VertexId>,
    /// Which limit sets the greatest feasible take-off angle.
    pub upper_limit: Limit,
}

impl Hop {
    /// Horizontal speed, constant over the flight, m/s: `v cos(theta) = v / sqrt(1 + m^2)`.
    pub fn horizontal_speed_m_s(&self) -> f64 {
        self.takeoff_speed_m_s / libm::hypot(1.0, self.takeoff_angle.slope())
    }

    /// Points of the flight at equal horizontal distances, take-off and landing included: `(fraction of the run, point)`.
    ///
    /// At least two points.
    pub fn flight_points(&self, gravity_m_s2: f64, count: u32) -> Vec<(f64, ChainPoint)> {
        let (from, to) = (self.takeoff.point, self.landing.point);
        let sight = LineOfSight::new((to.x_m - from.x_m).abs(), to.z_m - from.z_m);
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

/// A hop on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapEnds {
    /// Where it takes off.
    pub takeoff: MapPoint,
    /// Where it lands.
    pub landing: MapPoint,
    /// Direction of flight, clockwise from grid north, 0 to 360 degrees.
    pub heading_deg: f64,
}

/// A path of hops from start to goal.
#[derive(Clone, Debug, PartialEq)]
pub struct HopPath {
    /// The hops in the order of travel; none where start and goal are the same place.
    pub hops: Vec<Hop>,
    /// What they add up to.
    pub totals: Totals,
}

/// What the hops of a path add up to.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Totals {
    /// Time in flight, s.
    pub flight_time_s: f64,
    /// Energy per unit mass given at take-off, the sum of `v_t^2 / 2`, J/kg.
    pub energy_j_kg: f64,
    /// The greatest take-off speed, m/s.
    pub peak_takeoff_speed_m_s: f64,
    /// The sum of the hops' horizontal distances, m.
    pub ground_distance_m: f64,
    /// Energy, J, where the mass is known.
    pub energy_j: Option<f64>,
    /// Flight and rest between hops, s, where the rest time is known.
    pub mission_time_s: Option<f64>,
}
