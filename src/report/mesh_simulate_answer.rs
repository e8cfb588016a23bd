//! The results of trials over a mesh, as plain data and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    MeshPlanAnswer, SimulationRecord, SuccessRequirement, mesh_plan_text,
    simulate_answer::{records_text, requirement_text},
};

/// The answer of a simulation over a mesh: the plan and, with a path, the results of its trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshSimulateAnswer {
    /// The plan that is flown.
    #[serde(flatten)]
    pub plan: MeshPlanAnswer,
    /// The trials of the policy of the scenario.
    #[serde(flatten)]
    pub simulation: Option<SimulationRecord>,
    /// Both policies on the same draws, if requested.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compare: Vec<SimulationRecord>,
    /// Whether the required success is shown.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub requirement: Option<SuccessRequirement>,
}

impl MeshSimulateAnswer {
    /// Whether the required success, if there is one, is shown.
    pub fn shows_success(&self) -> bool {
        self.requirement.is_none_or(|requirement| requirement.success_min_shown)
    }
}

/// The text of `chta simulate` over a mesh.
pub fn mesh_simulate_text(answer: &MeshSimulateAnswer) -> String {
    let (own, compared) = (answer.simulation.as_ref(), answer.compare.as_slice());
    [mesh_plan_text(&answer.plan), records_text(own, compared), requirement_text(answer.requirement, own)].concat()
}
