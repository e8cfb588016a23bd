//! What may be wrong with a robot.

use std::fmt;

/// The part of a robot that a statement is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RobotPart {
    /// The robot as a whole.
    Robot,
    /// A box of its trunk, counted from 0.
    Trunk(usize),
    /// A limb, counted from 0, with its name.
    Limb(usize, String),
}

/// One statement about a robot that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotProblem {
    /// Which part.
    pub part: RobotPart,
    /// The key in a robot file.
    pub key: &'static str,
    /// What was found.
    pub found: String,
    /// What is expected.
    pub expected: &'static str,
}

/// All statements about a robot that do not hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct InvalidRobot(pub Vec<RobotProblem>);

impl fmt::Display for RobotPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot => f.write_str("robot"),
            Self::Trunk(index) => write!(f, "trunk box {}", index + 1),
            Self::Limb(index, name) => write!(f, "limb {} '{name}'", index + 1),
        }
    }
}

impl fmt::Display for RobotProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} is {}, expected {}", self.part, self.key, self.found, self.expected)
    }
}
