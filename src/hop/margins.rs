//! By how much one hop keeps each of its limits, each in its own unit.

use super::{HopTest, terrain::least_height};
use crate::{
    ballistics::{Arc, ContactLimits},
    chain::Station,
    quantity::{Angle, SlopeInterval},
    world::{Contact, Direction, HopperLimits, Limit},
};

/// One hop, as the margins see it. What the ground does not limit is infinite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flown<'a> {
    pub(crate) arc: &'a Arc,
    pub(crate) takeoff: ContactLimits,
    pub(crate) landing: ContactLimits,
    pub(crate) hopper: &'a HopperLimits,
    pub(crate) mechanism: SlopeInterval,
    /// The least height over the ground, or under it, with its clearance, m, and where that is, m from the take-off.
    pub(crate) terrain: Option<(f64, f64)>,
    /// By how much the ground at take-off and landing is less steep than the rest slope, degrees.
    pub(crate) rest_deg: [f64; 2],
    /// By how much the ground under the footprint at take-off and landing is more even than it has to be, m.
    pub(crate) roughness_m: [f64; 2],
}

/// One margin: its name, its limit and its equation. A further limit of the hopper is one more row of [`MARGINS`].
#[derive(Clone, Copy, Debug)]
pub struct MarginRow {
    /// The name in results, which ends in the unit.
    pub key: &'static str,
    /// The limit.
    pub limit: Limit,
    /// Infinite where the hopper or the ground has no such limit.
    of: fn(&Flown<'_>) -> f64,
}

/// All margins, in the order in which results list them.
pub const MARGINS: [MarginRow; 16] = [
    row("takeoff_speed_m_s", Limit::TakeoffSpeed, |f| f.takeoff.speed_max_m_s - f.arc.takeoff_speed_m_s()),
    row("landing_speed_m_s", Limit::LandingSpeed, |f| f.landing.speed_max_m_s - f.arc.landing_speed_m_s()),
    row("takeoff_cone_min_deg", Limit::TakeoffCone, |f| above_deg(f.arc.takeoff_angle(), f.takeoff.slopes)),
    row("takeoff_cone_max_deg", Limit::TakeoffCone, |f| below_deg(f.arc.takeoff_angle(), f.takeoff.slopes)),
    row("landing_cone_min_deg", Limit::LandingCone, |f| {
        if f.hopper.landing.brakes() { f64::INFINITY } else { above_deg(f.arc.landing_angle(), f.landing.slopes) }
    }),
    row("landing_cone_max_deg", Limit::LandingCone, |f| {
        if f.hopper.landing.brakes() { f64::INFINITY } else { below_deg(f.arc.landing_angle(), f.landing.slopes) }
    }),
    row("line_of_sight_deg", Limit::LineOfSight, |f| f.arc.takeoff_angle().degrees() - f.arc.line_of_sight().angle().degrees()),
    row("terrain_m", Limit::Terrain, |f| f.terrain.map_or(f64::INFINITY, |(height_m, _)| height_m)),
    row("mechanical_angle_min_deg", Limit::MechanicalAngle, |f| {
        f.hopper.takeoff_angle_min.map_or(f64::INFINITY, |_| above_deg(f.arc.takeoff_angle(), f.mechanism))
    }),
    row("mechanical_angle_max_deg", Limit::MechanicalAngle, |f| {
        f.hopper.takeoff_angle_max.map_or(f64::INFINITY, |_| below_deg(f.arc.takeoff_angle(), f.mechanism))
    }),
    row("apex_height_m", Limit::ApexHeight, |f| f.hopper.apex_height_max_m.map_or(f64::INFINITY, |m| m - f.arc.apex_height_m())),
    row("flight_time_s", Limit::FlightTime, |f| f.hopper.flight_time_max_s.map_or(f64::INFINITY, |s| s - f.arc.flight_time_s())),
    row("takeoff_rest_slope_deg", Limit::RestSlope, |f| f.rest_deg[0]),
    row("landing_rest_slope_deg", Limit::RestSlope, |f| f.rest_deg[1]),
    row("takeoff_roughness_m", Limit::Roughness, |f| f.roughness_m[0]),
    row("landing_roughness_m", Limit::Roughness, |f| f.roughness_m[1]),
];

const fn row(key: &'static str, limit: Limit, of: fn(&Flown<'_>) -> f64) -> MarginRow {
    MarginRow { key, limit, of }
}

/// How far a direction is above the lower end of a cone, degrees.
fn above_deg(angle: Angle, cone: SlopeInterval) -> f64 {
    angle.degrees() - Angle::from_slope(cone.lower).degrees()
}

/// How far a direction is below the upper end of a cone, degrees.
fn below_deg(angle: Angle, cone: SlopeInterval) -> f64 {
    Angle::from_slope(cone.upper).degrees() - angle.degrees()
}

/// The margins of one hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopMargins {
    /// By [`MARGINS`]; infinite without such a limit.
    values: [f64; MARGINS.len()],
    /// Where the margin of the terrain is least, m from the take-off; infinite if the terrain sets no limit.
    terrain_from_takeoff_m: f64,
}

impl HopMargins {
    /// No limits.
    pub const UNLIMITED: Self = Self { values: [f64::INFINITY; MARGINS.len()], terrain_from_takeoff_m: f64::INFINITY };

    /// The margins of an arc between two stations, from the closed forms of its limits; `None` if both have the same x, or the ground
    /// refuses one of the contacts for every hop.
    ///
    /// A margin of a hop that keeps its limits is not negative, but for the crate's tolerance of a speed limit and the rounding of an
    /// angle.
    pub fn of(test: &HopTest, takeoff: &Station, landing: &Station, arc: &Arc) -> Option<Self> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let rule = |station, contact| test.chain().check_contact(station, contact, direction).ok();
        let stands = |station, contact| {
            let fit = test.chain().footprint_fit(station);
            let rest = test.chain().rest_slope(station, contact, direction, fit);
            let rough = test.hopper().limits().roughness_max_m.zip(fit);
            (
                rest.map_or(f64::INFINITY, |(tilt, max)| max.degrees() - tilt.degrees()),
                rough.map_or(f64::INFINITY, |(max_m, fit)| max_m - fit.residual_m),
            )
        };
        let [from, to] = [stands(takeoff, Contact::Takeoff), stands(landing, Contact::Landing)];
        let terrain = least_height(test.chain().geometry(), takeoff, landing, arc, test.clearance());
        Some(Self::of_flown(&Flown {
            arc,
            takeoff: rule(takeoff, Contact::Takeoff)?.contact_limits(),
            landing: rule(landing, Contact::Landing)?.contact_limits(),
            hopper: test.hopper().limits(),
            mechanism: test.mechanism_slopes(),
            terrain,
            rest_deg: [from.0, to.0],
            roughness_m: [from.1, to.1],
        }))
    }

    /// The margins of a hop over any ground.
    pub(crate) fn of_flown(flown: &Flown<'_>) -> Self {
        let terrain_from_takeoff_m = flown.terrain.map_or(f64::INFINITY, |(_, from_takeoff_m)| from_takeoff_m);
        Self { values: MARGINS.map(|row| (row.of)(flown)), terrain_from_takeoff_m }
    }

    /// The margins with these values; a margin without a value belongs to a limit that the hop does not have.
    pub fn from_rows(mut value: impl FnMut(&MarginRow) -> Option<f64>, terrain_from_takeoff_m: Option<f64>) -> Self {
        Self {
            values: std::array::from_fn(|i| value(&MARGINS[i]).unwrap_or(f64::INFINITY)),
            terrain_from_takeoff_m: terrain_from_takeoff_m.unwrap_or(f64::INFINITY),
        }
    }

    /// The margins with their rows; `None` where there is no such limit.
    pub fn rows(&self) -> impl Iterator<Item = (&'static MarginRow, Option<f64>)> + '_ {
        MARGINS.iter().zip(self.values.iter().map(|&value| Some(value).filter(|value| value.is_finite())))
    }

    /// Where the margin of the terrain is least, m of horizontal distance from the take-off; `None` if the terrain sets no limit.
    pub fn terrain_from_takeoff_m(&self) -> Option<f64> {
        Some(self.terrain_from_takeoff_m).filter(|distance_m| distance_m.is_finite())
    }
}
