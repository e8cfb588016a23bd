//! The results of trials over a mesh, as plain data and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MeshPlanAnswer, SimulationRecord, SuccessRequirement, mesh_plan_text};

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
    let mut text = mesh_plan_text(&answer.plan);
    if answer.simulation.is_none() && answer.compare.is_empty() {
        text.push_str("nothing to simulate: there is no nominal path\n");
    }
    let own = answer.simulation.iter().filter(|_| answer.compare.is_empty());
    for record in own.chain(&answer.compare) {
        text.push('\n');
        text.push_str(&record.text());
    }
    if let (Some(requirement), Some(simulation)) = (&answer.requirement, &answer.simulation) {
        text.push('\n');
        text.push_str(&requirement.sentence(simulation));
    }
    text
}
