//! Robots with legs from TOML files, with the position of every problem.

mod build;
mod joints;
mod keys;
mod parts;
mod schema;
mod shape;

use std::{
    fs,
    path::{Path, PathBuf},
};

pub use keys::{ROBOT_KEYS, RobotKey, RobotKeyKind};
pub use schema::robot_schema;

use self::{build::build, parts::Parts};
use super::ScenarioProblems;
use crate::{robot_model::LimbChain, world::Robot};

/// A robot, and what its reader has to say.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotFile {
    /// The robot.
    pub robot: Robot,
    /// The joints of each limb, in the order of the limbs, where the file names its link in a URDF.
    pub chains: Vec<Option<LimbChain>>,
    /// Where the shapes that it names differ from what is used in their place, one sentence each.
    pub warnings: Vec<String>,
    /// The files that it names, in the order of the file.
    pub files: Vec<PathBuf>,
}

/// Why a robot file gives no robot.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotFileError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {error}; expected a robot file, TOML with [robot] and a [[limb]] for each limb", path.display())]
    Unreadable {
        /// Its path.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// What it says is no robot.
    #[error(transparent)]
    Problems(#[from] ScenarioProblems),
}

/// Reads a robot file. Paths in it start from its folder.
///
/// # Errors
/// [`RobotFileError`] with every problem of the file.
pub fn read_robot(path: &Path) -> Result<RobotFile, RobotFileError> {
    let source = fs::read_to_string(path).map_err(|error| RobotFileError::Unreadable { path: path.to_owned(), error })?;
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    Ok(robot_of_toml(&path.display().to_string(), &source, folder, &stem)?)
}

/// The robot of a TOML text. `name` stands in messages, `folder` is where paths in the text start, and `called` is the robot's name unless it
/// states one.
///
/// # Errors
/// Every problem: wrong syntax, unknown and missing keys, values of another kind, shapes that cannot be read, and whatever
/// [`Robot::new`] finds.
///
/// # Examples
/// ```
/// use chta::scenario::robot_of_toml;
/// let text = r#"
///     [robot]
///     contacts_min = 1
///     [[trunk]]
///     size_m = [0.2, 0.2, 0.1]
///     [[limb]]
///     name = "leg"
///     hip_m = [0, 0, -0.05]
///     shell = { radius_min_m = 0.1, radius_max_m = 0.25, axis = [0, 0, -1], half_angle_deg = 40 }
/// "#;
/// let file = robot_of_toml("hopper.toml", text, ".".as_ref(), "hopper")?;
/// assert_eq!((file.robot.name(), file.robot.leg_length_m()), ("hopper", 0.25));
/// # Ok::<(), chta::scenario::ScenarioProblems>(())
/// ```
pub fn robot_of_toml(name: &str, source: &str, folder: &Path, called: &str) -> Result<RobotFile, ScenarioProblems> {
    build(&Parts::of(source), folder, called).map_err(|problems| ScenarioProblems {
        name: name.to_owned(),
        source: source.to_owned(),
        problems,
    })
}
