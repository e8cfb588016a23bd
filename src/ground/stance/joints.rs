//! The joints of a robot that stands: whether they put its feet where the workspaces say, and what a push asks of them.
//!
//! ```text
//!     reach     joints q within their limits with foot(q) = p, the place of the foothold in the trunk frame
//!     efforts   tau = -J(q)^T f      f: the force of the ground on the foot, in the trunk frame
//!     rates     J(q) dq/dt = -v      v: the velocity of the trunk, while the foot stays
//! ```
//!
//! The forces `f` add up to the push and leave the least moment about the centre of mass
//! ([`forces_of_least_spin`]). They are one choice of many: others may ask less of a joint.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::{Foothold, Pose, Stance, StanceGround};
use crate::{
    ballistics::stance::forces_of_least_spin,
    robot_model::{IkVerdict, LimbChain},
};

/// How much of what a foot can do a push asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct FootPush {
    /// The limb, by its number.
    pub limb: usize,
    /// The force of the ground on the foot, N.
    pub force_n: Vector3<f64>,
    /// The torques, N m, or forces, N, of the joints that hold it; empty without a chain.
    pub efforts: Vec<f64>,
    /// The greatest of them as a share of its joint's limit; `None` without a chain whose joints state limits.
    pub effort_share: Option<f64>,
    /// The greatest rate of a joint as a share of its limit, with the foot at rest and the trunk at the velocity of the push; `None` as above, and of a
    /// robot at rest.
    pub rate_share: Option<f64>,
}

/// How many stances of a list have feet that no joints were found to reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointReach {
    /// The stances.
    pub stances: usize,
    /// Those with a foot that no joints were found to reach.
    pub stances_refuted: usize,
    /// Their feet with joints.
    pub feet: usize,
    /// Those that no joints were found to reach.
    pub feet_refuted: usize,
}

impl StanceGround {
    /// The same with the joints of its limbs, in the order of the limbs; `None` for a limb whose joints are not known.
    #[must_use]
    pub fn with_chains(self, chains: impl Into<Arc<[Option<LimbChain>]>>) -> Self {
        Self { chains: chains.into(), ..self }
    }

    /// Whether the joints of a limb are known.
    pub fn has_joints(&self) -> bool {
        self.chains.iter().any(Option::is_some)
    }

    /// The joints of a limb, if they are known.
    pub fn chain(&self, limb: usize) -> Option<&LimbChain> {
        self.chains.get(limb)?.as_ref()
    }

    /// The joints that put the foot of a limb at a point of the ground, for a pose of the trunk; `None` without a chain.
    pub fn joints_at(&self, pose: &Pose, limb: usize, point: &Point3<f64>) -> Option<IkVerdict> {
        Some(self.chain(limb)?.reach(&pose.to_trunk(point)))
    }

    /// Whether a foot reaches a point of the ground, for a pose of the trunk: by its joints if they are known, else by its workspace.
    pub fn foot_reaches(&self, pose: &Pose, limb: usize, point: &Point3<f64>) -> bool {
        self.joints_at(pose, limb, point)
            .map_or_else(|| self.robot().limbs()[limb].reaches(&pose.to_trunk(point)), |verdict| verdict.reached)
    }

    /// How many of some stances have feet that no joints were found to reach.
    pub fn joint_reach<'a>(&self, stances: impl IntoIterator<Item = &'a Stance>) -> JointReach {
        let mut found = JointReach::default();
        for stance in stances {
            let verdicts = stance.footholds().iter().filter_map(|foot| self.joints_at(stance.pose(), foot.limb, &foot.point_m));
            let (mut feet, mut refuted) = (0, 0);
            for verdict in verdicts {
                feet += 1;
                refuted += usize::from(!verdict.reached);
            }
            found.stances += 1;
            found.stances_refuted += usize::from(refuted > 0);
            found.feet += feet;
            found.feet_refuted += refuted;
        }
        found
    }

    /// The forces on the feet of a robot that rests in a stance, and what they ask of its joints; `None` without a mass, and where the feet do not bear
    /// the weight without slipping and toppling.
    pub fn rest(&self, stance: &Stance) -> Option<Vec<FootPush>> {
        let weight_n = Vector3::z() * (self.mass_kg()? * self.mesh().envelope().gravity_m_s2());
        self.rests_upright(stance).then(|| self.shared(stance, weight_n, None))?
    }

    /// The forces on the feet at the end of a straight push over the stroke, and what they ask of the joints: `velocity_m_s` of the take-off, or the
    /// reverse of that of the landing. `None` unless the robot states stroke and mass, and where the feet do not push that way. In sum they are
    /// [`push_force_n`](crate::ballistics::stance::push_force_n).
    pub fn push(&self, stance: &Stance, velocity_m_s: Vector3<f64>) -> Option<Vec<FootPush>> {
        let (stroke_m, mass_kg) = (self.robot().stroke_m()?, self.mass_kg()?);
        self.shared(stance, self.force_of_push_n(velocity_m_s, stroke_m) * mass_kg, Some(velocity_m_s))
    }

    /// A force in sum, shared by the feet.
    fn shared(&self, stance: &Stance, force_n: Vector3<f64>, velocity_m_s: Option<Vector3<f64>>) -> Option<Vec<FootPush>> {
        let feet: Vec<&Foothold> = stance.footholds().iter().filter(|foot| foot.cone().is_some()).collect();
        let forces = forces_of_least_spin(&self.arms(stance), force_n)?;
        let pose = stance.pose();
        let back = pose.turn.inverse();
        let of = |(foot, force_n): (&&Foothold, Vector3<f64>)| {
            let joints = self.chain(foot.limb).zip(self.joints_at(pose, foot.limb, &foot.point_m));
            let efforts = joints.as_ref().map(|(chain, found)| chain.efforts(&found.positions, &(back * force_n)));
            let limits = |limit: fn(&crate::robot_model::ChainJoint) -> Option<f64>| {
                joints.as_ref().filter(|(chain, _)| chain.joints().iter().any(|joint| limit(joint).is_some()))
            };
            let effort_share =
                limits(|joint| joint.effort_max).map(|(chain, found)| chain.effort_share(&found.positions, &(back * force_n)));
            let rate_share = velocity_m_s.and_then(|velocity| {
                let (chain, found) = limits(|joint| joint.rate_max)?;
                Some(chain.rate_share(&found.positions, &(back * -velocity)))
            });
            FootPush { limb: foot.limb, force_n, efforts: efforts.unwrap_or_default(), effort_share, rate_share }
        };
        Some(feet.iter().zip(forces).map(of).collect())
    }
}
