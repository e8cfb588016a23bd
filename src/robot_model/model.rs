//! The links and joints of a robot.

use nalgebra::{Point3, Unit, Vector3};

use super::{ChainJoint, Frame, InvalidUrdf, LimbChain, urdf};
use crate::world::TrunkBox;

/// How a joint moves its child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// It turns about its axis, within limits.
    Revolute,
    /// It turns about its axis without limits.
    Continuous,
    /// It slides along its axis, within limits.
    Prismatic,
    /// In more than one direction, or as another joint does; a limb with such a joint has no inverse kinematics here.
    Other,
}

/// A joint between two links.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelJoint {
    /// Its name.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// The link that it is fixed to, by its place among the links.
    pub parent: usize,
    /// The link that it moves, by its place among the links.
    pub child: usize,
    /// Its frame relative to the parent link, where the joint is at 0: that of the child link.
    pub frame: Frame,
    /// Its axis in its own frame.
    pub axis: Unit<Vector3<f64>>,
    /// The least position, rad or m.
    pub lower: f64,
    /// The greatest position, rad or m.
    pub upper: f64,
    /// The greatest torque, N m, or force, N; 0: not stated.
    pub effort: f64,
    /// The greatest rate, rad/s or m/s; 0: not stated.
    pub velocity: f64,
}

/// A link.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelLink {
    /// Its name.
    pub name: String,
    /// Its mass, kg; 0 where none is stated.
    pub mass_kg: f64,
    /// The boxes around its shapes for collisions, in its frame.
    pub boxes: Vec<TrunkBox>,
    /// How many of these shapes are meshes, which are not read.
    pub meshes: usize,
}

/// The links and joints of a robot: a tree, whose root is the trunk.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotModel {
    pub(super) name: String,
    pub(super) links: Vec<ModelLink>,
    pub(super) joints: Vec<ModelJoint>,
    pub(super) root: usize,
}

/// Why a link is no foot.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLimb {
    /// There is no such link.
    #[error("there is no link '{link}', expected one of the {count} links of the model; the nearest is '{nearest}'")]
    Unknown {
        /// The link.
        link: String,
        /// How many there are.
        count: usize,
        /// The most similar name.
        nearest: String,
    },
    /// No joint moves it.
    #[error("no joint moves link '{link}' relative to the root, expected a link that is moved by revolute or prismatic joints")]
    Unmoved {
        /// The link.
        link: String,
    },
    /// A joint on the way is of another kind.
    #[error(
        "joint '{joint}' before link '{link}' is neither fixed, revolute, continuous nor prismatic, or follows another joint, expected joints that move alone"
    )]
    Joint {
        /// The link.
        link: String,
        /// The joint.
        joint: String,
    },
}

impl RobotModel {
    /// The model of a URDF text.
    ///
    /// # Errors
    /// [`InvalidUrdf`] with every problem and its line.
    pub fn from_urdf(text: &str) -> Result<Self, InvalidUrdf> {
        urdf::read(text)
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its links.
    pub fn links(&self) -> &[ModelLink] {
        &self.links
    }

    /// Its joints.
    pub fn joints(&self) -> &[ModelJoint] {
        &self.joints
    }

    /// The link that no joint moves: its frame is the trunk frame.
    pub fn root(&self) -> &ModelLink {
        &self.links[self.root]
    }

    /// The mass of all links, kg; `None` if no link states one.
    pub fn mass_kg(&self) -> Option<f64> {
        let mass: f64 = self.links.iter().map(|link| link.mass_kg).sum();
        (mass > 0.0).then_some(mass)
    }

    /// The boxes of the root and of the links fixed to it, in the trunk frame, and how many of their shapes are meshes, which are not read.
    pub fn trunk(&self) -> (Vec<TrunkBox>, usize) {
        let (mut boxes, mut meshes) = (Vec::new(), 0);
        let mut fixed = vec![(self.root, Frame::identity())];
        while let Some((link, frame)) = fixed.pop() {
            meshes += self.links[link].meshes;
            boxes.extend(self.links[link].boxes.iter().map(|part| TrunkBox {
                centre_m: frame.point(&part.centre_m),
                half_m: part.half_m,
                axes: frame.axes * part.axes,
            }));
            let of_link = self.joints.iter().filter(|joint| joint.parent == link && joint.kind == JointKind::Fixed);
            fixed.extend(of_link.map(|joint| (joint.child, frame.then(&joint.frame))));
        }
        (boxes, meshes)
    }

    /// The joints from the root to a foot: a point of a link, m, in its frame.
    ///
    /// # Errors
    /// [`NoLimb`] if there is no such link, or no joint moves it, or one moves in more than one direction.
    pub fn limb(&self, link: &str, foot_m: Point3<f64>) -> Result<LimbChain, NoLimb> {
        let Some(last) = self.links.iter().position(|known| known.name == link) else {
            let nearest = self.links.iter().min_by_key(|known| strsim::damerau_levenshtein(&known.name, link));
            let nearest = nearest.map(|known| known.name.clone()).unwrap_or_default();
            return Err(NoLimb::Unknown { link: link.to_owned(), count: self.links.len(), nearest });
        };
        // From the foot to the root; a tree ends there.
        let mut path = Vec::new();
        let mut at = last;
        while let Some(joint) = self.joints.iter().find(|joint| joint.child == at) {
            path.push(joint);
            at = joint.parent;
        }
        path.reverse();
        let mut joints = Vec::new();
        let mut before = Frame::identity();
        for joint in path {
            before = before.then(&joint.frame);
            match joint.kind {
                JointKind::Fixed => {}
                JointKind::Other => return Err(NoLimb::Joint { link: link.to_owned(), joint: joint.name.clone() }),
                JointKind::Revolute | JointKind::Continuous | JointKind::Prismatic => {
                    joints.push(ChainJoint::new(joint, before));
                    before = Frame::identity();
                }
            }
        }
        if joints.is_empty() {
            return Err(NoLimb::Unmoved { link: link.to_owned() });
        }
        Ok(LimbChain::new(joints, before.point(&foot_m)))
    }
}
