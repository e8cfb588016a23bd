//! How a trial ends, and how the robot decides on its way.

/// How the robot goes about its journey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Policy {
    /// The planned commands, one after the other, from wherever it really is.
    #[default]
    OpenLoop,
    /// After every landing the best next hop from where it believes to be.
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

/// How a trial ended. Every trial ends in exactly one of these ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TrialOutcome {
    /// It stopped within the goal tolerance (horizontal distance).
    Reached,
    /// It stopped elsewhere: all planned commands flown (open loop), or it believed to be at the goal and was not (replan).
    Missed,
    /// The real direction of a take-off left the cone of the ground it really stood on, or that ground allows none.
    SlidAtTakeoff,
    /// The real direction of a landing left the cone of the ground it really met, or the surface is too steep to rest on there or
    /// where it came to rest.
    SlidAtLanding,
    /// It met the ground faster than its landing speed limit.
    Damaged,
    /// It left the chain, its plane of travel (past a bend) or the map, met no-data, or came down or to rest in a keep-out zone.
    Lost,
    /// No hop leads on from where it believes to be (replan).
    Stuck,
    /// It had flown as many hops as allowed and was not done.
    HopLimit,
}

impl TrialOutcome {
    /// All outcomes, in the order of results.
    pub const ALL: [Self; 8] = [
        Self::Reached,
        Self::Missed,
        Self::SlidAtTakeoff,
        Self::SlidAtLanding,
        Self::Damaged,
        Self::Lost,
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
            Self::Lost => "lost",
            Self::Stuck => "stuck",
            Self::HopLimit => "hop_limit",
        }
    }
}

/// How many trials ended in each way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutcomeCounts([u64; 8]);

impl OutcomeCounts {
    /// One more trial that ended so.
    pub const fn count(&mut self, outcome: TrialOutcome) {
        self.0[outcome as usize] += 1;
    }

    /// How many trials ended so.
    pub const fn of(&self, outcome: TrialOutcome) -> u64 {
        self.0[outcome as usize]
    }

    /// Every outcome with its count, in the order of [`TrialOutcome::ALL`], those of none included.
    pub fn each(&self) -> impl Iterator<Item = (TrialOutcome, u64)> + '_ {
        TrialOutcome::ALL.into_iter().map(|outcome| (outcome, self.of(outcome)))
    }

    /// All trials counted.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

impl std::ops::AddAssign for OutcomeCounts {
    fn add_assign(&mut self, other: Self) {
        for (mine, theirs) in self.0.iter_mut().zip(other.0) {
            *mine += theirs;
        }
    }
}
