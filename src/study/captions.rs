//! Titles and captions of pictures: the limits that apply.

use std::{fmt, path::Path};

use crate::{
    figure,
    quantity::{Angle, AngleInterval},
    scenario::Scenario,
    world::{Grip, Hopper, RestSlope},
};

/// A speed limit of the hopper, in words.
pub(super) struct SpeedLimit {
    /// The scenario's key for it.
    pub(super) key: &'static str,
    contact: &'static str,
    most_m_s: f64,
}

impl SpeedLimit {
    /// The take-off and landing speed limits.
    const fn of(hopper: &Hopper) -> [Self; 2] {
        // With brakes the landing speed limit is one of the touchdown.
        let landing = if hopper.limits().landing.brakes() { "touchdown" } else { "landing" };
        [
            Self { key: "hopper.takeoff_speed_max_m_s", contact: "take-off", most_m_s: hopper.limits().takeoff_speed_max_m_s },
            Self { key: "hopper.landing_speed_max_m_s", contact: landing, most_m_s: hopper.limits().landing_speed_max_m_s },
        ]
    }

    /// The finite ones: where the hopper has no limit of its own, the chain's limits apply.
    pub(super) fn stated(hopper: &Hopper) -> impl Iterator<Item = Self> {
        Self::of(hopper).into_iter().filter(|limit| limit.most_m_s.is_finite())
    }
}

impl fmt::Display for SpeedLimit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} at most {} m/s", self.contact, self.most_m_s)
    }
}

/// The assumptions of an answer over a map: body, gravity, hopper limits and ground, in the words of the pictures of plans. The limits are
/// those that planning may use.
pub fn conditions(scenario: &Scenario) -> String {
    let derated = scenario.derated();
    let scenario = derated.as_ref().unwrap_or(scenario);
    let (hopper, body) = (&scenario.hopper, &scenario.body);
    let bounds_m_s = (hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s);
    figure::conditions(body.name.as_deref().unwrap_or_default(), body.gravity.m_s2(), hopper, bounds_m_s, &format_ground(scenario))
}

/// The wheels of a machine that drives, in the words of its pictures; empty for another one.
pub fn wheels(scenario: &Scenario) -> String {
    let Some(keys) = scenario.drives() else { return String::new() };
    let limits = keys.rover.limits();
    let up = limits.slope_up_max.written_degrees();
    let [down, across] = [limits.slope_down_max, limits.cross_slope_max].map(|slope| slope.map_or(up, Angle::written_degrees));
    format!(
        "wheels: {} m/s over level ground; slopes at most {up} deg up, {down} deg down, {across} deg across; {} neighbours",
        limits.speed_m_s,
        limits.neighbours.count()
    )
}

/// The title of a picture: what it shows, and the scenario's title if it has one.
pub(super) fn title(shown: &str, scenario: &Scenario) -> String {
    scenario.title.as_ref().map_or_else(|| shown.to_owned(), |name| format!("{shown}: {name}"))
}

/// The ground in a few words: grip, rest slope and overlays.
pub(super) fn format_ground(scenario: &Scenario) -> String {
    let surface = &scenario.surface;
    let mut parts = Vec::new();
    match surface.grip {
        Some(Grip::Friction(cone)) => parts.push(format!("friction coefficient {}", cone.coefficient())),
        Some(Grip::FromSlope { takeoff, landing }) => {
            let range = |angles: AngleInterval| {
                let [min, max] = [angles.min, angles.max].map(Angle::written_degrees);
                format!("{min} to {max}")
            };
            parts.push(format!("take-off {} and landing {} deg from the slope", range(takeoff), range(landing)));
        }
        None => {}
    }
    let file = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    parts.extend(scenario.friction_raster.as_deref().map(|path| format!("friction from {}", file(path))));
    match (surface.rest, surface.grip) {
        (RestSlope::AsFrictionHolds, Some(Grip::Friction(_))) => parts.push("rest slope as friction holds".to_owned()),
        (RestSlope::AsFrictionHolds, _) => {}
        (RestSlope::AtMost(slope), _) => {
            parts.push(format!("rest slope ≤ {} deg", slope.written_degrees()));
        }
        (RestSlope::Unlimited, _) => parts.push("rest slope without limit".to_owned()),
    }
    parts.extend(scenario.keep_out.as_deref().map(|path| format!("keep-out {}", file(path))));
    parts.extend(scenario.keep_in.as_deref().map(|path| format!("keep-in {}", file(path))));
    parts.extend(scenario.layers.iter().map(|layer| format!("layer {} {}", layer.rule.name, layer.rule.condition)));
    if !scenario.groups.is_empty() {
        let names: Vec<&str> = scenario.groups.keys().map(String::as_str).collect();
        parts.push(format!("other surfaces of {}", names.join(", ")));
    }
    parts.join("; ")
}
