//! The path of a robot with legs, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FootRecord, JointReachRecord, LegsWalkRecord, MeshPlanAnswer, PoseRecord, PushRecord, mesh_plan_text, text::Sheet};
use crate::{
    ground::{LimbOutcome, Stance, StanceGround},
    path::{HopPath, StanceFlight},
    planner::RefusedStances,
    quantity::format_number,
    world::Contact,
};

/// The answer of `chta plan` for a robot with legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsPlanAnswer {
    /// The name of the robot.
    pub robot: String,
    /// Which cone stands for the directions in which its feet push: `exact`, `kc`, `kc-plus`, or pyramids of so many edges, `pyramid-4`,
    /// `pyramid-8` or `pyramid-16`.
    pub cone: String,
    /// Which way is up for its trunk: `normal` or `vertical`.
    pub up: String,
    /// The ground that it stands on.
    pub ground: LegsGroundRecord,
    /// Poses that were drawn and gave no stance.
    pub refused_poses: RefusedPosesRecord,
    /// How often the joints refute the workspaces; absent where no joints are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_reach: Option<JointReachRecord>,
    /// The path between stances, whose hops are those of the root of the robot; contacts of the roadmap are stances.
    #[serde(flatten)]
    pub plan: MeshPlanAnswer,
    /// The stances of the path, from start to goal; without a path those two.
    pub stances: Vec<StanceRecord>,
    /// How it walks, and its moves from stance to stance; absent for a robot that hops alone, whose hops lead from each stance to the next.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walk: Option<LegsWalkRecord>,
}

/// The ground that a robot with legs stands on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LegsGroundRecord {
    /// `mesh`, or `dem`: the facets between its posts.
    pub kind: LegsGroundKind,
    /// How many facets.
    pub facets: usize,
    /// Of a DEM: the distance of its posts, the greater of those to the east and to the north, m; absent otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub post_spacing_m: Option<f64>,
    /// Of a DEM: posts without elevation, around which is no ground and over which no hop flies; absent otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_data_posts: Option<usize>,
}

/// What kind of ground a robot with legs stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LegsGroundKind {
    /// A triangulated surface.
    Mesh,
    /// The facets between the posts of an elevation raster.
    Dem,
}

impl LegsGroundRecord {
    /// The ground, for a line of text.
    pub fn sentence(&self) -> String {
        let facets = self.facets;
        match (self.kind, self.post_spacing_m, self.no_data_posts) {
            (LegsGroundKind::Mesh, ..) => format!("ground: {facets} facets of a mesh"),
            (LegsGroundKind::Dem, spacing_m, gaps) => format!(
                "ground: {facets} facets between the posts of a DEM, {} m apart; {} posts without elevation are no ground",
                format_number(spacing_m.unwrap_or(f64::NAN)),
                gaps.unwrap_or(0)
            ),
        }
    }
}

/// Poses that gave no stance, by the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RefusedPosesRecord {
    /// The trunk met the ground, or the root lay inside it.
    pub trunk: usize,
    /// Too few feet stood.
    pub too_few_contacts: usize,
    /// The feet held no direction, or slipped under the weight of the robot.
    pub cone: usize,
}

impl From<RefusedStances> for RefusedPosesRecord {
    fn from(refused: RefusedStances) -> Self {
        Self { trunk: refused.trunk, too_few_contacts: refused.contacts, cone: refused.cone }
    }
}

/// A stance of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StanceRecord {
    /// The pose of the trunk.
    pub pose: PoseRecord,
    /// Its limbs, and where their feet stand.
    pub contacts: Vec<FootRecord>,
    /// Whether the feet can push in every direction, whatever the force.
    pub force_closure: bool,
    /// Whether the feet bear its weight without slipping.
    pub bears_weight: bool,
    /// Whether it need not topple at rest.
    pub upright: bool,
    /// The forces on its feet as the hop lands that ends here; absent at the start, and unless the robot states stroke and mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing: Option<PushRecord>,
    /// The forces on its feet as the next hop takes off; absent at the goal, and unless the robot states stroke and mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub takeoff: Option<PushRecord>,
}

impl StanceRecord {
    /// Of the stances of a path, with what its hops ask of them, each of which leads from the stance of this number to the next one; of stances alone
    /// without a path.
    pub fn all_of(ground: &StanceGround, stances: &[&Stance], path: Option<(&[usize], &HopPath)>) -> Vec<Self> {
        let mut records: Vec<Self> = stances.iter().map(|stance| Self::new(ground, stance)).collect();
        for (&number, hop) in path.into_iter().flat_map(|(takeoffs, path)| takeoffs.iter().zip(&path.hops)) {
            let ends = [stances[number], stances[number + 1]];
            let flight = StanceFlight::new(ground, ends, hop);
            records[number].takeoff = PushRecord::of_hop(ground, &flight, ends[0], Contact::Takeoff);
            records[number + 1].landing = PushRecord::of_hop(ground, &flight, ends[1], Contact::Landing);
        }
        records
    }

    /// Of a stance.
    pub fn new(ground: &StanceGround, stance: &Stance) -> Self {
        Self {
            landing: None,
            takeoff: None,
            pose: PoseRecord::of(stance.pose(), None),
            contacts: FootRecord::all_of(ground, stance),
            force_closure: stance.cone().is_some_and(crate::ballistics::stance::ConeSum::is_everything),
            bears_weight: stance.cone().is_some_and(crate::ballistics::stance::ConeSum::holds_weight),
            upright: ground.rests_upright(stance),
        }
    }
}

/// The text of `chta plan` for a robot with legs.
pub fn legs_plan_text(answer: &LegsPlanAnswer) -> String {
    let mut sheet = Sheet::default();
    sheet.line(format_args!("{}: cone of its feet {}, up {}", answer.robot, answer.cone, answer.up));
    sheet.line(format_args!("{}", answer.ground.sentence()));
    let RefusedPosesRecord { trunk, too_few_contacts, cone } = answer.refused_poses;
    sheet.line(format_args!(
        "poses without a stance: {trunk} by the trunk, {too_few_contacts} by too few contacts, {cone} by the cone"
    ));
    if let Some(reach) = &answer.joint_reach {
        sheet.line(format_args!("{}", reach.sentence()));
    }
    for (number, stance) in answer.stances.iter().enumerate() {
        let [x, y, z] = stance.pose.root_m;
        let stand = stance.contacts.iter().filter(|foot| foot.outcome == LimbOutcome::Stands);
        let names: Vec<&str> = stand.filter_map(|foot| foot.limb.as_deref()).collect();
        let closure = if stance.force_closure { ", force closure" } else { "" };
        let slips = if stance.bears_weight { "" } else { ", slips at rest" };
        sheet.line(format_args!(
            "stance {number}: root ({x:.3}, {y:.3}, {z:.3}) m, facing {:.0} deg, on {}{closure}{slips}",
            stance.pose.heading_deg,
            names.join(", ")
        ));
        for (when, push) in [("landing", &stance.landing), ("take-off", &stance.takeoff)] {
            if let Some(words) = push.as_ref().and_then(PushRecord::words) {
                sheet.line(format_args!("  {when}: {words}"));
            }
        }
    }
    let hops = mesh_plan_text(&answer.plan).replace("these contacts", "these stances").replace("contacts (", "stances (");
    let walk = answer.walk.as_ref().map(|walk| format!("\n{}", walk.text()));
    if walk.is_some() {
        sheet
            .line(format_args!("the table and the sums of the hops alone come first, those of walks and hops together at the end"));
    }
    sheet.into_text() + &hops + walk.as_deref().unwrap_or_default()
}
