//! Many trials of one mission.

use std::sync::Arc;

use nalgebra::{Point2, Point3, Vector2};
use rayon::prelude::*;

use super::{
    Mission, MissionPoint, Observer, Policy, SimulationError, Summary, Trajectory, TrialOptions,
    mission::{MissionGround, Replanning},
    post_replan::{CheapestPost, ReliablePost},
    replan::{ChainReplan, CorridorReplan, MapReplan, Replan},
    replan_mesh::ContactReplan,
    tally::{Flights, PlannedPlaces, Statistics, Tally},
    trial::{Flown, Plan, PlannedHop, Rules, Tank, fly},
};
use crate::{
    flight::{Command, Errors, TrialDraws, Uncertainty},
    ground::{
        ChainGround, ChainPosition, ContactPoint, DemGround, FirstContact, LiftoffVelocity, MapPosition, MeshGround, MeshPosition,
        Surface, Windows, heading_of,
    },
    path::Hop,
    progress::{Detail, Meter, Progress, Stage},
};

/// The success rate is checked after this many trials.
const BATCH: u64 = 1000;

/// The fixed trials that estimate the success of a path.
pub const ESTIMATE_TRIALS: u64 = 512;

/// Trials that one thread flies in one task: a batch then employs twenty threads, and the overhead per task is negligible.
const STRETCH: u64 = 50;

/// A mission prepared for repeated flights.
#[derive(Debug)]
pub struct Simulation {
    pub(super) mission: Mission,
    pub(super) uncertainty: Uncertainty,
    pub(super) ground_and_plan: GroundAndPlan,
}

/// The mission's ground and its plan.
#[derive(Debug)]
pub(super) enum GroundAndPlan {
    Chain(ChainGround, Plan<ChainPosition>),
    Map(DemGround, Plan<MapPosition>),
    Mesh(MeshGround, Plan<MeshPosition>),
}

/// The end of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightEnd {
    /// The first contact; or, if the flight leaves the known ground, the last known ground point beneath it.
    pub at_m: Point3<f64>,
    /// Whether it is a contact.
    pub landed: bool,
    /// Time of flight, s.
    pub time_s: f64,
}

impl Simulation {
    /// Prepares a mission with these errors.
    ///
    /// # Errors
    /// [`SimulationError`] if the deviations are invalid, or path and map do not match.
    pub fn new(mission: &Mission, uncertainty: Uncertainty) -> Result<Self, SimulationError> {
        uncertainty.check(!matches!(mission.ground, MissionGround::Chain(_)))?;
        let ground_and_plan = match &mission.ground {
            MissionGround::Chain(ground) => GroundAndPlan::Chain(ground.clone(), chain_plan(mission)?),
            MissionGround::Map(ground) => {
                if ground.surface().grip.is_none() && ground.terrain().overlays().friction().is_none() {
                    return Err(SimulationError::NoGrip);
                }
                GroundAndPlan::Map(ground.clone(), map_plan(mission, ground)?)
            }
            MissionGround::Mesh(ground) => {
                if uncertainty.height_sigma_m > 0.0 {
                    return Err(SimulationError::HeightsOfMesh { sigma_m: uncertainty.height_sigma_m });
                }
                GroundAndPlan::Mesh(ground.clone(), mesh_plan(mission, ground)?)
            }
        };
        Ok(Self { mission: mission.clone(), uncertainty, ground_and_plan })
    }

    /// The same mission, which goes on where it has reached its goal: with another one that begins there, over the same kind of ground.
    ///
    /// A trial begins the second mission where it ended the first. The goal of a mission is then one of several stops: a trial that
    /// misses it ends there.
    ///
    /// # Errors
    /// [`SimulationError::OtherGround`].
    pub fn followed_by(mut self, next: Self) -> Result<Self, SimulationError> {
        match (&mut self.ground_and_plan, next.ground_and_plan) {
            (GroundAndPlan::Chain(_, plan), GroundAndPlan::Chain(_, next)) => plan.append(next),
            (GroundAndPlan::Map(_, plan), GroundAndPlan::Map(_, next)) => plan.append(next),
            (GroundAndPlan::Mesh(_, plan), GroundAndPlan::Mesh(_, next)) => plan.append(next),
            _ => return Err(SimulationError::OtherGround),
        }
        self.mission = self.mission.followed_by(next.mission);
        Ok(self)
    }

    /// Flies the trials.
    ///
    /// Batches of 1 000 trials are distributed over the threads and added in the order of trials, so the results do not depend on
    /// the number of threads. Memory does not grow with the number of trials. Reports every batch.
    ///
    /// # Errors
    /// [`SimulationError`]: invalid options, [`Policy::Replan`] without costs-to-go, or cancelled.
    pub fn run(
        &self,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<Summary, SimulationError> {
        let (statistics, trajectories) = self.flown(options, observer, progress)?;
        Ok(Summary { trajectories, ..statistics.summary(options.policy, options.seed) })
    }

    /// Flies the trials once for both: the summary of [`run`](Self::run) and the tally of [`tally`](Self::tally).
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_and_tally(
        &self,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<(Summary, Tally), SimulationError> {
        let (statistics, trajectories) = self.flown(options, observer, progress)?;
        let summary = Summary { trajectories, ..statistics.summary(options.policy, options.seed) };
        Ok((summary, self.tallied(options, statistics)))
    }

    /// Flies the trials as [`run`](Self::run) does, and returns their statistics in a form that merges with that of other trials:
    /// those before [`first_trial`](TrialOptions::first_trial), and those after.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn tally(
        &self,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<Tally, SimulationError> {
        let (statistics, _) = self.flown(options, observer, progress)?;
        Ok(self.tallied(options, statistics))
    }

    /// Statistics with what they are of.
    fn tallied(&self, options: &TrialOptions, statistics: Statistics) -> Tally {
        let of = Flights {
            mission: self.mission.digest(),
            errors: format!("{:?}", self.uncertainty),
            seed: options.seed,
            policy: options.policy,
            hop_limit: self.hop_limit(options),
            goal_tolerance_m: options.goal_tolerance_m,
        };
        Tally { of, statistics }
    }

    fn flown(
        &self,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<(Statistics, Vec<Trajectory>), SimulationError> {
        self.check(options)?;
        observer.begin(options.policy);
        match &self.ground_and_plan {
            GroundAndPlan::Chain(ground, plan) => self.fly_all(ground, plan, options, observer, progress),
            GroundAndPlan::Map(ground, plan) => self.fly_all(ground, plan, options, observer, progress),
            GroundAndPlan::Mesh(ground, plan) => self.fly_all(ground, plan, options, observer, progress),
        }
    }

    fn hop_limit(&self, options: &TrialOptions) -> u32 {
        if let Some(command) = self.mission.drift {
            return command.hops;
        }
        options.hop_limit.unwrap_or_else(|| TrialOptions::default_hop_limit(self.mission.hops()))
    }

    /// The share of fixed trials that reach the goal, under the policy, tolerance and hop limit of the options.
    ///
    /// The same for every question, so that two paths differ by their own reliability and not by chance: 512 trials, whose share is
    /// within 0.044 of the success probability in 95 of 100 cases.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn estimated_success(&self, options: &TrialOptions, progress: &dyn Progress) -> Result<f64, SimulationError> {
        /// Apart from the seeds that users give.
        const SEED: u64 = 0x6368_7461;
        let fixed = TrialOptions {
            trials: ESTIMATE_TRIALS,
            seed: SEED,
            first_trial: 0,
            until_half_width: None,
            trajectories: 0,
            ..*options
        };
        Ok(self.run(&fixed, &mut (), progress)?.success.rate)
    }

    /// Flies the trials under both policies, open loop first, on the same draws.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn compare(
        &self,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<[Summary; 2], SimulationError> {
        let mut of = |policy| self.run(&TrialOptions { policy, ..*options }, observer, progress);
        let [open_loop, replan] = Policy::ALL;
        Ok([of(open_loop)?, of(replan)?])
    }

    /// Flies one hop from a position of the nominal ground to its first contact. If the velocity points into the ground, the
    /// contact is the take-off point. No limit is checked. `None` if there is no ground at that position, and over a mesh, of which several
    /// surfaces may lie there.
    ///
    /// `from`: x and y as in [`HopRecord`](super::HopRecord).
    pub fn fly(&self, from: Point2<f64>, liftoff: LiftoffVelocity) -> Option<FlightEnd> {
        match &self.ground_and_plan {
            GroundAndPlan::Chain(ground, _) => {
                let station = ground.test().chain().geometry().station(from.x).ok()?;
                Some(flown(ground, &ChainPosition { station, left_m: from.y }, &liftoff))
            }
            GroundAndPlan::Map(ground, _) => Some(flown(ground, &ground.position(from)?, &liftoff)),
            GroundAndPlan::Mesh(..) => None,
        }
    }

    /// Checks the options.
    fn check(&self, options: &TrialOptions) -> Result<(), SimulationError> {
        let TrialOptions { first_trial, trials, policy, hop_limit, goal_tolerance_m: found, until_half_width, .. } = *options;
        if trials == 0 {
            return Err(SimulationError::NoTrials);
        }
        if first_trial.checked_add(trials).is_none() {
            return Err(SimulationError::Range { first_trial, trials });
        }
        if hop_limit == Some(0) {
            return Err(SimulationError::NoHops);
        }
        if !(found.is_finite() && found >= 0.0) {
            return Err(SimulationError::GoalTolerance { found });
        }
        if let Some(found) = until_half_width.filter(|width| !(*width > 0.0 && *width < 0.5)) {
            return Err(SimulationError::HalfWidth { found });
        }
        let replans = match &self.ground_and_plan {
            GroundAndPlan::Chain(_, plan) => plan.legs().all(|leg| leg.replan.is_some()),
            GroundAndPlan::Map(_, plan) => plan.legs().all(|leg| leg.replan.is_some()),
            GroundAndPlan::Mesh(_, plan) => plan.legs().all(|leg| leg.replan.is_some()),
        };
        if policy == Policy::Replan && !replans {
            return Err(SimulationError::NoCostsToGo);
        }
        Ok(())
    }

    fn fly_all<G: FirstContact + Windows>(
        &self,
        ground: &G,
        plan: &Plan<G::Contact>,
        options: &TrialOptions,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<(Statistics, Vec<Trajectory>), SimulationError> {
        let meter = Meter::with_total(progress, Stage::Trials, options.trials);
        meter.report(Detail::None)?;
        let drifts = self.mission.drift.is_some();
        let errors = self.uncertainty.clone();
        let rules = Rules {
            errors: if drifts { Errors::with_any_heading(errors) } else { Errors::new(errors, options.policy == Policy::Replan) },
            policy: if drifts { Policy::OpenLoop } else { options.policy },
            hop_limit: self.hop_limit(options),
            // Wherever a robot without a goal rests after its hops.
            goal_tolerance_m: if drifts { f64::INFINITY } else { options.goal_tolerance_m },
            tank: Tank::of(ground.hopper().limits()),
        };
        let keep_records = observer.wants_records();
        let place = |contact: &G::Contact| {
            let point = ground.point(contact);
            [point.x, point.y]
        };
        let mut tally = Statistics::new(PlannedPlaces {
            landings: plan.legs().flat_map(|leg| &leg.hops).map(|hop| place(&hop.command.aim)).collect(),
            goal: [plan.last().goal.x, plan.last().goal.y],
            on_a_map: !matches!(self.ground_and_plan, GroundAndPlan::Chain(..)),
        });
        let mut trajectories = Vec::new();
        let last = options.first_trial + options.trials;
        let mut done = options.first_trial;
        while done < last {
            let end = last.min(done.saturating_add(BATCH));
            let starts: Vec<u64> = (done..end).step_by(usize::try_from(STRETCH).unwrap_or(usize::MAX)).collect();
            let stretch = |first: u64| {
                let mut realized = ground.clone();
                let mut draws = TrialDraws::seeded(options.seed);
                let mut flown = Flown::default();
                for trial in first..end.min(first + STRETCH) {
                    let keep = keep_records || trial - options.first_trial < options.trajectories;
                    fly((ground, &mut realized), &mut draws, plan, &rules, trial, keep, &mut flown);
                }
                flown
            };
            let stretches: Vec<Flown> = starts.into_par_iter().map(stretch).collect();
            for flown in &stretches {
                add(flown, &mut tally, &mut trajectories, options.first_trial.saturating_add(options.trajectories));
                if keep_records {
                    tell(flown, observer);
                }
            }
            done = end;
            meter.set_done(done - options.first_trial, options.trials);
            meter.report(Detail::Trials { reached_goal: tally.reached_goal() })?;
            if options.until_half_width.is_some_and(|width| tally.success().half_width() <= width) {
                break;
            }
        }
        Ok((tally, trajectories))
    }
}

/// Adds the results of some trials, in their order; those with a number below `wanted_end` with all their hops.
fn add(flown: &Flown, tally: &mut Statistics, trajectories: &mut Vec<Trajectory>, wanted_end: u64) {
    for trial in &flown.trials {
        tally.trial(trial);
        if trial.trial < wanted_end {
            let hops = flown.hops.iter().filter(|hop| hop.trial == trial.trial).copied().collect();
            trajectories.push(Trajectory { trial: *trial, hops });
        }
    }
    for landing in &flown.landings {
        tally.landing(landing);
    }
}

/// Reports some trials to an observer, in their order.
fn tell(flown: &Flown, observer: &mut dyn Observer) {
    let mut hops = flown.hops.iter().peekable();
    for trial in &flown.trials {
        while let Some(hop) = hops.next_if(|hop| hop.trial == trial.trial) {
            observer.hop(hop);
        }
        observer.trial(trial);
    }
}

/// Flies one hop that has no planned landing; `from` is passed as the aim.
fn flown<G: FirstContact>(ground: &G, from: &G::Contact, liftoff: &LiftoffVelocity) -> FlightEnd {
    let flight = ground.first_contact(from, liftoff, from);
    FlightEnd { at_m: ground.point(&flight.end), landed: flight.support_facet.is_some(), time_s: flight.time_s }
}

/// The command of a planned hop along a heading.
pub(super) fn command<C: Copy>(hop: &Hop, heading: Vector2<f64>, aim: C) -> Command<C> {
    let (sine, cosine) = libm::sincos(hop.takeoff_angle.radians());
    let speed_m_s = hop.takeoff_speed_m_s;
    let liftoff = LiftoffVelocity { heading, horizontal_m_s: speed_m_s * cosine, vertical_m_s: speed_m_s * sine };
    Command { liftoff, speed_m_s, aim, rest: aim }
}

/// The plan along a chain.
fn chain_plan(mission: &Mission) -> Result<Plan<ChainPosition>, SimulationError> {
    let position =
        |point: &ContactPoint, which| point.station.map(ChainPosition::on_chain).ok_or(SimulationError::NotOnChain { which });
    let planned = mission.path.hops.iter().enumerate().map(|(i, hop)| {
        let which = MissionPoint::Hop(i + 1);
        let (from, aim) = (position(&hop.takeoff, which)?, position(&hop.landing, which)?);
        Ok(PlannedHop { from, command: command(hop, heading_of(hop.direction), aim) })
    });
    let hops = planned.collect::<Result<_, SimulationError>>()?;
    let replan = match &mission.replanning {
        Some(Replanning::Nodes { test, to_go }) => {
            Some(Box::new(ChainReplan { test: test.as_ref().clone(), to_go: Arc::clone(to_go) }) as _)
        }
        Some(_) | None => None,
    };
    let goal = Point3::new(mission.goal.along_m, 0.0, mission.goal.point_m.z);
    Ok(Plan { start: position(&mission.start, MissionPoint::Start)?, goal, hops, replan, next: None })
}

/// The plan on a map.
fn map_plan(mission: &Mission, ground: &DemGround) -> Result<Plan<MapPosition>, SimulationError> {
    let position = |point: &ContactPoint, which| {
        let at = point.map().ok_or(SimulationError::NotOnMap { which })?;
        Ok::<_, SimulationError>(MapPosition { at, z_m: point.point_m.z })
    };
    let planned = mission.path.hops.iter().enumerate().map(|(i, hop)| {
        let which = MissionPoint::Hop(i + 1);
        let (from, aim) = (position(&hop.takeoff, which)?, position(&hop.landing, which)?);
        let away = aim.at - from.at;
        Ok(PlannedHop { from, command: command(hop, away / away.norm(), aim) })
    });
    let hops = planned.collect::<Result<_, SimulationError>>()?;
    let on_ground = |point: &ContactPoint, which| {
        let position = position(point, which)?;
        if !ground.covers(position.at) {
            return Err(SimulationError::NoGround { which, x_m: position.at.x, y_m: position.at.y });
        }
        Ok(position)
    };
    let (start, goal) = (on_ground(&mission.start, MissionPoint::Start)?, on_ground(&mission.goal, MissionPoint::Goal)?);
    let planning = mission.planned_over.as_deref().unwrap_or(ground);
    let replan: Option<Box<dyn Replan<MapPosition>>> = match &mission.replanning {
        Some(Replanning::Nodes { test, to_go }) => {
            let stations = to_go.nodes().stations().iter();
            let node = |station| on_ground(&test.chain().contact_point(station), MissionPoint::Node);
            let nodes = stations.map(node).collect::<Result<_, _>>()?;
            Some(Box::new(MapReplan::new(planning.clone(), Arc::clone(to_go), nodes)))
        }
        Some(Replanning::Corridor(corridor)) => Some(Box::new(CorridorReplan { corridor: Arc::clone(corridor) })),
        Some(Replanning::PostCosts(to_go)) => Some(Box::new(CheapestPost::new(planning, to_go))),
        Some(Replanning::PostRisks(to_go)) => Some(Box::new(ReliablePost::new(planning, to_go))),
        Some(Replanning::Contacts(_)) | None => None,
    };
    Ok(Plan { start, goal: ground.point(&goal), hops, replan, next: None })
}

/// The plan over a mesh.
fn mesh_plan(mission: &Mission, ground: &MeshGround) -> Result<Plan<MeshPosition>, SimulationError> {
    let position = |point: &ContactPoint, which| {
        let own = ground.contact_at(point).filter(|own| own.point_m == point.point_m);
        own.ok_or(SimulationError::NotOnMesh { which, point_m: point.point_m.coords.into() })
    };
    let planned = mission.path.hops.iter().enumerate().map(|(i, hop)| {
        let which = MissionPoint::Hop(i + 1);
        let (from, aim) = (position(&hop.takeoff, which)?, position(&hop.landing, which)?);
        let (_, heading) = Surface::course(ground, &from, &aim).ok_or(SimulationError::NoCourse { which })?;
        Ok(PlannedHop { from, command: command(hop, heading, aim) })
    });
    let hops = planned.collect::<Result<_, SimulationError>>()?;
    let (start, goal) = (position(&mission.start, MissionPoint::Start)?, position(&mission.goal, MissionPoint::Goal)?);
    let replan: Option<Box<dyn Replan<MeshPosition>>> = match &mission.replanning {
        // A hop to a contact has no nearest command in steps here.
        Some(Replanning::Contacts(contacts)) if ground.hopper().limits().steps.is_continuous() => {
            Some(Box::new(ContactReplan::new(contacts)))
        }
        _ => None,
    };
    Ok(Plan { start, goal: goal.point_m, hops, replan, next: None })
}
