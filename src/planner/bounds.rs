//! What no path to a place takes less of.

use super::{Amount, Amounts};
use crate::world::HopperLimits;

/// Lower bounds on the amounts of every path of hops over a straight line, from its length and its climb alone.
///
/// ```text
///     with X the horizontal distance, Z the climb, C = hypot(X, Z), and the greatest speeds v_t, v_l at the ends of an arc:
///     hops >= max( g (C + Z) / v_t^2, g (C - Z) / v_l^2 )        sum of take-off speeds >= g (C + Z) / v_t
///     energy of motion >= g (C + Z) / 2                           flight time >= 2 C / (v_t + v_l)
/// ```
///
/// Each is exact for one hop, and no greater than the sum over two parts of the way: C obeys the triangle inequality, and Z adds up. So
/// they are consistent bounds for a search towards a goal. A billionth is shaved for rounding and for the tolerance of speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastAmounts {
    gravity_m_s2: f64,
    takeoff_max_m_s: f64,
    landing_max_m_s: f64,
    limits: HopperLimits,
}

impl LeastAmounts {
    /// Bounds for a hopper.
    ///
    /// # Arguments
    /// `speeds_m_s`: the greatest speeds with which an arc begins and ends anywhere; infinite where nothing limits them.
    /// `relief_m`: the highest ground less the lowest, which limits the second speed too.
    pub fn new(limits: &HopperLimits, gravity_m_s2: f64, speeds_m_s: (f64, f64), relief_m: f64) -> Self {
        let (takeoff_m_s, landing_m_s) = speeds_m_s;
        let fallen_m_s = (takeoff_m_s * takeoff_m_s + 2.0 * gravity_m_s2 * relief_m).sqrt();
        // Limits of speeds hold to a billionth.
        let [takeoff_max_m_s, landing_max_m_s] = [takeoff_m_s, landing_m_s.min(fallen_m_s)].map(|speed| speed * (1.0 + 1e-8));
        Self { gravity_m_s2, takeoff_max_m_s, landing_max_m_s, limits: *limits }
    }

    /// The bounds for a way that is so long horizontally and climbs so far, m.
    ///
    /// # Examples
    /// ```
    /// use chta::{planner::{Amount, LeastAmounts}, world::HopperLimits};
    /// // 10 m/s reach 10 m over flat ground at 10 m/s^2: 25 m are three hops of 50 J/kg for every 10 m.
    /// let least = LeastAmounts::new(&HopperLimits::with_speeds(10.0, 10.0), 10.0, (10.0, 10.0), 0.0).over(25.0, 0.0);
    /// assert_eq!(least.of(Amount::Hops), 3.0);
    /// assert!((least.of(Amount::Energy) - 125.0).abs() < 1e-5);
    /// ```
    pub fn over(&self, run_m: f64, climb_m: f64) -> Amounts {
        const SHAVED: f64 = 1.0 - 1e-9;
        let Self { gravity_m_s2: g, takeoff_max_m_s: takeoff, landing_max_m_s: landing, limits } = *self;
        let straight_m = libm::hypot(run_m, climb_m);
        if straight_m == 0.0 {
            return Amounts::NONE;
        }
        // The difference of two nearly equal lengths is computed without it.
        let up_m = if climb_m >= 0.0 { straight_m + climb_m } else { run_m * (run_m / (straight_m - climb_m)) };
        let down_m = if climb_m <= 0.0 { straight_m - climb_m } else { run_m * (run_m / (straight_m + climb_m)) };
        let ratio = |above: f64, below: f64| if below.is_finite() && below > 0.0 { above / below } else { 0.0 };
        let hops = (ratio(g * up_m, takeoff * takeoff).max(ratio(g * down_m, landing * landing)) * SHAVED).ceil();
        let speeds_m_s = ratio(g * up_m, takeoff) * SHAVED;
        let flight_s = ratio(2.0 * straight_m, takeoff + landing) * SHAVED;
        let kinetic_j_kg = 0.5 * g * up_m * SHAVED;
        let prepared_j_kg = limits.preparation_energy_j.zip(limits.mass_kg).map_or(0.0, |(energy_j, mass_kg)| energy_j / mass_kg);
        let waits_s = limits.preparation_time_s.unwrap_or(0.0) * hops + limits.settling_s().unwrap_or(0.0) * (hops - 1.0).max(0.0);
        Amounts::NONE
            .with(Amount::Hops, hops)
            .with(Amount::TakeoffSpeed, speeds_m_s)
            .with(Amount::DeltaV, speeds_m_s + hops * limits.hop_delta_v_overhead_m_s.unwrap_or(0.0) * SHAVED)
            .with(Amount::Energy, limits.store_energy_j_kg(kinetic_j_kg, 0) + hops * prepared_j_kg * SHAVED)
            .with(Amount::FlightTime, flight_s)
            .with(Amount::MissionTime, flight_s + waits_s * SHAVED)
            .with(Amount::Distance, run_m * SHAVED)
            .with(Amount::ArcLength, straight_m * SHAVED)
    }
}
