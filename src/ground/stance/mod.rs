//! A robot with legs on a mesh: where it can stand, which ways it may jump from there, and which arcs its trunk can fly.
//!
//! ```text
//!        ____________                 A stance is a pose of the trunk with its feet on the ground. The sum of the friction cones of
//!       |   trunk    |                the feet allows, for any heading, one interval of take-off slopes and one of landing slopes.
//!       |____________|                In flight the trunk must not meet the ground; its boxes keep their orientation over a piece of
//!        / \      / \                 the arc, so that the lofts that a facet blocks are known in closed form
//!       /   \    /   \                ([`blocked_lofts_of_box`](crate::ballistics::limits::blocked_lofts_of_box)).
//!     _o_____o__o_____o______ ground
//! ```
//!
//! Source: Campana, Fernbach, Tonneau, Taix and Laumond 2016, *Ballistic motion planning for jumping superheroes*, sections 3 and 4, with
//! the exact sum of the cones in place of one cone inside it, and exact windows in place of sampled angles.
//!
//! # Assumptions
//! The feet keep off the ground in flight: legs are drawn in. Take-off and landing are impulses, unless a stroke is stated. The trunk turns
//! evenly from the one pose to the other; over each piece of at most ten degrees its boxes are grown by how far their corners turn.

mod clip;
mod flight;
mod foothold;
mod joints;
mod map;
mod pose;
mod push;
mod stand;
mod trunk;

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

pub use foothold::{Foothold, LimbOutcome};
pub use joints::{FootPush, JointReach};
pub use map::StanceMap;
pub use pose::Pose;
pub use stand::{NoStance, Stance, TrunkHit};

use super::{MeshBuffers, MeshGround};
use crate::{
    ballistics::stance::ConeKind,
    robot_model::LimbChain,
    world::{Robot, TrunkBox},
};

/// Heights at which a stance is looked for, as shares of the range.
const HEIGHTS: [f64; 11] = [0.7, 0.6, 0.8, 0.5, 0.9, 0.4, 0.95, 0.3, 0.2, 0.1, 1.0];

/// A robot with legs over a mesh: all that a hop between two of its stances depends on. A clone shares mesh and robot.
#[derive(Clone, Debug)]
pub struct StanceGround {
    mesh: MeshGround,
    robot: Arc<Robot>,
    cone: ConeKind,
    up: StandsUp,
    map: Option<Arc<StanceMap>>,
    /// The joints of the limbs; empty where none are known.
    chains: Arc<[Option<LimbChain>]>,
}

/// Which way is up for a trunk that stands on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StandsUp {
    /// Along the normal of the ground.
    #[default]
    Normal,
    /// Against gravity.
    Vertical,
}

/// A ground whose surface gives feet no friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoFriction {
    /// The surface states angles.
    #[error(
        "the surface states its grip by angles from the slope, expected a friction coefficient: feet on slopes of several directions push by \
         friction; give surface.friction_coefficient"
    )]
    Angles,
    /// A coefficient of 0.
    #[error(
        "found surface.friction_coefficient of 0, expected a number above 0 for a robot with legs: feet without friction push along the normal alone \
         and do not stand"
    )]
    Zero,
}

/// Buffers of one stance and one hop after another.
#[derive(Clone, Debug, Default)]
pub struct StanceBuffers {
    mesh: MeshBuffers,
}

impl StanceGround {
    /// A robot over a ground, whose hopper has the limits of its flight. `cone`: which cone stands for the sum of those of its feet.
    ///
    /// # Errors
    /// [`NoFriction`], unless the robot is a point.
    pub fn new(mesh: MeshGround, robot: impl Into<Arc<Robot>>, cone: ConeKind, up: StandsUp) -> Result<Self, NoFriction> {
        let robot = robot.into();
        let ground = Self { mesh, robot, cone, up, map: None, chains: Arc::default() };
        match ground.mesh.surface().constant_friction() {
            _ if ground.is_point() => Ok(ground),
            Some(friction) if friction.coefficient() > 0.0 => Ok(ground),
            Some(_) => Err(NoFriction::Zero),
            None => Err(NoFriction::Angles),
        }
    }

    /// The same over the facets of a DEM, with what its map lays over them.
    #[must_use]
    pub fn with_map(self, map: impl Into<Arc<StanceMap>>) -> Self {
        Self { map: Some(map.into()), ..self }
    }

    /// The map of the DEM whose facets are the mesh; `None` over a mesh of its own.
    pub fn map(&self) -> Option<&StanceMap> {
        self.map.as_deref()
    }

    /// The mesh.
    pub const fn mesh(&self) -> &MeshGround {
        &self.mesh
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Which cone stands for the sum of those of its feet.
    pub const fn cone_kind(&self) -> ConeKind {
        self.cone
    }

    /// Which way is up for a trunk that stands.
    pub const fn stands_up(&self) -> StandsUp {
        self.up
    }

    /// Whether the robot is a point: one limb whose foot is its root, and no trunk. It then stands and flies as a hopper without legs does.
    pub fn is_point(&self) -> bool {
        let [limb] = self.robot.limbs() else { return false };
        self.robot.trunk().is_empty() && limb.reach_m() == 0.0
    }

    /// How high the root of a standing robot may be over the ground under it, m: from where its trunk touches level ground to where its longest
    /// limb leaves it.
    pub fn heights_m(&self) -> [f64; 2] {
        let lowest = |low: f64, z: f64| low.min(z);
        let trunk = self.robot.trunk().iter().flat_map(TrunkBox::corners_m).map(|corner| corner.z).fold(0.0, lowest);
        let limbs = self.robot.limbs().iter().map(|limb| limb.bounds()[0].z).fold(0.0, lowest);
        [(-trunk).min(-limbs), -limbs]
    }

    /// Heights of the root over a place at which a stance is looked for, m, the middle ones of the [range](Self::heights_m) first.
    pub fn standing_heights_m(&self) -> [f64; 11] {
        let [low_m, high_m] = self.heights_m();
        HEIGHTS.map(|share| low_m + (high_m - low_m) * share)
    }

    /// The highest ground straight under a point, m; `None` over a gap or beside the mesh.
    pub fn ground_below_m(&self, point: Point3<f64>) -> Option<f64> {
        let near_m = self.mesh.tree().resolution_m();
        let mut highest: Option<f64> = None;
        self.mesh.tree().visit(
            |min, max| {
                min.x - near_m <= point.x
                    && point.x <= max.x + near_m
                    && min.y - near_m <= point.y
                    && point.y <= max.y + near_m
                    && min.z <= point.z
            },
            |_, [a, b, c]| {
                let normal = (b - a).cross(&(c - a));
                let side = |from: &Point3<f64>, to: &Point3<f64>| {
                    let edge = (to - from).xy();
                    edge.perp(&(point - from).xy()) * normal.z.signum() >= -near_m * edge.norm()
                };
                if normal.z != 0.0 && side(a, b) && side(b, c) && side(c, a) {
                    let z_m = a.z - (point - a).xy().dot(&normal.xy()) / normal.z;
                    if z_m <= point.z && highest.is_none_or(|known| z_m > known) {
                        highest = Some(z_m);
                    }
                }
            },
        );
        highest
    }

    /// Up for a trunk over a facet or several with this mean normal.
    pub fn up_over(&self, normal: Vector3<f64>) -> Vector3<f64> {
        match self.up {
            StandsUp::Vertical => Vector3::z(),
            StandsUp::Normal => normal.try_normalize(1e-9).unwrap_or_else(Vector3::z),
        }
    }
}

impl StandsUp {
    /// All, the default first.
    pub const ALL: [Self; 2] = [Self::Normal, Self::Vertical];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Vertical => "vertical",
        }
    }
}

crate::quantity::by_name!(StandsUp, StandsUp::ALL);
