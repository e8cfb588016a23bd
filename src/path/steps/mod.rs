//! Commands of a machine that takes them in steps.
//!
//! A path of the search has exact commands. Here each hop is aimed again from where the one before really lands, with the nearest
//! command the machine has, and is flown to where it really lands:
//!
//! ```text
//!   planned     o-----------o-----------o        the landings of the search
//!   commanded   o----------x----------x          nearest commands; each hop starts where the last one landed
//!                                     |<->|      the miss
//! ```
//!
//! All limits are judged on the hop so flown. Where the nearest command breaks one, the next nearest is tried, and after the last of
//! them the hop before gets its next nearest.
//!
//! The machine flies over any [`SteppedGround`]: along a chain, or over a DEM, where it takes a heading in steps as well and leaves the
//! line of the search.

mod commands;
mod grounds;

use super::{Aim, Hop, generate::hop};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    ground::{ChainGround, ContactPoint, DemGround, LiftoffVelocity},
    hop::HopTest,
    quantity::{Angle, SlopeInterval},
    world::{CommandSteps, Limit, SPEED_TOLERANCE, headings_near, tolerant_speed_m_s},
};
use commands::Command;
pub(crate) use grounds::SteppedGround;
use grounds::{Heading, Line, Pair, Target};

/// No sequence of commands in the machine's steps flies a path that exact commands would.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCommand {
    /// No command near that of a hop keeps all limits.
    #[error(
        "the path found ({hops} hop{}) is for exact commands: of {tried} commands in the machine's steps ({steps}), none flies hop {hop} from {} \
         to near x = {aim_x_m} m within all limits ({limit}); use smaller steps, or nodes closer together",
        if *hops == 1 { "" } else { "s" },
        if *hop == 1 { "the start" } else { "where the hop before lands" }
    )]
    Refused {
        /// The farthest hop that was tried, from 1.
        hop: usize,
        /// How many hops the path has.
        hops: usize,
        /// The x of its planned landing.
        aim_x_m: String,
        /// The limit that refused the nearest command.
        limit: Limit,
        /// How many commands were flown.
        tried: usize,
        /// The steps.
        steps: String,
    },
    /// The hops follow a line whose heading is not a multiple of the step, and the ground beside the line is not known.
    #[error(
        "hop {hop} flies along the transect at a heading of {heading_deg} degrees from grid north, and the nearest that \
         hopper.heading_step_deg allows is {nearest_deg}: a hop at this heading leaves the line, and the ground is known on the line alone; \
         choose start and goal so that the transect has this heading, such as {goal}, give the DEM that the line was cut from (terrain.dem), \
         or leave the key out"
    )]
    Heading {
        /// The hop, from 1.
        hop: usize,
        /// Its heading.
        heading_deg: String,
        /// The nearest multiple of the step.
        nearest_deg: String,
        /// The ends of a line with this heading, from where the hop takes off as far as where the path ends.
        goal: String,
    },
}

/// Commands flown per hop of a path before it is given up, on average.
const PER_HOP: usize = 400;

/// Relative tolerance of a slope against the window of the hop that is flown: rounding, far below the tolerances of the checker.
const TOLERANCE: f64 = 1e-13;

/// A landing farther from its aim than this share of the planned hop is another hop, not the planned one.
const MISS_MAX: f64 = 0.25;

/// The hops of a path with the nearest commands of the machine: along their chain or, where the machine has no heading along it and the
/// DEM that it was cut from is known, over that DEM.
///
/// # Errors
/// [`NoCommand`].
///
/// # Complexity
/// One flight and one hop test per command tried: one or a few a hop, at most 400 on average.
pub(super) fn in_steps(
    test: &HopTest,
    dem: Option<&DemGround>,
    planned: Vec<Hop>,
    choice: TakeoffChoice,
) -> Result<Vec<Hop>, NoCommand> {
    let steps = test.hopper().limits().steps;
    if steps.is_continuous() {
        return Ok(planned);
    }
    match (headings(&planned, steps), dem) {
        (Ok(()), _) => Machine { ground: &ChainGround::new(test.clone()), steps, choice }.flown(&planned),
        (Err(_), Some(dem)) => Machine { ground: dem, steps, choice }.flown(&planned),
        (Err(refusal), None) => Err(refusal),
    }
}

/// The command of a machine in steps that is nearest to an exact one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestCommand<C> {
    /// The velocity at the take-off.
    pub(crate) liftoff: LiftoffVelocity,
    /// Its speed, m/s.
    pub(crate) speed_m_s: f64,
    /// Where it lands.
    pub(crate) landing: C,
}

/// The nearest command of a machine that flies from a contact to near another under all limits, and where it lands; `None` without such a
/// command.
pub(crate) fn nearest_command<G: SteppedGround>(
    ground: &G,
    takeoff: &G::Contact,
    aim: &G::Contact,
    choice: TakeoffChoice,
) -> Option<NearestCommand<G::Contact>> {
    let steps = ground.hopper().limits().steps;
    let machine = Machine { ground, steps, choice };
    let targets = ground.targets(takeoff, aim, steps).into_iter();
    let commands = targets.flat_map(|target| {
        let commands = machine.commands(takeoff, &target).unwrap_or_default();
        commands.into_iter().map(move |command| (target, command))
    });
    commands.take(G::TRIED_ANEW).find_map(|(target, command)| {
        let flown = machine.fly(takeoff, command, &target, aim).ok()?;
        let liftoff = liftoff(flown.command, target.heading);
        Some(NearestCommand { liftoff, speed_m_s: flown.command.1, landing: flown.landing })
    })
}

/// A transect fixes the heading of its hops: each has to be a multiple of the step.
fn headings(hops: &[Hop], steps: CommandSteps) -> Result<(), NoCommand> {
    let Some(step_deg) = steps.heading.map(Angle::degrees) else { return Ok(()) };
    for (i, hop) in hops.iter().enumerate() {
        if hop.takeoff.map().is_some() && !steps.has_heading(hop.heading_deg) {
            let nearest_deg = headings_near(hop.heading_deg, step_deg).first().copied().unwrap_or(0.0);
            let text = |degrees: f64| format!("{degrees:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
            let from = hop.takeoff.point_m.xy();
            let length_m = hops.last().map_or(0.0, |last| (last.landing.point_m.xy() - from).norm());
            let (east, north) = libm::sincos(nearest_deg.to_radians());
            let to = (from.x + length_m * east, from.y + length_m * north);
            let goal = format!("({:.3}, {:.3}) m to ({:.3}, {:.3}) m", from.x, from.y, to.0, to.1);
            return Err(NoCommand::Heading {
                hop: i + 1,
                heading_deg: text(hop.heading_deg),
                nearest_deg: text(nearest_deg),
                goal,
            });
        }
    }
    Ok(())
}

/// The velocity of a command along a heading.
fn liftoff((angle, speed_m_s): Command, heading: Heading) -> LiftoffVelocity {
    let (up, across) = libm::sincos(angle.radians());
    LiftoffVelocity { heading: heading.along, horizontal_m_s: speed_m_s * across, vertical_m_s: speed_m_s * up }
}

/// The machine over its ground.
struct Machine<'a, G> {
    ground: &'a G,
    steps: CommandSteps,
    choice: TakeoffChoice,
}

/// The commands of one hop that are still to be tried, and the hop flown with the current one.
struct Trial<C> {
    /// The targets still to be aimed at, the next one last.
    targets: Vec<Target<C>>,
    /// The target aimed at, and its commands still to be tried, the next one last.
    current: Option<(Target<C>, Vec<Command>)>,
    /// The headings that had commands.
    headings: Vec<Heading>,
    flown: Option<(Hop, C)>,
}

/// One command flown.
struct Flown<C> {
    command: Command,
    landing: C,
    /// The hop test from take-off to landing.
    pair: Pair,
    lofts: SlopeInterval,
    sight: LineOfSight,
    loft: f64,
}

impl<G: SteppedGround> Machine<'_, G> {
    /// A depth-first search over the commands of all hops, nearest commands first.
    fn flown(&self, planned: &[Hop]) -> Result<Vec<Hop>, NoCommand> {
        let budget = PER_HOP * (planned.len() + 1);
        let (mut trials, mut tried): (Vec<Trial<G::Contact>>, usize) = (Vec::with_capacity(planned.len()), 0);
        let mut farthest = None;
        let start = planned.first().and_then(|hop| Some((hop.takeoff, self.ground.planned(&hop.takeoff)?)));
        while trials.len() < planned.len() || trials.last().is_some_and(|trial| trial.flown.is_none()) {
            // Where the hop in question takes off: the landing of the one before it, which is flown.
            let is_new = trials.last().is_none_or(|trial| trial.flown.is_some());
            let number = if is_new { trials.len() } else { trials.len() - 1 };
            let takeoff = match number.checked_sub(1) {
                Some(before) => trials[before].flown.map(|(hop, at)| (hop.landing, at)),
                None => start.map(|(point, at)| (self.ground.stated(&at, &Line::of(&planned[0]), point.along_m), at)),
            };
            let aim = self.ground.planned(&planned[number].landing);
            let Some((takeoff, aim)) = takeoff.zip(aim) else {
                farthest = Some(later(farthest, (number, Limit::Direction)));
                return Err(self.refused(planned, farthest, tried));
            };
            if is_new {
                let mut targets = self.ground.targets(&takeoff.1, &aim, self.steps);
                if targets.is_empty() {
                    farthest = Some(later(farthest, (number, Limit::HeadingStep)));
                }
                targets.reverse();
                trials.push(Trial { targets, current: None, headings: Vec::new(), flown: None });
            }
            let Some((target, command)) = self.next(&mut trials[number], &takeoff.1, |limit| {
                farthest = Some(later(farthest, (number, limit)));
            }) else {
                trials.pop();
                match trials.last_mut() {
                    // The hop before gets its next command.
                    Some(before) => before.flown = None,
                    None => return Err(self.refused(planned, farthest, tried)),
                }
                continue;
            };
            if tried == budget {
                return Err(self.refused(planned, farthest, tried));
            }
            tried += 1;
            let flown = self.fly(&takeoff.1, command, &target, &aim);
            match flown.and_then(|flown| self.hop(&planned[number], takeoff, &target, &flown).map(|hop| (hop, flown.landing))) {
                Ok(flown) => trials[number].flown = Some(flown),
                Err(limit) => farthest = Some(later(farthest, (number, limit))),
            }
        }
        Ok(trials.into_iter().filter_map(|trial| Some(trial.flown?.0)).collect())
    }

    /// The next command of a hop; `None` after the last one. Reports the limit of each target that has no commands.
    fn next(
        &self,
        trial: &mut Trial<G::Contact>,
        takeoff: &G::Contact,
        mut refused: impl FnMut(Limit),
    ) -> Option<(Target<G::Contact>, Command)> {
        loop {
            if let Some((target, left)) = &mut trial.current
                && let Some(command) = left.pop()
            {
                return Some((*target, command));
            }
            let target = trial.targets.pop()?;
            // In steps of angle or speed, the commands around one target of a heading are those around all of them.
            let is_exact = self.steps.takeoff_angle.is_none() && self.steps.takeoff_speed_m_s.is_none();
            if !is_exact && trial.headings.contains(&target.heading) {
                continue;
            }
            let mut left = self.commands(takeoff, &target).unwrap_or_else(|limit| {
                refused(limit);
                Vec::new()
            });
            if !left.is_empty() {
                trial.headings.push(target.heading);
            }
            left.reverse();
            trial.current = Some((target, left));
        }
    }

    fn refused(&self, planned: &[Hop], farthest: Option<(usize, Limit)>, tried: usize) -> NoCommand {
        let (hop, limit) = farthest.unwrap_or((0, Limit::TakeoffAngleStep));
        let CommandSteps { takeoff_angle, takeoff_speed_m_s, heading } = self.steps;
        let angle = takeoff_angle.map(|step| format!("{} degrees", step.written_degrees()));
        let speed = takeoff_speed_m_s.map(|step| format!("{step} m/s"));
        let heading = heading.filter(|_| G::LEAVES_THE_LINE).map(|step| format!("{} degrees of heading", step.written_degrees()));
        NoCommand::Refused {
            hop: hop + 1,
            hops: planned.len(),
            aim_x_m: format!("{:.3}", planned[hop].landing.along_m),
            limit,
            tried,
            steps: angle.into_iter().chain(speed).chain(heading).collect::<Vec<_>>().join(", "),
        }
    }

    fn arc(&self, sight: LineOfSight, loft: f64) -> Arc {
        Arc::new(sight, loft, self.ground.gravity_m_s2())
    }

    /// A command flown to where it really lands, under all limits.
    fn fly(
        &self,
        takeoff: &G::Contact,
        command: Command,
        target: &Target<G::Contact>,
        aim: &G::Contact,
    ) -> Result<Flown<G::Contact>, Limit> {
        let (angle, speed_m_s) = command;
        let flight = self.ground.first_contact(takeoff, &liftoff(command, target.heading), &target.at);
        let landing = flight.support_facet.and_then(|_| self.ground.landed(flight.end)).ok_or(Limit::Direction)?;
        let (run_m, forwards) = self.ground.course(takeoff, aim).ok_or(Limit::Direction)?;
        let miss = (self.ground.point(&landing) - self.ground.point(aim)).xy();
        if miss.norm() > MISS_MAX * run_m {
            return Err(self.coarse(miss.dot(&forwards).abs() < forwards.perp(&miss).abs()));
        }
        let pair = self.ground.pair(takeoff, &landing)?;
        let sight = pair.test.line_of_sight(&pair.takeoff, &pair.landing).ok_or(Limit::Terrain)?;
        let lofts = pair.test.lofts(&pair.takeoff, &pair.landing)?;
        let loft = angle.slope() - sight.slope();
        match self.outside(&pair, (sight, loft), lofts, speed_m_s) {
            Some(limit) => Err(limit),
            None => Ok(Flown { command, landing, pair, lofts, sight, loft }),
        }
    }

    /// The step that makes a landing lie too far from its aim; `aside`: more to the side than along.
    const fn coarse(&self, aside: bool) -> Limit {
        if aside || (self.steps.takeoff_angle.is_none() && self.steps.takeoff_speed_m_s.is_none() && self.steps.heading.is_some()) {
            Limit::HeadingStep
        } else if self.steps.takeoff_speed_m_s.is_some() {
            Limit::TakeoffSpeedStep
        } else {
            Limit::TakeoffAngleStep
        }
    }

    /// The hop of a command that was flown, with all its numbers.
    ///
    /// # Errors
    /// [`Limit::Direction`] if it does not lead on along the line of the planned hop.
    fn hop(
        &self,
        planned: &Hop,
        (takeoff, _): (ContactPoint, G::Contact),
        target: &Target<G::Contact>,
        flown: &Flown<G::Contact>,
    ) -> Result<Hop, Limit> {
        let Flown { command: (takeoff_angle, takeoff_speed_m_s), pair, .. } = flown;
        let arc = self.arc(flown.sight, flown.loft);
        let own = hop(&pair.test, pair.takeoff, pair.landing, &arc, flown.lofts, Limit::TakeoffSpeed);
        let commanded = Hop { takeoff_angle: *takeoff_angle, takeoff_speed_m_s: *takeoff_speed_m_s, ..own };
        let line = Line::of(planned);
        if !G::LEAVES_THE_LINE {
            let miss_m = own.direction.sign() * (own.landing.along_m - planned.landing.along_m);
            return Ok(Hop { aim: Some(Aim { point: planned.landing, miss_m, across_m: None }), ..commanded });
        }
        let landing = self.ground.stated(&flown.landing, &line, planned.landing.along_m);
        let (miss_m, across_m) = line.off(&landing, &planned.landing);
        if planned.direction.sign() * (landing.along_m - takeoff.along_m) <= 0.0 {
            return Err(Limit::Direction);
        }
        Ok(Hop {
            direction: planned.direction,
            takeoff,
            landing,
            heading_deg: target.heading.degrees.unwrap_or(own.heading_deg),
            // A vertex of the slice under this hop is not a vertex of the chain.
            lower_vertex: None,
            aim: Some(Aim { point: planned.landing, miss_m, across_m: Some(across_m) }),
            ..commanded
        })
    }

    /// Whether a speed is below the machine's least one.
    fn is_too_slow(&self, speed_m_s: f64) -> bool {
        let least_m_s = self.ground.hopper().limits().takeoff_speed_min_m_s;
        least_m_s.is_some_and(|least_m_s| speed_m_s < least_m_s * (1.0 - SPEED_TOLERANCE))
    }

    /// The limit that a command breaks on the hop that it really flies; `None` if it keeps all.
    fn outside(
        &self,
        Pair { test, takeoff, landing }: &Pair,
        (sight, loft): (LineOfSight, f64),
        lofts: SlopeInterval,
        speed_m_s: f64,
    ) -> Option<Limit> {
        let slope = sight.slope() + loft;
        let tolerance = TOLERANCE * (1.0 + slope * slope);
        if speed_m_s > tolerant_speed_m_s(test.chain().speed_bounds_m_s().0) {
            return Some(Limit::TakeoffSpeed);
        }
        if self.is_too_slow(speed_m_s) {
            return Some(Limit::TakeoffSpeedMin);
        }
        let binding = || test.takeoff_set(takeoff, landing).and_then(|set| set.binding());
        if loft < lofts.lower - tolerance {
            return Some(binding().map_or(Limit::Terrain, |binding| binding.lower.limit));
        }
        (loft > lofts.upper + tolerance).then(|| binding().map_or(Limit::TakeoffCone, |binding| binding.upper.limit))
    }
}

/// The farther of two hops, with the limit that refused it; of the same hop, the earlier one, whose command is nearer.
const fn later(before: Option<(usize, Limit)>, now: (usize, Limit)) -> (usize, Limit) {
    match before {
        Some(before) if before.0 >= now.0 => before,
        _ => now,
    }
}
