//! The hop path: its generation from the result of a search, and an independent checker that flies it again.

mod execute;
mod generate;
mod hop;
mod timetable;

pub use execute::{Clearance, Execution, Flight, Measure, StatedValue, ViolatedLimit, Violation, execute};
pub use generate::{TooManyHops, generate};
pub use hop::{Hop, HopPath, Totals, heading_deg};
pub use timetable::{Phase, TimedState, Timetable, TimetableError};
