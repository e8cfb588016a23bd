//! What to simulate, how often, and who is given the records.

use super::{HopRecord, Policy, TrialRecord, UncertaintyProblem};
use crate::progress::Cancelled;

/// How many trials, and how they are flown and checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialOptions {
    /// How many trials at most; at least 1.
    pub trials: u64,
    /// The draws of a trial depend on this and the trial's number alone.
    pub seed: u64,
    /// Open loop or replanned.
    pub policy: Policy,
    /// Most hops of a trial; `None`: [`TrialOptions::default_hop_limit`].
    pub hop_limit: Option<u32>,
    /// Horizontal distance from the goal within which a trial has reached it, m.
    pub goal_tolerance_m: f64,
    /// Stop once half the width of the success rate's 95 % interval is at most this; tested after every 1 000 trials.
    pub until_half_width: Option<f64>,
    /// How many trials, from the first, to keep with all their hops.
    pub trajectories: u64,
}

impl Default for TrialOptions {
    /// 10 000 open-loop trials of seed 1, to be within 1 m of the goal.
    fn default() -> Self {
        Self {
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
    /// Twice the planned hops and ten more: room to make up for errors, and an end for a robot that goes to and fro.
    pub fn default_hop_limit(planned_hops: usize) -> u32 {
        u32::try_from(planned_hops).unwrap_or(u32::MAX).saturating_mul(2).saturating_add(10)
    }
}

/// Why there is no simulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// Deviations that make no sense.
    #[error(transparent)]
    Uncertainty(#[from] UncertaintyProblem),
    /// No trials.
    #[error("trials is 0, expected at least 1")]
    NoTrials,
    /// A hop limit below 1.
    #[error("hop_limit is 0, expected at least 1: leave it out for twice the planned hops and ten more")]
    NoHops,
    /// A tolerance that no distance is within.
    #[error("goal_tolerance_m is {found} m, expected a finite number of at least 0")]
    GoalTolerance {
        /// What was given, m.
        found: f64,
    },
    /// An interval that no number of trials gives.
    #[error("the half-width to reach is {found}, expected a number above 0 and below 0.5")]
    HalfWidth {
        /// What was given.
        found: f64,
    },
    /// A policy that needs costs-to-go.
    #[error("the policy replan needs the costs-to-go of a node set, and none were given: build a graph::CostToGo for the mission")]
    NoCostsToGo,
    /// A path in three dimensions that does not lie on the map.
    #[error("hop {hop} of the path lies on no map, but the simulation is to fly over a DEM: slice the chain from that DEM")]
    NotOnMap {
        /// Which hop, from 1.
        hop: usize,
    },
    /// A path along a chain that is given without its stations.
    #[error("hop {hop} of the path has no station, but the simulation is to fly along a chain: plan the path on that chain")]
    NotOnChain {
        /// Which hop, from 1; 0: the start.
        hop: usize,
    },
    /// A map of which nobody says how it grips.
    #[error(
        "nothing says how the ground of the DEM grips: give the surface a friction coefficient or angles from the slope, or the map a \
         friction raster"
    )]
    NoGrip,
    /// A start or goal without ground.
    #[error("the {which} lies at ({x_m} m, {y_m} m), where the DEM has no ground: give the DEM that the chain was sliced from")]
    NoGround {
        /// Start or goal.
        which: &'static str,
        /// East, m.
        x_m: f64,
        /// North, m.
        y_m: f64,
    },
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Who listens to a simulation. All calls come from one thread, in the order of trials and hops, whatever the number of threads.
pub trait Observer {
    /// Whether [`hop`](Self::hop) and [`trial`](Self::trial) are wanted; records are only made where they are.
    fn wants_records(&self) -> bool {
        false
    }

    /// A hop was flown.
    fn hop(&mut self, _hop: &HopRecord) {}

    /// A trial ended, all of its hops told.
    fn trial(&mut self, _trial: &TrialRecord) {}
}

/// Nobody listens.
impl Observer for () {}
