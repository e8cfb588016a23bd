//! How reliably a robot that replans over a map flies its hops: in closed form, to weigh millions of them, and by flown draws, to choose
//! the command of one.

use nalgebra::Vector2;

use super::{LEAST_SUCCESS, most_reliable};
use crate::{
    ballistics::{Arc, FlightEnvelope, LineOfSight, TakeoffChoice},
    flight::{Command, CommandSpread, HopTrials, JudgedHop, MeasuredRow, SEARCHED_DRAWS, Uncertainty},
    ground::{DemGround, LandingScatter, MapPosition, Surface},
    quantity::{Angle, SlopeInterval},
    world::FrictionCone,
};

/// Judges hops over a map, without a chain.
#[derive(Clone, Debug)]
pub(crate) struct MapJudge {
    trials: HopTrials<DemGround>,
    /// Under the limits that planning may use.
    planning: FlightEnvelope,
    spread: CommandSpread,
    /// Of every landing, whatever the hop.
    beside_command: LandingScatter,
    /// Standard deviation of the heading, rad.
    heading_sigma: f64,
    position_sigma_m: f64,
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
        let mu = ground.constant_friction().map_or(0.0, FrictionCone::coefficient);
        let root = |sigmas: [f64; 3]| sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>().sqrt();
        let rows =
            |of: fn(&MeasuredRow) -> f64| errors.measured.as_ref().map_or(0.0, |rows| rows.mean(|row| of(row) * of(row)).sqrt());
        Self {
            trials,
            planning: *ground.envelope(),
            // The cone about the normal of a facet, whose half-angle is atan(mu), is as uncertain as friction.
            spread: CommandSpread::of(errors).with_error_of_limits(errors.friction_sigma / (1.0 + mu * mu)),
            beside_command: LandingScatter {
                along_m: root([errors.drift_along_sigma_m, errors.position_sigma_m, rows(|row| row.drift_m[0])]),
                across_m: root([errors.drift_across_sigma_m, errors.position_sigma_m, rows(|row| row.drift_m[1])]),
                friction: errors.friction_sigma,
            },
            heading_sigma: root([errors.heading_sigma.radians(), errors.heading_bias_sigma.radians(), rows(|row| row.heading_rad)]),
            position_sigma_m: errors.position_sigma_m,
            takeoff,
        }
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
        let takeoff_sigma_m = [self.position_sigma_m; 2];
        command(most_reliable(envelope, (sight, lofts), |loft, enough| {
            let hop = JudgedHop { from: *from, command: command(loft), takeoff_sigma_m, goal: None, aims_at_rest: true };
            self.trials.survival(&hop, enough).failed
        }))
    }

    /// The choice of take-offs.
    pub(crate) const fn takeoff(&self) -> TakeoffChoice {
        self.takeoff
    }

    /// An estimate of the weight of a hop to a place on the DEM, in closed form: for the command chosen (the middle one for the most reliable),
    /// the probability that its angle stays inside the feasible window and its landing below the speed limit, and that the facet on which it
    /// comes down holds it.
    ///
    /// At least [`EACH_HOP`](Self::EACH_HOP). Errors of speed and angle count as independent, also where rows were measured together.
    pub(crate) fn estimate(
        &self,
        target: &MapPosition,
        heading: Vector2<f64>,
        (sight, lofts): (LineOfSight, SlopeInterval),
    ) -> f64 {
        let envelope = &self.planning;
        let arc = Arc::new(sight, envelope.loft(self.takeoff, sight, lofts), envelope.gravity_m_s2());
        let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
        let flown = arc.takeoff_angle().radians();
        let of_angle = self.spread.angle_within(flown - angle(lofts.lower), angle(lofts.upper) - flown);
        let limits = self.trials.ground().hopper().limits();
        let of_speed = if limits.landing.brakes() {
            1.0
        } else {
            self.spread.landing_speed_below(arc.takeoff_speed_m_s(), arc.landing_speed_m_s(), limits.landing_speed_max_m_s)
        };
        let of_ground =
            1.0 - self.trials.ground().refusing_share(target, heading, arc.landing_slope(), &self.landing_scatter(&arc));
        Self::EACH_HOP - libm::log((of_angle * of_speed * of_ground).clamp(LEAST_SUCCESS, 1.0))
    }

    /// How the landings of an arc scatter, to the first order: over level ground of the arc's length,
    /// `dR / R = 2 dv / v + 2 cot(2 theta) d theta`.
    fn landing_scatter(&self, arc: &Arc) -> LandingScatter {
        let run_m = arc.line_of_sight().run_m();
        let (speed, angle) = (self.spread.speed_deviation(arc.takeoff_speed_m_s()), self.spread.angle_deviation());
        let cotangent = 1.0 / libm::tan(2.0 * arc.takeoff_angle().radians());
        let of_angle_m = if angle > 0.0 { (2.0 * run_m * angle * cotangent).abs().min(run_m) } else { 0.0 };
        let of_command_m = libm::hypot(2.0 * run_m * speed, of_angle_m);
        let LandingScatter { along_m, across_m, friction } = self.beside_command;
        LandingScatter {
            along_m: libm::hypot(along_m, of_command_m),
            across_m: libm::hypot(across_m, run_m * self.heading_sigma),
            friction,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::csv::read_measured_csv,
        flight::{Distribution, MeasuredErrors},
        ground::Windows,
        quantity::MapPoint,
        terrain::{Dem, GeoReference, OverlaidDem, Overlays},
        world::{Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    const GRAVITY_M_S2: f64 = 3.711;

    fn level(friction: f64, landing_speed_max_m_s: f64) -> DemGround {
        let map = GeoReference::local(MapPoint::new(0.0, 29.0), 1.0, 1.0).expect("a map");
        let dem = Dem::new(30, 30, vec![0.0; 900], map).expect("a DEM");
        let grip = Some(Grip::Friction(FrictionCone::new(friction).expect("a cone")));
        let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
        let hopper = Hopper::with_speeds(20.0, landing_speed_max_m_s).expect("a hopper");
        let gravity = Gravity::new(GRAVITY_M_S2).expect("a gravity");
        DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, gravity, &surface)
    }

    /// A level hop of 10 m whose landing is that much slower than the limit, or whose angle is that of the steepest cone, flown by 4 096 draws.
    #[test]
    fn estimates_are_the_shares_of_flown_draws() {
        let degrees = Angle::from_degrees;
        let quantile = |i: u32| Distribution::Normal.standard_quantile((f64::from(i % 256) + 0.5) / 256.0);
        let rows = |mean_fraction: f64, mean_deg: f64| {
            let row = |i: u32| format!("{},{}", mean_fraction + 0.02 * quantile(i), mean_deg + quantile(i * 89));
            let text = (0..256).map(row).collect::<Vec<_>>().join("\n");
            let file = read_measured_csv(format!("takeoff_speed_error_fraction,takeoff_angle_error_deg\n{text}\n").as_bytes());
            Uncertainty { measured: Some(MeasuredErrors::of(&file.expect("a valid file"))), ..Uncertainty::NONE }
        };
        let of_command = |distribution| Uncertainty {
            takeoff_speed_sigma_fraction: 0.02,
            takeoff_angle_sigma: degrees(1.0),
            distribution,
            ..Uncertainty::NONE
        };
        let (normal, even) = (of_command(Distribution::Normal), of_command(Distribution::Uniform));
        let lasting = Uncertainty { takeoff_speed_bias_sigma_fraction: 0.01, ..even.clone() };
        let beside_rows =
            Uncertainty { takeoff_speed_bias_sigma_fraction: 0.01, distribution: Distribution::Uniform, ..rows(0.0, 0.0) };
        let least_m_s = (GRAVITY_M_S2 * 10.0).sqrt();
        let speed_alone = |above: f64| (3.0, least_m_s * (1.0 + above));
        let angle_alone = (0.7, 50.0);
        let mut shares = Vec::new();
        for (name, errors, (friction, landing_m_s)) in [
            ("Gaussian", &normal, speed_alone(0.02)),
            ("even, near", &even, speed_alone(0.02)),
            ("even, far", &even, speed_alone(0.036)),
            ("even, at the cone", &even, angle_alone),
            ("even with a bias", &lasting, speed_alone(0.03)),
            ("rows", &rows(0.0, 0.0), speed_alone(0.02)),
            ("rows that are too fast", &rows(0.01, 0.0), speed_alone(0.02)),
            ("rows that are too slow", &rows(-0.03, 0.0), speed_alone(0.02)),
            ("rows that are too steep", &rows(0.0, 0.8), angle_alone),
            ("rows and an even bias", &beside_rows, speed_alone(0.02)),
        ] {
            let ground = level(friction, landing_m_s);
            let (from, to) = (MapPoint::new(9.0, 14.0), MapPoint::new(19.0, 14.0));
            let [from, to] = [from, to].map(|at| ground.position(at).expect("on the map"));
            let judge = MapJudge::new(&ground, errors, TakeoffChoice::LeastSpeed);
            let heading = Vector2::new(1.0, 0.0);
            let windows = ground.windows(&from, &to).expect("windows");
            let (sight, lofts) = (windows.sight, windows.lofts.first().copied().expect("a window"));
            let weight = judge.estimate(&to, heading, (sight, lofts));
            let estimated = libm::exp(MapJudge::EACH_HOP - weight);
            let trials = HopTrials::new(&ground, errors, errors.distribution, 1, 4096);
            let command = judge.command((&from, &to), heading, (sight, lofts));
            let hop = JudgedHop { from, command, takeoff_sigma_m: [0.0; 2], goal: None, aims_at_rest: true };
            let survival = trials.survival(&hop, u32::MAX);
            let flown = 1.0 - f64::from(survival.failed) / f64::from(survival.of);
            assert!((estimated - flown).abs() < 0.01, "{name}: {estimated}, flown {flown}");
            shares.push(flown);
        }
        assert!(shares[1] < 0.8 && shares[0] > 0.83 && shares[2] == 1.0, "the shapes differ: {shares:?}");
    }
}
