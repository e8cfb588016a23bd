//! What no mission takes less of on the way to its goal, whether it drives, hops or does both.

use super::super::{Amount, Amounts, LeastAmounts};
use crate::{
    ground::{DemGround, HopReach, MapPosition, Surface},
    world::Rover,
};

/// Rounding errors are far smaller than this share.
const SHAVED: f64 = 1.0 - 1e-9;

/// Lower bounds on the amounts of the rest of a mission, from the line to its goal.
///
/// Hops alone have those of routes. With driving, amounts are bounded for each metre `L` of the map and each metre `Z` of climb:
///
/// ```text
///     drive leg   time >= L / v0                              energy >= (g c_rr / eta + P / (m v0)) L + (g / eta) Z
///     hop         time >= preparation + 2 L / (v_t + v_l) + settling >= (2 / (v_t + v_l) + (preparation + settling) / L_max) L
///                 energy >= (g C + g Z) / (2 eta_h) + E_p / m >= (q cos a) L + q (1 + sin a) Z + (E_p / (m L_max)) L
/// ```
///
/// with the longest hop `L_max`, the chord `C >= L cos a + Z sin a` for any `a`, and `q = g / (2 eta_h)`. The lesser bound for each metre holds for
/// both. The energy of a drive leg is no less than a share of its bound with climbs, and the rest of idle power; the share is chosen so that a metre
/// of climb counts alike for both. Settling after the last hop may be spared.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeastLeft {
    by: By,
}

#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "one value for a search")]
enum By {
    Hops(LeastAmounts),
    Lines(Lines),
}

/// Bounds for each metre.
#[derive(Clone, Copy, Debug)]
struct Lines {
    time_s_m: f64,
    spared_s: f64,
    energy_j_kg_m: f64,
    /// For each metre of climb.
    climb_j_kg_m: f64,
}

impl LeastLeft {
    /// For a machine that drives by this rover, hops by these bounds, or does both.
    pub(super) fn of(ground: &DemGround, rover: Option<&Rover>, hops: Option<&LeastAmounts>) -> Self {
        let by = match (rover, hops) {
            (None, Some(hops)) => By::Hops(*hops),
            (rover, hops) => By::Lines(Lines::of(ground, rover, hops)),
        };
        Self { by }
    }

    /// The bounds on the way from one position to another.
    pub(super) fn between(&self, from: &MapPosition, to: &MapPosition) -> Amounts {
        let run_m = libm::hypot(to.at.x - from.at.x, to.at.y - from.at.y);
        let climb_m = to.z_m - from.z_m;
        match &self.by {
            By::Hops(least) => least.over(run_m, climb_m),
            By::Lines(lines) => lines.over(run_m, climb_m),
        }
    }
}

impl Lines {
    fn of(ground: &DemGround, rover: Option<&Rover>, hops: Option<&LeastAmounts>) -> Self {
        let gravity = ground.gravity_m_s2();
        let limits = ground.hopper().limits();
        let settling_s = limits.settling_s().unwrap_or(0.0);
        let longest_m = HopReach::of(ground).longest_m();
        // Of what each hop takes, the part of a metre: none, where a hop may be of any length.
        let of_metre = |of_hop: f64| if longest_m.is_finite() && longest_m > 0.0 { of_hop / longest_m } else { 0.0 };
        let hop = hops.map(|least| {
            let flight_s_m = least.of_any_hop(1.0).of(Amount::FlightTime);
            let [prepared_s, prepared_j_kg] = [limits.preparation_time_s.unwrap_or(0.0), limits.store_energy_j_kg(0.0, 1)];
            (flight_s_m + of_metre(prepared_s + settling_s), limits.store_energy_j_kg(0.5 * gravity, 0), of_metre(prepared_j_kg))
        });
        let drive = rover.map(|rover| {
            let limits = rover.limits();
            let idle_j_kg_m = rover.idle_j_kg_s() / limits.speed_m_s;
            (1.0 / limits.speed_m_s, gravity / limits.efficiency, limits.rolling_resistance, idle_j_kg_m)
        });
        let time_s_m = hop.map_or(f64::INFINITY, |hop| hop.0).min(drive.map_or(f64::INFINITY, |drive| drive.0));
        // A metre of climb counts as much as the lesser of both takes for it; with sin a = 0 a hop takes q for it.
        let climb_j_kg_m = hop.map_or(f64::INFINITY, |hop| hop.1).min(drive.map_or(f64::INFINITY, |drive| drive.1));
        let of_hops = hop.map_or(f64::INFINITY, |(_, q, prepared)| {
            let sine = if q > 0.0 { climb_j_kg_m / q - 1.0 } else { 0.0 };
            q * (1.0 - sine * sine).max(0.0).sqrt() + prepared
        });
        let of_drives = drive.map_or(f64::INFINITY, |(_, climb, resistance, idle)| {
            let share = if climb > 0.0 { climb_j_kg_m / climb } else { 0.0 };
            share * climb * resistance + idle
        });
        let finite = |bound: f64| if bound.is_finite() { bound } else { 0.0 };
        Self {
            time_s_m: finite(time_s_m),
            spared_s: if hop.is_some() { settling_s } else { 0.0 },
            energy_j_kg_m: finite(of_hops.min(of_drives)),
            climb_j_kg_m: finite(climb_j_kg_m),
        }
    }

    fn over(&self, run_m: f64, climb_m: f64) -> Amounts {
        // Differences of sums that round: what is lost of both sides counts.
        let level_j_kg = self.energy_j_kg_m * run_m;
        let climb_j_kg = self.climb_j_kg_m * climb_m;
        let energy_j_kg = level_j_kg + climb_j_kg - (level_j_kg + climb_j_kg.abs()) * (1.0 - SHAVED);
        let time_s = self.time_s_m * run_m * SHAVED - self.spared_s;
        Amounts::NONE
            .with(Amount::Distance, run_m * SHAVED)
            .with(Amount::MissionTime, time_s.max(0.0))
            .with(Amount::Energy, energy_j_kg.max(0.0))
    }
}
