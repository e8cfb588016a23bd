//! The hop path: its generation from the result of a search, and an independent checker that flies it again.

mod execute;
mod generate;
mod hop;

pub use execute::{Clearance, Execution, Flight, Measure, StatedValue, ViolatedLimit, Violation, execute};
pub use generate::{TooManyHops, generate};
pub use hop::{Hop, HopPath, Propellant, Totals, heading_deg};
