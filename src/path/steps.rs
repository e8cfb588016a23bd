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

use super::{Aim, Hop, generate::hop};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, limits},
    chain::Station,
    ground::{ChainGround, ChainPosition, FirstContact, LiftoffVelocity, Surface, heading_of},
    hop::HopTest,
    quantity::{Angle, SlopeInterval},
    world::{CommandSteps, Direction, Limit, SPEED_TOLERANCE, is_multiple, nearest_multiple, tolerant_speed_m_s},
};

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
    /// The hops follow a line whose heading is not a multiple of the step.
    #[error(
        "hop {hop} flies along the transect at a heading of {heading_deg} degrees from grid north, and the nearest that \
         hopper.heading_step_deg allows is {nearest_deg}: choose start and goal so that the transect has this heading, or leave the key out"
    )]
    Heading {
        /// The hop, from 1.
        hop: usize,
        /// Its heading.
        heading_deg: String,
        /// The nearest multiple of the step.
        nearest_deg: String,
    },
}

/// How many multiples of a step are tried around a command, the nearest first.
const NEAREST: i32 = 24;

/// Commands flown per hop of a path before it is given up, on average.
const PER_HOP: usize = 400;

/// Relative tolerance of a slope against the window of the hop that is flown: rounding, far below the tolerances of the checker.
const TOLERANCE: f64 = 1e-13;

/// A landing farther from its aim than this share of the planned hop is another hop, not the planned one.
const MISS_MAX: f64 = 0.25;

/// The hops of a path with the nearest commands of the machine.
///
/// # Errors
/// [`NoCommand`].
///
/// # Complexity
/// One flight and one hop test per command tried: one or a few a hop, at most 400 on average.
pub(super) fn in_steps(test: &HopTest, planned: Vec<Hop>, choice: TakeoffChoice) -> Result<Vec<Hop>, NoCommand> {
    let steps = test.hopper().limits().steps;
    if steps.is_continuous() {
        return Ok(planned);
    }
    headings(&planned, steps)?;
    let machine = Machine { test, ground: ChainGround::new(test.clone()), steps, choice };
    machine.flown(&planned)
}

/// The nearest command of a machine that flies from a station to near another under all limits, and where it lands; `None` without such a command.
pub(crate) fn nearest_command(test: &HopTest, takeoff: &Station, aim: &Station, choice: TakeoffChoice) -> Option<Hop> {
    let steps = test.hopper().limits().steps;
    let machine = Machine { test, ground: ChainGround::new(test.clone()), steps, choice };
    machine.commands(takeoff, aim).ok()?.into_iter().find_map(|command| machine.fly(takeoff, command, aim).ok())
}

/// A transect fixes the heading of its hops: each has to be a multiple of the step.
fn headings(hops: &[Hop], steps: CommandSteps) -> Result<(), NoCommand> {
    let Some(step_deg) = steps.heading.map(Angle::degrees) else { return Ok(()) };
    for (i, hop) in hops.iter().enumerate() {
        if hop.takeoff.map().is_some() && !is_multiple(hop.heading_deg, step_deg) {
            let text = |degrees: f64| format!("{degrees:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
            let nearest_deg = nearest_multiple(hop.heading_deg, step_deg).rem_euclid(360.0);
            return Err(NoCommand::Heading { hop: i + 1, heading_deg: text(hop.heading_deg), nearest_deg: text(nearest_deg) });
        }
    }
    Ok(())
}

/// A command: take-off angle and speed, m/s.
type Command = (Angle, f64);

/// The machine over its ground.
struct Machine<'a> {
    test: &'a HopTest,
    ground: ChainGround,
    steps: CommandSteps,
    choice: TakeoffChoice,
}

/// The commands of one hop that are still to be tried, the next one last, and the hop flown with the current one.
struct Trial {
    left: Vec<Command>,
    flown: Option<Hop>,
}

impl Machine<'_> {
    /// A depth-first search over the commands of all hops, nearest commands first.
    fn flown(&self, planned: &[Hop]) -> Result<Vec<Hop>, NoCommand> {
        let budget = PER_HOP * (planned.len() + 1);
        let (mut trials, mut tried): (Vec<Trial>, usize) = (Vec::with_capacity(planned.len()), 0);
        let mut farthest = None;
        while trials.len() < planned.len() || trials.last().is_some_and(|trial| trial.flown.is_none()) {
            if trials.last().is_none_or(|trial| trial.flown.is_some()) {
                let takeoff = match trials.last().and_then(|trial| trial.flown.as_ref()) {
                    Some(before) => before.landing.station,
                    None => planned.first().and_then(|hop| hop.takeoff.station),
                };
                let aim = planned[trials.len()].landing.station;
                let commands = takeoff.zip(aim).ok_or(Limit::Direction).and_then(|(takeoff, aim)| self.commands(&takeoff, &aim));
                let mut left = commands.unwrap_or_else(|limit| {
                    farthest = Some(later(farthest, (trials.len(), limit)));
                    Vec::new()
                });
                left.reverse();
                trials.push(Trial { left, flown: None });
            }
            let number = trials.len() - 1;
            let before = number.checked_sub(1).and_then(|before| trials[before].flown);
            let takeoff = before.map_or_else(|| planned[0].takeoff.station, |before| before.landing.station);
            let command = trials[number].left.pop();
            let (Some(command), Some(takeoff), Some(aim)) = (command, takeoff, planned[number].landing.station) else {
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
            match self.fly(&takeoff, command, &aim) {
                Ok(hop) => trials[number].flown = Some(hop),
                Err(limit) => farthest = Some(later(farthest, (number, limit))),
            }
        }
        Ok(trials.into_iter().filter_map(|trial| trial.flown).collect())
    }

    fn refused(&self, planned: &[Hop], farthest: Option<(usize, Limit)>, tried: usize) -> NoCommand {
        let (hop, limit) = farthest.unwrap_or((0, Limit::TakeoffAngleStep));
        let CommandSteps { takeoff_angle, takeoff_speed_m_s, heading: _ } = self.steps;
        let angle = takeoff_angle.map(|step| format!("{} degrees", step.written_degrees()));
        let speed = takeoff_speed_m_s.map(|step| format!("{step} m/s"));
        NoCommand::Refused {
            hop: hop + 1,
            hops: planned.len(),
            aim_x_m: format!("{:.3}", planned[hop].landing.along_m),
            limit,
            tried,
            steps: angle.into_iter().chain(speed).collect::<Vec<_>>().join(", "),
        }
    }

    /// The commands near that of an exact hop between two stations, the nearest first.
    ///
    /// With a step of the speed alone, the angle makes up for it: each speed has two angles that land exactly.
    fn commands(&self, takeoff: &Station, aim: &Station) -> Result<Vec<Command>, Limit> {
        let sight = self.test.line_of_sight(takeoff, aim).ok_or(Limit::Direction)?;
        let lofts = self.test.lofts(takeoff, aim)?;
        let exact = self.arc(sight, self.test.loft(self.choice, sight, lofts));
        let (angle, speed_m_s) = (exact.takeoff_angle(), exact.takeoff_speed_m_s());
        let is_too_slow = |speed_m_s: f64| self.is_too_slow(speed_m_s);
        Ok(match (self.steps.takeoff_angle, self.steps.takeoff_speed_m_s) {
            (None, None) => vec![(angle, speed_m_s)],
            (Some(step), speed_step) => {
                let angles = multiples(angle.degrees(), step.degrees()).map(Angle::from_degrees);
                let inside = |angle: &Angle| angle.radians().abs() < std::f64::consts::FRAC_PI_2;
                let arcs =
                    angles.filter(inside).map(|angle| (angle, angle.slope() - sight.slope())).filter(|(_, loft)| *loft > 0.0);
                arcs.flat_map(|(angle, loft)| {
                    let exact_m_s = self.arc(sight, loft).takeoff_speed_m_s();
                    let mut speeds = match (speed_step, self.test.hopper().limits().takeoff_speed_levels) {
                        (_, Some(levels)) => levels.as_slice().to_vec(),
                        (Some(step), None) => multiples(exact_m_s, step).filter(|&speed_m_s| !is_too_slow(speed_m_s)).collect(),
                        (None, None) => vec![exact_m_s],
                    };
                    speeds.sort_by(|a, b| (a - exact_m_s).abs().total_cmp(&(b - exact_m_s).abs()));
                    speeds.into_iter().take(3).map(move |speed_m_s| (angle, speed_m_s))
                })
                .filter(|(_, speed_m_s)| *speed_m_s > 0.0)
                .collect()
            }
            (None, Some(step)) => {
                let speeds = multiples(speed_m_s, step).filter(|speed_m_s| *speed_m_s > 0.0);
                let gravity = self.test.gravity_m_s2();
                let lofts = |speed_m_s: f64| limits::takeoff_speed_level(sight, speed_m_s, gravity, lofts).into_iter().flatten();
                speeds
                    .flat_map(|speed_m_s| {
                        let mut both: Vec<f64> = lofts(speed_m_s).collect();
                        both.sort_by(|a, b| (a - exact.loft()).abs().total_cmp(&(b - exact.loft()).abs()));
                        both.into_iter().map(move |loft| (Angle::from_slope(sight.slope() + loft), speed_m_s))
                    })
                    .collect()
            }
        })
    }

    fn arc(&self, sight: LineOfSight, loft: f64) -> Arc {
        Arc::new(sight, loft, self.test.gravity_m_s2())
    }

    /// The hop of a command, to where it really lands, under all limits.
    fn fly(&self, takeoff: &Station, (angle, speed_m_s): Command, aim: &Station) -> Result<Hop, Limit> {
        let direction = Direction::between(takeoff.point.x_m, aim.point.x_m).ok_or(Limit::Direction)?;
        let (up, across) = libm::sincos(angle.radians());
        let heading = heading_of(direction);
        let liftoff = LiftoffVelocity { heading, horizontal_m_s: speed_m_s * across, vertical_m_s: speed_m_s * up };
        let [from, to] = [takeoff, aim].map(|station| ChainPosition::on_chain(*station));
        let flight = self.ground.first_contact(&from, &liftoff, &to);
        let landing = flight.support_facet.map(|_| flight.end.station).ok_or(Limit::Direction)?;
        let miss_m = direction.sign() * (landing.point.x_m - aim.point.x_m);
        if miss_m.abs() > MISS_MAX * (aim.point.x_m - takeoff.point.x_m).abs() {
            let by_speed = self.steps.takeoff_speed_m_s.is_some();
            return Err(if by_speed { Limit::TakeoffSpeedStep } else { Limit::TakeoffAngleStep });
        }
        let sight = self.test.line_of_sight(takeoff, &landing).ok_or(Limit::Terrain)?;
        let lofts = self.test.lofts(takeoff, &landing)?;
        let loft = angle.slope() - sight.slope();
        let limit = self.outside(takeoff, &landing, (sight, loft), lofts, speed_m_s);
        if let Some(limit) = limit {
            return Err(limit);
        }
        let arc = self.arc(sight, loft);
        let flown = hop(self.test, *takeoff, landing, &arc, lofts, Limit::TakeoffSpeed);
        let aimed = self.test.chain().contact_point(aim);
        Ok(Hop { takeoff_angle: angle, takeoff_speed_m_s: speed_m_s, aim: Some(Aim { point: aimed, miss_m }), ..flown })
    }

    /// Whether a speed is below the machine's least one.
    fn is_too_slow(&self, speed_m_s: f64) -> bool {
        let least_m_s = self.test.hopper().limits().takeoff_speed_min_m_s;
        least_m_s.is_some_and(|least_m_s| speed_m_s < least_m_s * (1.0 - SPEED_TOLERANCE))
    }

    /// The limit that a command breaks on the hop that it really flies; `None` if it keeps all.
    fn outside(
        &self,
        takeoff: &Station,
        landing: &Station,
        (sight, loft): (LineOfSight, f64),
        lofts: SlopeInterval,
        speed_m_s: f64,
    ) -> Option<Limit> {
        let slope = sight.slope() + loft;
        let tolerance = TOLERANCE * (1.0 + slope * slope);
        if speed_m_s > tolerant_speed_m_s(self.test.chain().speed_bounds_m_s().0) {
            return Some(Limit::TakeoffSpeed);
        }
        if self.is_too_slow(speed_m_s) {
            return Some(Limit::TakeoffSpeedMin);
        }
        let binding = || self.test.takeoff_set(takeoff, landing).and_then(|set| set.binding());
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

/// The multiples of a step around a value, the nearest first.
fn multiples(value: f64, step: f64) -> impl Iterator<Item = f64> {
    let nearest = libm::rint(value / step);
    // The second nearest lies on the other side of the value.
    let side = if value >= nearest * step { 1.0 } else { -1.0 };
    (0..2 * NEAREST).map(move |i| {
        let away = f64::from((i + 1) / 2) * if i % 2 == 1 { side } else { -side };
        (nearest + away) * step
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_come_in_the_order_of_distance() {
        for (value, step) in [(7.3, 2.0), (-3.1, 0.5), (0.0, 1.0), (44.99, 5.0)] {
            let found: Vec<f64> = multiples(value, step).collect();
            let away = |multiple: &f64| (multiple - value).abs();
            assert!(found.windows(2).all(|pair| away(&pair[0]) <= away(&pair[1]) + 1e-12), "{value}: {found:?}");
            assert!(found.iter().all(|multiple| is_multiple(*multiple, step)));
        }
        assert_eq!(multiples(7.3, 2.0).take(4).collect::<Vec<_>>(), [8.0, 6.0, 10.0, 4.0]);
    }
}
