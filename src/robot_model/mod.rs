//! The joints of a robot with legs, from a URDF: where a foot is for given joints, and whether joints exist that put it at a point.
//!
//! ```
//! use chta::robot_model::RobotModel;
//! use nalgebra::Point3;
//!
//! // A leg in the plane of x and z: two links of 0.2 m below a hip.
//! let model = RobotModel::from_urdf(r#"<robot name="leg">
//!     <link name="trunk"/> <link name="thigh"/> <link name="shank"/> <link name="foot"/>
//!     <joint name="hip" type="revolute"><parent link="trunk"/><child link="thigh"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" effort="20" velocity="9"/></joint>
//!     <joint name="knee" type="revolute"><parent link="thigh"/><child link="shank"/><origin xyz="0 0 -0.2"/><axis xyz="0 1 0"/><limit lower="0" upper="2.5" effort="20" velocity="9"/></joint>
//!     <joint name="ankle" type="fixed"><parent link="shank"/><child link="foot"/><origin xyz="0 0 -0.2"/></joint>
//! </robot>"#)?;
//! let leg = model.limb("foot", Point3::origin())?;
//! assert!((leg.foot(&[0.0, 0.0]) - Point3::new(0.0, 0.0, -0.4)).norm() < 1e-15);
//! assert!(leg.reach(&Point3::new(0.1, 0.0, -0.3)).reached);
//! assert!(!leg.reach(&Point3::new(0.0, 0.0, -0.5)).reached, "beyond the stretched leg");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chain;
mod frame;
mod inverse;
mod model;
mod urdf;

pub use chain::{ChainJoint, LimbChain};
pub use frame::Frame;
pub use inverse::IkVerdict;
pub use model::{JointKind, ModelJoint, ModelLink, NoLimb, RobotModel};
pub use urdf::{InvalidUrdf, UrdfProblem};
