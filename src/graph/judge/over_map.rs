//! The most reliable command of a hop between two positions of a map, for a robot that replans.

use nalgebra::Vector2;

use super::most_reliable;
use crate::{
    ballistics::{Arc, LineOfSight},
    flight::{Command, HopTrials, JudgedHop, Uncertainty},
    ground::{DemGround, MapPosition},
    quantity::SlopeInterval,
};

/// Judges hops over a map, without a chain, by flown draws.
#[derive(Clone, Debug)]
pub(crate) struct MapJudge {
    trials: HopTrials<DemGround>,
    ground: DemGround,
    position_sigma_m: f64,
}

impl MapJudge {
    pub(crate) fn new(ground: &DemGround, errors: &Uncertainty) -> Self {
        Self { trials: HopTrials::new(ground, errors, 1), ground: ground.clone(), position_sigma_m: errors.position_sigma_m }
    }

    /// The loft of the most reliable command of a hop from where the robot believes to be, and how many of the draws fail.
    pub(crate) fn command(
        &self,
        (from, to): (&MapPosition, &MapPosition),
        heading: Vector2<f64>,
        (sight, lofts): (LineOfSight, SlopeInterval),
    ) -> (f64, u32) {
        let envelope = self.ground.envelope();
        most_reliable(envelope, (sight, lofts), |loft, enough| {
            let command = Command::of_arc(&Arc::new(sight, loft, envelope.gravity_m_s2()), heading, *to);
            let takeoff_sigma_m = [self.position_sigma_m; 2];
            self.trials.survival(&JudgedHop { from: *from, command, takeoff_sigma_m, goal: None }, enough).failed
        })
    }
}
