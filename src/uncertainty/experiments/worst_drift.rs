//! The worst bounce-and-roll displacement of a hundred flights from each landing (P section V-B, Fig. 6b).

use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::ground::{FreeArc, comes_down};
use crate::{
    chain::ConstrainedChain,
    path::Hop,
    quantity::{ChainPoint, standard_normals},
    world::Direction,
};

/// The readings of the paper's description, which leaves two things open: the rate of the noise, and which landing is the farthest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DriftReading {
    /// One draw of noise per axis, added to the landing point; farthest from that hop's planned landing (model section 6).
    #[default]
    NoiseAtLanding,
    /// One draw of noise per axis for every step of 0.1 s of flight, all added to the landing point; farthest as above.
    NoiseInFlight,
    /// Noise at the landing; the landing farthest from the goal is kept: the robot that lags behind the most.
    FarthestFromGoal,
}

impl DriftReading {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::NoiseAtLanding, Self::NoiseInFlight, Self::FarthestFromGoal];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoiseAtLanding => "noise-at-landing",
            Self::NoiseInFlight => "noise-in-flight",
            Self::FarthestFromGoal => "farthest-from-goal",
        }
    }
}

crate::quantity::by_name!(DriftReading, DriftReading::ALL);

/// The paper's experiment in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftExperiment {
    /// The reading.
    pub reading: DriftReading,
    /// The number of flights from each landing.
    pub flights: u32,
    /// Variance of the noise on each axis, m^2.
    pub noise_variance_m2: f64,
    /// Variances of the take-off about the previous landing, along, across and up, m^2.
    pub takeoff_variances_m2: [f64; 3],
    /// The seed of all draws.
    pub seed: u64,
}

impl DriftExperiment {
    /// The paper's numbers: 100 flights, noise of 0.1 m^2, take-offs scattered by (1, 1, 0.1) m^2.
    pub const fn of_the_paper(reading: DriftReading, seed: u64) -> Self {
        Self { reading, flights: 100, noise_variance_m2: 0.1, takeoff_variances_m2: [1.0, 1.0, 0.1], seed }
    }
}

/// The landings of one hop.
#[derive(Clone, Debug, PartialEq)]
pub struct DriftLanding {
    /// Distance in three dimensions from this hop's planned landing, m, for every flight that came down, in the order of flights.
    pub errors_m: Vec<f64>,
    /// The landings: along the chain, to its left, up, m.
    pub landings_m: Vec<Point3<f64>>,
    /// The take-offs, in the same order.
    pub takeoffs_m: Vec<Point3<f64>>,
    /// The number of flights that never came down: they began too deep below the ground to rise above it.
    pub lost: u32,
    /// The landing from which the next flights start.
    pub farthest_m: Point3<f64>,
}

impl DriftLanding {
    /// Root mean square distance of the landings from their mean, m: what this hop adds, without the inherited displacement; `None`
    /// without a landing.
    ///
    /// For two landings 2 m apart it is 1 m.
    pub fn spread_m(&self) -> Option<f64> {
        let count = self.landings_m.len();
        #[expect(clippy::cast_precision_loss, reason = "a hundred flights")]
        let share = 1.0 / count as f64;
        let mean = self.landings_m.iter().map(|landing| landing.coords).sum::<Vector3<f64>>() * share;
        let square_m2 = self.landings_m.iter().map(|landing| (landing.coords - mean).norm_squared()).sum::<f64>() * share;
        (count > 0).then(|| square_m2.sqrt())
    }
}

/// Time step of the noise for [`DriftReading::NoiseInFlight`], s; the paper does not state it.
const STEP_S: f64 = 0.1;

/// Flies the paper's experiment along a planned path.
///
/// The first hundred flights start exactly at the planned start and differ by noise only. Every flight has the planned speed, angle
/// and direction of its hop; it lands where its parabola first comes down on the chain, which is extended unchanged to both sides
/// of the plane of travel, and beyond its ends as its first and last segments. The farthest landing is the centre of the next
/// hundred take-offs, so displacements accumulate.
///
/// Source: P section V-B; model section 6.
///
/// # Returns
/// One entry per hop; fewer if no flight of a hop came down.
pub fn worst_drift(chain: &ConstrainedChain, hops: &[Hop], experiment: &DriftExperiment) -> Vec<DriftLanding> {
    let scatter = |_: &Hop| experiment.takeoff_variances_m2.map(f64::sqrt);
    drift_with(chain, hops, experiment, &scatter)
}

/// The same with the standard deviations of the take-offs given by the previous hop.
pub(super) fn drift_with(
    chain: &ConstrainedChain,
    hops: &[Hop],
    experiment: &DriftExperiment,
    takeoff_sigmas_m: &dyn Fn(&Hop) -> [f64; 3],
) -> Vec<DriftLanding> {
    let Some(goal) = hops.last().map(|hop| solid(hop.landing.in_profile())) else { return Vec::new() };
    let mut landings: Vec<DriftLanding> = Vec::new();
    let mut centre = solid(hops[0].takeoff.in_profile());
    let mut sigmas_m = [0.0; 3];
    for (number, hop) in hops.iter().enumerate() {
        let landing = hundred(chain, hop, experiment, number as u64, (centre, sigmas_m), goal);
        if landing.errors_m.is_empty() {
            break;
        }
        centre = landing.farthest_m;
        sigmas_m = takeoff_sigmas_m(hop);
        landings.push(landing);
    }
    landings
}

/// A point of the plane of travel in three dimensions.
fn solid(point: ChainPoint) -> Point3<f64> {
    Point3::new(point.x_m, 0.0, point.z_m)
}

/// All flights of one hop. Each flight has its own random stream, so other hops and other experiments with the same seed share the
/// same draws.
fn hundred(
    chain: &ConstrainedChain,
    hop: &Hop,
    experiment: &DriftExperiment,
    number: u64,
    (centre, sigmas_m): (Point3<f64>, [f64; 3]),
    goal: Point3<f64>,
) -> DriftLanding {
    let planned = solid(hop.landing.in_profile());
    let mut landing =
        DriftLanding { errors_m: Vec::new(), landings_m: Vec::new(), takeoffs_m: Vec::new(), lost: 0, farthest_m: centre };
    let mut farthest_m = f64::NEG_INFINITY;
    let mut draws = ChaCha8Rng::seed_from_u64(experiment.seed);
    for flight in 0..experiment.flights {
        draws.set_stream((number << 32) | u64::from(flight));
        draws.set_word_pos(0);
        let [along, across, up, _] = four(&mut draws);
        let from = Point3::new(centre.x + sigmas_m[0] * along, centre.y + sigmas_m[1] * across, centre.z + sigmas_m[2] * up);
        let Some(contact) = flown(chain, hop, from) else {
            landing.lost += 1;
            continue;
        };
        let noise = noise_sigma_m(hop, experiment);
        let [along, across, up, _] = four(&mut draws);
        let at = Point3::new(contact.x + noise * along, contact.y + noise * across, contact.z + noise * up);
        let away_m = match experiment.reading {
            DriftReading::NoiseAtLanding | DriftReading::NoiseInFlight => (at - planned).norm(),
            DriftReading::FarthestFromGoal => (at - goal).norm(),
        };
        if away_m > farthest_m {
            (farthest_m, landing.farthest_m) = (away_m, at);
        }
        landing.errors_m.push((at - planned).norm());
        landing.landings_m.push(at);
        landing.takeoffs_m.push(from);
    }
    landing
}

/// Standard deviation of the noise on one axis of a landing, m: the variances of independent steps add up.
fn noise_sigma_m(hop: &Hop, experiment: &DriftExperiment) -> f64 {
    let steps = match experiment.reading {
        DriftReading::NoiseAtLanding | DriftReading::FarthestFromGoal => 1.0,
        DriftReading::NoiseInFlight => (hop.flight_time_s / STEP_S).ceil(),
    };
    (experiment.noise_variance_m2 * steps).sqrt()
}

/// Where a hop with the planned command lands if it starts at another point.
fn flown(chain: &ConstrainedChain, hop: &Hop, from: Point3<f64>) -> Option<Point3<f64>> {
    let (slope, horizontal_m_s) = (hop.takeoff_angle.slope(), hop.horizontal_speed_m_s());
    let sign = if hop.direction == Direction::Forward { 1.0 } else { -1.0 };
    let bend_per_m = chain.gravity().m_s2() / (2.0 * horizontal_m_s * horizontal_m_s);
    let (x_m, z_m) = comes_down(chain.geometry(), &FreeArc { x_m: from.x, z_m: from.z, sign, slope, bend_per_m })?;
    Some(Point3::new(x_m, from.y, z_m))
}

/// Four standard normals.
fn four(draws: &mut ChaCha8Rng) -> [f64; 4] {
    let mut two = || standard_normals([draws.random::<f64>(), draws.random::<f64>()]);
    let ([a, b], [c, d]) = (two(), two());
    [a, b, c, d]
}
