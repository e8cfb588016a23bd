//! The keys of a scenario of which another value may close the gap that a search did not cross.

use crate::{
    planner::RouteGap,
    scenario::Scenario,
    world::{Grip, Limit, RestSlope},
};

/// The keys whose limits refuse hops across a gap, the one that refuses most of them first; of a gap wider than a hop the take-off speed, unless
/// an end by itself has no hop: so many places are reached.
pub(super) fn gap_keys(gap: &RouteGap, reached: usize, scenario: &Scenario) -> Vec<String> {
    let mut keys: Vec<&str> = Vec::new();
    if gap.width_m.is_none() && reached > 1 && gap.leading > 1 {
        keys.push(TAKEOFF_SPEED);
    }
    for (limit, _) in gap.refusals.ranked() {
        keys.extend(key_of(limit, scenario).filter(|key| !keys.contains(key)));
    }
    keys.into_iter().map(str::to_owned).collect()
}

const TAKEOFF_SPEED: &str = "hopper.takeoff_speed_max_m_s";

/// The key that sets a limit; `None` where no number of the scenario does.
fn key_of(limit: Limit, scenario: &Scenario) -> Option<&'static str> {
    let by_friction = || matches!(scenario.surface.grip, Some(Grip::Friction(_))) && scenario.friction_raster.is_none();
    let friction = || by_friction().then_some("surface.friction_coefficient");
    match limit {
        // A faster hopper flies over what is in the way.
        Limit::TakeoffSpeed | Limit::Terrain | Limit::LineOfSight => Some(TAKEOFF_SPEED),
        Limit::LandingSpeed => Some("hopper.landing_speed_max_m_s"),
        Limit::TakeoffCone | Limit::LandingCone | Limit::Touchdown => friction(),
        Limit::RestSlope | Limit::FootprintSlope => match scenario.surface.rest {
            RestSlope::AsFrictionHolds => friction(),
            RestSlope::AtMost(_) | RestSlope::Unlimited => Some("surface.rest_slope_max_deg"),
        },
        Limit::Roughness => Some("hopper.roughness_max_m"),
        Limit::ApexHeight => Some("hopper.apex_height_max_m"),
        Limit::FlightTime => Some("hopper.flight_time_max_s"),
        Limit::MechanicalAngle => Some("hopper.takeoff_angle_max_deg"),
        Limit::TakeoffSpeedMin => Some("hopper.takeoff_speed_min_m_s"),
        Limit::Direction
        | Limit::KeepOut
        | Limit::Bend
        | Limit::TakeoffSpeedLevels
        | Limit::TakeoffAngleStep
        | Limit::TakeoffSpeedStep
        | Limit::HeadingStep
        | Limit::Stroke
        | Limit::Force
        | Limit::Spin
        | Limit::Layer(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scenario::{CATALOGUE, Entries, Kind},
        study::SweptKey,
    };

    #[test]
    fn every_key_can_be_varied() {
        let source = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.0\nlanding_speed_max_m_s = 2.0\n\
                      [surface]\nfriction_coefficient = 0.6\n";
        let by_friction = Scenario::new(Entries::from_toml(source)).unwrap();
        let by_slope = Scenario::new(Entries::from_toml(&format!("{source}rest_slope_max_deg = 20.0\n"))).unwrap();
        let keys_of = |scenario: &Scenario| Limit::ALL.map(|limit| key_of(limit, scenario));
        let rest = Limit::ALL.iter().position(|limit| *limit == Limit::RestSlope).unwrap();
        assert_eq!(keys_of(&by_friction)[rest], Some("surface.friction_coefficient"));
        assert_eq!(keys_of(&by_slope)[rest], Some("surface.rest_slope_max_deg"));
        for key in [by_friction, by_slope].iter().flat_map(keys_of).flatten() {
            assert!(SweptKey::parse(&format!("{key}=1:2:3")).is_ok(), "{key}");
            let known = CATALOGUE.iter().find(|known| known.path() == key).unwrap();
            assert!(matches!(known.kind, Kind::Number { .. } | Kind::AngleOrUnlimited), "{key}");
        }
    }
}
