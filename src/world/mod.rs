//! The body hopped on, the hopper or the robot with legs, and the grip of the ground.

mod body;
mod derating;
mod face_group;
mod friction_cone;
mod gravity;
mod hopper;
mod layer_name;
mod legs;
mod limit;
mod prepared_cone;
mod propulsion;
mod restitution;
mod rover;
mod speed_levels;
mod steps;
mod surface;
mod travel;

pub use body::{Body, KNOWN_BODIES};
pub use derating::Derating;
pub use face_group::{FaceGroup, FaceGroups};
pub use friction_cone::{FrictionCone, InvalidFriction};
pub use gravity::{Gravity, InvalidGravity, InvalidRadius};
pub use hopper::{ClearanceRule, Hopper, HopperLimits, HopperProblem, InvalidHopper};
pub use layer_name::LayerName;
pub use legs::{
    ConvexWorkspace, HalfSpace, InvalidHull, InvalidRobot, Limb, Robot, RobotDescription, RobotPart, RobotProblem, Shell,
    TrunkBounds, TrunkBox, Workspace, roll_pitch_yaw,
};
pub use limit::{Limit, SPEED_TOLERANCE, tolerant_speed_m_s};
pub use prepared_cone::PreparedCone;
pub use propulsion::LandingMode;
pub(crate) use restitution::RESTITUTION_MAX;
pub use restitution::{InvalidRestitution, Restitution};
pub use rover::{InvalidRover, Neighbours, Rover, RoverLimits, RoverProblem, SlipCurve};
pub use speed_levels::{InvalidLevels, SpeedLevels};
pub use steps::{CommandSteps, is_multiple, nearest_multiple};
pub(crate) use steps::{headings_near, multiples};
pub use surface::{Grip, InvalidSurface, RestSlope, SurfaceProperties};
pub use travel::{Contact, Direction};
