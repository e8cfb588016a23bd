//! The URDF that a robot file names: trunk, mass and the joints of its limbs.

use std::fs;

use nalgebra::Point3;

use super::{
    build::Builder,
    parts::{Part, Parts},
};
use crate::{
    robot_model::{LimbChain, RobotModel},
    scenario::ProblemKind,
    world::TrunkBox,
};

/// A hip that is farther from the first joint than this share of the limb's length is said: two limbs may be exchanged. A smaller
/// share would complain of hips that stand for the middle of several joints.
const HIP_SHARE: f64 = 0.5;

impl Builder<'_> {
    /// The model that `robot.urdf` names, if it does and can be read.
    pub(super) fn model(&mut self, parts: &Parts) -> Option<RobotModel> {
        let whole = parts.tables.iter().find(|part| part.table == "robot")?;
        let path = self.file(whole.text("urdf")?);
        let model = fs::read_to_string(&path).map_err(|error| format!("cannot be read: {error}"));
        match model.and_then(|text| RobotModel::from_urdf(&text).map_err(|error| error.to_string())) {
            Ok(model) => Some(model),
            Err(error) => {
                let message = format!("robot.urdf: {}: {error}", path.display());
                let help = "give the path of a URDF from this file's folder; of xacro, what `xacro` makes of it";
                self.problem(whole, "urdf", ProblemKind::Value, message, help);
                None
            }
        }
    }

    /// The boxes of the model's trunk.
    pub(super) fn model_trunk(&mut self, model: &RobotModel) -> Vec<TrunkBox> {
        let (boxes, meshes) = model.trunk();
        if meshes > 0 {
            let root = &model.root().name;
            self.warnings.push(format!(
                "trunk: {meshes} shapes of link '{root}' and what is fixed to it are meshes, which are not read from a URDF: the trunk is its {} boxes; add [[trunk]] with \
                 size_m or stl",
                boxes.len()
            ));
        }
        boxes
    }

    /// The joints of a limb, if its table names a link. `hip_m`: where the file has its hip.
    pub(super) fn chain(
        &mut self,
        part: &Part,
        model: Option<&RobotModel>,
        has_urdf: bool,
        hip_m: &Point3<f64>,
    ) -> Option<LimbChain> {
        let Some(link) = part.text("urdf_link") else {
            if part.has("urdf_foot_m") && !part.has("urdf_link") {
                let message = format!("{} is given without urdf_link, in whose frame it is", part.path("urdf_foot_m"));
                self.problem(part, "urdf_foot_m", ProblemKind::Misplaced, message, "add urdf_link, or remove it");
            }
            return None;
        };
        if !has_urdf {
            let message = format!("{} is given without robot.urdf", part.path("urdf_link"));
            self.problem(part, "urdf_link", ProblemKind::Misplaced, message, "add urdf below [robot], or remove it");
        }
        let foot_m = part.three("urdf_foot_m").map_or_else(Point3::origin, Point3::from);
        match model?.limb(link, foot_m) {
            Ok(chain) => {
                let apart_m = (chain.hip_m() - hip_m).norm();
                if part.has("hip_m") && apart_m > HIP_SHARE * chain.length_m() {
                    self.warnings.push(format!(
                        "{} lies {apart_m:.3} m from joint '{}', the first on the way to link '{link}': are two limbs exchanged?",
                        part.path("hip_m"),
                        chain.joints()[0].name
                    ));
                }
                Some(chain)
            }
            Err(error) => {
                let message = format!("{}: {error}", part.path("urdf_link"));
                self.problem(part, "urdf_link", ProblemKind::Value, message, "give the link that is the foot");
                None
            }
        }
    }
}

/// Whether the file names a URDF, readable or not.
pub(super) fn names_urdf(parts: &Parts) -> bool {
    parts.tables.iter().any(|part| part.table == "robot" && part.has("urdf"))
}
