//! One trial, hop after hop until it ends.

use nalgebra::{Point2, Point3};

use super::{DrawnErrors, HopRecord, Policy, TrialOutcome, TrialRecord, replan::Replan};
use crate::{
    ballistics::{delta_v_of_m_s, propellant_kg},
    flight::{Command, Errors, FlownHop, HopErrors, TrialDraws, resting_at},
    ground::{ContactFailure, FirstContact, LiftoffVelocity, Windows},
    world::HopperLimits,
};

/// The planned journey over one kind of ground.
#[derive(Debug)]
pub(super) struct Plan<C> {
    pub(super) start: C,
    pub(super) goal: Point3<f64>,
    pub(super) hops: Vec<PlannedHop<C>>,
    /// For [`Policy::Replan`].
    pub(super) replan: Option<Box<dyn Replan<C>>>,
    /// The journey that follows from the goal on, where a mission has several stops.
    pub(super) next: Option<Box<Self>>,
}

impl<C> Plan<C> {
    /// This journey and those that follow.
    pub(super) fn legs(&self) -> impl Iterator<Item = &Self> {
        std::iter::successors(Some(self), |plan| plan.next.as_deref())
    }

    /// The last journey.
    pub(super) fn last(&self) -> &Self {
        self.legs().last().unwrap_or(self)
    }

    /// Adds a journey at the end.
    pub(super) fn append(&mut self, next: Self) {
        match &mut self.next {
            Some(later) => later.append(next),
            None => self.next = Some(Box::new(next)),
        }
    }
}

/// Propellant beyond the greatest by less than this share is within it: the tolerance of speeds.
const PROPELLANT_ROUNDING: f64 = 1e-9;

/// A planned hop.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlannedHop<C> {
    pub(super) from: C,
    pub(super) command: Command<C>,
}

/// What is the same for all trials of a run.
#[derive(Clone, Debug)]
pub(super) struct Rules {
    pub(super) errors: Errors,
    pub(super) policy: Policy,
    pub(super) hop_limit: u32,
    pub(super) goal_tolerance_m: f64,
    /// The propellant of the machine, if its use is known and its amount limited.
    pub(super) tank: Option<Tank>,
}

/// The propellant of a machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tank {
    /// Mass at the start, with all propellant, kg.
    mass_kg: f64,
    /// Specific impulse, s.
    isp_s: f64,
    /// Propellant at the start, kg.
    max_kg: f64,
}

impl Tank {
    /// That of a hopper; `None` unless mass, specific impulse and amount are given.
    pub(super) fn of(limits: &HopperLimits) -> Option<Self> {
        Some(Self { mass_kg: limits.mass_kg?, isp_s: limits.isp_s?, max_kg: limits.propellant_max_kg? })
    }

    /// The propellant used after a delta-v more, m/s, of what was used before, kg; `None` if there is not so much.
    fn used_kg(&self, before_kg: f64, delta_v_m_s: f64) -> Option<f64> {
        let used_kg = before_kg + propellant_kg(self.mass_kg - before_kg, delta_v_m_s, self.isp_s);
        (used_kg <= self.max_kg * (1.0 + PROPELLANT_ROUNDING)).then_some(used_kg)
    }
}

/// A landing for the statistics.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// From 0.
    pub(super) hop: u32,
    pub(super) error_m: f64,
    pub(super) rest: Point2<f64>,
}

/// The results of some trials, in the order of trials and hops.
#[derive(Debug, Default)]
pub(super) struct Flown {
    pub(super) trials: Vec<TrialRecord>,
    pub(super) landings: Vec<Landing>,
    /// Empty if no records are requested.
    pub(super) hops: Vec<HopRecord>,
}

/// Flies one trial. `grounds`: the nominal one, which the robot knows, and the one of this trial.
pub(super) fn fly<G: FirstContact + Windows>(
    grounds: (&G, &mut G),
    draws: &mut TrialDraws,
    plan: &Plan<G::Contact>,
    rules: &Rules,
    trial: u64,
    keep_hops: bool,
    flown: &mut Flown,
) {
    let (nominal, ground) = grounds;
    let mut friction = 0.0;
    if let Some(realization) = rules.errors.realization(draws, trial) {
        friction = realization.friction;
        ground.realize(realization);
    }
    let biases = rules.errors.begin(draws, trial);
    let mut journey =
        Journey { nominal, ground, plan, rules, position: ground.realized(plan.start), hops: 0, stops: 0, before: 0, used_kg: 0.0 };
    let outcome = loop {
        let drawn = rules.errors.draw(draws, &biases);
        let command = match journey.decide_over_stops(&drawn) {
            Ok(command) => command,
            Err(outcome) => break outcome,
        };
        if journey.hops == rules.hop_limit {
            break TrialOutcome::HopLimit;
        }
        let liftoff = rules.errors.liftoff(&command.liftoff, command.speed_m_s, &drawn);
        if !liftoff.stays() && !journey.ground.holds_takeoff(&journey.position, &liftoff) {
            break TrialOutcome::SlidAtTakeoff;
        }
        let hop = drawn.fly(journey.ground, &journey.position, &liftoff, &command.aim);
        if let Some(tank) = &rules.tank {
            let Some(used_kg) = tank.used_kg(journey.used_kg, journey.delta_v_m_s(&liftoff, &hop)) else {
                break TrialOutcome::OutOfPropellant;
            };
            journey.used_kg = used_kg;
        }
        let ended = journey.land(&liftoff, &command.rest, hop, |landing, hop| {
            flown.landings.extend(landing);
            if keep_hops {
                let drawn = drawn.drawn(command.speed_m_s, friction);
                flown.hops.push(HopRecord { trial, drawn, ..hop() });
            }
        });
        if let Some(outcome) = ended {
            break outcome;
        }
    };
    // The last hop of a trial has the outcome of the trial, whatever ended it.
    if let Some(last) = flown.hops.last_mut().filter(|last| last.trial == trial) {
        last.outcome = Some(outcome);
    }
    let end_m = journey.ground.point(&journey.position);
    let goal_distance_m = journey.ground.apart_m(&end_m, &plan.last().goal);
    flown.trials.push(TrialRecord { trial, outcome, hops: journey.hops, stops: journey.stops, end_m, goal_distance_m });
}

/// A trial in progress.
struct Journey<'t, G: FirstContact> {
    /// The ground as the robot knows it.
    nominal: &'t G,
    ground: &'t G,
    plan: &'t Plan<G::Contact>,
    rules: &'t Rules,
    position: G::Contact,
    hops: u32,
    /// How many stops of the mission it has reached.
    stops: u32,
    /// The hops flown before the last stop.
    before: u32,
    /// Propellant used, kg; counted for a machine with a [`Tank`].
    used_kg: f64,
}

impl<G: FirstContact + Windows> Journey<'_, G> {
    /// The next command, from each stop that it is at on towards the next one, or the outcome of a mission that ends here.
    fn decide_over_stops(&mut self, drawn: &HopErrors) -> Result<Command<G::Contact>, TrialOutcome> {
        loop {
            let decided = self.decide(drawn);
            if !matches!(decided, Err(TrialOutcome::Reached)) {
                return decided;
            }
            self.stops += 1;
            let Some(next) = self.plan.next.as_deref() else { return decided };
            (self.plan, self.before) = (next, self.hops);
        }
    }

    /// The next command, or the outcome of a journey that ends here.
    fn decide(&self, drawn: &HopErrors) -> Result<Command<G::Contact>, TrialOutcome> {
        let planned = usize::try_from(self.hops - self.before).ok().and_then(|hop| self.plan.hops.get(hop));
        match self.rules.policy {
            Policy::OpenLoop => planned.map(|hop| hop.command).ok_or_else(|| self.arrived()),
            Policy::Replan => {
                let [along_m, across_m] = drawn.position_m;
                let believed = self.ground.believed(&self.position, along_m, across_m).ok_or(TrialOutcome::Stuck)?;
                if self.is_at_goal(&believed) {
                    return Err(self.arrived());
                }
                let replan = self.plan.replan.as_ref();
                let command = match planned {
                    Some(hop) if hop.from == believed && replan.is_none_or(|replan| replan.follows_plan()) => Ok(hop.command),
                    _ => replan.and_then(|replan| replan.next(&believed)).ok_or(TrialOutcome::Stuck),
                };
                // A robot that bounces aims short.
                command.map(|command| resting_at(self.nominal, &believed, command))
            }
        }
    }

    fn is_at_goal(&self, position: &G::Contact) -> bool {
        self.ground.apart_m(&self.ground.point(position), &self.plan.goal) <= self.rules.goal_tolerance_m
    }

    /// The outcome of a journey that the robot ends here on purpose.
    fn arrived(&self) -> TrialOutcome {
        if self.is_at_goal(&self.position) { TrialOutcome::Reached } else { TrialOutcome::Missed }
    }

    /// The delta-v of a hop as flown, m/s: of the take-off as drawn, of the brakes from the velocity at which its arc meets the ground, and
    /// the overhead. A flight that leaves the known ground does not brake.
    fn delta_v_m_s(&self, liftoff: &LiftoffVelocity, flown: &FlownHop<G::Contact>) -> f64 {
        if liftoff.stays() {
            return 0.0;
        }
        let landing_m_s = flown.landed.then_some([flown.touchdown.horizontal_m_s, flown.touchdown.vertical_m_s]);
        let takeoff_m_s = libm::hypot(liftoff.horizontal_m_s, liftoff.vertical_m_s);
        delta_v_of_m_s(takeoff_m_s, landing_m_s, self.ground.hopper().limits())
    }

    /// Ends a flown hop, with its bounce-and-roll displacement, and reports it; returns the outcome if the trial ends with it.
    fn land(
        &mut self,
        liftoff: &LiftoffVelocity,
        rest_aim: &G::Contact,
        flown: FlownHop<G::Contact>,
        mut report: impl FnMut(Option<Landing>, &dyn Fn() -> HopRecord),
    ) -> Option<TrialOutcome> {
        let ground = self.ground;
        let from = self.position;
        let FlownHop { rest, landed, .. } = flown;
        let outcome = flown.failure.map(outcome_of);
        let (aim_m, rest_m) = (ground.point(rest_aim), ground.point(&rest));
        let error_m = ground.apart_m(&rest_m, &aim_m);
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
            landing_vertical_m_s: flown.touchdown.vertical_m_s,
            flight_time_s: flown.time_s,
            planned_m: aim_m,
            contact_m: self.end_of_flight(&flown.end, &from, liftoff, flown.time_s, landed),
            rest_m,
            bounces: flown.bounces.count,
            bounce_time_s: flown.bounces.time_s,
            error_m,
            drawn: DrawnErrors::default(),
            landed,
            outcome,
        };
        report(landing, &record);
        outcome
    }

    /// The contact; for a flight that left the known ground, its position in the air there.
    fn end_of_flight(
        &self,
        end: &G::Contact,
        from: &G::Contact,
        liftoff: &LiftoffVelocity,
        time_s: f64,
        landed: bool,
    ) -> Point3<f64> {
        let end_m = self.ground.point(end);
        if landed {
            return end_m;
        }
        let up_m = time_s * (liftoff.vertical_m_s - 0.5 * self.ground.gravity_m_s2() * time_s);
        Point3::new(end_m.x, end_m.y, self.ground.point(from).z + up_m)
    }
}

/// The outcome of a contact that does not hold.
pub(super) const fn outcome_of(failure: ContactFailure) -> TrialOutcome {
    match failure {
        ContactFailure::Slides => TrialOutcome::SlidAtLanding,
        ContactFailure::TooFast => TrialOutcome::Damaged,
        ContactFailure::OffLimits => TrialOutcome::Lost,
    }
}
