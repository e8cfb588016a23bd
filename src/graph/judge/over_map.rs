//! How reliably a robot that replans over a map flies its hops: in closed form, to weigh millions of them, and by flown draws, to choose
//! the command of one.

use nalgebra::Vector2;

use super::{LEAST_SUCCESS, most_reliable};
use crate::{
    ballistics::{Arc, FlightEnvelope, LineOfSight, TakeoffChoice},
    flight::{Command, HopTrials, JudgedHop, SEARCHED_DRAWS, Uncertainty},
    ground::{DemGround, MapPosition, Post, Surface},
    quantity::{Angle, SlopeInterval, normal_cdf},
};

/// Judges hops over a map, without a chain.
#[derive(Clone, Debug)]
pub(crate) struct MapJudge {
    trials: HopTrials<DemGround>,
    /// Under the limits that planning may use.
    planning: FlightEnvelope,
    errors: Uncertainty,
    takeoff: TakeoffChoice,
}

impl MapJudge {
    /// What every hop weighs beside its risk, so that a robot does not go in circles, nor take many short hops for a long one.
    ///
    /// Measured on twelve journeys over both DEMs of the tests, with 2 % of speed and 1 degree: with 0.01 and 0.02 0.98 of the trials
    /// reach the goal, with 0.05 0.97, with 0.1 0.96.
    pub(crate) const EACH_HOP: f64 = 0.02;

    pub(crate) fn new(ground: &DemGround, errors: &Uncertainty, takeoff: TakeoffChoice) -> Self {
        let trials = HopTrials::new(ground, errors, errors.distribution, 1, SEARCHED_DRAWS);
        Self { trials, planning: *ground.envelope(), errors: errors.clone(), takeoff }
    }

    /// The same for commands that are planned within the limits of another envelope.
    #[must_use]
    pub(crate) const fn planned_within(mut self, planning: &FlightEnvelope) -> Self {
        self.planning = *planning;
        self
    }

    /// The command of a hop from where the robot believes to be: by the choice of take-offs.
    pub(crate) fn command(
        &self,
        (from, to): (&MapPosition, &MapPosition),
        heading: Vector2<f64>,
        (sight, lofts): (LineOfSight, SlopeInterval),
    ) -> Command<MapPosition> {
        let envelope = &self.planning;
        let command = |loft| Command::of_arc(&Arc::new(sight, loft, envelope.gravity_m_s2()), heading, *to);
        if self.takeoff != TakeoffChoice::MostReliable {
            return command(envelope.loft(self.takeoff, sight, lofts));
        }
        let takeoff_sigma_m = [self.errors.position_sigma_m; 2];
        command(most_reliable(envelope, (sight, lofts), |loft, enough| {
            let hop = JudgedHop { from: *from, command: command(loft), takeoff_sigma_m, goal: None, aims_at_rest: true };
            self.trials.survival(&hop, enough).failed
        }))
    }

    /// The choice of take-offs.
    pub(crate) const fn takeoff(&self) -> TakeoffChoice {
        self.takeoff
    }

    /// An estimate of the weight of a hop to a post of the DEM, in closed form: for the command chosen (the
    /// middle one for the most reliable), the probability that its angle
    /// stays inside the feasible window and its landing below the speed limit, and the share of the facets around the post that hold it.
    ///
    /// At least [`EACH_HOP`](Self::EACH_HOP). Measured errors are left to the trials, which fly them.
    pub(crate) fn estimate(&self, post: Post, heading: Vector2<f64>, (sight, lofts): (LineOfSight, SlopeInterval)) -> f64 {
        let envelope = &self.planning;
        let arc = Arc::new(sight, envelope.loft(self.takeoff, sight, lofts), envelope.gravity_m_s2());
        let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
        let flown = arc.takeoff_angle().radians();
        let inside = |room: f64, sigma: f64| if sigma > 0.0 { normal_cdf(room / sigma) } else { 1.0 };
        let errors = &self.errors;
        let sigma = libm::hypot(errors.takeoff_angle_sigma.radians(), errors.takeoff_angle_bias_sigma.radians());
        let of_angle = inside(flown - angle(lofts.lower), sigma) + inside(angle(lofts.upper) - flown, sigma) - 1.0;
        let limits = self.trials.ground().hopper().limits();
        let of_speed = if limits.landing.brakes() {
            1.0
        } else {
            // v_l^2 = v_t^2 - 2 g Z: an error of the take-off speed is one of the landing speed, times v_t / v_l.
            let (takeoff_m_s, landing_m_s) = (arc.takeoff_speed_m_s(), arc.landing_speed_m_s());
            let fraction = libm::hypot(errors.takeoff_speed_sigma_fraction, errors.takeoff_speed_bias_sigma_fraction);
            let sigma_m_s = libm::hypot(fraction * takeoff_m_s, errors.takeoff_speed_sigma_m_s);
            inside((limits.landing_speed_max_m_s - landing_m_s) * landing_m_s, sigma_m_s * takeoff_m_s)
        };
        let of_ground = 1.0 - self.trials.ground().refusing_share(post, heading, arc.landing_slope());
        Self::EACH_HOP - libm::log((of_angle * of_speed * of_ground).clamp(LEAST_SUCCESS, 1.0))
    }
}
