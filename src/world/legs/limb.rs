//! Limbs and the space that their feet reach.

use nalgebra::Point3;

use super::{ConvexWorkspace, HalfSpace, Shell, TrunkBounds};
use crate::world::FrictionCone;

/// Where the foot of a limb may be, relative to the trunk.
#[derive(Clone, Debug, PartialEq)]
pub enum Workspace {
    /// A sector of a spherical shell about the hip.
    Shell(Shell),
    /// A convex polyhedron in the trunk frame.
    Convex(ConvexWorkspace),
}

impl Workspace {
    /// The half-spaces whose intersection it is; `None` of a shell, which has none.
    pub fn planes(&self) -> Option<&[HalfSpace]> {
        match self {
            Self::Shell(_) => None,
            Self::Convex(convex) => Some(convex.half_spaces()),
        }
    }
}

/// A limb that may push off and land on its foot, as stated, not yet checked: [`Robot::new`](super::Robot::new) does that.
#[derive(Clone, Debug, PartialEq)]
pub struct Limb {
    /// Its name in reports, other than those of all other limbs.
    pub name: String,
    /// Where it is fixed to the trunk, m. The ground at a contact has to face it.
    pub hip_m: Point3<f64>,
    /// Where its foot may be.
    pub workspace: Workspace,
    /// The friction of its foot, above 0; `None`: that of the ground.
    pub friction: Option<FrictionCone>,
    /// The greatest force on its foot, N; `None`: any.
    pub force_max_n: Option<f64>,
}

impl Limb {
    /// A limb of which only the workspace is stated.
    pub fn new(name: impl Into<String>, hip_m: Point3<f64>, workspace: Workspace) -> Self {
        Self { name: name.into(), hip_m, workspace, friction: None, force_max_n: None }
    }

    /// Whether its foot may be at a point of the trunk frame.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::{Limb, Shell, Workspace}};
    /// use nalgebra::{Point3, Vector3};
    /// let shell = Shell::new(0.1, 0.3, -Vector3::z_axis(), Angle::from_degrees(60.0));
    /// let limb = Limb::new("left", Point3::new(0.0, 0.1, 0.0), Workspace::Shell(shell));
    /// assert!(limb.reaches(&Point3::new(0.0, 0.1, -0.3)) && !limb.reaches(&Point3::new(0.0, 0.1, -0.31)));
    /// assert_eq!(limb.bounds()[0].z, -0.3);
    /// // sqrt(0.1^2 + 0.3^2 + 2 0.1 0.3 cos(90 - 60)) from the root
    /// assert!((limb.reach_m() - 0.389_822).abs() < 1e-6);
    /// ```
    #[inline]
    pub fn reaches(&self, point: &Point3<f64>) -> bool {
        match &self.workspace {
            Workspace::Shell(shell) => shell.contains(&self.hip_m, point),
            Workspace::Convex(convex) => convex.contains(point),
        }
    }

    /// The smallest axis-parallel box around its workspace.
    pub fn bounds(&self) -> TrunkBounds {
        match &self.workspace {
            Workspace::Shell(shell) => shell.bounds(&self.hip_m),
            Workspace::Convex(convex) => convex.bounds(),
        }
    }

    /// The distance of the farthest point of its workspace from the root, m.
    pub fn reach_m(&self) -> f64 {
        match &self.workspace {
            Workspace::Shell(shell) => shell.reach_m(&self.hip_m),
            Workspace::Convex(convex) => convex.farthest_m(&Point3::origin()),
        }
    }

    /// The distance of the farthest point of its workspace from its hip, m.
    pub fn length_m(&self) -> f64 {
        match &self.workspace {
            Workspace::Shell(shell) => shell.radius_max_m(),
            Workspace::Convex(convex) => convex.farthest_m(&self.hip_m),
        }
    }
}
