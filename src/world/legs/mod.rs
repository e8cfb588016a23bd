//! A robot with legs: a trunk of boxes, limbs with the space that their feet reach, and the limits of a push-off.
//!
//! All positions are in the trunk frame: x forward, y to the left, z up. Its origin, the root, is the point that flies the arc.
//!
//! ```text
//!              z
//!         _____|_____            trunk: boxes
//!        |     |     |  root = origin
//!        o-----+-----o---> x     hips
//!       /             \
//!    ( / )           ( \ )       workspaces: where the feet may be
//! ```

mod convex;
mod hull;
mod limb;
mod problem;
mod robot;
mod shell;
mod trunk;

pub use convex::{ConvexWorkspace, HalfSpace, InvalidHull};
pub use limb::{Limb, Workspace};
pub use problem::{InvalidRobot, RobotPart, RobotProblem};
pub use robot::{Robot, RobotDescription};
pub use shell::Shell;
pub use trunk::{TrunkBox, roll_pitch_yaw};

/// An axis-parallel box in the trunk frame: its least and its greatest corner, m.
pub type TrunkBounds = [nalgebra::Point3<f64>; 2];
