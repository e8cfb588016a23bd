//! Many trials of a mission that drives and hops.

use nalgebra::Vector2;
use rayon::prelude::*;

use super::{
    Policy, QuantileSketch, SimulationError, TravelToGo, TrialOptions, TrialOutcome, Wilson,
    driving::{DriveDraws, Driven},
    simulation::command,
    trial::outcome_of,
};
use crate::{
    ballistics::TakeoffChoice,
    drive::DriveGround,
    flight::{Biases, Command, Errors, HopErrors, TrialDraws, Uncertainty, resting_at},
    ground::{DemGround, FirstContact, MapPosition, Surface},
    path::Hop,
    progress::{Detail, Meter, Progress, Stage},
    quantity::MapPoint,
    world::Rover,
};

/// Trials that one thread makes in one task.
const STRETCH: u64 = 50;
/// After so many trials progress is reported and the wanted precision checked.
const BATCH: u64 = 1000;
/// How often a robot that replans tries to drive on where its errors lead it over a limit.
const TRIES_MOST: u32 = 20;
/// A robot that replans makes at most so many moves for each planned one, and these beside.
const MOVES_MOST: (usize, usize) = (4, 40);

/// One move of a mission as planned.
#[derive(Clone, Debug)]
pub enum TravelMove {
    /// A straight drive.
    Drive {
        /// Where it begins.
        from: MapPosition,
        /// Where it ends.
        to: MapPosition,
    },
    /// A hop.
    Hop {
        /// Its command.
        hop: Box<Hop>,
        /// Where it takes off.
        from: MapPosition,
        /// Where it lands.
        to: MapPosition,
    },
}

/// How a trial of a mission ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TravelOutcome {
    /// As a trial of hops.
    Trial(TrialOutcome),
    /// The ground ahead broke a limit of the wheels, or was unknown or kept out: it stopped there.
    DriveStopped,
    /// A failure ended its driving.
    DriveFailed,
}

impl TravelOutcome {
    /// All of them, in the order of results.
    pub const ALL: [Self; 11] = [
        Self::Trial(TrialOutcome::ALL[0]),
        Self::Trial(TrialOutcome::ALL[1]),
        Self::Trial(TrialOutcome::ALL[2]),
        Self::Trial(TrialOutcome::ALL[3]),
        Self::Trial(TrialOutcome::ALL[4]),
        Self::Trial(TrialOutcome::ALL[5]),
        Self::Trial(TrialOutcome::ALL[6]),
        Self::Trial(TrialOutcome::ALL[7]),
        Self::Trial(TrialOutcome::ALL[8]),
        Self::DriveStopped,
        Self::DriveFailed,
    ];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trial(outcome) => outcome.name(),
            Self::DriveStopped => "drive_stopped",
            Self::DriveFailed => "drive_failed",
        }
    }
}

crate::quantity::by_name!(TravelOutcome, TravelOutcome::ALL);

/// A planned mission, ready to be tried.
#[derive(Clone, Debug)]
pub struct TravelMission {
    /// The ground with the whole limits, over which hops are flown.
    pub whole: DemGround,
    /// The ground under the limits that planning may use, by which a robot replans and its wheels are judged.
    pub planning: DemGround,
    /// The wheels.
    pub rover: Rover,
    /// The moves, in order.
    pub moves: Vec<TravelMove>,
    /// Where it ends.
    pub goal: MapPosition,
    /// Which of the feasible take-off angles a replanned hop has.
    pub takeoff: TakeoffChoice,
    /// What the best missions take from all nodes to the goal, by which a robot replans; needed for [`Policy::Replan`].
    pub to_go: Option<TravelToGo>,
}

/// The next move of a robot that replans.
#[derive(Clone, Copy, Debug)]
pub(super) enum Choice {
    /// To a place.
    Drive(MapPosition),
    /// With a command.
    Hop(Command<MapPosition>),
}

/// What the trials of a mission show.
#[derive(Clone, Debug, PartialEq)]
pub struct TravelSummary {
    /// The policy.
    pub policy: Policy,
    /// The seed.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The share that reached the goal.
    pub success: Wilson,
    /// How many ended in each way that occurs, in the order of [`TravelOutcome::ALL`].
    pub outcomes: Vec<(TravelOutcome, u64)>,
    /// By the number of the move, from 1, how many ended during it otherwise than at the goal; 0: after the last one.
    pub ended_in: Vec<(usize, u64)>,
    /// The mean mission time of those that reached the goal, s; `None` if none did.
    pub mission_time_mean_s: Option<f64>,
    /// The mean length driven by those that reached the goal, m.
    pub driven_mean_m: Option<f64>,
    /// How far from the goal the trials ended: medians and 95 % quantiles, m.
    pub goal_distance_m: Option<[f64; 2]>,
}

/// One trial.
#[derive(Clone, Copy, Debug)]
struct Tried {
    outcome: TravelOutcome,
    /// The move during which it ended, from 1; 0 after the last one.
    ended_in: usize,
    time_s: f64,
    driven_m: f64,
    goal_distance_m: f64,
}

impl TravelMission {
    /// Makes the trials.
    ///
    /// A drive has errors of its heading and of its length, as the rover states them, and fails with a rate for each metre; hops are flown as
    /// in [`Simulation`](super::Simulation). Open loop the robot makes the planned moves, with their directions, lengths and commands, from
    /// wherever it is, and a drive that breaks a limit ends the trial. Replanned, it makes the planned move where it believes to be at its
    /// beginning, and else drives or hops to the node by which least is left to the goal; where its errors would lead it over a limit it stays
    /// and tries again. The wheels are judged over the map as it is known, also where heights have errors.
    ///
    /// The results do not depend on the number of threads.
    ///
    /// # Errors
    /// [`SimulationError`]: invalid errors, no trials, or cancelled.
    pub fn run(
        &self,
        errors: &Uncertainty,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<TravelSummary, SimulationError> {
        errors.check(true)?;
        if options.trials == 0 {
            return Err(SimulationError::NoTrials);
        }
        let meter = Meter::with_total(progress, Stage::Trials, options.trials);
        meter.report(Detail::None)?;
        let rules = Errors::new(errors.clone(), options.policy == Policy::Replan);
        if options.policy == Policy::Replan && self.to_go.is_none() {
            return Err(SimulationError::NoCostsToGo);
        }
        let mut sums = Sums::default();
        let (mut done, last) = (options.first_trial, options.first_trial + options.trials);
        while done < last {
            let end = last.min(done + BATCH);
            let starts: Vec<u64> = (done..end).step_by(usize::try_from(STRETCH).unwrap_or(usize::MAX)).collect();
            let stretch = |first: u64| {
                let mut realized = self.whole.clone();
                let mut draws = (TrialDraws::seeded(options.seed), DriveDraws::seeded(options.seed));
                let trials = first..end.min(first + STRETCH);
                trials.map(|trial| self.tried(&rules, errors, (options, trial), &mut draws, &mut realized)).collect()
            };
            let stretches: Vec<Vec<Tried>> = starts.into_par_iter().map(stretch).collect();
            stretches.iter().flatten().for_each(|tried| sums.add(tried));
            done = end;
            meter.set_done(done - options.first_trial, options.trials);
            meter.report(Detail::Trials { reached_goal: sums.reached })?;
            let success = Wilson::of(sums.reached, sums.trials);
            if options.until_half_width.is_some_and(|width| success.half_width() <= width) {
                break;
            }
        }
        Ok(sums.summary(options))
    }

    fn tried(
        &self,
        rules: &Errors,
        errors: &Uncertainty,
        (options, trial): (&TrialOptions, u64),
        (draws, wheels): &mut (TrialDraws, DriveDraws),
        realized: &mut DemGround,
    ) -> Tried {
        if let Some(realization) = rules.realization(draws, trial) {
            realized.realize(realization);
        }
        wheels.begin(trial);
        let start = self.moves.first().map_or(self.goal, TravelMove::from);
        let biases = rules.begin(draws, trial);
        let mut journey = Journey {
            mission: self,
            ground: realized,
            drive: DriveGround::new(&self.planning, &self.rover),
            rules,
            errors,
            at: start.at,
            time_s: 0.0,
            driven_m: 0.0,
            heading: None,
            settles: false,
        };
        let ended = match options.policy {
            Policy::OpenLoop => journey.as_planned((draws, wheels), &biases),
            Policy::Replan => journey.replanning((draws, wheels), &biases, options.goal_tolerance_m),
        };
        let goal_distance_m = (journey.at - self.goal.at).norm();
        let at_end = if goal_distance_m <= options.goal_tolerance_m { TrialOutcome::Reached } else { TrialOutcome::Missed };
        let (outcome, ended_in) = ended.err().unwrap_or((TravelOutcome::Trial(at_end), 0));
        Tried { outcome, ended_in, time_s: journey.time_s, driven_m: journey.driven_m, goal_distance_m }
    }
}

impl TravelMove {
    /// Where it begins.
    pub const fn from(&self) -> MapPosition {
        match self {
            Self::Drive { from, .. } | Self::Hop { from, .. } => *from,
        }
    }

    /// The move as a robot at its beginning makes it.
    fn choice(&self) -> Option<Choice> {
        match self {
            Self::Drive { to, .. } => Some(Choice::Drive(*to)),
            Self::Hop { hop, from, to } => planned_command(hop, *from, *to).map(Choice::Hop),
        }
    }
}

/// A trial on its way.
struct Journey<'t> {
    mission: &'t TravelMission,
    /// The ground of this trial.
    ground: &'t DemGround,
    drive: DriveGround<'t>,
    rules: &'t Errors,
    errors: &'t Uncertainty,
    at: MapPoint,
    time_s: f64,
    driven_m: f64,
    /// The direction of the drive before, from which it turns; `None` after a landing.
    heading: Option<Vector2<f64>>,
    /// Whether it has landed, and settles before it moves.
    settles: bool,
}

/// The end of a trial before the last move.
type Ended = Result<(), TravelOutcome>;

/// The same, with the number of the move.
type EndedIn = Result<(), (TravelOutcome, usize)>;

impl Journey<'_> {
    /// Makes the planned moves from wherever it is.
    fn as_planned(&mut self, (draws, wheels): (&mut TrialDraws, &mut DriveDraws), biases: &Biases) -> EndedIn {
        for (number, planned) in (1..).zip(&self.mission.moves) {
            let moved = match planned {
                TravelMove::Drive { from, to } => {
                    self.drive(to.at - from.at, wheels).and_then(|on| if on { Ok(()) } else { Err(TravelOutcome::DriveStopped) })
                }
                TravelMove::Hop { hop, from, to } => {
                    let drawn = self.rules.draw(draws, biases);
                    planned_command(hop, *from, *to).map_or(Ok(()), |command| self.hop(command, &drawn))
                }
            };
            moved.map_err(|outcome| (outcome, number))?;
        }
        Ok(())
    }

    /// Makes the planned moves where it believes to be at their beginnings, and else those by which least is left.
    fn replanning(
        &mut self,
        (draws, wheels): (&mut TrialDraws, &mut DriveDraws),
        biases: &Biases,
        goal_tolerance_m: f64,
    ) -> EndedIn {
        let mission = self.mission;
        let most = MOVES_MOST.0 * mission.moves.len() + MOVES_MOST.1;
        let mut tries = 0;
        for number in 1..=most {
            let drawn = self.rules.draw(draws, biases);
            let [east_m, north_m] = drawn.position_m;
            let lost = (TravelOutcome::Trial(TrialOutcome::Lost), number);
            let believed = mission.planning.position(self.at + Vector2::new(east_m, north_m)).ok_or(lost)?;
            if (believed.at - mission.goal.at).norm() <= goal_tolerance_m {
                return Ok(());
            }
            let planned = mission.moves.iter().find(|planned| planned.from().at == believed.at).and_then(TravelMove::choice);
            let to_go = || mission.to_go.as_ref()?.next(&self.drive, &mission.planning, &believed, mission.takeoff);
            let choice = planned.or_else(to_go).ok_or((TravelOutcome::Trial(TrialOutcome::Stuck), number))?;
            let moved = match choice {
                Choice::Drive(to) => self.drive(to.at - believed.at, wheels),
                Choice::Hop(command) => self.hop(command, &drawn).map(|()| true),
            };
            tries = if moved.map_err(|outcome| (outcome, number))? { 0 } else { tries + 1 };
            if tries > TRIES_MOST {
                return Err((TravelOutcome::DriveStopped, number));
            }
        }
        Err((TravelOutcome::Trial(TrialOutcome::HopLimit), most))
    }

    /// Time to settle after the landing before this move.
    fn settle(&mut self) {
        if std::mem::take(&mut self.settles) {
            self.time_s += self.ground.hopper().limits().settling_s().unwrap_or(0.0);
        }
    }

    /// Drives so far, with errors.
    ///
    /// # Returns
    /// Whether the wheels hold on the way; it stays where they do not.
    fn drive(&mut self, along: Vector2<f64>, draws: &mut DriveDraws) -> Result<bool, TravelOutcome> {
        self.settle();
        let (at, leg, heading) = match draws.drive(&self.drive, self.errors.distribution, self.at, along) {
            Driven::To { at, leg, heading } => (at, leg, heading),
            Driven::Refused => return Ok(false),
            Driven::Failed => return Err(TravelOutcome::DriveFailed),
        };
        if let Some(heading) = heading {
            let angle = self.heading.map_or(0.0, |before| libm::atan2(before.perp(&heading).abs(), before.dot(&heading)));
            self.time_s += self.mission.rover.limits().turn_s_per_deg * angle.to_degrees();
            self.heading = Some(heading);
        }
        self.at = at;
        self.time_s += leg.time_s;
        self.driven_m += leg.length_m;
        Ok(true)
    }

    /// Flies a hop, with errors.
    fn hop(&mut self, command: Command<MapPosition>, drawn: &HopErrors) -> Ended {
        self.settle();
        let lost = TravelOutcome::Trial(TrialOutcome::Lost);
        let here = self.ground.realized(self.mission.planning.position(self.at).ok_or(lost)?);
        let command = resting_at(&self.mission.whole, &here, command);
        let liftoff = self.rules.liftoff(&command.liftoff, command.speed_m_s, drawn);
        if !liftoff.stays() && !self.ground.holds_takeoff(&here, &liftoff) {
            return Err(TravelOutcome::Trial(TrialOutcome::SlidAtTakeoff));
        }
        let flown = drawn.fly(self.ground, &here, &liftoff, &command.aim);
        self.at = self.ground.point(&flown.rest).xy();
        self.time_s += self.ground.hopper().limits().preparation_time_s.unwrap_or(0.0) + flown.time_s + flown.bounces.time_s;
        (self.settles, self.heading) = (true, None);
        flown.failure.map_or(Ok(()), |failure| Err(TravelOutcome::Trial(outcome_of(failure))))
    }
}

/// The command of a planned hop; `None` for one straight up.
fn planned_command(hop: &Hop, from: MapPosition, to: MapPosition) -> Option<Command<MapPosition>> {
    Some(command(hop, (to.at - from.at).try_normalize(0.0)?, to))
}

/// What trials add up to.
#[derive(Debug, Default)]
struct Sums {
    trials: u64,
    reached: u64,
    outcomes: [u64; TravelOutcome::ALL.len()],
    ended_in: std::collections::BTreeMap<usize, u64>,
    time_s: f64,
    driven_m: f64,
    distances: QuantileSketch,
}

impl Sums {
    fn add(&mut self, tried: &Tried) {
        self.trials += 1;
        let place = TravelOutcome::ALL.iter().position(|outcome| *outcome == tried.outcome).unwrap_or(0);
        self.outcomes[place] += 1;
        self.distances.add(tried.goal_distance_m);
        if tried.outcome == TravelOutcome::Trial(TrialOutcome::Reached) {
            self.reached += 1;
            self.time_s += tried.time_s;
            self.driven_m += tried.driven_m;
        } else {
            *self.ended_in.entry(tried.ended_in).or_default() += 1;
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "fewer trials than 2^53")]
    fn summary(&self, options: &TrialOptions) -> TravelSummary {
        let mean = |sum: f64| (self.reached > 0).then(|| sum / self.reached as f64);
        let outcomes = TravelOutcome::ALL.into_iter().zip(self.outcomes);
        TravelSummary {
            policy: options.policy,
            seed: options.seed,
            trials: self.trials,
            success: Wilson::of(self.reached, self.trials),
            outcomes: outcomes.filter(|(_, count)| *count > 0).collect(),
            ended_in: self.ended_in.iter().map(|(number, count)| (*number, *count)).collect(),
            mission_time_mean_s: mean(self.time_s),
            driven_mean_m: mean(self.driven_m),
            goal_distance_m: self.distances.quantile(0.5).zip(self.distances.quantile(0.95)).map(|(half, most)| [half, most]),
        }
    }
}
