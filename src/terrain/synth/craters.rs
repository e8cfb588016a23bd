//! Impact craters: bowls with raised rims and ejecta.

use super::Canvas;
use super::options::{at_least, check_count, within};
use super::random::{Draws, Layer};
use crate::terrain::TerrainError;

/// Ejecta extend to this many crater radii, where their thickness is 1/125 of that at the rim.
const EJECTA_REACH: f64 = 5.0;

/// Depth of a fresh simple crater from rim to floor, by its rim-to-rim diameter D, both in km.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthLaw {
    /// Moon: 0.196 D^1.010 (Pike, Size-dependence in the shape of fresh impact craters on the Moon, in Impact and Explosion
    /// Cratering, 1977).
    Moon,
    /// Mars: 0.179 D^1.012 (Robbins and Hynek, A new global database of Mars impact craters >= 1 km: 2, J. Geophys. Res. 117,
    /// 2012, E06001).
    Mars,
}

impl DepthLaw {
    /// Depth from rim to floor, m.
    ///
    /// ```
    /// use chta::terrain::DepthLaw;
    /// assert_eq!(DepthLaw::Moon.depth_m(1000.0), 196.0);
    /// ```
    pub fn depth_m(self, diameter_m: f64) -> f64 {
        let (factor, exponent) = match self {
            Self::Moon => (0.196, 1.010),
            Self::Mars => (0.179, 1.012),
        };
        1000.0 * factor * libm::pow(diameter_m / 1000.0, exponent)
    }
}

/// Height of a fresh simple crater's rim above its surroundings: 0.036 D^1.014, in km (Pike 1977, as above). Also used for
/// Mars.
fn rim_height_m(diameter_m: f64) -> f64 {
    36.0 * libm::pow(diameter_m / 1000.0, 1.014)
}

/// A population of craters at random positions, with diameters from a power law: the number per area of at least diameter D
/// is proportional to D^-b.
///
/// ```text
/// z(r) = rim - depth (1 - (r/R)^2)   for r <= R,      z(r) = rim (r/R)^-3   outside, out to 5 R
/// ```
///
/// Inside, a paraboloid of revolution; outside, the ejecta thickness of `McGetchin`, Settle and Head, Earth Planet. Sci.
/// Lett. 20 (1973) 226. Degradation scales depth and rim height by 1 - d, with d drawn uniformly from 0 to `degradation_max`.
/// Craters are added to the existing terrain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Craters {
    /// Smallest diameter, m.
    pub diameter_min_m: f64,
    /// Largest diameter, m.
    pub diameter_max_m: f64,
    /// Number of craters per square kilometre between the two diameters.
    pub density_per_km2: f64,
    /// b, the exponent of the cumulative counts: 3 for a young surface, 2 for one in equilibrium.
    pub power_law_exponent: f64,
    /// Depth of fresh craters.
    pub depth_law: DepthLaw,
    /// 0: all craters are fresh; 1: some are completely levelled.
    pub degradation_max: f64,
}

impl Default for Craters {
    /// A lunar plain of moderate age, craters of 4 to 60 m.
    fn default() -> Self {
        Self {
            diameter_min_m: 4.0,
            diameter_max_m: 60.0,
            density_per_km2: 1500.0,
            power_law_exponent: 2.5,
            depth_law: DepthLaw::Moon,
            degradation_max: 0.8,
        }
    }
}

impl Craters {
    pub(super) fn add(&self, heights_m: &mut [f64], canvas: Canvas, seed: u64) -> Result<(), TerrainError> {
        self.check(canvas)?;
        // Craters with centres off the map can still extend into it.
        let margin_m = 0.5 * EJECTA_REACH * self.diameter_max_m;
        let [width_m, height_m] = canvas.extent_m();
        let area_km2 = (width_m + 2.0 * margin_m) * (height_m + 2.0 * margin_m) * 1.0e-6;
        check_count("density_per_km2", self.density_per_km2 * area_km2)?;
        let mut draws = Draws::of(seed, Layer::Craters);
        for _ in 0..draws.count(self.density_per_km2 * area_km2) {
            let centre = [draws.between(-margin_m, width_m + margin_m), draws.between(-margin_m, height_m + margin_m)];
            let diameter_m = self.diameter_at(draws.uniform());
            let freshness = 1.0 - self.degradation_max * draws.uniform();
            let crater = Crater {
                radius: 0.5 * diameter_m,
                depth: freshness * self.depth_law.depth_m(diameter_m),
                rim: freshness * rim_height_m(diameter_m),
            };
            canvas.each_within(centre, EJECTA_REACH * crater.radius, |index, [x_m, y_m]| {
                heights_m[index] += crater.height_m(libm::hypot(x_m - centre[0], y_m - centre[1]));
            });
        }
        Ok(())
    }

    fn check(&self, canvas: Canvas) -> Result<(), TerrainError> {
        let [width_m, height_m] = canvas.extent_m();
        at_least("crater diameter_min_m", self.diameter_min_m, canvas.spacing_m, "m, the post spacing")?;
        within("crater diameter_max_m", self.diameter_max_m, self.diameter_min_m, 10.0 * (width_m + height_m), "m")?;
        within("crater density_per_km2", self.density_per_km2, 0.0, 1.0e15, "per square kilometre")?;
        within("crater power_law_exponent", self.power_law_exponent, 0.1, 10.0, "")?;
        within("crater degradation_max", self.degradation_max, 0.0, 1.0, "")
    }

    /// The diameter that a fraction `drawn` of the population does not exceed: the inverse of the truncated power law.
    fn diameter_at(&self, drawn: f64) -> f64 {
        let worn = 1.0 - libm::pow(self.diameter_min_m / self.diameter_max_m, self.power_law_exponent);
        self.diameter_min_m * libm::pow(1.0 - drawn * worn, -1.0 / self.power_law_exponent)
    }
}

/// One crater as drawn; lengths in m.
struct Crater {
    radius: f64,
    depth: f64,
    rim: f64,
}

impl Crater {
    fn height_m(&self, distance_m: f64) -> f64 {
        let r = distance_m / self.radius;
        if r <= 1.0 {
            self.rim - self.depth * (1.0 - r * r)
        } else if r <= EJECTA_REACH {
            self.rim / (r * r * r)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fresh_crater_has_the_published_depth_and_a_rim_without_a_step() {
        let (depth_m, rim_m) = (DepthLaw::Mars.depth_m(100.0), rim_height_m(100.0));
        // 179 * 0.1^1.012 and 36 * 0.1^1.014, by hand.
        assert!((depth_m - 17.412).abs() < 1e-3 && (rim_m - 3.4858).abs() < 1e-4, "{depth_m} {rim_m}");
        let crater = Crater { radius: 50.0, depth: depth_m, rim: rim_m };
        assert!((crater.height_m(50.0) - crater.height_m(0.0) - depth_m).abs() < 1e-12);
        assert!((crater.height_m(50.0) - crater.height_m(50.0 + 1e-9)).abs() < 1e-8);
        assert_eq!(crater.height_m(100.0), rim_m / 8.0);
        assert_eq!(crater.height_m(251.0), 0.0);
    }

    #[test]
    fn diameters_follow_the_power_law_between_their_bounds() {
        let craters = Craters { diameter_min_m: 2.0, diameter_max_m: 200.0, power_law_exponent: 2.0, ..Craters::default() };
        assert_eq!(craters.diameter_at(0.0), 2.0);
        assert!((craters.diameter_at(1.0) - 200.0).abs() < 1e-6);
        // The fraction with a diameter above D is (D^-2 - Dmax^-2) / (Dmin^-2 - Dmax^-2).
        let share = (0.01 - 0.000_025) / (0.25 - 0.000_025);
        assert!((craters.diameter_at(1.0 - share) - 10.0).abs() < 1e-9);
    }
}
