//! How reliably every planned hop is flown by itself.

use super::{
    Policy, Simulation,
    simulation::GroundAndPlan,
    trial::{Plan, PlannedHop},
};
use crate::{
    flight::{Distribution, HopTrials, JudgedHop, REPORTED_DRAWS},
    ground::{FirstContact, Windows},
};

impl Simulation {
    /// The share of 256 fixed draws of its errors, 1024 where heights have errors, that every planned hop survives, begun at its planned take-off: from 0 to 1.
    ///
    /// A draw fails if the hop takes off out of its cone, leaves the known ground, lands out of its cone or too fast, or cannot rest where
    /// it lands. Under replanning a hop aims short by its nominal bounces. How far from the goal the last hop rests does not count.
    ///
    /// The product over the hops is not the success of the path: friction and heights are one draw for all of them, and a hop that is
    /// planned anew is another hop. See [`estimated_success`](Self::estimated_success) for that.
    pub fn hop_successes(&self, policy: Policy) -> Vec<f64> {
        match &self.ground_and_plan {
            GroundAndPlan::Chain(ground, plan) => {
                self.successes(policy, ground, plan, ground.test().chain().geometry().vertices().len())
            }
            GroundAndPlan::Map(ground, plan) => self.successes(policy, ground, plan, 1),
            GroundAndPlan::Mesh(ground, plan) => self.successes(policy, ground, plan, 1),
        }
    }

    fn successes<G: FirstContact + Windows>(&self, policy: Policy, ground: &G, plan: &Plan<G::Contact>, points: usize) -> Vec<f64> {
        // A random field of heights is not spread evenly by the fixed draws.
        let count = if self.uncertainty.height_sigma_m > 0.0 { 4 * REPORTED_DRAWS } else { REPORTED_DRAWS };
        let trials = HopTrials::new(ground, &self.uncertainty, Distribution::Normal, points, count);
        let success = |hop: &PlannedHop<G::Contact>| {
            let judged = JudgedHop {
                from: hop.from,
                command: hop.command,
                takeoff_sigma_m: [0.0; 2],
                goal: None,
                aims_at_rest: policy == Policy::Replan,
            };
            let survival = trials.survival(&judged, u32::MAX);
            f64::from(survival.of - survival.failed) / f64::from(survival.of)
        };
        plan.hops.iter().map(success).collect()
    }
}
