//! The hop path: its generation from the result of a search, and an independent checker that flies it again.

mod drive_again;
mod execute;
mod generate;
mod hop;
mod outages;
mod over_mesh;
mod postures;
mod pushes_again;
mod stances_again;
#[cfg(test)]
mod stances_tests;
mod steps;
mod timetable;

pub use drive_again::{DriveViolation, DrivenAgain, drive_again};
pub use execute::{Clearance, Execution, Flight, Measure, StatedValue, ViolatedLimit, Violation, execute, execute_over_mesh};
pub use generate::{PathError, TooManyHops, generate, generate_over};
pub use hop::{Aim, Hop, HopPath, Propellant, RollOut, Totals, heading_deg};
pub use outages::{LongestOutage, longest_outage};
pub use over_mesh::{path_over_mesh, path_over_stances};
pub use postures::{FootTime, Posture, PostureKind, StanceFlight};
pub use stances_again::{StanceFault, StanceViolation, flown_by_stances};
pub use steps::NoCommand;
pub(crate) use steps::{SteppedGround, nearest_command};
pub use timetable::{Phase, TimedState, Timetable, TimetableError};
