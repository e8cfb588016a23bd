//! The landings of all trials' hops with one number.

use nalgebra::{Matrix2, Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::{ErrorSummary, LandingEllipse, LandingSummary, QuantileSketch, exact_sum::ExactSum, trial::Landing};
use crate::quantity::Angle;

/// The 95 % quantile of the chi-squared distribution with two degrees of freedom, `-2 ln 0.05`.
const CHI_SQUARED_95: f64 = 5.991_464_547_107_979;

/// The statistics of these landings, in any order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LandingTally {
    errors: QuantileSketch,
    sum_m: ExactSum,
    max_m: f64,
    /// On a map: how far positions of rest lie from the planned one, east and north.
    away_m: [ExactSum; 2],
    /// The squares of these, east and north, and their product.
    squares_m2: [ExactSum; 3],
}

impl LandingTally {
    /// Adds a landing; `planned` is where the hop is planned to land, on a map.
    pub(super) fn add(&mut self, landing: &Landing, planned: Option<Point2<f64>>) {
        self.errors.add(landing.error_m);
        self.sum_m.add(landing.error_m);
        self.max_m = self.max_m.max(landing.error_m);
        if let Some(planned) = planned {
            let away = landing.rest - planned;
            let squares = [away.x * away.x, away.y * away.y, away.x * away.y];
            self.away_m.iter_mut().zip([away.x, away.y]).for_each(|(sum, term)| sum.add(term));
            self.squares_m2.iter_mut().zip(squares).for_each(|(sum, term)| sum.add(term));
        }
    }

    /// Adds the landings of other trials.
    pub(super) fn merge(&mut self, other: &Self) {
        self.errors.merge(&other.errors);
        self.sum_m.merge(&other.sum_m);
        self.max_m = self.max_m.max(other.max_m);
        self.away_m.iter_mut().zip(&other.away_m).for_each(|(mine, theirs)| mine.merge(theirs));
        self.squares_m2.iter_mut().zip(&other.squares_m2).for_each(|(mine, theirs)| mine.merge(theirs));
    }

    /// The statistics; `None` without landings.
    #[expect(clippy::cast_precision_loss, reason = "fewer landings than 2^53")]
    pub(super) fn summary(&self, hop: u32, planned: Option<Point2<f64>>) -> Option<LandingSummary> {
        let count = self.errors.count();
        let n = count as f64;
        // The middle of the last bin may lie beyond the largest value.
        let quantile = |share: f64| self.errors.quantile(share).map(|value| value.min(self.max_m));
        let error = ErrorSummary {
            mean_m: self.sum_m.value() / n,
            q05_m: quantile(0.05)?,
            q25_m: quantile(0.25)?,
            q50_m: quantile(0.5)?,
            q75_m: quantile(0.75)?,
            q95_m: quantile(0.95)?,
            max_m: self.max_m,
        };
        let mean = Vector2::new(self.away_m[0].value(), self.away_m[1].value()) / n;
        let [east, north, mixed] = [0, 1, 2].map(|i| self.squares_m2[i].value());
        let squares_m2 = Matrix2::new(east, mixed, mixed, north);
        let covariance_m2 = if count > 1 { (squares_m2 - mean * mean.transpose() * n) / (n - 1.0) } else { Matrix2::zeros() };
        let ellipse = planned.map(|planned| ellipse(planned + mean, covariance_m2));
        Some(LandingSummary { hop, count, error, ellipse })
    }
}

/// The 95 % ellipse of a Gaussian.
fn ellipse(centre: Point2<f64>, covariance_m2: Matrix2<f64>) -> LandingEllipse {
    let (east, north, mixed) = (covariance_m2[(0, 0)], covariance_m2[(1, 1)], covariance_m2[(0, 1)]);
    let (middle, half) = (0.5 * (east + north), libm::hypot(0.5 * (east - north), mixed));
    let axis = |variance: f64| (CHI_SQUARED_95 * variance.max(0.0)).sqrt();
    // The long axis turns by half the angle of (north - east, 2 mixed), clockwise from north.
    let turned = 0.5 * libm::atan2(2.0 * mixed, north - east);
    let orientation = if turned < 0.0 { turned + std::f64::consts::PI } else { turned };
    LandingEllipse {
        centre,
        covariance_m2,
        semi_major_m: axis(middle + half),
        semi_minor_m: axis(middle - half),
        orientation: Angle::from_radians(orientation),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally_of(places: &[(f64, f64)]) -> LandingSummary {
        let mut tally = LandingTally::default();
        let planned = Some(Point2::new(1e6, -2e6));
        for &(x, y) in places {
            tally.add(&Landing { hop: 0, error_m: libm::hypot(x, y), rest: Point2::new(1e6 + x, -2e6 + y) }, planned);
        }
        tally.summary(1, planned).unwrap()
    }

    #[test]
    fn ellipses_have_the_axes_and_the_direction_of_their_places() {
        // Along the bearing 30 degrees by 2 both ways, across it by 1 both ways: variances 4 x 2/3 and 2/3.
        let (sine, cosine) = (0.5, 3f64.sqrt() / 2.0);
        let found = tally_of(&[(2.0 * sine, 2.0 * cosine), (-2.0 * sine, -2.0 * cosine), (cosine, -sine), (-cosine, sine)]);
        let ellipse = found.ellipse.unwrap();
        assert!((ellipse.orientation.degrees() - 30.0).abs() < 1e-6);
        assert!((ellipse.semi_major_m - (CHI_SQUARED_95 * 8.0 / 3.0).sqrt()).abs() < 1e-6);
        assert!((ellipse.semi_minor_m - (CHI_SQUARED_95 * 2.0 / 3.0).sqrt()).abs() < 1e-6);
        assert!((ellipse.centre - Point2::new(1e6, -2e6)).norm() < 1e-6);
        assert!(found.count == 4 && (found.error.max_m - 2.0).abs() < 1e-12);
        assert!((found.error.mean_m - 1.5).abs() < 1e-12);
        // North-west to south-east: 135 degrees.
        let west = tally_of(&[(1.0, -1.0), (-1.0, 1.0)]).ellipse.unwrap();
        assert!((west.orientation.degrees() - 135.0).abs() < 1e-6 && west.semi_minor_m < 1e-6);
    }

    #[test]
    fn one_landing_is_a_point() {
        let found = tally_of(&[(3.0, 4.0)]);
        let ellipse = found.ellipse.unwrap();
        assert_eq!((ellipse.semi_major_m, ellipse.semi_minor_m), (0.0, 0.0));
        assert_eq!(found.error.q95_m, 5.0, "no quantile is over the largest value");
    }
}
