//! What no path to a place takes less of.

use super::{Amount, Amounts};
use crate::{
    ballistics::{LineOfSight, PathBounds},
    ground::{DemGround, Surface},
    world::HopperLimits,
};

/// Lower bounds on the amounts of every path of hops over a straight line, from its length and its climb alone: those of
/// [`PathBounds`], with what preparations, settling and overheads add for every hop.
///
/// They are consistent bounds for a search towards a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastAmounts {
    /// `None` where nothing hops.
    bounds: Option<PathBounds>,
    gravity_m_s2: f64,
    limits: HopperLimits,
}

/// Rounding errors are far smaller than this share.
const SHAVED: f64 = 1.0 - 1e-9;

impl LeastAmounts {
    /// Bounds for a hopper.
    ///
    /// # Arguments
    /// `speeds_m_s`: the greatest speeds with which an arc begins and ends anywhere; infinite where nothing limits them.
    /// `relief_m`: the highest ground less the lowest, which limits the second speed too.
    pub fn new(limits: &HopperLimits, gravity_m_s2: f64, speeds_m_s: (f64, f64), relief_m: f64) -> Self {
        let (takeoff_m_s, landing_m_s) = speeds_m_s;
        let fallen_m_s = (takeoff_m_s * takeoff_m_s + 2.0 * gravity_m_s2 * relief_m).sqrt();
        // Sums of many hops round: speeds count with ten times the tolerance of their limits.
        let [takeoff_m_s, landing_m_s] = [takeoff_m_s, landing_m_s.min(fallen_m_s)].map(|speed| speed * (1.0 + 1e-8));
        let hops = takeoff_m_s > 0.0 && landing_m_s > 0.0;
        Self { bounds: hops.then(|| PathBounds::new(takeoff_m_s, landing_m_s, gravity_m_s2)), gravity_m_s2, limits: *limits }
    }

    /// Those of the hops over a DEM.
    pub(crate) fn over_dem(ground: &DemGround) -> Self {
        let limits = ground.hopper().limits();
        let (low_m, high_m) = ground.terrain().dem().elevation_range_m();
        let landing_m_s = if limits.landing.brakes() { f64::INFINITY } else { limits.landing_speed_max_m_s };
        Self::new(limits, ground.gravity_m_s2(), (limits.takeoff_speed_max_m_s, landing_m_s), high_m - low_m)
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
        self.over_in(run_m, climb_m, 0)
    }

    /// The same for a way that is known to take so many hops at least.
    #[expect(clippy::cast_precision_loss, reason = "a bound on hops may be less")]
    pub fn over_in(&self, run_m: f64, climb_m: f64, hops_min: u64) -> Amounts {
        let straight_m = libm::hypot(run_m, climb_m);
        let Some(bounds) = self.bounds.as_ref().filter(|_| straight_m > 0.0) else { return Amounts::NONE };
        let limits = &self.limits;
        let hops = bounds.hops(run_m, climb_m).unwrap_or(0).max(hops_min) as f64;
        let speeds_m_s = bounds.takeoff_speeds_m_s(run_m, climb_m);
        let flight_s = bounds.flight_time_s(run_m, climb_m);
        let kinetic_j_kg = bounds.energy_j_kg(run_m, climb_m);
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

    /// The bounds for one hop over a line of sight, whose least take-off speed is exact.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::LineOfSight, planner::{Amount, LeastAmounts}, world::HopperLimits};
    /// // 8.1 m over flat ground at 10 m/s^2 take 9 m/s, however fast the machine may be.
    /// let least = LeastAmounts::new(&HopperLimits::with_speeds(20.0, 20.0), 10.0, (20.0, 20.0), 0.0).of_hop(LineOfSight::new(8.1, 0.0));
    /// assert!((least.of(Amount::TakeoffSpeed) - 9.0).abs() < 1e-7 && least.of(Amount::Hops) == 1.0);
    /// ```
    pub fn of_hop(&self, sight: LineOfSight) -> Amounts {
        let limits = &self.limits;
        let speed_m_s = (self.gravity_m_s2 * sight.run_m() * sight.min_speed_ratio()).sqrt() * SHAVED;
        self.over_in(sight.run_m(), sight.rise_m(), 1)
            .with(Amount::TakeoffSpeed, speed_m_s)
            .with(Amount::PeakSpeed, speed_m_s)
            .with(Amount::DeltaV, speed_m_s + limits.hop_delta_v_overhead_m_s.unwrap_or(0.0) * SHAVED)
            .with(Amount::Energy, limits.store_energy_j_kg(0.5 * speed_m_s * speed_m_s, 1) * SHAVED)
    }

    /// The bounds for one hop of this horizontal length, whatever it climbs.
    ///
    /// # Examples
    /// ```
    /// use chta::{planner::{Amount, LeastAmounts}, world::HopperLimits};
    /// let limits = HopperLimits { preparation_time_s: Some(3.0), ..HopperLimits::with_speeds(10.0, 10.0) };
    /// let least = LeastAmounts::new(&limits, 10.0, (10.0, 10.0), 0.0).of_any_hop(5.0);
    /// // As fast as both speeds allow: 2 * 5 / 20 s.
    /// assert!((least.of(Amount::MissionTime) - 3.5).abs() < 1e-6 && least.of(Amount::Energy) == 0.0);
    /// ```
    pub fn of_any_hop(&self, run_m: f64) -> Amounts {
        // The chord is no shorter than this, in either speed's bound on the time.
        let flight_s = self.bounds.as_ref().map_or(0.0, |bounds| bounds.flight_time_s(run_m, 0.0));
        Amounts::NONE
            .with(Amount::Hops, 1.0)
            .with(Amount::FlightTime, flight_s)
            .with(Amount::MissionTime, flight_s + self.limits.preparation_time_s.unwrap_or(0.0) * SHAVED)
            .with(Amount::Distance, run_m * SHAVED)
            .with(Amount::ArcLength, run_m * SHAVED)
    }
}
