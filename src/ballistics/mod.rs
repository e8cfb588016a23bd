//! The equations of one arc and its limits, for any ground. Only the independent checker in [`crate::path`] repeats them.
//!
//! ```text
//!                 . - ~ - .            m = tan(theta_t)   take-off slope
//!              .             `         b = tan(beta)      slope of the line of sight, Z / X
//!            /                 \       n = m - b          the loft
//!          / theta_t      ___---\      l = b - n          landing slope, 2 b - m
//!         t---------______       \
//!          beta ___---            \    X = x_l - x_t > 0, Z = z_l - z_t,
//!         ---- X -------------->   l   in the direction of travel
//! ```
//!
//! Every limit of a hop is an interval of its take-off slope (model section 2). They are stated here in the loft `n = m - b`,
//! the take-off slope above that of the line of sight. In this form they are shorter, and keep their digits at weak gravity
//! and over long distances:
//!
//! | limit | in the loft |
//! |---|---|
//! | line of sight | `n > 0` |
//! | take-off cone `[m1, m2]` | `m1 - b <= n <= m2 - b` |
//! | landing cone `[l1, l2]` | `b - l2 <= n <= b - l1` |
//! | take-off speed `v`, `q = v^2 / (g X)` | `n^2 - 2 (q - b) n + (1 + b^2) <= 0` |
//! | landing speed `v`, `q = v^2 / (g X)` | `n^2 - 2 (q + b) n + (1 + b^2) <= 0` |
//! | a vertex seen at slope `s` from the take-off, from which the landing is seen at slope `t` | `n >= s - t` |
//! | flight time `T` | `n <= g T^2 / (2 X)` |
//! | least take-off speed `v` | `n^2 - 2 (q - b) n + (1 + b^2) >= 0`: up to two windows |
//! | take-off speed levels | the roots for each level: single lofts |
//!
//! Least take-off and least landing speed are both at `n = sqrt(1 + b^2)`.

mod arc;
mod bounce;
mod box_flight;
mod choice;
mod commands;
mod delta_v;
mod flight_envelope;
mod greatest_reach;
pub mod limits;
mod line_of_sight;
mod path_bounds;
mod plane_times;
mod safety;
pub mod stance;

pub use arc::{Arc, least_landing_speed_m_s, least_takeoff_speed_m_s};
pub use bounce::{LevelBounces, bounced, level_bounces};
pub use box_flight::{BoxFlight, ContactTimes};
pub use choice::{TakeoffChoice, loft_at_share};
pub use commands::{TakeoffSpeeds, TakeoffWindow};
pub use delta_v::{STANDARD_GRAVITY_M_S2, delta_v_m_s, delta_v_of_m_s, delta_v_of_propellant_m_s, propellant_kg};
pub use flight_envelope::{ContactLimits, FlightEnvelope};
pub use greatest_reach::{landing_reach_m, takeoff_reach_m};
pub use line_of_sight::LineOfSight;
pub use path_bounds::PathBounds;
pub use plane_times::plane_times_s;
pub use safety::{safety_ceiling_m, safety_range_m};
