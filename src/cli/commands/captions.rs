//! Titles and captions of pictures: the limits that apply.

use std::fmt;

use chta::{figure, scenario::Scenario, world::Hopper};

use super::plan::format_ground;

/// A speed limit of the hopper, in words.
pub(super) struct SpeedLimit {
    /// The scenario's key for it.
    pub(super) key: &'static str,
    contact: &'static str,
    most_m_s: f64,
}

impl SpeedLimit {
    /// The take-off and landing speed limits.
    pub(super) const fn of(hopper: &Hopper) -> [Self; 2] {
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

/// The assumptions of an answer over a map: body, gravity, hopper limits and ground, in the words of the pictures of plans.
pub(in crate::cli) fn conditions(scenario: &Scenario) -> String {
    let (hopper, body) = (&scenario.hopper, &scenario.body);
    let bounds_m_s = (hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s);
    figure::conditions(body.name.as_deref().unwrap_or_default(), body.gravity.m_s2(), hopper, bounds_m_s, &format_ground(scenario))
}

/// The title of a picture: what it shows, and the scenario's title if it has one.
pub(super) fn title(shown: &str, scenario: &Scenario) -> String {
    scenario.title.as_ref().map_or_else(|| shown.to_owned(), |name| format!("{shown}: {name}"))
}
