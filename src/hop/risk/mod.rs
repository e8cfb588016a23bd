//! The reliability of one hop: a deterministic estimate of its probability to fail.
//!
//! Deviations of speed and angle are divided into eight cells each. In every pair of cells the hop is one parabola, whose
//! landing is further scattered by deviations of position and height through the derivatives of the flight. The probability
//! follows from the ground within that scatter, and from the width of its cones and speed limits. The same hop always has the
//! same weight, so paths can be compared.
//!
//! The estimate ignores errors of previous hops (correct for a robot that replans from its actual position, too optimistic
//! for one that follows an old plan), errors of heading (a hop is flown in its plane), and the correlation between hops that
//! share the errors of friction and height, drawn once per traverse. For a hop on the very edge of its cones, the estimated
//! probability to fail is up to 0.2 too high. `chta simulate` counts failures instead; this estimate only has to rank hops.

mod contact;
mod flight;
mod footing;

use super::HopTest;
use crate::{
    ballistics::Arc,
    chain::Station,
    quantity::{Angle, SlopeInterval},
    world::Direction,
};
use contact::{ContactScatter, contact_success};
use flight::{Flight, Ground, cells};
pub(super) use footing::FootingSamples;

/// Standard deviations of the quantities with which a hop is flown.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct HopDeviations {
    /// Take-off speed, m/s.
    pub takeoff_speed_m_s: f64,
    /// Take-off speed, as a fraction of the commanded one.
    pub takeoff_speed_fraction: f64,
    /// Take-off angle.
    pub takeoff_angle: Angle,
    /// Position of the take-off along the chain, m: bounce-and-roll displacement after the previous landing, and localisation
    /// error.
    pub place_m: f64,
    /// Friction coefficient, if the ground's cones are cones of friction.
    pub friction: f64,
    /// Height of the ground, m.
    pub height_m: f64,
}

/// A deviation that is below 0, infinite or NaN.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the deviation {what} is {found}, expected a finite number of at least 0: leave it 0 if there is no such error")]
pub struct InvalidDeviation {
    /// Its field in [`HopDeviations`].
    pub what: &'static str,
    /// What was given, an angle in degrees.
    pub found: f64,
}

/// The source of the estimated probability to fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RiskModel {
    /// From the deviations of a scenario.
    Deviations(HopDeviations),
    /// The margin of the flown angle to either end of its feasible set, for an angle with one degree of standard deviation.
    Slack,
}

/// The standard deviation of the angle assumed by [`RiskModel::Slack`]: one degree. A larger value distinguishes narrow sets
/// less well, a smaller value wide ones.
const SLACK_SIGMA_DEG: f64 = 1.0;

/// A hop as planned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedHop {
    /// The take-off station.
    pub takeoff: Station,
    /// The landing station.
    pub landing: Station,
    /// The arc between them.
    pub arc: Arc,
    /// All feasible lofts between them.
    pub lofts: SlopeInterval,
    /// Allowed distance of the landing from its plan, m, if it matters: for the last hop to a goal.
    pub tolerance_m: Option<f64>,
}

impl RiskModel {
    /// Checks the deviations.
    ///
    /// # Errors
    /// The first [`InvalidDeviation`].
    ///
    /// ```
    /// use chta::hop::{HopDeviations, RiskModel};
    /// let of = |height_m| RiskModel::Deviations(HopDeviations { height_m, ..HopDeviations::default() });
    /// assert!(of(0.1).check().is_ok() && of(f64::NAN).check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), InvalidDeviation> {
        let Self::Deviations(deviations) = self else { return Ok(()) };
        // No destructuring with `..`, so that a new deviation cannot be left unchecked.
        let HopDeviations { takeoff_speed_m_s, takeoff_speed_fraction, takeoff_angle, place_m, friction, height_m } = *deviations;
        let all = [
            ("takeoff_speed_m_s", takeoff_speed_m_s),
            ("takeoff_speed_fraction", takeoff_speed_fraction),
            ("takeoff_angle", takeoff_angle.degrees()),
            ("place_m", place_m),
            ("friction", friction),
            ("height_m", height_m),
        ];
        match all.into_iter().find(|(_, found)| !(found.is_finite() && *found >= 0.0)) {
            Some((what, found)) => Err(InvalidDeviation { what, found }),
            None => Ok(()),
        }
    }

    /// Whether every hop has the same probability to fail: deviations that are all 0.
    pub fn tells_nothing(&self) -> bool {
        *self == Self::Deviations(HopDeviations::default())
    }

    /// The probability that a hop fails.
    ///
    /// ```text
    ///     1 - P(take-off within its cone) P(no vertex struck in flight) P(landing within cone, speed and tolerance)
    /// ```
    ///
    /// Take-off and landing are averaged over the segments around them, weighted by the probability of each position; a
    /// segment that refuses the contact, and the end of the chain, count as failure. With [`RiskModel::Slack`]: the
    /// probability that a normal deviation of one degree exceeds the lower or the upper margin.
    ///
    /// # Returns
    /// From 0 to 1; 0 for a feasible hop without deviations, 1 with deviations that [`check`](Self::check) refuses.
    pub fn failure_probability(&self, test: &HopTest, hop: &PlannedHop) -> f64 {
        if self.check().is_err() {
            return 1.0;
        }
        let success = match self {
            Self::Deviations(deviations) => deviations.success(test, hop),
            Self::Slack => slack_success(hop),
        };
        (1.0 - success).clamp(0.0, 1.0)
    }

    /// The weight of a hop in a search, `-ln(1 - p)`: its sum over hops is `-ln` of the product of their success
    /// probabilities. At most some 28.
    pub fn weight(&self, test: &HopTest, hop: &PlannedHop) -> f64 {
        // A certain failure has a finite weight, so that paths with fewer of them are better.
        const LEAST_SUCCESS: f64 = 1e-12;
        -libm::log((1.0 - self.failure_probability(test, hop)).max(LEAST_SUCCESS))
    }
}

impl HopDeviations {
    /// The standard deviation of a take-off speed, m/s.
    fn speed_sigma_m_s(&self, speed_m_s: f64) -> f64 {
        libm::hypot(self.takeoff_speed_m_s, self.takeoff_speed_fraction * speed_m_s)
    }

    fn success(&self, test: &HopTest, hop: &PlannedHop) -> f64 {
        let Some(direction) = Direction::between(hop.takeoff.point.x_m, hop.landing.point.x_m) else { return 1.0 };
        let ground = Ground::of(test, hop, direction);
        let speed_sigma_m_s = self.speed_sigma_m_s(hop.arc.takeoff_speed_m_s());
        let mut success = 0.0;
        // Speed and angle affect take-off, flight and landing together, so these are evaluated cell by cell; the other
        // deviations scatter inside.
        for angle in cells(self.takeoff_angle.radians()) {
            for speed in cells(speed_sigma_m_s) {
                let Some(flight) = Flight::new(self, test, hop, &ground, [speed, angle]) else { continue };
                success += angle.probability
                    * speed.probability
                    * contact_success(test, &hop.takeoff, direction, self.friction, &flight.takeoff(self))
                    * (1.0 - flight.strike_probability(self, test, hop, &ground))
                    * contact_success(test, &hop.landing, direction, self.friction, &flight.landing(hop));
            }
        }
        success
    }
}

/// The success probability from the margin of the flown angle alone.
fn slack_success(hop: &PlannedHop) -> f64 {
    let angle_deg = |loft: f64| Angle::from_slope(hop.arc.line_of_sight().slope() + loft).degrees();
    let flown_deg = angle_deg(hop.arc.loft());
    let kept = |slack_deg: f64| flight::normal(slack_deg / SLACK_SIGMA_DEG);
    kept(flown_deg - angle_deg(hop.lofts.lower)) + kept(angle_deg(hop.lofts.upper) - flown_deg) - 1.0
}

#[cfg(test)]
mod tests;
