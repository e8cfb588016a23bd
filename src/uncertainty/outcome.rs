//! How a trial ends, and the policies of the robot.

use serde::{Deserialize, Serialize};

/// How the robot chooses its commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Policy {
    /// The planned commands, one after the other, from its actual position.
    #[default]
    OpenLoop,
    /// After every landing, the best next hop from the estimated position.
    Replan,
}

impl Policy {
    /// Both policies.
    pub const ALL: [Self; 2] = [Self::OpenLoop, Self::Replan];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::OpenLoop => "open-loop",
            Self::Replan => "replan",
        }
    }
}

crate::quantity::by_name!(Policy, Policy::ALL);

/// How a trial ended. Every trial ends in exactly one of these ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TrialOutcome {
    /// It stopped within the goal tolerance (horizontal distance).
    Reached,
    /// It stopped elsewhere: all planned commands were flown (open loop), or its estimated position was at the goal (replan).
    Missed,
    /// The actual direction of a take-off was outside the cone of the ground there, or that ground, under the hopper's footprint if it
    /// has one, allows no take-off.
    SlidAtTakeoff,
    /// The actual direction of a landing was outside the cone of the ground there, or the ground at the landing or at the place of
    /// rest is too steep to rest on, or under the hopper's footprint too steep or too rough; or its bounces did not end.
    SlidAtLanding,
    /// It met the ground faster than its landing speed limit, at its first contact or after a bounce.
    Damaged,
    /// It left the chain, its plane of travel (past a bend) or the map, met no-data, came down, bounced or came to rest in a keep-out zone
    /// or where a layer does not hold, flew where one does not, or left the body: an error made its take-off faster than escape, or it bounced off so fast.
    Lost,
    /// No hop leads on from its estimated position (replan).
    Stuck,
    /// It flew the greatest number of hops without ending otherwise.
    HopLimit,
    /// Its next hop took more propellant than it had left, so that it stayed where it was.
    OutOfPropellant,
}

impl TrialOutcome {
    /// All outcomes, in the order of results.
    pub const ALL: [Self; 9] = [
        Self::Reached,
        Self::Missed,
        Self::SlidAtTakeoff,
        Self::SlidAtLanding,
        Self::Damaged,
        Self::Lost,
        Self::Stuck,
        Self::HopLimit,
        Self::OutOfPropellant,
    ];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Missed => "missed",
            Self::SlidAtTakeoff => "slid_at_takeoff",
            Self::SlidAtLanding => "slid_at_landing",
            Self::Damaged => "damaged",
            Self::Lost => "lost",
            Self::Stuck => "stuck",
            Self::HopLimit => "hop_limit",
            Self::OutOfPropellant => "out_of_propellant",
        }
    }
}

crate::quantity::by_name!(TrialOutcome, TrialOutcome::ALL);

/// How many trials ended in each way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutcomeCounts([u64; 9]);

impl OutcomeCounts {
    /// Counts one trial with this outcome.
    pub const fn count(&mut self, outcome: TrialOutcome) {
        self.0[outcome as usize] += 1;
    }

    /// The number of trials with this outcome.
    pub const fn of(&self, outcome: TrialOutcome) -> u64 {
        self.0[outcome as usize]
    }

    /// Every outcome with its count, zero counts included, in the order of [`TrialOutcome::ALL`];
    /// [`OutOfPropellant`](TrialOutcome::OutOfPropellant), which few machines can meet, only where it occurs.
    pub fn each(&self) -> impl Iterator<Item = (TrialOutcome, u64)> + '_ {
        let all = TrialOutcome::ALL.into_iter().map(|outcome| (outcome, self.of(outcome)));
        all.filter(|(outcome, count)| *outcome != TrialOutcome::OutOfPropellant || *count > 0)
    }

    /// The number of trials counted.
    pub fn total(&self) -> u64 {
        self.0.iter().fold(0, |sum, count| sum.saturating_add(*count))
    }
}

impl std::ops::AddAssign for OutcomeCounts {
    fn add_assign(&mut self, other: Self) {
        for (mine, theirs) in self.0.iter_mut().zip(other.0) {
            *mine = mine.saturating_add(theirs);
        }
    }
}
