//! Trials of a robot with legs that also walks.
//!
//! A walk has the errors of a drive: of its heading, of its length, and a rate of failures. At its end the root is as high over the ground as
//! planned, in the planned orientation, and the feet look for ground anew.

use nalgebra::{Point3, Vector2};

use super::{
    LegsMission, LegsOutcome,
    driving::{DriveDraws, Driven},
    legs::{Aim, shifted},
};
use crate::{
    ballistics::Arc,
    drive::DriveGround,
    flight::{Biases, Distribution, Errors, HopErrors, TrialDraws},
    ground::{DemGround, MapPosition, Pose, Stance, StanceBuffers},
    planner::{
        Amount, Amounts, Travel, drive_amounts,
        roadmap::{Left, RoadmapGround, RoadmapMove},
    },
    quantity::MapPoint,
    world::Rover,
};

/// A robot that replans walks on after a refused walk so many times: each time with other errors.
const TRIES_MOST: u32 = 20;
/// Stances nearer than this share of the length of its legs are no step forward: a robot that errs would walk to them again and again.
const TOO_NEAR: f64 = 0.5;

/// How a robot with legs walks in trials.
#[derive(Clone, Debug)]
pub struct LegsWalking {
    /// The ground under the limits that planning may use: walks are judged over the map as it is known.
    pub ground: DemGround,
    /// The limits of its walks, and their errors.
    pub rover: Rover,
    /// Whether it walks alone, or also hops.
    pub travel: Travel,
    /// The amount by which it chooses a move when it replans.
    pub amount: Amount,
    /// Stances from which the goal can be reached, and what is left from each, the least first; needed to replan.
    pub aims: Vec<(Stance, Left)>,
}

/// The next move of a robot that replans.
enum Choice<'m> {
    Hop(Aim),
    Walk(&'m Stance),
}

/// The draws of a trial: those of its hops, their biases, and those of its walks.
pub(super) struct WalkDraws<'d> {
    pub(super) hops: &'d mut TrialDraws,
    pub(super) biases: &'d Biases,
    pub(super) walks: &'d mut DriveDraws,
    pub(super) distribution: Distribution,
}

impl LegsMission {
    /// Walks from a stance so far, towards a planned one; `None` where a limit refuses the line, and it stays.
    pub(super) fn walk(
        &self,
        walking: &LegsWalking,
        from: &Stance,
        (along, to): (Vector2<f64>, &Stance),
        draws: &mut WalkDraws<'_>,
    ) -> Result<Option<Stance>, LegsOutcome> {
        let drive = DriveGround::new(&walking.ground, &walking.rover);
        let at = match draws.walks.drive(&drive, draws.distribution, place_of(from), along) {
            Driven::To { at, .. } => at,
            Driven::Refused => return Ok(None),
            Driven::Failed => return Err(LegsOutcome::WalkFailed),
        };
        let planned = to.pose().root_m;
        // Where it comes to the planned place it stands as planned, also where its feet are on an edge and rounding would decide.
        if (at - place_of(to)).norm() <= self.whole.mesh().tree().resolution_m() {
            return Ok(Some(to.clone()));
        }
        let top_m = self.whole.mesh().tree().mesh().bounds().high_m + self.whole.robot().reach_m();
        let ground_m =
            |x_m: f64, y_m: f64, z_m: f64| self.whole.ground_below_m(Point3::new(x_m, y_m, z_m)).ok_or(LegsOutcome::Lost);
        let height_m = planned.z - ground_m(planned.x, planned.y, planned.z)?;
        let root_m = Point3::new(at.x, at.y, ground_m(at.x, at.y, top_m)? + height_m);
        self.whole.stand(Pose { root_m, ..*to.pose() }).map(Some).map_err(|_| LegsOutcome::Fell)
    }

    /// Makes the planned moves where it believes to be at their beginnings, and else those by which least is left.
    pub(super) fn walking_on(
        &self,
        (walking, rules): (&LegsWalking, &Errors),
        draws: &mut WalkDraws<'_>,
        at: &mut Stance,
        (buffers, goal_tolerance_m, most): (&mut StanceBuffers, f64, usize),
    ) -> Result<(), (LegsOutcome, usize)> {
        let goal = self.stances[self.stances.len() - 1].pose().root_m;
        let mut tries = 0;
        for number in 1..=most {
            let drawn: HopErrors = rules.draw(draws.hops, draws.biases);
            let shifted = shifted(at, &drawn);
            if (shifted.root_m - goal).xy().norm() <= goal_tolerance_m {
                return Ok(());
            }
            let believed = self.believed(at, shifted);
            let choice = self.planned_from(&believed).or_else(|| self.least_left(walking, &believed, buffers));
            let moved = match choice.ok_or((LegsOutcome::Stuck, number))? {
                Choice::Hop(aim) => self.hop(rules, at, &aim, &drawn).map(Some),
                Choice::Walk(to) => {
                    let along = (to.pose().root_m - believed.pose().root_m).xy();
                    self.walk(walking, at, (along, to), draws)
                }
            };
            match moved.map_err(|outcome| (outcome, number))? {
                Some(stance) => (*at, tries) = (stance, 0),
                None => tries += 1,
            }
            if tries > TRIES_MOST {
                return Err((LegsOutcome::WalkStopped, number));
            }
        }
        Err((LegsOutcome::HopLimit, most))
    }

    /// The planned move from where it believes to stand, if one begins there.
    fn planned_from(&self, believed: &Stance) -> Option<Choice<'_>> {
        let is_here = |planned: &Stance| self.planning.are_one_place([planned, believed]);
        let number = (0..self.moves.len()).find(|number| is_here(&self.stances[*number]))?;
        let to = &self.stances[number + 1];
        match &self.moves[number] {
            RoadmapMove::Hop(arc) => self.aim([believed, to], arc).map(Choice::Hop),
            RoadmapMove::Walk => Some(Choice::Walk(to)),
        }
    }

    /// The walk to a stance nearby, or the hop, by which least is left to the goal.
    fn least_left<'m>(&'m self, walking: &'m LegsWalking, believed: &Stance, buffers: &mut StanceBuffers) -> Option<Choice<'m>> {
        let mut best: Option<(Left, Choice<'m>)> = None;
        let left_after = |amounts: &Amounts, left: Left| Left::of(walking.amount, amounts) + left;
        if walking.travel.drives() {
            let drive = DriveGround::new(&walking.ground, &walking.rover);
            let place = |stance: &Stance| -> Option<MapPosition> { walking.ground.position(place_of(stance)) };
            let away_m = |to: &Stance| (place_of(to) - place_of(believed)).norm();
            let too_near_m = TOO_NEAR * self.planning.robot().leg_length_m();
            let is_forward = |(to, left): &&(Stance, Left)| *left == Left::default() || away_m(to) > too_near_m;
            let mut near: Vec<&(Stance, Left)> = walking.aims.iter().filter(is_forward).collect();
            near.sort_by(|a, b| away_m(&a.0).total_cmp(&away_m(&b.0)));
            for (to, left) in near.into_iter().take(walking.rover.limits().neighbours.count()) {
                let Some(ends) = place(believed).zip(place(to)) else { continue };
                let Ok(leg) = drive.leg(&ends.0, &ends.1) else { continue };
                let total = left_after(&drive_amounts(&walking.rover, &leg, 0.0), *left);
                if best.as_ref().is_none_or(|(least, _)| total < *least) {
                    best = Some((total, Choice::Walk(to)));
                }
            }
        }
        if !walking.travel.hops() {
            return best.map(|(_, choice)| choice);
        }
        let envelope = self.planning.mesh().envelope();
        for (to, left) in &walking.aims {
            // The least first: what follows leaves more.
            if best.as_ref().is_some_and(|(least, _)| least <= left) {
                break;
            }
            let Some((sight, lofts)) = self.planning.windows(believed, to, buffers) else { continue };
            let Some((_, loft)) = self.takeoff.among(sight, lofts.iter().copied()) else { continue };
            let arc = Arc::new(sight, loft, envelope.gravity_m_s2());
            let total = left_after(&Amounts::of_arc(&arc, envelope.hopper().limits(), false), *left);
            if best.as_ref().is_none_or(|(least, _)| total < *least)
                && let Some(aim) = self.aim([believed, to], &arc)
            {
                best = Some((total, Choice::Hop(aim)));
            }
        }
        best.map(|(_, choice)| choice)
    }
}

/// The place on the map under the root of a stance.
fn place_of(stance: &Stance) -> MapPoint {
    MapPoint::new(stance.pose().root_m.x, stance.pose().root_m.y)
}
