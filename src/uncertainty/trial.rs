//! One trial: hop after hop until it ends.

use nalgebra::{Point2, Point3, Vector2};

use super::{
    HopRecord, LiftoffVelocity, Policy, TrialOutcome, TrialRecord, Uncertainty,
    draws::{HopDraws, TrialDraws, Wanted},
    field::HeightField,
    ground::{Command, Ground, Realization, TouchdownState},
};

/// The planned journey over one kind of ground.
#[derive(Clone, Debug)]
pub(super) struct Plan<S> {
    pub(super) start: S,
    pub(super) goal: Point2<f64>,
    pub(super) hops: Vec<PlannedHop<S>>,
}

/// A planned hop.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlannedHop<S> {
    pub(super) from: S,
    pub(super) command: Command<S>,
}

/// What holds for every trial of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub(super) uncertainty: Uncertainty,
    pub(super) wanted: Wanted,
    pub(super) policy: Policy,
    pub(super) hop_limit: u32,
    pub(super) goal_tolerance_m: f64,
    pub(super) gravity_m_s2: f64,
}

/// A landing as the statistics need it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// From 0.
    pub(super) hop: u32,
    pub(super) error_m: f64,
    pub(super) rest: Point2<f64>,
}

/// What some trials gave, in the order of trials and hops.
#[derive(Debug, Default)]
pub(super) struct Flown {
    pub(super) trials: Vec<TrialRecord>,
    pub(super) landings: Vec<Landing>,
    /// Empty where no records are wanted.
    pub(super) hops: Vec<HopRecord>,
}

impl Rules {
    /// Which draws these errors and this policy use.
    pub(super) fn wanted(uncertainty: &Uncertainty, policy: Policy) -> Wanted {
        let u = uncertainty;
        Wanted {
            speed: u.takeoff_speed_sigma_m_s > 0.0 || u.takeoff_speed_sigma_fraction > 0.0,
            direction: u.takeoff_angle_sigma.radians() > 0.0 || u.heading_sigma.radians() > 0.0,
            drift: u.drift_along_sigma_m > 0.0 || u.drift_across_sigma_m > 0.0,
            position: u.position_sigma_m > 0.0 && policy == Policy::Replan,
        }
    }

    /// Draws how the ground of a trial differs from the map; `None` where it does not.
    fn realization(&self, draws: &mut TrialDraws, trial: u64) -> Option<Realization> {
        let u = &self.uncertainty;
        let friction = if u.friction_sigma > 0.0 { u.friction_sigma * draws.friction(trial) } else { 0.0 };
        let heights =
            (u.height_sigma_m > 0.0).then(|| Box::new(HeightField::of(draws, trial, u.height_sigma_m, u.height_correlation_m)));
        (u.friction_sigma > 0.0 || heights.is_some()).then_some(Realization { friction, heights })
    }

    /// A command as it is really given: its speed first, then its elevation, then its heading.
    fn with_errors(&self, liftoff: &LiftoffVelocity, speed_m_s: f64, draws: &HopDraws) -> LiftoffVelocity {
        let u = &self.uncertainty;
        let real_m_s =
            speed_m_s * (1.0 + u.takeoff_speed_sigma_fraction * draws.speed[1]) + u.takeoff_speed_sigma_m_s * draws.speed[0];
        let scale = if self.wanted.speed { real_m_s.max(0.0) / speed_m_s } else { 1.0 };
        let (across, up) = (liftoff.horizontal_m_s * scale, liftoff.vertical_m_s * scale);
        if !self.wanted.direction {
            return LiftoffVelocity { heading: liftoff.heading, horizontal_m_s: across, vertical_m_s: up };
        }
        let (sine, cosine) = libm::sincos(u.takeoff_angle_sigma.radians() * draws.direction[0]);
        let (across, up) = (across * cosine - up * sine, across * sine + up * cosine);
        let mut heading = liftoff.heading;
        if u.heading_sigma.radians() > 0.0 {
            let (sine, cosine) = libm::sincos(u.heading_sigma.radians() * draws.direction[1]);
            heading = Vector2::new(heading.x * cosine + heading.y * sine, heading.y * cosine - heading.x * sine);
        }
        // Beyond the vertical it flies the other way.
        if across < 0.0 {
            return LiftoffVelocity { heading: -heading, horizontal_m_s: -across, vertical_m_s: up };
        }
        LiftoffVelocity { heading, horizontal_m_s: across, vertical_m_s: up }
    }
}

/// Flies one trial.
pub(super) fn fly<G: Ground>(
    ground: &mut G,
    draws: &mut TrialDraws,
    plan: &Plan<G::Position>,
    rules: &Rules,
    trial: u64,
    keep_hops: bool,
    flown: &mut Flown,
) {
    if let Some(realization) = rules.realization(draws, trial) {
        ground.realize(realization);
    }
    draws.begin(trial);
    let mut journey = Journey { ground, plan, rules, position: ground.real(plan.start), hops: 0 };
    let outcome = loop {
        let errors = draws.hop(rules.wanted);
        let command = match journey.decide(&errors) {
            Ok(command) => command,
            Err(outcome) => break outcome,
        };
        if journey.hops == rules.hop_limit {
            break TrialOutcome::HopLimit;
        }
        let liftoff = rules.with_errors(&command.liftoff, command.speed_m_s, &errors);
        if !liftoff.stays() && !journey.ground.holds_takeoff(&journey.position, &liftoff) {
            break TrialOutcome::SlidAtTakeoff;
        }
        let ended = journey.hop(&liftoff, &command.aim, &errors, |landing, hop| {
            flown.landings.extend(landing);
            if keep_hops {
                flown.hops.push(HopRecord { trial, ..hop() });
            }
        });
        if let Some(outcome) = ended {
            break outcome;
        }
    };
    let end_m = journey.ground.point(&journey.position);
    let goal_distance_m = (end_m.xy() - plan.goal).norm();
    flown.trials.push(TrialRecord { trial, outcome, hops: journey.hops, end_m, goal_distance_m });
}

/// A trial on its way.
struct Journey<'t, G: Ground> {
    ground: &'t G,
    plan: &'t Plan<G::Position>,
    rules: &'t Rules,
    position: G::Position,
    hops: u32,
}

impl<G: Ground> Journey<'_, G> {
    /// The next command, or how the journey ends here.
    fn decide(&self, errors: &HopDraws) -> Result<Command<G::Position>, TrialOutcome> {
        let planned = usize::try_from(self.hops).ok().and_then(|hop| self.plan.hops.get(hop));
        match self.rules.policy {
            Policy::OpenLoop => planned.map(|hop| hop.command).ok_or_else(|| self.arrived()),
            Policy::Replan => {
                let sigma_m = self.rules.uncertainty.position_sigma_m;
                let [along_m, across_m] = errors.position.map(|normal| sigma_m * normal);
                let believed = self.ground.believed(&self.position, along_m, across_m).ok_or(TrialOutcome::Stuck)?;
                if self.is_at_goal(&believed) {
                    return Err(self.arrived());
                }
                // Where it believes to be on the plan, the plan is as good as any other.
                match planned {
                    Some(hop) if hop.from == believed => Ok(hop.command),
                    _ => self.ground.replanned(&believed).ok_or(TrialOutcome::Stuck),
                }
            }
        }
    }

    fn is_at_goal(&self, position: &G::Position) -> bool {
        (self.ground.point(position).xy() - self.plan.goal).norm() <= self.rules.goal_tolerance_m
    }

    /// How a journey ends that stops here on purpose.
    fn arrived(&self) -> TrialOutcome {
        if self.is_at_goal(&self.position) { TrialOutcome::Reached } else { TrialOutcome::Missed }
    }

    /// Flies a hop, with the bounce-and-roll displacement after it; tells of it, and how the trial ends where it ends with it.
    fn hop(
        &mut self,
        liftoff: &LiftoffVelocity,
        aim: &G::Position,
        errors: &HopDraws,
        mut tell: impl FnMut(Option<Landing>, &dyn Fn() -> HopRecord),
    ) -> Option<TrialOutcome> {
        let (ground, uncertainty) = (self.ground, &self.rules.uncertainty);
        let from = self.position;
        let flight = ground.fly(&from, liftoff, aim);
        let touchdown = TouchdownState::after(liftoff, flight.time_s, self.rules.gravity_m_s2);
        let displacement_m =
            [uncertainty.drift_along_sigma_m * errors.drift[0], uncertainty.drift_across_sigma_m * errors.drift[1]];
        let failure = match &flight.support_facet {
            // Nothing happens to a robot that does not move.
            _ if liftoff.stays() => None,
            None => Some(TrialOutcome::Lost),
            Some(support_facet) => ground.landing_failure(&flight.end, support_facet, &touchdown),
        };
        let (rest, outcome) = match failure {
            Some(outcome) => (flight.end, Some(outcome)),
            None => match ground.displaced(&flight.end, liftoff.heading, displacement_m[0], displacement_m[1]) {
                Ok(rest) => (rest, None),
                Err(outcome) => (flight.end, Some(outcome)),
            },
        };
        let (aim_m, rest_m) = (ground.point(aim), ground.point(&rest));
        let error_m = (rest_m - aim_m).xy().norm();
        let landed = flight.support_facet.is_some() || liftoff.stays();
        let landing = landed.then(|| Landing { hop: self.hops, error_m, rest: rest_m.xy() });
        self.hops += 1;
        self.position = rest;
        let record = || HopRecord {
            trial: 0,
            hop: self.hops,
            takeoff_m: ground.point(&from),
            heading: liftoff.heading,
            horizontal_m_s: liftoff.horizontal_m_s,
            takeoff_vertical_m_s: liftoff.vertical_m_s,
            landing_vertical_m_s: touchdown.vertical_m_s,
            flight_time_s: flight.time_s,
            planned_m: aim_m,
            contact_m: self.end_of_flight(&flight.end, &from, liftoff, flight.time_s, landed),
            rest_m,
            error_m,
            landed,
            outcome,
        };
        tell(landing, &record);
        outcome
    }

    /// The contact; of a flight that left the known ground, where it was then, in the air.
    fn end_of_flight(
        &self,
        end: &G::Position,
        from: &G::Position,
        liftoff: &LiftoffVelocity,
        time_s: f64,
        landed: bool,
    ) -> Point3<f64> {
        let end_m = self.ground.point(end);
        if landed {
            return end_m;
        }
        let up_m = time_s * (liftoff.vertical_m_s - 0.5 * self.rules.gravity_m_s2 * time_s);
        Point3::new(end_m.x, end_m.y, self.ground.point(from).z + up_m)
    }
}
