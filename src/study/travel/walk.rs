//! The legs of a mission with all their numbers, each driven or flown again by the independent checker.

use super::super::{
    FreeRouteError, JourneyError,
    free_route::{Laid, Unrolled},
};
use super::search::TravelSearch;
use crate::{
    ballistics::TakeoffChoice,
    drive::{DriveGround, DriveLeg},
    ground::{DemGround, MapPosition, Surface},
    path::{DrivenAgain, Hop, HopPath, drive_again},
    planner::{Amount, Amounts, MissionMove, MissionPath, SearchedCommands},
    quantity::total,
    world::Rover,
};

/// One stretch of a mission.
#[derive(Clone, Debug)]
pub(super) enum Stretch {
    /// Straight lines from each place to the next, driven without a hop.
    Drive(Driven),
    /// Hops without a drive leg between them.
    Hops(HopPath),
}

/// A driven stretch.
#[derive(Clone, Debug)]
pub(in crate::study) struct Driven {
    pub(in crate::study) places: Vec<MapPosition>,
    pub(in crate::study) legs: Vec<DriveLeg>,
    pub(in crate::study) turn_time_s: f64,
}

/// Why a planned drive leg does not hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a planned drive leg does not pass its own check: {0}; this is a defect of chta, please report it with the scenario")]
pub struct DriveDefect(pub String);

/// The stretches of a path that was searched with these commands.
///
/// # Errors
/// [`JourneyError`]; a [`Defect`] or a [`DriveDefect`] where a leg does not pass the checker.
pub(super) fn stretches(
    search: &TravelSearch,
    path: &MissionPath,
    commands: SearchedCommands,
) -> Result<Vec<Stretch>, JourneyError> {
    let mut stretches = Vec::new();
    let is_drive = |at: &MissionMove| matches!(at, MissionMove::Drive);
    let mut first = 0;
    while first < path.moves.len() {
        let kind = is_drive(&path.moves[first]);
        let count = path.moves[first..].iter().take_while(|next| is_drive(next) == kind).count();
        let places = &path.places[first..=first + count];
        let moves = &path.moves[first..first + count];
        stretches.push(if kind {
            Stretch::Drive(driven_again((&search.free.ground, &search.keys.rover), places)?)
        } else {
            Stretch::Hops(flown(search, (places, moves), commands)?)
        });
        first += count;
    }
    Ok(stretches)
}

/// Hops, flown again over their unrolled chain and over the DEM.
fn flown(
    search: &TravelSearch,
    (places, moves): (&[MapPosition], &[MissionMove]),
    commands: SearchedCommands,
) -> Result<HopPath, JourneyError> {
    let free = &search.free;
    let choices: Vec<TakeoffChoice> = moves
        .iter()
        .filter_map(|each| match each {
            MissionMove::Hop(choice) => Some(*choice),
            MissionMove::Drive => None,
        })
        .collect();
    let chosen = (commands == SearchedCommands::Distinct).then_some(choices.as_slice());
    let laid: Laid = free.laid_over(places, chosen)?;
    let Unrolled { path, .. } = free.flown(laid)?;
    path.ok_or(FreeRouteError::Lost { hop: 1 }.into())
}

/// A driven stretch, by the slices and by the checker.
pub(in crate::study) fn driven_again(
    (ground, rover): (&DemGround, &Rover),
    places: &[MapPosition],
) -> Result<Driven, FreeRouteError> {
    let drive = DriveGround::new(ground, rover);
    let mut legs = Vec::with_capacity(places.len() - 1);
    for pair in places.windows(2) {
        let leg = drive.leg(&pair[0], &pair[1]).map_err(|refusal| FreeRouteError::Drive(DriveDefect(refusal.to_string())))?;
        checked(ground, rover, pair, &leg)?;
        legs.push(leg);
    }
    Ok(Driven { turn_time_s: turn_time_s(rover, places), places: places.to_vec(), legs })
}

/// Whether two ways to add up the same differ by more than rounding.
fn differs(a: f64, b: f64) -> bool {
    /// As a share.
    const ROUNDING: f64 = 1e-6;
    (a - b).abs() > ROUNDING * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
}

/// Drives a leg again.
fn checked(ground: &DemGround, rover: &Rover, pair: &[MapPosition], leg: &DriveLeg) -> Result<(), FreeRouteError> {
    let DrivenAgain { length_m, time_s, energy_j_kg, violations } = drive_again(ground, rover, &pair[0], &pair[1]);
    let problem = violations.first().map(ToString::to_string).or_else(|| {
        let pairs = [(length_m, leg.length_m), (time_s, leg.time_s), (energy_j_kg, leg.energy_j_kg)];
        let (found, stated) = pairs.into_iter().find(|(a, b)| differs(*a, *b))?;
        Some(format!("it takes {found}, and the plan states {stated}"))
    });
    problem.map_or(Ok(()), |problem| {
        let [from, to] = [pair[0].at, pair[1].at];
        let place = format!("from ({}, {}) m to ({}, {}) m: {problem}", from.x, from.y, to.x, to.y);
        Err(FreeRouteError::Drive(DriveDefect(place)))
    })
}

/// The time of all turns between the straight lines of a stretch, which begins in the direction of the first.
fn turn_time_s(rover: &Rover, places: &[MapPosition]) -> f64 {
    let heading = |pair: &[MapPosition]| {
        let along = pair[1].at - pair[0].at;
        libm::atan2(along.y, along.x).to_degrees()
    };
    let moves = places.windows(2).filter(|pair| pair[0].at != pair[1].at);
    let headings: Vec<f64> = moves.map(heading).collect();
    let turned = headings.windows(2).map(|pair| {
        let turn = (pair[1] - pair[0]).abs() % 360.0;
        turn.min(360.0 - turn)
    });
    rover.limits().turn_s_per_deg * total(turned)
}

/// What the stretches take, added up anew: mission time, energy and distance, which are those of the search.
///
/// # Errors
/// A [`DriveDefect`], where the search has other sums.
pub(super) fn agreed_sums(search: &TravelSearch, stretches: &[Stretch], planned: &Amounts) -> Result<[f64; 3], JourneyError> {
    let sums = sums(search, stretches);
    agreed(planned, sums)?;
    Ok(sums)
}

/// Refuses sums of mission time, energy and distance over legs that are not those of the search.
pub(in crate::study) fn agreed(planned: &Amounts, sums: [f64; 3]) -> Result<(), FreeRouteError> {
    for (amount, sum) in [Amount::MissionTime, Amount::Energy, Amount::Distance].into_iter().zip(sums) {
        if differs(planned.of(amount), sum) {
            let problem = format!("the legs add up to {sum} in {amount}, and the search has {}", planned.of(amount));
            return Err(FreeRouteError::Drive(DriveDefect(problem)));
        }
    }
    Ok(())
}

fn sums(search: &TravelSearch, stretches: &[Stretch]) -> [f64; 3] {
    let (limits, rover) = (search.free.ground.hopper().limits(), &search.keys.rover);
    let mut sums = [0.0; 3];
    for stretch in stretches {
        match stretch {
            Stretch::Drive(driven) => {
                for leg in &driven.legs {
                    sums[0] += leg.time_s;
                    sums[1] += leg.energy_j_kg;
                    sums[2] += leg.run_m;
                }
                sums[0] += driven.turn_time_s;
                sums[1] += rover.idle_j_kg_s() * driven.turn_time_s;
            }
            Stretch::Hops(path) => {
                sums[1] += path.totals.energy_j_kg;
                sums[2] += path.totals.ground_distance_m;
                let settles = |hop: &&Hop| hop.landing.map() != Some(search.free.goal.goal);
                #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
                let [hops, settled] = [path.hops.len(), path.hops.iter().filter(settles).count()].map(|count| count as f64);
                sums[0] += path.totals.flight_time_s
                    + hops * limits.preparation_time_s.unwrap_or(0.0)
                    + settled * limits.settling_s().unwrap_or(0.0);
            }
        }
    }
    sums
}
