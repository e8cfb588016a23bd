//! What stands above pictures: under which limits.

use std::fmt;

use chta::{report::figure, scenario::Scenario, world::Hopper};

use super::plan::format_ground;

/// A greatest speed of the hopper's, in words.
pub(super) struct SpeedLimit {
    /// The scenario's key for it.
    pub(super) key: &'static str,
    contact: &'static str,
    most_m_s: f64,
}

impl SpeedLimit {
    /// Of take-off and of landing.
    pub(super) const fn of(hopper: &Hopper) -> [Self; 2] {
        [
            Self { key: "hopper.takeoff_speed_max_m_s", contact: "take-off", most_m_s: hopper.limits().takeoff_speed_max_m_s },
            Self { key: "hopper.landing_speed_max_m_s", contact: "landing", most_m_s: hopper.limits().landing_speed_max_m_s },
        ]
    }

    /// Those that limit anything: without one of the hopper's own the chain's hold.
    pub(super) fn stated(hopper: &Hopper) -> impl Iterator<Item = Self> {
        Self::of(hopper).into_iter().filter(|limit| limit.most_m_s.is_finite())
    }
}

impl fmt::Display for SpeedLimit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} at most {} m/s", self.contact, self.most_m_s)
    }
}

/// All that an answer over a map assumes: body, gravity, the hopper's limits and the ground, as the pictures of plans say it.
pub(super) fn conditions(scenario: &Scenario) -> String {
    let (hopper, body) = (&scenario.hopper, &scenario.body);
    let bounds_m_s = (hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s);
    figure::conditions(body.name.as_deref().unwrap_or_default(), body.gravity.m_s2(), hopper, bounds_m_s, &format_ground(scenario))
}

/// What a picture shows, and of which scenario where that has a name.
pub(super) fn title(shown: &str, scenario: &Scenario) -> String {
    scenario.title.as_ref().map_or_else(|| shown.to_owned(), |name| format!("{shown}: {name}"))
}
