//! What to simulate, how many times, and the observer of the records.

use std::fmt;

use super::{HopRecord, Policy, TrialRecord, UncertaintyProblem};
use crate::progress::Cancelled;

/// The number of trials, and how they are flown and checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialOptions {
    /// The number of the first trial: 0, but for a later part of a run.
    pub first_trial: u64,
    /// The most trials; at least 1.
    pub trials: u64,
    /// The seed. The draws of a trial depend on it and on the trial's number only.
    pub seed: u64,
    /// Open loop or replanned.
    pub policy: Policy,
    /// The most hops of a trial; `None`: [`TrialOptions::default_hop_limit`].
    pub hop_limit: Option<u32>,
    /// A trial has reached the goal within this horizontal distance from it, m.
    pub goal_tolerance_m: f64,
    /// Stop once half the width of the success rate's 95 % interval is at most this; checked after every 1 000 trials of this part.
    pub until_half_width: Option<f64>,
    /// The first trials of this part, as many as this, are kept with all their hops.
    pub trajectories: u64,
}

impl Default for TrialOptions {
    /// 10 000 open-loop trials of seed 1, to be within 1 m of the goal.
    fn default() -> Self {
        Self {
            first_trial: 0,
            trials: 10_000,
            seed: 1,
            policy: Policy::OpenLoop,
            hop_limit: None,
            goal_tolerance_m: 1.0,
            until_half_width: None,
            trajectories: 0,
        }
    }
}

impl TrialOptions {
    /// Twice the planned hops plus ten: enough to correct errors, and a bound for a robot that goes back and forth.
    pub fn default_hop_limit(planned_hops: usize) -> u32 {
        u32::try_from(planned_hops).unwrap_or(u32::MAX).saturating_mul(2).saturating_add(10)
    }
}

/// A point of a mission, as errors name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissionPoint {
    /// The take-off or landing of a hop of the path; the number counts from 1.
    Hop(usize),
    /// The start.
    Start,
    /// The goal.
    Goal,
    /// A node of the costs-to-go, at which a replanned hop may begin or end.
    Node,
}

impl fmt::Display for MissionPoint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hop(number) => write!(formatter, "hop {number} of the path"),
            Self::Start => write!(formatter, "the start"),
            Self::Goal => write!(formatter, "the goal"),
            Self::Node => write!(formatter, "a node of the costs-to-go"),
        }
    }
}

/// Why there is no simulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A mission that is to follow another one over another kind of ground.
    #[error("found missions over different kinds of ground, expected all over a chain, all over a DEM or all over a mesh")]
    OtherGround,
    /// Invalid deviations.
    #[error(transparent)]
    Uncertainty(#[from] UncertaintyProblem),
    /// Zero trials.
    #[error("trials is 0, expected at least 1")]
    NoTrials,
    /// Trials whose numbers exceed the greatest.
    #[error("first_trial is {first_trial} with {trials} trials, expected their sum to be below 2^64: begin with a smaller one")]
    Range {
        /// The first one.
        first_trial: u64,
        /// How many.
        trials: u64,
    },
    /// A commanded speed that no hop has.
    #[error("takeoff_speed_m_s is {found} m/s, expected a finite number above 0")]
    CommandedSpeed {
        /// What was given, m/s.
        found: f64,
    },
    /// A hop limit below 1.
    #[error("hop_limit is 0, expected at least 1: leave it out for twice the planned hops and ten more")]
    NoHops,
    /// A negative or non-finite tolerance.
    #[error("goal_tolerance_m is {found} m, expected a finite number of at least 0")]
    GoalTolerance {
        /// What was given, m.
        found: f64,
    },
    /// A half-width outside (0, 0.5), which no number of trials gives.
    #[error("the half-width to reach is {found}, expected a number above 0 and below 0.5")]
    HalfWidth {
        /// What was given.
        found: f64,
    },
    /// A policy that needs costs-to-go.
    #[error("the policy replan needs the costs-to-go of a node set, and none were given: build a graph::CostToGo for the mission")]
    NoCostsToGo,
    /// A point without a position on the map, in a simulation over a DEM.
    #[error("{which} lies on no map, but the simulation is to fly over a DEM: slice the chain from that DEM")]
    NotOnMap {
        /// Which point.
        which: MissionPoint,
    },
    /// A point without a station, in a simulation along a chain.
    #[error("{which} has no station, but the simulation is to fly along a chain: plan the path on that chain")]
    NotOnChain {
        /// Which point.
        which: MissionPoint,
    },
    /// A DEM without friction or stated angles.
    #[error(
        "the ground of the DEM has no friction: give the surface a friction coefficient or angles from the slope, or the map a friction \
         raster"
    )]
    NoGrip,
    /// A start, goal or node without ground under it.
    #[error(
        "{which} lies at ({x_m} m, {y_m} m), where the DEM has no ground: give a place on it, or for a chain the DEM that it was sliced from"
    )]
    NoGround {
        /// Which point.
        which: MissionPoint,
        /// East, m.
        x_m: f64,
        /// North, m.
        y_m: f64,
    },
    /// A point off the mesh, in a simulation over it.
    #[error(
        "{which} is at {point_m:?} m, off the surface of the mesh, expected a point on it: give the mesh that the path was planned over"
    )]
    NotOnMesh {
        /// Which point.
        which: MissionPoint,
        /// The point, m.
        point_m: [f64; 3],
    },
    /// A hop straight up.
    #[error("{which} lands right over its take-off or below it, expected two different places: it has no heading")]
    NoCourse {
        /// Which hop.
        which: MissionPoint,
    },
    /// Errors of heights, which belong to ground with one height at every place.
    #[error("the heights of the ground have a standard deviation of {sigma_m} m, expected none over a mesh: set it to 0")]
    HeightsOfMesh {
        /// What was given, m.
        sigma_m: f64,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// An observer of a simulation. All calls come from one thread, in the order of trials and hops, for any number of threads.
pub trait Observer {
    /// Whether [`hop`](Self::hop) and [`trial`](Self::trial) are called; records are only made if they are.
    fn wants_records(&self) -> bool {
        false
    }

    /// The trials of a policy begin.
    fn begin(&mut self, _policy: Policy) {}

    /// A hop was flown.
    fn hop(&mut self, _hop: &HopRecord) {}

    /// A trial ended; all its hops have been reported.
    fn trial(&mut self, _trial: &TrialRecord) {}
}

/// An observer that ignores everything.
impl Observer for () {}
