//! How much of the ground about a planned landing refuses it, in closed form.

use nalgebra::{Vector2, Vector3};

use super::{DemGround, MapPosition, Surface, dem::BESIDE_M, rest::rest_slope};
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
    /// The probability that the facet on which a hop comes down refuses it: without elevation, where a layer does not hold, too steep to rest on,
    /// or with a friction cone that does not hold the direction of arrival. Where friction differs from place to place, cones are not looked at.
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
        let (along, across) =
            (heading * scatter.along_m.max(least_m), Vector2::new(-heading.y, heading.x) * scatter.across_m.max(least_m));
        let triangles = self.triangles();
        let mut share = 0.0;
        for (ahead, weight) in FOUR {
            for (aside, beside) in TWO {
                let at = target.at + along * ahead + across * aside;
                let off_limits = self.layers().refusing_contact(at).is_some();
                let gradient = triangles.at(at, triangles.nominal()).map(|(_, gradient)| gradient).filter(|_| !off_limits);
                let refused = match (gradient, coefficient) {
                    (None, _) => 1.0,
                    (Some(gradient), None) => f64::from(u8::from(self.refuses(gradient, back, None))),
                    (Some(gradient), Some(mu)) if scatter.friction > 0.0 => {
                        let of = |(drawn, weight): (f64, f64)| {
                            weight
                                * f64::from(u8::from(self.refuses(gradient, back, Some((mu + drawn * scatter.friction).max(0.0)))))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        quantity::MapPoint,
        terrain::{Dem, GeoReference, OverlaidDem, Overlays},
        world::{Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    const SIDE: usize = 12;

    fn ground(draw: &mut Draw, relief_m: f64, mu: f64) -> DemGround {
        let heights = (0..SIDE * SIDE).map(|_| draw.uniform(0.0, 1.0) * relief_m).collect();
        let dem = Dem::new(SIDE, SIDE, heights, GeoReference::local(MapPoint::new(0.0, 11.0), 1.0, 1.0).unwrap()).unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(mu).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
        let terrain = OverlaidDem::new(dem, Overlays::default());
        DemGround::new(terrain, &Hopper::with_speeds(5.0, 5.0).unwrap(), Gravity::new(1.62).unwrap(), &surface)
    }

    /// Box and Muller's transform.
    fn normal(draw: &mut Draw) -> f64 {
        let (size, turn) = (draw.uniform(f64::MIN_POSITIVE, 1.0), draw.uniform(0.0, std::f64::consts::TAU));
        (-2.0 * libm::log(size)).sqrt() * libm::cos(turn)
    }

    #[test]
    fn level_ground_holds_every_landing_and_no_ground_none() {
        let draw = &mut Draw::seeded(1711);
        let level = ground(draw, 0.0, 0.7);
        let exact = LandingScatter { along_m: 0.0, across_m: 0.0, friction: 0.0 };
        let heading = Vector2::new(0.6, 0.8);
        let at = |x: f64, y: f64| MapPosition { at: MapPoint::new(x, y), z_m: 0.0 };
        assert_eq!(level.refusing_share(&at(5.0, 5.0), heading, -2.0, &exact), 0.0);
        // Shallower than the friction cone about the vertical: tan = 1 / 0.7.
        assert_eq!(level.refusing_share(&at(5.0, 5.0), heading, -1.4, &exact), 1.0);
        assert_eq!(level.refusing_share(&at(40.0, 5.0), heading, -2.0, &exact), 1.0);
        // Half of a scatter along x lies beyond the border of the map.
        let wide = LandingScatter { along_m: 2.0, ..exact };
        let half = level.refusing_share(&at(11.0, 5.0), Vector2::new(1.0, 0.0), -2.0, &wide);
        assert!((half - 0.5).abs() < 1e-12, "{half}");
    }

    /// Against draws of the place and of friction.
    #[test]
    fn the_share_is_that_of_drawn_landings() {
        const CASES: u32 = 200;
        const DRAWS: u32 = 4000;
        let draw = &mut Draw::seeded(1712);
        let (mut sum, mut far_off, mut doubtful) = (0.0, 0, 0);
        for _ in 0..CASES {
            let mu = draw.uniform(0.6, 1.1);
            let relief_m = draw.uniform(0.2, 0.9);
            let ground = ground(draw, relief_m, mu);
            let scatter = LandingScatter {
                along_m: draw.uniform(0.1, 1.5),
                across_m: draw.uniform(0.0, 0.6),
                friction: if draw.chance(0.5) { draw.uniform(0.0, 0.1) } else { 0.0 },
            };
            let target = MapPosition { at: MapPoint::new(draw.uniform(4.0, 7.0), draw.uniform(4.0, 7.0)), z_m: 0.0 };
            let turn = draw.uniform(0.0, 6.0);
            let (heading, slope) = (Vector2::new(libm::cos(turn), libm::sin(turn)), -draw.uniform(1.0, 4.0));
            let estimated = ground.refusing_share(&target, heading, slope, &scatter);
            let back = Vector3::new(-heading.x, -heading.y, -slope);
            let triangles = ground.triangles();
            let mut refused = 0;
            for _ in 0..DRAWS {
                let (ahead, aside) = (normal(draw) * scatter.along_m, normal(draw) * scatter.across_m);
                let at = target.at + heading * ahead + Vector2::new(-heading.y, heading.x) * aside;
                let drawn = (mu + normal(draw) * scatter.friction).max(0.0);
                let gradient = triangles.at(at, triangles.nominal()).map(|(_, gradient)| gradient);
                refused += u32::from(gradient.is_none_or(|gradient| ground.refuses(gradient, back, Some(drawn))));
            }
            let flown = f64::from(refused) / f64::from(DRAWS);
            sum += (estimated - flown).abs();
            far_off += u32::from((estimated - flown).abs() > 0.25);
            doubtful += u32::from(flown > 0.1 && flown < 0.9);
        }
        let mean = sum / f64::from(CASES);
        // Eight places stand for them all: good enough to rank hops, not to state how reliable one is.
        assert!(mean < 0.08 && far_off < 15 && doubtful > 60, "mean error {mean}, {far_off} far off, {doubtful} in doubt");
    }
}
