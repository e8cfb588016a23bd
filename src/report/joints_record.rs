//! The joints of a robot with legs, and what stances and hops ask of them, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    ground::{FootPush, Foothold, JointReach, Pose, Stance, StanceGround},
    path::StanceFlight,
    world::Contact,
};

/// The joints that put a foot where its workspace says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FootJointsRecord {
    /// Whether joints within their limits put the foot there, to a thousandth of the length of the limb. If so, they are below; if not, no posture that was
    /// tried led to it.
    pub reached: bool,
    /// How far from it they leave the foot, m.
    pub error_m: f64,
    /// The greatest travel of a joint as a share of the way from the middle of its range to a limit.
    pub travel_share: f64,
    /// The joints from the trunk to the foot.
    pub joints: Vec<JointRecord>,
}

/// A joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct JointRecord {
    /// Its name in the URDF.
    pub name: String,
    /// Of a joint that turns: its angle, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Of a joint that slides: its position, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extension_m: Option<f64>,
}

/// The forces on the feet of a push, or of a robot at rest, and what they ask of its joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PushRecord {
    /// The feet that push, in the order of the limbs. The forces leave the least moment about the centre of mass: one choice of many.
    pub feet: Vec<FootPushRecord>,
}

/// The force on a foot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FootPushRecord {
    /// The name of the limb.
    pub limb: String,
    /// The force of the ground on the foot, [x, y, z], N.
    pub force_n: [f64; 3],
    /// The greatest torque or force of a joint as a share of its limit; null where no limits are known.
    pub effort_share: Option<f64>,
    /// The greatest rate of a joint as a share of its limit, with the foot at rest; null where no limits are known, and at rest.
    pub rate_share: Option<f64>,
    /// Of a hop: how long the foot still reaches its foothold after the take-off, or does already before the landing, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_s: Option<f64>,
    /// Of a hop: how far the root moves in that time, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretch_m: Option<f64>,
}

/// How often the joints refute the workspaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct JointReachRecord {
    /// Stances of the roadmap.
    pub stances: usize,
    /// Those with a foot that no joints were found to reach.
    pub stances_refuted: usize,
    /// Their feet with joints.
    pub feet: usize,
    /// Those that no joints were found to reach.
    pub feet_refuted: usize,
}

impl From<JointReach> for JointReachRecord {
    fn from(reach: JointReach) -> Self {
        let JointReach { stances, stances_refuted, feet, feet_refuted } = reach;
        Self { stances, stances_refuted, feet, feet_refuted }
    }
}

impl JointReachRecord {
    /// A line of text.
    pub fn sentence(&self) -> String {
        let Self { stances, stances_refuted, feet, feet_refuted } = self;
        format!(
            "joints: of {stances} stances of the roadmap {stances_refuted} have a foot that no joints were found to reach ({feet_refuted} of {feet} \
             feet)"
        )
    }
}

impl FootJointsRecord {
    /// Of a foot of a pose; `None` where its joints are not known.
    pub fn of(ground: &StanceGround, pose: &Pose, foot: &Foothold) -> Option<Self> {
        let (chain, verdict) = (ground.chain(foot.limb)?, ground.joints_at(pose, foot.limb, &foot.point_m)?);
        let joints = chain.joints().iter().zip(&verdict.positions).map(|(joint, position)| JointRecord {
            name: joint.name.clone(),
            angle_deg: (!joint.slides).then(|| position.to_degrees()),
            extension_m: joint.slides.then_some(*position),
        });
        Some(Self {
            reached: verdict.reached,
            error_m: verdict.error_m,
            travel_share: verdict.travel_share,
            joints: joints.collect(),
        })
    }

    /// The end of a sentence about the foot.
    pub(super) fn words(&self) -> String {
        if self.reached {
            format!("its joints reach it with {:.0} % of their travel", 100.0 * self.travel_share)
        } else {
            format!("no joints were found that reach it, the nearest stop {:.4} m short", self.error_m)
        }
    }
}

impl PushRecord {
    /// Of a robot at rest in a stance; `None` where its mass is not known, and where its feet do not bear it without slipping and toppling.
    pub fn at_rest(ground: &StanceGround, stance: &Stance) -> Option<Self> {
        let feet = ground.rest(stance)?;
        let feet = feet.iter().map(|push| FootPushRecord::of(ground, push));
        Some(Self { feet: feet.collect() })
    }

    /// Of the take-off or the landing of a hop; `None` unless the robot states stroke and mass.
    pub fn of_hop(ground: &StanceGround, flight: &StanceFlight<'_>, stance: &Stance, contact: Contact) -> Option<Self> {
        let [takeoff, landing] = flight.pushes_m_s();
        let pushes = ground.push(stance, if contact == Contact::Takeoff { takeoff } else { landing })?;
        let times = flight.foot_times(contact);
        let feet = pushes.iter().map(|push| {
            let time = times.iter().find(|time| time.limb == push.limb);
            let (contact_s, stretch_m) = (time.map(|time| time.reaches_for_s), time.map(|time| time.way_m));
            FootPushRecord { contact_s, stretch_m, ..FootPushRecord::of(ground, push) }
        });
        Some(Self { feet: feet.collect() })
    }

    /// The greatest share of a torque or force that a joint has, and the limb.
    pub fn greatest_effort(&self) -> Option<(&str, f64)> {
        greatest(self.feet.iter().filter_map(|foot| Some((foot.limb.as_str(), foot.effort_share?))))
    }

    /// The greatest share of a rate that a joint has, and the limb.
    pub fn greatest_rate(&self) -> Option<(&str, f64)> {
        greatest(self.feet.iter().filter_map(|foot| Some((foot.limb.as_str(), foot.rate_share?))))
    }
}

impl PushRecord {
    /// What it asks of the joints, in words; `None` where no limits are known.
    pub(super) fn words(&self) -> Option<String> {
        let share = |what: &str, found: Option<(&str, f64)>| {
            found.map(|(limb, share)| format!("{:.0} % of the greatest {what} of a joint ({limb})", 100.0 * share))
        };
        let shares = [share("torque", self.greatest_effort()), share("rate", self.greatest_rate())];
        let shares: Vec<String> = shares.into_iter().flatten().collect();
        (!shares.is_empty()).then(|| shares.join(", "))
    }
}

impl FootPushRecord {
    fn of(ground: &StanceGround, push: &FootPush) -> Self {
        Self {
            limb: ground.robot().limbs()[push.limb].name.clone(),
            force_n: push.force_n.into(),
            effort_share: push.effort_share,
            rate_share: push.rate_share,
            contact_s: None,
            stretch_m: None,
        }
    }
}

fn greatest<'a>(shares: impl Iterator<Item = (&'a str, f64)>) -> Option<(&'a str, f64)> {
    shares.reduce(|best, other| if other.1 > best.1 { other } else { best })
}
