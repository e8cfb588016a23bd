//! The legs of missions as rows.

use super::walk::Driven;
use crate::{
    drive::{DriveLeg, Extreme},
    ground::MapPosition,
    path::{Hop, HopPath, heading_deg},
    quantity::{Angle, total},
    report::{DriveLegRecord, DriveMarginsRecord, HopLegRecord, HopRecord, TravelTotalsRecord},
    world::{HopperLimits, Rover},
};

/// A hop among the legs, which settles after its landing unless it ends the mission.
pub(in crate::study) fn hop_leg(
    (limits, ends_mission): (&HopperLimits, bool),
    (row, hop): (HopRecord, &Hop),
    leg: usize,
) -> HopLegRecord {
    let settling_s = if ends_mission { 0.0 } else { limits.settling_s().unwrap_or(0.0) };
    HopLegRecord {
        leg,
        takeoff_m: hop.takeoff.point_m.coords.into(),
        landing_m: hop.landing.point_m.coords.into(),
        time_s: limits.preparation_time_s.unwrap_or(0.0) + hop.flight_time_s + settling_s,
        energy_j_kg: limits.store_energy_j_kg(0.5 * hop.takeoff_speed_m_s * hop.takeoff_speed_m_s, 1),
        hop: row,
    }
}

/// Straight lines driven one after another.
pub(in crate::study) fn drive_leg(rover: &Rover, driven: &Driven, leg: usize) -> DriveLegRecord {
    let Driven { places, legs, turn_time_s } = driven;
    let sum = |of: fn(&DriveLeg) -> f64| total(legs.iter().map(of));
    let (first, last) = (places[0], places[places.len() - 1]);
    // The steepest of all lines, up or down, with its place.
    let of_line = |(number, line): (usize, &DriveLeg)| {
        let (up, down) = (line.steepest_up, line.steepest_down);
        let (slope, Extreme { at_m, .. }) = if up.value >= down.value { (up.value, up) } else { (-down.value, down) };
        let along = places[number + 1].at - places[number].at;
        (slope, places[number].at + along * (at_m / line.run_m.max(f64::MIN_POSITIVE)))
    };
    let steepest = legs.iter().enumerate().map(of_line).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let (slope, at) = steepest.unwrap_or((0.0, first.at));
    DriveLegRecord {
        leg,
        takeoff_m: point(&first),
        landing_m: point(&last),
        heading_deg: heading_deg(first.at, last.at),
        waypoints_m: places.iter().map(point).collect(),
        length_m: sum(|leg| leg.length_m),
        distance_m: sum(|leg| leg.run_m),
        climb_m: sum(|leg| leg.climb_m),
        descent_m: sum(|leg| leg.descent_m),
        time_s: sum(|leg| leg.time_s) + turn_time_s,
        turn_time_s: *turn_time_s,
        energy_j_kg: sum(|leg| leg.energy_j_kg) + rover.idle_j_kg_s() * turn_time_s,
        steepest_deg: Angle::from_slope(slope).degrees(),
        steepest_at_m: at.into(),
        margins: DriveMarginsRecord::of(legs, rover),
    }
}

/// The sums over driven stretches, of so many without a hop between them, and hops; mission time, energy and distance are added up already.
pub(in crate::study) fn sums_record(
    (limits, rover): (&HopperLimits, &Rover),
    (driven, stretches): (&[&Driven], u64),
    flown: &HopPath,
    [mission_time_s, energy_j_kg, distance_m]: [f64; 3],
) -> TravelTotalsRecord {
    let sum = |of: fn(&DriveLeg) -> f64| total(driven.iter().flat_map(|driven| &driven.legs).map(of));
    let drive_length_m = sum(|leg| leg.length_m);
    let rate = rover.limits().failure_per_m;
    TravelTotalsRecord {
        hops: flown.hops.len() as u64,
        drive_legs: stretches,
        mission_time_s,
        drive_time_s: sum(|leg| leg.time_s) + total(driven.iter().map(|driven| driven.turn_time_s)),
        flight_time_s: flown.totals.flight_time_s,
        energy_j_kg,
        energy_j: limits.mass_kg.map(|mass_kg| mass_kg * energy_j_kg),
        delta_v_m_s: flown.totals.delta_v_m_s,
        propellant_kg: flown.totals.propellant.map(|propellant| propellant.used_kg),
        peak_takeoff_speed_m_s: flown.totals.peak_takeoff_speed_m_s,
        distance_m,
        drive_length_m,
        climb_m: sum(|leg| leg.climb_m),
        descent_m: sum(|leg| leg.descent_m),
        drive_success: (rate > 0.0).then(|| libm::exp(-rate * drive_length_m)),
    }
}

/// A place, [x, y, z], m.
pub(in crate::study) fn point(place: &MapPosition) -> [f64; 3] {
    [place.at.x, place.at.y, place.z_m]
}
