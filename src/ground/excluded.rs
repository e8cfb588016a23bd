//! Whether the friction cones of both contacts and the greatest speeds exclude every arc, without trigonometry: a test that costs a
//! tenth of the exact one and is passed by every feasible hop.

use nalgebra::Vector2;

use super::dem::Gradient;
use crate::{ballistics::LineOfSight, quantity::SlopeInterval, world::tolerant_speed_m_s};

/// Far more than rounding errors, as a share.
const SLACK: f64 = 1e-6;

/// The greatest speeds of a machine, as their squares with some slack, over gravity, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct GreatestSpeeds {
    takeoff_m: f64,
    landing_m: f64,
}

impl GreatestSpeeds {
    pub(super) fn new((takeoff_m_s, landing_m_s): (f64, f64), gravity_m_s2: f64) -> Self {
        let [takeoff_m, landing_m] = [takeoff_m_s, landing_m_s].map(|speed_m_s| {
            let tolerant_m_s = tolerant_speed_m_s(speed_m_s);
            tolerant_m_s * (tolerant_m_s / gravity_m_s2) * (1.0 + SLACK)
        });
        Self { takeoff_m, landing_m }
    }

    /// Whether every arc over a line of sight is excluded. `takeoff`: the slopes that the ground leaves of the take-off; `landing`: those of
    /// the landing flown backwards, a take-off in the opposite heading.
    ///
    /// ```text
    ///     v_t^2 / g = X (1 + (b + n)^2) / 2n,    v_l^2 / g = X (1 + (n - b)^2) / 2n,    n the loft, b the slope of the line of sight:
    ///     both are convex and least at n = sqrt(1 + b^2)
    /// ```
    pub(super) fn exclude(&self, sight: LineOfSight, takeoff: SlopeInterval, landing: SlopeInterval) -> bool {
        let b = sight.slope();
        let (lower, upper) = ((takeoff.lower - b).max(landing.lower + b).max(0.0), (takeoff.upper - b).min(landing.upper + b));
        if upper <= 0.0 || lower * (1.0 - SLACK) > upper {
            return true;
        }
        let n = sight.secant().max(lower).min(upper);
        let twice = 2.0 * n / sight.run_m();
        let (rising, falling) = (b + n, n - b);
        1.0 + rising * rising > self.takeoff_m * twice || 1.0 + falling * falling > self.landing_m * twice
    }
}

/// The slopes of the directions ahead that a friction cone about the normal of a facet leaves; `None` if it leaves no direction.
///
/// ```text
///     s   slope of the facet along the heading,  t   tangent of its cross-slope,  T   tangent of the half-angle of the cone in the plane of
///     travel, T^2 = (mu^2 - t^2) / (1 + t^2):
///     from (1 + s T) / (T - s), where s < T, to (1 - s T) / (-s - T), where s < -T, else to any
/// ```
pub(super) fn slopes_ahead(gradient: Gradient, heading: Vector2<f64>, friction: f64) -> Option<SlopeInterval> {
    let (s, across) = (gradient.dot(&heading), gradient.x * heading.y - gradient.y * heading.x);
    let t_squared = across * across / (1.0 + s * s);
    let tangent = ((friction * friction - t_squared).max(0.0) / (1.0 + t_squared)).sqrt() * (1.0 + SLACK) + SLACK;
    if s >= tangent {
        return None;
    }
    let upper = if s < -tangent { (1.0 - s * tangent) / (-s - tangent) } else { f64::INFINITY };
    Some(SlopeInterval { lower: (1.0 + s * tangent) / (tangent - s), upper })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ballistics::{Arc, FlightEnvelope},
        chain::LineConstraints,
        draw::Draw,
        terrain::ProfileFacet,
        world::{FrictionCone, Gravity, Hopper},
    };

    /// Random facets and lines of sight: what is excluded has no arc by the exact limits, and most without one are excluded.
    #[test]
    fn every_feasible_hop_passes_and_most_others_do_not() {
        let draw = &mut Draw::seeded(1733);
        let (mut feasible, mut refused, mut excluded) = (0, 0, 0);
        for _ in 0..40_000 {
            let (takeoff_m_s, landing_m_s) = (draw.log_uniform(0.5, 20.0), draw.log_uniform(0.5, 20.0));
            let gravity_m_s2 = draw.log_uniform(0.01, 10.0);
            let heading = Vector2::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)).normalize();
            let steepness = draw.log_uniform(1e-3, 3.0);
            let gradients = [0, 1].map(|_| Vector2::new(draw.uniform(-steepness, steepness), draw.uniform(-steepness, steepness)));
            let friction = draw.log_uniform(0.05, 3.0);
            let run_m = takeoff_m_s * landing_m_s / gravity_m_s2 * draw.uniform(0.02, 1.2);
            let sight = LineOfSight::new(run_m, run_m * draw.uniform(-0.8, 0.8));
            let [ahead, back] = [(gradients[0], heading), (gradients[1], -heading)]
                .map(|(gradient, heading)| slopes_ahead(gradient, heading, friction));
            let speeds = GreatestSpeeds::new((takeoff_m_s, landing_m_s), gravity_m_s2);
            let is_excluded = ahead.zip(back).is_none_or(|(ahead, back)| speeds.exclude(sight, ahead, back));
            let hopper = Hopper::with_speeds(takeoff_m_s, landing_m_s).unwrap();
            let envelope = FlightEnvelope::new(&hopper, Gravity::new(gravity_m_s2).unwrap());
            let rules = gradients.map(|gradient| {
                let cut = FrictionCone::new(friction).unwrap().cut(ProfileFacet::from_gradient(gradient, heading).cross_slope)?;
                Some(LineConstraints::from_cone(gradient.dot(&heading), cut, takeoff_m_s, landing_m_s))
            });
            let lofts = rules[0]
                .zip(rules[1])
                .map(|(from, to)| envelope.lofts(sight, from.takeoff.contact_limits(), to.landing.contact_limits()));
            if let Some(lofts) = lofts.filter(|lofts| !lofts.is_empty() && lofts.upper > 0.0) {
                let arc = Arc::new(sight, lofts.lower.max(1e-9), gravity_m_s2);
                assert!(!is_excluded, "{gradients:?} along {heading:?}, friction {friction}: {arc:?}");
                feasible += 1;
            } else {
                refused += 1;
                excluded += u32::from(is_excluded);
            }
        }
        assert!(feasible > 3000 && refused > 3000 && 10 * excluded > 8 * refused, "{feasible} feasible, {excluded} of {refused}");
    }
}
