//! Trials of a robot with legs: where its errors bring it down, and whether it stands there.
//!
//! ```text
//!     . - ~ - .            It comes down where its root is as high over the ground as at the planned landing. There its feet look for
//!   .           `          ground anew: too few of them, or a trunk that meets the ground, and it has fallen.
//!  root          root'
//! ```

use nalgebra::{Point3, UnitQuaternion, Vector2, Vector3};
use rayon::prelude::*;

use super::{
    LegsWalking, Policy, QuantileSketch, SimulationError, TrialOptions, Wilson, driving::DriveDraws, legs_walk::WalkDraws,
};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    flight::{Command, Errors, HopErrors, TrialDraws, Uncertainty},
    ground::{LiftoffVelocity, Pose, Stance, StanceBuffers, StanceGround},
    planner::roadmap::RoadmapMove,
    progress::{Detail, Meter, Progress, Stage},
    world::{Limit, tolerant_speed_m_s},
};

/// After so many trials progress is reported and the wanted precision checked.
const BATCH: u64 = 200;

/// Steps of a flight to its planned end.
const STEPS: u32 = 200;

/// A direction this far outside the cone of the feet, of 1, is on its edge.
const ON_THE_EDGE: f64 = 1.0e-6;

/// A flight that has not come down after so many times its planned duration has left the ground.
const LONGEST: u32 = 4;

/// A robot that replans makes at most so many moves for each planned one, and these beside.
const MOVES_MOST: (usize, usize) = (3, 20);

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LegsOutcome {
    /// It stands within the goal tolerance (horizontal distance of its root).
    Reached,
    /// It stands elsewhere after the last planned hop.
    Missed,
    /// Its feet do not push in the direction of a take-off, with the limits of a push.
    SlidAtTakeoff,
    /// Its feet do not stop it in the direction in which it came down.
    SlidAtLanding,
    /// It came down faster than its greatest landing speed.
    Damaged,
    /// Its trunk met the ground in flight.
    Crashed,
    /// It came down where it cannot stand: too few feet find ground, or its trunk meets it.
    Fell,
    /// It left the ground of the mesh.
    Lost,
    /// A limit refused the line of a walk, or its ground was unknown or kept out: it stopped there.
    WalkStopped,
    /// A failure ended its walking.
    WalkFailed,
    /// No move leads on from where it believes to stand (replanned).
    Stuck,
    /// It made the greatest number of moves without ending otherwise (replanned).
    HopLimit,
}

impl LegsOutcome {
    /// All of them, in the order of results.
    pub const ALL: [Self; 12] = [
        Self::Reached,
        Self::Missed,
        Self::SlidAtTakeoff,
        Self::SlidAtLanding,
        Self::Damaged,
        Self::Crashed,
        Self::Fell,
        Self::Lost,
        Self::WalkStopped,
        Self::WalkFailed,
        Self::Stuck,
        Self::HopLimit,
    ];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Missed => "missed",
            Self::SlidAtTakeoff => "slid_at_takeoff",
            Self::SlidAtLanding => "slid_at_landing",
            Self::Damaged => "damaged",
            Self::Crashed => "crashed",
            Self::Fell => "fell",
            Self::Lost => "lost",
            Self::WalkStopped => "walk_stopped",
            Self::WalkFailed => "walk_failed",
            Self::Stuck => "stuck",
            Self::HopLimit => "hop_limit",
        }
    }
}

crate::quantity::by_name!(LegsOutcome, LegsOutcome::ALL);

/// A planned path of a robot with legs, ready to be tried.
#[derive(Clone, Debug)]
pub struct LegsMission {
    /// The ground with the whole limits, over which it flies.
    pub whole: StanceGround,
    /// The ground under the limits that planning may use, by which it replans.
    pub planning: StanceGround,
    /// The stances of the path.
    pub stances: Vec<Stance>,
    /// The move from each to the next.
    pub moves: Vec<RoadmapMove>,
    /// Stances from which the goal can be reached, with their hops to it; needed for [`Policy::Replan`] of a robot that hops alone.
    pub aims: Vec<(Stance, u32)>,
    /// How it walks; `None` of a robot that hops alone.
    pub walking: Option<LegsWalking>,
    /// Which of the feasible take-off angles a replanned hop has.
    pub takeoff: TakeoffChoice,
}

/// What trials show.
#[derive(Clone, Debug, PartialEq)]
pub struct LegsSummary {
    /// The policy.
    pub policy: Policy,
    /// The seed.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The share that reached the goal.
    pub success: Wilson,
    /// How many ended in each way that occurs.
    pub outcomes: Vec<(LegsOutcome, u64)>,
    /// By the number of the move, from 1, how many ended during it otherwise than at the goal; 0: after the last one.
    pub ended_in: Vec<(usize, u64)>,
    /// How far from the goal the trials ended: median and 95 % quantile, m.
    pub goal_distance_m: Option<[f64; 2]>,
}

/// One trial.
struct Tried {
    outcome: LegsOutcome,
    ended_in: usize,
    goal_distance_m: f64,
}

/// A hop to make: its velocity, the heading of the robot's landing pose, and how high its root then is over the ground.
pub(super) struct Aim {
    command: Command<()>,
    landing: Pose,
    height_m: f64,
    duration_s: f64,
}

impl LegsMission {
    /// Makes the trials.
    ///
    /// A take-off has errors of its speed, elevation and heading; at the landing the trunk is turned by the error of the heading, and the root
    /// moved by the drift. Open loop the robot makes the planned take-offs from wherever it stands. Replanned, it hops from where it believes to
    /// stand to the stance with the fewest hops to the goal that one hop reaches. A robot that walks makes the planned move where one begins, and
    /// else the one by which least is left. The results do not depend on the number of threads.
    ///
    /// # Errors
    /// [`SimulationError`]: invalid errors, no trials, or cancelled.
    pub fn run(
        &self,
        errors: &Uncertainty,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<LegsSummary, SimulationError> {
        errors.check(true)?;
        if options.trials == 0 {
            return Err(SimulationError::NoTrials);
        }
        let meter = Meter::with_total(progress, Stage::Trials, options.trials);
        meter.report(Detail::None)?;
        let rules = Errors::new(errors.clone(), options.policy == Policy::Replan);
        let mut sums = Sums::default();
        let (mut done, last) = (options.first_trial, options.first_trial + options.trials);
        while done < last {
            let end = last.min(done + BATCH);
            let tried: Vec<Tried> = (done..end)
                .into_par_iter()
                .map_init(
                    || (TrialDraws::seeded(options.seed), DriveDraws::seeded(options.seed), StanceBuffers::default()),
                    |(hops, walks, buffers), trial| self.tried((&rules, errors), (options, trial), (hops, walks), buffers),
                )
                .collect();
            for tried in &tried {
                sums.add(tried);
            }
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
        (rules, errors): (&Errors, &Uncertainty),
        (options, trial): (&TrialOptions, u64),
        (hops, walks): (&mut TrialDraws, &mut DriveDraws),
        buffers: &mut StanceBuffers,
    ) -> Tried {
        let biases = rules.begin(hops, trial);
        walks.begin(trial);
        let mut draws = WalkDraws { hops, biases: &biases, walks, distribution: errors.distribution };
        let goal = self.stances[self.stances.len() - 1].pose().root_m;
        let mut at = self.stances[0].clone();
        let most = MOVES_MOST.0 * self.moves.len() + MOVES_MOST.1;
        let ended = match (options.policy, &self.walking) {
            (Policy::OpenLoop, _) => self.as_planned(rules, &mut draws, &mut at),
            (Policy::Replan, None) => self.replanning(rules, &mut draws, &mut at, (buffers, options.goal_tolerance_m, most)),
            (Policy::Replan, Some(walking)) => {
                self.walking_on((walking, rules), &mut draws, &mut at, (buffers, options.goal_tolerance_m, most))
            }
        };
        let goal_distance_m = (at.pose().root_m - goal).xy().norm();
        let at_end = if goal_distance_m <= options.goal_tolerance_m { LegsOutcome::Reached } else { LegsOutcome::Missed };
        let (outcome, ended_in) = ended.err().unwrap_or((at_end, 0));
        Tried { outcome, ended_in, goal_distance_m }
    }

    fn as_planned(&self, rules: &Errors, draws: &mut WalkDraws<'_>, at: &mut Stance) -> Result<(), (LegsOutcome, usize)> {
        for (number, (pair, planned)) in (1..).zip(self.stances.windows(2).zip(&self.moves)) {
            let moved = match (planned, &self.walking) {
                (RoadmapMove::Hop(arc), _) => {
                    let drawn = rules.draw(draws.hops, draws.biases);
                    let Some(aim) = self.aim([&pair[0], &pair[1]], arc) else { continue };
                    self.hop(rules, at, &aim, &drawn)
                }
                (RoadmapMove::Walk, Some(walking)) => {
                    let along = (pair[1].pose().root_m - pair[0].pose().root_m).xy();
                    let walked = self.walk(walking, at, (along, &pair[1]), draws);
                    walked.and_then(|stance| stance.ok_or(LegsOutcome::WalkStopped))
                }
                (RoadmapMove::Walk, None) => Err(LegsOutcome::WalkStopped),
            };
            *at = moved.map_err(|outcome| (outcome, number))?;
        }
        Ok(())
    }

    fn replanning(
        &self,
        rules: &Errors,
        draws: &mut WalkDraws<'_>,
        at: &mut Stance,
        (buffers, goal_tolerance_m, most): (&mut StanceBuffers, f64, usize),
    ) -> Result<(), (LegsOutcome, usize)> {
        let goal = self.stances[self.stances.len() - 1].pose().root_m;
        for number in 1..=most {
            let drawn = rules.draw(draws.hops, draws.biases);
            let shifted = shifted(at, &drawn);
            if (shifted.root_m - goal).xy().norm() <= goal_tolerance_m {
                return Ok(());
            }
            let believed = self.believed(at, shifted);
            let aim = self.next(&believed, buffers).ok_or((LegsOutcome::Stuck, number))?;
            *at = self.hop(rules, at, &aim, &drawn).map_err(|outcome| (outcome, number))?;
        }
        Err((LegsOutcome::HopLimit, most))
    }

    /// The stance in which it believes to be; where that would be in the air or in rock, it sees where its feet stand.
    pub(super) fn believed(&self, at: &Stance, shifted: Pose) -> Stance {
        self.planning.stand(shifted).unwrap_or_else(|_| at.clone())
    }

    /// The hop to the stance with the fewest hops to the goal that one hop reaches.
    fn next(&self, from: &Stance, buffers: &mut StanceBuffers) -> Option<Aim> {
        self.aims.iter().find_map(|(to, _)| {
            let (sight, lofts) = self.planning.windows(from, to, buffers)?;
            let (_, loft) = self.takeoff.among(sight, lofts.iter().copied())?;
            let arc = Arc::new(sight, loft, self.planning.mesh().envelope().gravity_m_s2());
            self.aim([from, to], &arc)
        })
    }

    /// The hop along an arc from one stance to another.
    pub(super) fn aim(&self, [from, to]: [&Stance; 2], arc: &Arc) -> Option<Aim> {
        let heading = self.planning.course(from, to)?.plane.heading;
        let landing = *to.pose();
        let ground_m = self.whole.ground_below_m(landing.root_m)?;
        let height_m = landing.root_m.z - ground_m;
        Some(Aim { command: Command::of_arc(arc, heading, ()), landing, height_m, duration_s: arc.flight_time_s() })
    }

    /// Makes a hop with errors, and stands where it comes down.
    pub(super) fn hop(&self, rules: &Errors, from: &Stance, aim: &Aim, drawn: &HopErrors) -> Result<Stance, LegsOutcome> {
        let liftoff = rules.liftoff(&aim.command.liftoff, aim.command.speed_m_s, drawn);
        let velocity = velocity_m_s(&liftoff);
        if self.is_refused(from, velocity) {
            return Err(LegsOutcome::SlidAtTakeoff);
        }
        let turned = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, -drawn.heading_rad));
        let landing = Pose { turn: turned * aim.landing.turn, ..aim.landing };
        let (down_m, touchdown) = self.flown(from.pose(), &landing, (velocity, aim))?;
        let limits = self.whole.mesh().envelope().hopper().limits();
        if touchdown.norm() > tolerant_speed_m_s(limits.arc_landing_speed_max_m_s()) {
            return Err(LegsOutcome::Damaged);
        }
        let [along_m, across_m] = drawn.drift_m;
        let heading = liftoff.heading;
        let moved = Vector2::new(heading.x * along_m - heading.y * across_m, heading.y * along_m + heading.x * across_m);
        let mut root_m = down_m + Vector3::new(moved.x, moved.y, 0.0);
        if moved != Vector2::zeros() {
            let above = Point3::new(root_m.x, root_m.y, root_m.z + aim.height_m.abs());
            root_m.z = self.whole.ground_below_m(above).ok_or(LegsOutcome::Lost)? + aim.height_m;
        }
        let stance = self.whole.stand(Pose { root_m, ..landing }).map_err(|_| LegsOutcome::Fell)?;
        if self.is_refused(&stance, -touchdown) {
            return Err(LegsOutcome::SlidAtLanding);
        }
        Ok(stance)
    }

    /// Whether the feet of a stance do not push in a direction.
    fn is_refused(&self, stance: &Stance, push: Vector3<f64>) -> bool {
        // A planned arc may lie on the edge of its window, where rounding decides: the sum of the normals is well inside the cone.
        let inwards: Vector3<f64> = stance.footholds().iter().map(|foot| foot.normal).sum();
        let within = push / push.norm().max(f64::MIN_POSITIVE) + inwards * ON_THE_EDGE;
        let inside = stance.cone().is_none_or(|cone| cone.contains(push) || cone.contains(within));
        let refused: Option<Limit> = self.whole.refuses_push(stance, push);
        !inside || refused.is_some()
    }

    /// Flies until the root is as high over the ground as it is to land; the place, and the velocity there.
    fn flown(
        &self,
        from: &Pose,
        landing: &Pose,
        (velocity, aim): (Vector3<f64>, &Aim),
    ) -> Result<(Point3<f64>, Vector3<f64>), LegsOutcome> {
        let fall = Vector3::new(0.0, 0.0, -self.whole.mesh().envelope().gravity_m_s2());
        let at = |time_s: f64| from.root_m + velocity * time_s + fall * (0.5 * time_s * time_s);
        let over_m = |time_s: f64| self.whole.ground_below_m(at(time_s)).map(|ground_m| at(time_s).z - ground_m - aim.height_m);
        let step_s = aim.duration_s / f64::from(STEPS);
        let mut was_over = false;
        for step in 1..=STEPS * LONGEST {
            let time_s = step_s * f64::from(step);
            let share = (time_s / aim.duration_s).min(1.0);
            // Beneath the mesh there is no ground: it has left it, or passed through it.
            let over = over_m(time_s);
            let is_down = over.is_none_or(|over| over <= 0.0) && (was_over || 2 * step > STEPS);
            if is_down {
                let (mut early, mut late) = (time_s - step_s, time_s);
                for _ in 0..40 {
                    let middle = f64::midpoint(early, late);
                    if over_m(middle).is_some_and(|over| over > 0.0) { early = middle } else { late = middle }
                }
                // Where the ground ends within the step, it has not come down on it.
                let is_on_ground = over_m(early).is_some() && over_m(late).is_some();
                return if is_on_ground { Ok((at(early), velocity + fall * early)) } else { Err(LegsOutcome::Lost) };
            }
            was_over |= over.is_some_and(|over| over > 0.0);
            let pose = Pose { root_m: at(time_s), turn: from.turn.try_slerp(&landing.turn, share, 1e-9).unwrap_or(landing.turn) };
            if self.whole.trunk_hit(&pose).is_some() {
                return Err(LegsOutcome::Crashed);
            }
        }
        Err(LegsOutcome::Lost)
    }
}

/// The pose of a stance, moved by the error of where it believes to be.
pub(super) fn shifted(at: &Stance, drawn: &HopErrors) -> Pose {
    let [east_m, north_m] = drawn.position_m;
    Pose { root_m: at.pose().root_m + Vector3::new(east_m, north_m, 0.0), ..*at.pose() }
}

fn velocity_m_s(liftoff: &LiftoffVelocity) -> Vector3<f64> {
    Vector3::new(liftoff.heading.x * liftoff.horizontal_m_s, liftoff.heading.y * liftoff.horizontal_m_s, liftoff.vertical_m_s)
}

/// What trials add up to.
#[derive(Debug, Default)]
struct Sums {
    trials: u64,
    reached: u64,
    outcomes: [u64; LegsOutcome::ALL.len()],
    ended_in: std::collections::BTreeMap<usize, u64>,
    distances: QuantileSketch,
}

impl Sums {
    fn add(&mut self, tried: &Tried) {
        self.trials += 1;
        let place = LegsOutcome::ALL.iter().position(|outcome| *outcome == tried.outcome).unwrap_or(0);
        self.outcomes[place] += 1;
        self.distances.add(tried.goal_distance_m);
        if tried.outcome == LegsOutcome::Reached {
            self.reached += 1;
        } else {
            *self.ended_in.entry(tried.ended_in).or_default() += 1;
        }
    }

    fn summary(&self, options: &TrialOptions) -> LegsSummary {
        let outcomes = LegsOutcome::ALL.into_iter().zip(self.outcomes);
        LegsSummary {
            policy: options.policy,
            seed: options.seed,
            trials: self.trials,
            success: Wilson::of(self.reached, self.trials),
            outcomes: outcomes.filter(|(_, count)| *count > 0).collect(),
            ended_in: self.ended_in.iter().map(|(number, count)| (*number, *count)).collect(),
            goal_distance_m: self.distances.quantile(0.5).zip(self.distances.quantile(0.95)).map(|(half, most)| [half, most]),
        }
    }
}
