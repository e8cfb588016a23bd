//! All limits except the terrain, evaluated for a block of landings at once.

use super::table::{LandingRules, LandingTable};
use crate::{ballistics::LineOfSight, hop::HopTest, quantity::SlopeInterval, world::Limit};

/// The data of a take-off that all landings share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    pub(super) x_m: f64,
    pub(super) z_m: f64,
    /// The greatest take-off speed with its tolerance, squared, m^2/s^2.
    pub(super) speed_squared: f64,
    /// The take-off cone of the ground.
    pub(super) cone: SlopeInterval,
}

/// The results of the flight envelope for one block of landings. The formulas are those of [`HopTest::lofts`], operation by
/// operation, so that every number is the same to the last bit. They are written so that the compiler can vectorise over
/// landings.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    /// Slope of the line of sight.
    slope: [f64; Self::COUNT],
    /// The take-off speed limit minus the least take-off speed, as ratios v^2 / (g X); below 0 the hop is too slow.
    takeoff_excess: [f64; Self::COUNT],
    /// The same for the landing speed.
    landing_excess: [f64; Self::COUNT],
    /// The lofts that both speeds allow.
    slowest: [f64; Self::COUNT],
    fastest: [f64; Self::COUNT],
    /// The lofts that all limits except the terrain allow.
    lower: [f64; Self::COUNT],
    upper: [f64; Self::COUNT],
    /// Above 0 where a kink of a tapered clearance, or the ground near the landing, may ask for more loft than the other limits.
    near_excess: [f64; Self::COUNT],
}

impl Lanes {
    /// The greatest number of landings in one block.
    pub(super) const COUNT: usize = LandingTable::BLOCK;

    pub(super) const fn new() -> Self {
        let zeros = [0.0; Self::COUNT];
        Self {
            slope: zeros,
            takeoff_excess: zeros,
            landing_excess: zeros,
            slowest: zeros,
            fastest: zeros,
            lower: zeros,
            upper: zeros,
            near_excess: zeros,
        }
    }

    /// Evaluates the landings `range` of the table, at most [`Self::COUNT`] of them, none on a segment of the take-off.
    ///
    /// With a tapered clearance, `seen` is the slope at which the ground one ramp away is seen from the take-off.
    pub(super) fn evaluate(
        &mut self,
        test: &HopTest,
        from: &Departure,
        positions: (&[f64], &[f64]),
        rules: &LandingRules,
        range: std::ops::Range<usize>,
        seen: f64,
    ) {
        if test.clearance().has_kinks() {
            self.evaluate_with::<true>(test, from, positions, rules, range, seen);
        } else {
            self.evaluate_with::<false>(test, from, positions, rules, range, seen);
        }
    }

    /// The same, with or without the near ground of a tapered clearance.
    ///
    /// At hops of at least two ramps, a kink or a vertex nearer than one ramp to the landing asks for no more than
    /// `(h / w + k) X / (X - w)` with the steepest of them (see [`NearGround`](super::near::NearGround)). Without a division:
    /// `(h/w + k) X` is compared with `n (X - w)`, with a margin for rounding.
    #[inline]
    fn evaluate_with<const TAPERED: bool>(
        &mut self,
        test: &HopTest,
        from: &Departure,
        (x_m, z_m): (&[f64], &[f64]),
        rules: &LandingRules,
        range: std::ops::Range<usize>,
        seen: f64,
    ) {
        /// Far more than rounding. Lofts that the speeds allow are above 0.
        const NEARLY: f64 = 1.0 - 1e-12;
        let count = range.len().min(Self::COUNT);
        let cone = from.cone.intersect(test.mechanism_slopes());
        let gravity = test.gravity_m_s2();
        let (x_m, z_m) = (&x_m[range.clone()][..count], &z_m[range.clone()][..count]);
        let speed_squared = &rules.speed_squared[range.clone()][..count];
        let (cone_lower, cone_upper) = (&rules.cone_lower[range.clone()][..count], &rules.cone_upper[range.clone()][..count]);
        let steepest_back = if TAPERED { &rules.steepest_back[range][..count] } else { &[] };
        let (taper, ramp_m) = (test.clearance().taper(), test.clearance().ramp_m());
        let near_excess = &mut self.near_excess[..count];
        let (slope, takeoff_excess) = (&mut self.slope[..count], &mut self.takeoff_excess[..count]);
        let (landing_excess, slowest) = (&mut self.landing_excess[..count], &mut self.slowest[..count]);
        let (fastest, lower, upper) = (&mut self.fastest[..count], &mut self.lower[..count], &mut self.upper[..count]);
        for i in 0..count {
            let run_m = (x_m[i] - from.x_m).abs();
            let b = (z_m[i] - from.z_m) / run_m;
            let secant = (1.0 + b * b).sqrt();
            // The two least speed ratios are reciprocals of each other; the sign of b decides which one belongs to the
            // take-off.
            let steep = secant + b.abs();
            let gentle = 1.0 / steep;
            let gravity_run = gravity * run_m;
            let takeoff = from.speed_squared / gravity_run - if b >= 0.0 { steep } else { gentle };
            let landing = speed_squared[i] / gravity_run - if b <= 0.0 { steep } else { gentle };
            let excess = takeoff.min(landing);
            let half_sum = secant + excess;
            let larger = half_sum + excess.sqrt() * (half_sum + secant).sqrt();
            let smaller = secant * (secant / larger);
            slope[i] = b;
            takeoff_excess[i] = takeoff;
            landing_excess[i] = landing;
            slowest[i] = smaller;
            fastest[i] = larger;
            let least = smaller.max(cone.lower - b).max(b - cone_upper[i]);
            let greatest = larger.min(cone.upper - b).min(b - cone_lower[i]);
            // An excess below 0 has no roots: the interval is empty.
            lower[i] = least;
            upper[i] = if excess >= 0.0 { greatest } else { f64::NEG_INFINITY };
            if TAPERED {
                let (ahead, back) = (seen - b, b + steepest_back[i]);
                let over = if back > ahead { back } else { ahead };
                let excess = (over + taper) * run_m - least * (run_m - ramp_m) * NEARLY;
                near_excess[i] = if run_m < 2.0 * ramp_m { f64::INFINITY } else { excess };
            }
        }
        if test.has_flight_limits() {
            for (i, x_m) in x_m.iter().enumerate() {
                let flight = test.flight_limits(LineOfSight::along((x_m - from.x_m).abs(), self.slope[i]));
                self.lower[i] = self.lower[i].max(flight.lower);
                self.upper[i] = self.upper[i].min(flight.upper);
            }
        }
    }

    /// Whether a kink or the ground near the landing may ask for more loft than the other limits of a lane: always for a hop shorter than
    /// two ramps.
    #[inline]
    pub(super) fn near_ground_may_bind(&self, lane: usize) -> bool {
        self.near_excess[lane] > 0.0
    }

    /// The lofts of one lane; `None` if empty.
    #[inline]
    pub(super) fn lofts(&self, lane: usize) -> Option<SlopeInterval> {
        let lofts = SlopeInterval { lower: self.lower[lane], upper: self.upper[lane] };
        (lofts.lower <= lofts.upper && lofts.upper > 0.0).then_some(lofts)
    }

    /// The limit that leaves no arc in a lane, in the order of [`HopTest::lofts`].
    pub(super) fn refusing(&self, test: &HopTest, from: &Departure, lane: usize, run_m: f64, landing_cone: SlopeInterval) -> Limit {
        for (excess, limit) in [(self.takeoff_excess[lane], Limit::TakeoffSpeed), (self.landing_excess[lane], Limit::LandingSpeed)]
        {
            if excess.is_nan() || excess < 0.0 {
                return limit;
            }
        }
        let left = SlopeInterval { lower: self.slowest[lane], upper: self.fastest[lane] };
        test.refusing_after_speeds(LineOfSight::along(run_m, self.slope[lane]), left, from.cone, landing_cone)
    }

    /// The slope of the line of sight of a lane.
    #[inline]
    pub(super) const fn slope(&self, lane: usize) -> f64 {
        self.slope[lane]
    }
}
