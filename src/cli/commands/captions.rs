//! What stands above pictures: under which limits.

use std::fmt;

use chta::{scenario::Scenario, world::Hopper};

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
            Self { key: "hopper.takeoff_speed_max_m_s", contact: "take-off", most_m_s: hopper.takeoff_speed_max_m_s },
            Self { key: "hopper.landing_speed_max_m_s", contact: "landing", most_m_s: hopper.landing_speed_max_m_s },
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

/// Body, gravity and greatest speeds, for a map.
pub(super) fn conditions(scenario: &Scenario) -> String {
    let body = scenario.body.name.as_ref().map(|name| format!("{name}, ")).unwrap_or_default();
    let [takeoff, landing] = SpeedLimit::of(&scenario.hopper);
    format!("{body}gravity {:.4} m/s²; {takeoff}, {landing}", scenario.body.gravity_m_s2)
}

/// What a picture shows, and of which scenario where that has a name.
pub(super) fn title(shown: &str, scenario: &Scenario) -> String {
    scenario.title.as_ref().map_or_else(|| shown.to_owned(), |name| format!("{shown}: {name}"))
}
