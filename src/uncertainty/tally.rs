//! Statistics that accumulate trial by trial in bounded memory.

use nalgebra::{Matrix2, Point2, Vector2};

use super::{
    ErrorSummary, LandingEllipse, LandingSummary, OutcomeCounts, QuantileSketch, RatePoint, TrialOutcome, Wilson, trial::Landing,
};
use crate::quantity::Angle;

/// The 95 % quantile of the chi-squared distribution with two degrees of freedom, `-2 ln 0.05`.
const CHI_SQUARED_95: f64 = 5.991_464_547_107_979;

/// The most points of the record of the rate; beyond it every second point is dropped.
const MOST_RATE_POINTS: usize = 1000;

/// Numbers of trials before the end of the first batch at which the rate is noted, so that short runs have a curve too.
const EARLY: [u64; 6] = [10, 20, 50, 100, 200, 500];

/// The statistics of all trials so far. Trials must be added in their order: sums of floating-point numbers depend on it.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) outcomes: OutcomeCounts,
    pub(super) hops_flown: u64,
    landings: Vec<LandingTally>,
    /// The rate before the first batch ended.
    early: Vec<RatePoint>,
    /// The rate at the ends of batches.
    convergence: Vec<RatePoint>,
    /// Batches from one point of the record to the next.
    stride: u64,
    batches: u64,
}

/// The landings of all trials' hops with one number.
#[derive(Debug, Default)]
struct LandingTally {
    errors: QuantileSketch,
    sum_m: f64,
    max_m: f64,
    /// The first position of rest; the sums below are relative to it, so that large map coordinates do not cost digits.
    origin: Option<Point2<f64>>,
    away_m: Vector2<f64>,
    squares_m2: Matrix2<f64>,
}

impl Tally {
    /// How many trials have reached the goal.
    pub(super) fn reached_goal(&self) -> u64 {
        self.outcomes.of(TrialOutcome::Reached)
    }

    pub(super) fn success(&self) -> Wilson {
        Wilson::of(self.reached_goal(), self.outcomes.total())
    }

    pub(super) fn trial(&mut self, outcome: TrialOutcome, hops: u32) {
        self.outcomes.count(outcome);
        self.hops_flown += u64::from(hops);
        if self.batches == 0 && EARLY.contains(&self.outcomes.total()) {
            self.early.push(self.rate());
        }
    }

    /// The rate now.
    fn rate(&self) -> RatePoint {
        RatePoint { trials: self.outcomes.total(), success: self.success() }
    }

    pub(super) fn landing(&mut self, landing: &Landing) {
        let hop = usize::try_from(landing.hop).unwrap_or(usize::MAX);
        while self.landings.len() <= hop {
            self.landings.push(LandingTally::default());
        }
        if let Some(tally) = self.landings.get_mut(hop) {
            tally.add(landing);
        }
    }

    /// Notes the rate at the end of a batch.
    pub(super) fn end_batch(&mut self) {
        self.batches += 1;
        self.stride = self.stride.max(1);
        if self.batches.is_multiple_of(self.stride) {
            self.convergence.push(self.rate());
        }
        if self.convergence.len() > MOST_RATE_POINTS {
            let mut number = 0;
            self.convergence.retain(|_| {
                number += 1;
                number % 2 == 0
            });
            self.stride *= 2;
        }
    }

    /// The record of the rate, ending with the present rate.
    pub(super) fn convergence(&self) -> Vec<RatePoint> {
        let now = self.rate();
        let first_batch = self.convergence.first().map_or(now.trials, |point| point.trials);
        let early = self.early.iter().filter(|point| point.trials < first_batch);
        let mut points: Vec<RatePoint> = early.chain(&self.convergence).copied().collect();
        if points.last().is_none_or(|last| last.trials < now.trials) {
            points.push(now);
        }
        points
    }

    /// The landings by the number of their hop.
    pub(super) fn landings(&self, on_a_map: bool) -> Vec<LandingSummary> {
        let of = |(hop, tally): (u32, &LandingTally)| tally.summary(hop, on_a_map);
        (1..).zip(&self.landings).filter_map(of).collect()
    }
}

impl LandingTally {
    fn add(&mut self, landing: &Landing) {
        self.errors.add(landing.error_m);
        self.sum_m += landing.error_m;
        self.max_m = self.max_m.max(landing.error_m);
        let away = landing.rest - *self.origin.get_or_insert(landing.rest);
        self.away_m += away;
        self.squares_m2 += away * away.transpose();
    }

    #[expect(clippy::cast_precision_loss, reason = "fewer landings than 2^53")]
    fn summary(&self, hop: u32, on_a_map: bool) -> Option<LandingSummary> {
        let count = self.errors.count();
        let n = count as f64;
        // The middle of the last bin may lie beyond the largest value.
        let quantile = |share: f64| self.errors.quantile(share).map(|value| value.min(self.max_m));
        let error = ErrorSummary {
            mean_m: self.sum_m / n,
            q05_m: quantile(0.05)?,
            q25_m: quantile(0.25)?,
            q50_m: quantile(0.5)?,
            q75_m: quantile(0.75)?,
            q95_m: quantile(0.95)?,
            max_m: self.max_m,
        };
        let mean = self.away_m / n;
        let covariance_m2 = if count > 1 { (self.squares_m2 - mean * mean.transpose() * n) / (n - 1.0) } else { Matrix2::zeros() };
        let ellipse = self.origin.filter(|_| on_a_map).map(|origin| ellipse(origin + mean, covariance_m2));
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
        let mut tally = Tally::default();
        for &(x, y) in places {
            tally.landing(&Landing { hop: 0, error_m: libm::hypot(x, y), rest: Point2::new(1e6 + x, -2e6 + y) });
        }
        tally.landings(true).remove(0)
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

    #[test]
    fn short_runs_have_a_record_of_their_rate_too() {
        let mut tally = Tally::default();
        for trial in 1..=200u64 {
            tally.trial(if trial <= 15 { TrialOutcome::Lost } else { TrialOutcome::Reached }, 1);
        }
        tally.end_batch();
        let points = tally.convergence();
        assert_eq!(points.iter().map(|point| point.trials).collect::<Vec<_>>(), [10, 20, 50, 100, 200]);
        let rates: Vec<f64> = points.iter().map(|point| point.success.rate).collect();
        assert_eq!(rates, [0.0, 5.0 / 20.0, 35.0 / 50.0, 85.0 / 100.0, 185.0 / 200.0]);
    }

    #[test]
    fn the_record_of_the_rate_is_thinned_and_keeps_its_end() {
        let mut tally = Tally::default();
        for batch in 0..5_001u64 {
            tally.trial(if batch % 3 == 0 { TrialOutcome::Reached } else { TrialOutcome::Lost }, 1);
            tally.end_batch();
        }
        let points = tally.convergence();
        assert!(points.len() <= MOST_RATE_POINTS + 1);
        assert!(points.windows(3).all(|p| p[2].trials <= 5000 && p[1].trials - p[0].trials == 8 || p[2].trials == 5001));
        assert_eq!(points.last().unwrap().trials, 5001);
    }
}
