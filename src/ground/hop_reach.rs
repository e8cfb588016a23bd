//! How far one hop over a DEM reaches.

use nalgebra::Vector2;

use super::{DemGround, MapPosition, Surface};
use crate::{
    ballistics::{LineOfSight, safety_range_m},
    world::{SPEED_TOLERANCE, tolerant_speed_m_s},
};

/// How far one hop reaches: the parabolas of safety of the greatest speeds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HopReach {
    /// The greatest take-off speed, squared, m^2/s^2.
    takeoff_squared: f64,
    /// The greatest landing speed of an arc, squared, m^2/s^2; infinite with brakes.
    landing_squared: f64,
    gravity_m_s2: f64,
    /// The lowest elevation of the DEM, m.
    lowest_m: f64,
    /// The highest one, m.
    highest_m: f64,
}

impl HopReach {
    /// The reach of a ground's hopper.
    pub(crate) fn of(ground: &DemGround) -> Self {
        let limits = ground.hopper().limits();
        let squared = |speed_m_s: f64| tolerant_speed_m_s(speed_m_s) * tolerant_speed_m_s(speed_m_s) * (1.0 + SPEED_TOLERANCE);
        let (lowest_m, highest_m) = ground.terrain().dem().elevation_range_m();
        Self {
            takeoff_squared: squared(limits.takeoff_speed_max_m_s),
            landing_squared: squared(limits.arc_landing_speed_max_m_s()),
            gravity_m_s2: ground.gravity_m_s2(),
            lowest_m,
            highest_m,
        }
    }

    /// Gravity, m/s^2.
    pub(crate) const fn gravity_m_s2(&self) -> f64 {
        self.gravity_m_s2
    }

    /// The length of the longest hop over level ground, m.
    pub(crate) fn level_m(&self) -> f64 {
        self.takeoff_squared.min(self.landing_squared) / self.gravity_m_s2
    }

    /// A length over the map that no hop from a position exceeds, m.
    ///
    /// With C the length of the line of sight and Z its rise, `g (C + Z) <= v_t^2` and `g (C - Z) <= v_l^2` (see
    /// [`LineOfSight::min_speed_ratio`]), so that `2 g C <= v_t^2 + v_l^2`; and no hop goes farther than one down to the lowest ground.
    pub(crate) fn run_m(&self, from: &MapPosition) -> f64 {
        self.run_over_m(from.z_m - self.lowest_m)
    }

    /// The same for hops from anywhere.
    pub(crate) fn longest_m(&self) -> f64 {
        self.run_over_m(self.highest_m - self.lowest_m)
    }

    /// The same for hops to a position.
    pub(crate) fn run_into_m(&self, to: &MapPosition) -> f64 {
        self.run_over_m(self.highest_m - to.z_m)
    }

    /// The same for hops that fall by at most this height, m.
    fn run_over_m(&self, fall_m: f64) -> f64 {
        let down_m = safety_range_m(fall_m.max(0.0), self.takeoff_squared.sqrt(), self.gravity_m_s2);
        down_m.min((self.takeoff_squared + self.landing_squared) / (2.0 * self.gravity_m_s2))
    }

    /// The line of sight from one position to another, and its heading; `None` if no hop can span it, or if the two are one.
    #[inline]
    pub(crate) fn sight(
        &self,
        ground: &DemGround,
        from: &MapPosition,
        target: &MapPosition,
    ) -> Option<(LineOfSight, Vector2<f64>)> {
        let away = target.at - from.at;
        let run_m = away.norm();
        if run_m <= ground.position_rounding_m() {
            return None;
        }
        let sight = LineOfSight::new(run_m, target.z_m - from.z_m);
        let g_x = self.gravity_m_s2 * run_m;
        let too_far =
            g_x * sight.min_speed_ratio() > self.takeoff_squared || g_x * sight.min_speed_ratio_reversed() > self.landing_squared;
        (!too_far).then(|| (sight, away / run_m))
    }
}
