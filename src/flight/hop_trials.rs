//! How reliably one hop is flown: the share of fixed draws of its errors that it survives.

use nalgebra::{Point2, Vector2};

use super::{
    Command, Distribution, Errors, TrialDraws, Uncertainty,
    quasi::{FixedDraw, fixed_draws},
    resting_at,
};
use crate::ground::{FirstContact, Realization, Windows};

/// Draws of every hop in a search.
pub(crate) const SEARCHED_DRAWS: u32 = 64;

/// Draws of a hop that is reported.
pub(crate) const REPORTED_DRAWS: u32 = 256;

/// The most vertices or posts that all realizations of a ground with random heights may have together.
const REALIZED_POINTS_MAX: usize = 1 << 22;

/// One hop to be judged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JudgedHop<C> {
    /// Where it is planned to begin.
    pub(crate) from: C,
    /// Its command.
    pub(crate) command: Command<C>,
    /// Standard deviation of the take-off position about `from`, m: along the heading and to its left.
    pub(crate) takeoff_sigma_m: [f64; 2],
    /// For the last hop: the goal, and how near to it the hopper has to come to rest, m.
    pub(crate) goal: Option<(Point2<f64>, f64)>,
    /// Whether the robot makes the command anew where it is, and so accounts for its bounces.
    pub(crate) aims_at_rest: bool,
}

/// What became of the draws of a hop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Survival {
    /// How many draws were flown.
    pub(crate) of: u32,
    /// How many of them failed.
    pub(crate) failed: u32,
    /// Mean square distance of the places of rest from the planned landing over the draws that survived, along the heading and to its
    /// left, m^2.
    pub(crate) spread_m2: [f64; 2],
}

/// Fixed draws of the errors of a hop, flown by the code that flies trials.
///
/// ```text
///     share that fails = 1/K sum [draw k leaves the take-off cone, or leaves the known ground, or lands out of its cone, too fast,
///                                 on ground that holds no contact, or rests too far from the goal]
/// ```
///
/// All hops are judged by the same draws, so that two hops differ by their own risk and not by chance. Errors that last for a whole trial
/// (biases, friction, heights) are drawn with the others, as a hop has them without knowledge of the hops before it; of measured errors
/// every draw has a row.
#[derive(Clone, Debug)]
pub(crate) struct HopTrials<G> {
    draws: Vec<FixedDraw>,
    /// The ground as the robot knows it.
    nominal: G,
    plain: Errand<G>,
    doubled: Errand<G>,
}

/// The errors of one size, and the grounds they are flown over: one, or one for each realization.
#[derive(Clone, Debug)]
struct Errand<G> {
    errors: Errors,
    grounds: Vec<G>,
}

impl<G: FirstContact + Windows> HopTrials<G> {
    /// A number of draws of these errors over a ground that has this many points to realize. `of_takeoffs`: the distribution of the take-off
    /// position.
    pub(crate) fn new(ground: &G, uncertainty: &Uncertainty, of_takeoffs: Distribution, points: usize, count: u32) -> Self {
        let draws = fixed_draws(count, uncertainty.distribution, of_takeoffs);
        let errand = |uncertainty: Uncertainty| {
            let errors = Errors::new(uncertainty.clone(), false);
            let realizations = if uncertainty.height_sigma_m > 0.0 {
                (REALIZED_POINTS_MAX / points.max(1)).clamp(4, draws.len())
            } else if uncertainty.friction_sigma > 0.0 {
                draws.len()
            } else {
                0
            };
            let realized = |number: usize| {
                let mut ground = ground.clone();
                let heights = errors.realization(&mut TrialDraws::seeded(0), number as u64).and_then(|drawn| drawn.heights);
                let friction = uncertainty.friction_sigma * draws[number].friction;
                ground.realize(Realization { friction, heights });
                ground
            };
            let grounds = if realizations == 0 { vec![ground.clone()] } else { (0..realizations).map(realized).collect() };
            Errand { errors, grounds }
        };
        Self { nominal: ground.clone(), plain: errand(uncertainty.clone()), doubled: errand(uncertainty.scaled(2.0)), draws }
    }

    /// The ground without errors of heights or friction.
    pub(crate) const fn ground(&self) -> &G {
        &self.nominal
    }

    /// What becomes of a hop under the errors; `enough`: the count of failures after which no more draws are flown.
    pub(crate) fn survival(&self, hop: &JudgedHop<G::Contact>, enough: u32) -> Survival {
        self.flown(&self.plain, hop, 1.0, enough)
    }

    /// The share of draws that fail when every error is twice as large.
    pub(crate) fn failing_share_of_doubled(&self, hop: &JudgedHop<G::Contact>) -> f64 {
        let Survival { of, failed, .. } = self.flown(&self.doubled, hop, 2.0, u32::MAX);
        f64::from(failed) / f64::from(of)
    }

    fn flown(&self, errand: &Errand<G>, hop: &JudgedHop<G::Contact>, scale: f64, enough: u32) -> Survival {
        let command = if hop.aims_at_rest { resting_at(&self.nominal, &hop.from, hop.command) } else { hop.command };
        let hop = &JudgedHop { command, ..*hop };
        let mut survival = Survival::default();
        for (number, draw) in self.draws.iter().enumerate() {
            let ground = &errand.grounds[number % errand.grounds.len()];
            survival.of += 1;
            match rest(ground, &errand.errors, hop, draw, scale) {
                Some(away_m) => {
                    for (sum, away_m) in survival.spread_m2.iter_mut().zip(away_m) {
                        *sum += away_m * away_m;
                    }
                }
                None => survival.failed += 1,
            }
            if survival.failed >= enough {
                break;
            }
        }
        let survived = f64::from((survival.of - survival.failed).max(1));
        survival.spread_m2 = survival.spread_m2.map(|sum| sum / survived);
        survival
    }
}

/// How far from its planned landing a drawn hop comes to rest, m; `None` if it fails.
fn rest<G: FirstContact>(
    ground: &G,
    errors: &Errors,
    hop: &JudgedHop<G::Contact>,
    draw: &FixedDraw,
    scale: f64,
) -> Option<[f64; 2]> {
    let heading = hop.command.liftoff.heading;
    let [along_m, left_m] = [0, 1].map(|axis| scale * hop.takeoff_sigma_m[axis] * draw.takeoff[axis]);
    let scatter_m = along_m * heading + left_m * Vector2::new(-heading.y, heading.x);
    let planned = if scatter_m == Vector2::zeros() { hop.from } else { ground.believed(&hop.from, scatter_m.x, scatter_m.y)? };
    let from = ground.realized(planned);
    let drawn = errors.fixed(draw);
    let liftoff = errors.liftoff(&hop.command.liftoff, hop.command.speed_m_s, &drawn);
    if !liftoff.stays() && !ground.holds_takeoff(&from, &liftoff) {
        return None;
    }
    let flown = drawn.fly(ground, &from, &liftoff, &hop.command.aim);
    if flown.failure.is_some() {
        return None;
    }
    let at = ground.point(&flown.rest).xy();
    if hop.goal.is_some_and(|(goal, tolerance_m)| (at - goal).norm() > tolerance_m) {
        return None;
    }
    let away = at - ground.point(&hop.command.rest).xy();
    Some([away.dot(&heading), heading.x * away.y - heading.y * away.x])
}
