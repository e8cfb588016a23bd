//! The reliability of one hop: an estimate of its probability to fail, without a single draw.
//!
//! Deviations of speed and angle are cut into eight cells each; in every pair of cells the hop is one parabola, whose landing scatters
//! further by deviations of place and height through the flight's own derivatives. What ground lies within that scatter, and how wide
//! its cones and speed limits are, gives the probability. The same hop always weighs the same, so paths can be compared.
//!
//! What it leaves out: errors of the hops before (right where a robot replans from where it really is, too bright where it flies an
//! old plan), headings (a hop is flown in its plane), and how errors of friction and height, one draw for a whole traverse, bind its
//! hops together. On the very edge of its cones it calls a hop up to 0.2 too risky. `chta simulate` counts instead; this estimate only
//! has to rank hops.

mod contact;
mod flight;

use super::HopTest;
use crate::{
    ballistics::Arc,
    chain::Station,
    quantity::{Angle, SlopeInterval},
    world::Direction,
};
use contact::{ContactScatter, contact_success};
use flight::{Flight, Ground, cells};

/// Standard deviations of what a hop is flown with.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct HopDeviations {
    /// Take-off speed, m/s.
    pub takeoff_speed_m_s: f64,
    /// Take-off speed, as a share of the commanded one.
    pub takeoff_speed_fraction: f64,
    /// Take-off angle.
    pub takeoff_angle: Angle,
    /// Where along the chain it takes off, m: bounce-and-roll displacement after the landing before, and what it knows of its place.
    pub place_m: f64,
    /// Friction coefficient, where the ground's cones are made of friction.
    pub friction: f64,
    /// Height of the ground, m.
    pub height_m: f64,
}

/// What the probability to fail is estimated from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RiskModel {
    /// From the deviations of a scenario.
    Deviations(HopDeviations),
    /// From the slack that the flown angle has to either end of its feasible set, as if it were off by one degree of standard
    /// deviation.
    Slack,
}

/// The deviation that [`RiskModel::Slack`] measures slack in: one degree. A larger one blurs the order of narrow sets, a smaller one
/// that of wide ones.
const SLACK_SIGMA_DEG: f64 = 1.0;

/// A hop as it would be flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedHop {
    /// Where it takes off.
    pub takeoff: Station,
    /// Where it lands.
    pub landing: Station,
    /// The flight between.
    pub arc: Arc,
    /// All feasible lofts between the two.
    pub lofts: SlopeInterval,
    /// How far from its landing it may come down, m, where that matters: the last hop to a goal.
    pub tolerance_m: Option<f64>,
}

impl RiskModel {
    /// The probability that a hop fails.
    ///
    /// ```text
    ///     1 - P(take-off within its cone) P(no vertex struck on the way) P(landing within cone, speed and tolerance)
    /// ```
    ///
    /// Take-off and landing are averaged over the segments about them, each as probable as the place scatters; a segment that refuses the
    /// contact, or the end of the chain, fails. With [`RiskModel::Slack`]: `P(lower slack) + P(upper slack)` of a normal deviation of
    /// one degree.
    ///
    /// # Returns
    /// From 0 to 1; 0 for a sound hop without deviations.
    pub fn failure_probability(&self, test: &HopTest, hop: &PlannedHop) -> f64 {
        let success = match self {
            Self::Deviations(deviations) => deviations.success(test, hop),
            Self::Slack => slack_success(hop),
        };
        (1.0 - success).clamp(0.0, 1.0)
    }

    /// The weight of a hop in a search: `-ln(1 - p)`, which adds up over hops as probabilities multiply; at most some 28.
    pub fn weight(&self, test: &HopTest, hop: &PlannedHop) -> f64 {
        // A certain failure stays comparable: fewer of them are better than more.
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
        // Speed and angle decide on take-off, way and landing together, so these are taken cell by cell; the rest scatters within.
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

/// By the slack of the flown angle alone.
fn slack_success(hop: &PlannedHop) -> f64 {
    let angle_deg = |loft: f64| Angle::from_slope(hop.arc.line_of_sight().slope() + loft).degrees();
    let flown_deg = angle_deg(hop.arc.loft());
    let kept = |slack_deg: f64| flight::normal(slack_deg / SLACK_SIGMA_DEG);
    kept(flown_deg - angle_deg(hop.lofts.lower)) + kept(angle_deg(hop.lofts.upper) - flown_deg) - 1.0
}

#[cfg(test)]
mod tests;
