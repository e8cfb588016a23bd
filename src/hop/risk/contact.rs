//! The probability that the ground allows a contact whose position, angle and speed scatter.

use super::flight::normal;
use crate::{
    chain::{ContactRule, Station},
    hop::HopTest,
    world::{Contact, Direction, tolerant_speed_m_s},
};

/// A contact with its scatter.
pub(super) struct ContactScatter {
    pub(super) contact: Contact,
    /// Offset of the mean position from the planned one, in the direction of travel, m.
    pub(super) shift_m: f64,
    /// Standard deviation of the position along the chain, m.
    pub(super) place_m: f64,
    /// Direction of flight, radians from the direction of travel, positive upwards.
    pub(super) angle: f64,
    /// Derivative of the angle with respect to the position, in the direction of travel, radians per metre.
    pub(super) angle_per_m: f64,
    /// Standard deviation of the angle at a fixed position, radians.
    pub(super) angle_sigma: f64,
    /// Speed, m/s.
    pub(super) speed_m_s: f64,
    /// Standard deviation of the speed, m/s.
    pub(super) speed_sigma_m_s: f64,
    /// Allowed distance from the planned position, m.
    pub(super) tolerance_m: Option<f64>,
}

/// The range of positions evaluated, in standard deviations: a probability of 2e-9 lies beyond and counts as failure.
const DEVIATIONS: f64 = 6.0;

/// The probability that a contact succeeds, over all ground within [`DEVIATIONS`] and the tolerance.
pub(super) fn contact_success(
    test: &HopTest,
    planned: &Station,
    direction: Direction,
    friction_sigma: f64,
    scatter: &ContactScatter,
) -> f64 {
    let chain = test.chain();
    let kept =
        |rule: Option<&ContactRule>, from_mean_m: f64| rule.map_or(0.0, |rule| scatter.kept_by(rule, from_mean_m, friction_sigma));
    let mean_m = planned.point.x_m + direction.sign() * scatter.shift_m;
    if scatter.place_m == 0.0 {
        // An undisturbed flight ends at its planned position; at a vertex the rule of that vertex applies.
        let at = if scatter.shift_m.abs() <= 1e-9 * planned.point.x_m.abs().max(1.0) {
            *planned
        } else {
            let Ok(at) = chain.geometry().station(mean_m) else { return 0.0 };
            at
        };
        let near = scatter.tolerance_m.is_none_or(|tolerance_m| scatter.shift_m.abs() <= tolerance_m);
        let rule = chain.allowed(&at, scatter.contact, direction);
        return kept(rule.filter(|_| near), 0.0);
    }
    let tolerance_m = scatter.tolerance_m.unwrap_or(f64::INFINITY);
    let range_m = DEVIATIONS * scatter.place_m;
    let low_m = (mean_m - range_m).max(planned.point.x_m - tolerance_m);
    let high_m = (mean_m + range_m).min(planned.point.x_m + tolerance_m);
    let vertices = chain.geometry().vertices();
    let first = vertices.partition_point(|vertex| vertex.x_m <= low_m).saturating_sub(1);
    let mut success = 0.0;
    for (segment, ends) in vertices.windows(2).enumerate().skip(first).take_while(|(_, ends)| ends[0].x_m < high_m) {
        let from = (ends[0].x_m.max(low_m) - mean_m) / scatter.place_m;
        let to = (ends[1].x_m.min(high_m) - mean_m) / scatter.place_m;
        if to > from {
            let middle_m = 0.5 * (from + to) * scatter.place_m;
            let rule = chain.segments()[segment].allowed(scatter.contact, direction);
            let there = match test.footing_samples() {
                None => normal(to) - normal(from),
                Some(samples) => samples.probability((from, to), mean_m, scatter.place_m),
            };
            success += there * kept(rule, direction.sign() * middle_m);
        }
    }
    success
}

impl ContactScatter {
    /// The probability that a rule is satisfied at an offset from the mean position, in the direction of travel: that the angle lies
    /// in the cone, times that the speed is within its limit.
    fn kept_by(&self, rule: &ContactRule, from_mean_m: f64, friction_sigma: f64) -> f64 {
        let angles = rule.angles();
        let angle = self.angle + self.angle_per_m * from_mean_m;
        // The half-angle of a cone of friction is atan(mu): d(phi) = d(mu) / (1 + mu^2) = d(mu) cos^2(phi).
        let half = 0.5 * (angles.max.radians() - angles.min.radians());
        let cosine = libm::cos(half.min(std::f64::consts::FRAC_PI_2));
        let sigma = libm::hypot(self.angle_sigma, friction_sigma * cosine * cosine);
        let within = probability_within(angle, sigma, angles.min.radians(), angles.max.radians());
        let speed_max_m_s = tolerant_speed_m_s(rule.speed_max_m_s());
        within * probability_within(self.speed_m_s, self.speed_sigma_m_s, f64::NEG_INFINITY, speed_max_m_s)
    }
}

/// The probability that a normal variable lies within two bounds; without spread, whether its mean does (a mean within
/// rounding of a bound counts as on it).
fn probability_within(mean: f64, sigma: f64, low: f64, high: f64) -> f64 {
    const ROUNDING: f64 = 1e-9;
    if sigma > 0.0 {
        (normal((high - mean) / sigma) - normal((low - mean) / sigma)).max(0.0)
    } else if (low - ROUNDING..=high + ROUNDING).contains(&mean) {
        1.0
    } else {
        0.0
    }
}
