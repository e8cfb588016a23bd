//! How much of the ground about a planned landing refuses it, in closed form.

use nalgebra::{Vector2, Vector3};

use super::{
    DemGround, MapPosition, Surface,
    dem::{BESIDE_M, rest_slope},
};
use crate::world::FrictionCone;

/// How the places scatter where hops to one target come down, and how exactly friction is known: standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LandingScatter {
    /// Along the heading, m.
    pub(crate) along_m: f64,
    /// To its sides, m.
    pub(crate) across_m: f64,
    /// Of the friction coefficient.
    pub(crate) friction: f64,
}

/// Nodes and weights of Gauss-Hermite quadrature for a Gaussian variable of deviation 1, with four points: it is exact up to the seventh
/// power. An even number of points, since the middle may lie on an edge between facets, which no landing meets.
const FOUR: [(f64, f64); 4] = [
    (-2.334_414_218_338_977, 0.045_875_854_768_068_5),
    (-0.741_963_784_302_725_8, 0.454_124_145_231_931_5),
    (0.741_963_784_302_725_8, 0.454_124_145_231_931_5),
    (2.334_414_218_338_977, 0.045_875_854_768_068_5),
];

/// The same with two points.
const TWO: [(f64, f64); 2] = [(-1.0, 0.5), (1.0, 0.5)];

impl DemGround {
    /// The probability that the facet on which a hop comes down refuses it: without elevation, too steep to rest on, or with a friction cone
    /// that does not hold the direction of arrival. Where friction differs from place to place, cones are not looked at.
    ///
    /// By quadrature over the scatter of the landings and the error of friction; without scatter, over the facets that meet at the target.
    ///
    /// # Arguments
    /// `arrival_slope`: that of the arc at the landing, negative on the way down.
    pub(crate) fn refusing_share(
        &self,
        target: &MapPosition,
        heading: Vector2<f64>,
        arrival_slope: f64,
        scatter: &LandingScatter,
    ) -> f64 {
        let friction = self.constant_friction().filter(|_| self.terrain().overlays().friction().is_none());
        let coefficient = friction.map(FrictionCone::coefficient);
        let back = Vector3::new(-heading.x, -heading.y, -arrival_slope);
        // Every facet has room for rounding.
        let least_m = 2.0 * self.resolution_m().max(BESIDE_M);
        let (along, across) = (heading * scatter.along_m.max(least_m), Vector2::new(-heading.y, heading.x) * scatter.across_m.max(least_m));
        let triangles = self.triangles();
        let mut share = 0.0;
        for (ahead, weight) in FOUR {
            for (aside, beside) in TWO {
                let at = target.at + along * ahead + across * aside;
                let gradient = triangles.at(at, triangles.nominal()).map(|(_, gradient)| gradient);
                let refused = match (gradient, coefficient) {
                    (None, _) => 1.0,
                    (Some(gradient), None) => f64::from(u8::from(self.refuses(gradient, back, None))),
                    (Some(gradient), Some(mu)) if scatter.friction > 0.0 => {
                        let of = |(drawn, weight): (f64, f64)| {
                            weight * f64::from(u8::from(self.refuses(gradient, back, Some((mu + drawn * scatter.friction).max(0.0)))))
                        };
                        TWO.into_iter().map(of).sum()
                    }
                    (Some(gradient), mu) => f64::from(u8::from(self.refuses(gradient, back, mu))),
                };
                share += weight * beside * refused;
            }
        }
        share
    }

    /// Whether a facet refuses the arrival from a direction, which points backwards along the arc.
    fn refuses(&self, gradient: Vector2<f64>, back: Vector3<f64>, friction: Option<f64>) -> bool {
        let rest = rest_slope(self.surface().rest, friction);
        let is_steep = rest.is_some_and(|rest| gradient.norm_squared() > rest * rest);
        // Within the cone: the part along the facet is at most the coefficient times the part along its normal.
        let slides = friction.is_some_and(|mu| {
            let normal = Vector3::new(-gradient.x, -gradient.y, 1.0);
            let (across, squared) = (back.dot(&normal), normal.norm_squared());
            let along = back.norm_squared() - across * across / squared;
            across <= 0.0 || along > mu * mu * across * across / squared
        });
        is_steep || slides
    }
}
