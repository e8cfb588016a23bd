//! The command of a hopper that bounces: aimed short, so that the place of rest is the one wanted.

use nalgebra::Vector2;

use super::{Command, HopErrors};
use crate::{
    ballistics::Arc,
    ground::{FirstContact, Windows},
};

/// Corrections of the aim. Over level ground the first one is exact but for the settling speed; each costs a flight and the windows of a
/// hop.
const CORRECTIONS: u32 = 6;

/// A miss that is not worth a correction, as a share of the hop's length: far below the errors of any machine.
const NEAR: f64 = 1e-3;

/// The command whose hop, flown without errors over this ground, comes to rest nearest to where the given command is meant to end. For a
/// hopper that stays where it lands, and for a machine that takes its commands in steps, the given command.
///
/// ```text
///     o ---------- hop to the contact c ----------> c -- bounces --> rest      c <- c - (rest - wanted) / (1 + f)
///                                                                              f: bounces over the length of the hop
/// ```
///
/// The take-off angle stays as it is, as far as the feasible window of the shorter hop contains it; every hop tried keeps all limits.
/// Where no shorter hop is feasible, the given command is kept.
pub(crate) fn resting_at<G: FirstContact + Windows>(
    ground: &G,
    from: &G::Contact,
    command: Command<G::Contact>,
) -> Command<G::Contact> {
    let limits = ground.hopper().limits();
    if limits.restitution.is_none_or(|restitution| !restitution.bounces()) || !limits.steps.is_continuous() {
        return command;
    }
    let (takeoff, wanted) = (ground.point(from).xy(), ground.point(&command.rest).xy());
    let mut best: Option<(f64, Command<G::Contact>)> = None;
    let mut tried = command;
    for _ in 0..=CORRECTIONS {
        let flown = HopErrors::default().fly(ground, from, &tried.liftoff, &tried.aim);
        let (contact, rest) = (ground.point(&flown.end).xy(), ground.point(&flown.rest).xy());
        let miss = rest - wanted;
        if flown.failure.is_none() && best.as_ref().is_none_or(|(least_m, _)| miss.norm() < *least_m) {
            best = Some((miss.norm(), tried));
        }
        let run = contact - takeoff;
        let share = (rest - contact).dot(&run) / run.norm_squared();
        // A hop that went nowhere says nothing about the next one.
        if miss.norm() <= NEAR * (wanted - takeoff).norm() || !share.is_finite() {
            break;
        }
        // Downhill the bounces may lead back: a correction of more than four misses would be a leap.
        let Some(next) = aimed_at(ground, from, &command, run - miss / (1.0 + share).max(0.25)) else { break };
        tried = next;
    }
    best.map_or(command, |(_, command)| command)
}

/// The command with the same take-off angle to a contact this far from the take-off, m; `None` if no hop to it is feasible.
fn aimed_at<G: FirstContact + Windows>(
    ground: &G,
    from: &G::Contact,
    command: &Command<G::Contact>,
    away_m: Vector2<f64>,
) -> Option<Command<G::Contact>> {
    let aim = ground.believed(from, away_m.x, away_m.y)?;
    let (_, heading) = ground.course(from, &aim)?;
    let windows = ground.windows(from, &aim)?;
    let same = command.liftoff.vertical_m_s / command.liftoff.horizontal_m_s - windows.sight.slope();
    let within = windows.lofts.iter().filter(|lofts| !lofts.is_empty()).map(|lofts| same.clamp(lofts.lower, lofts.upper));
    let loft = within.min_by(|a, b| (a - same).abs().total_cmp(&(b - same).abs()))?;
    Some(Command { rest: command.rest, ..Command::of_arc(&Arc::new(windows.sight, loft, ground.gravity_m_s2()), heading, aim) })
}
