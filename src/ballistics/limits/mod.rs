//! Each limit of a hop as an interval of the loft `n = m - b`; one file per kind.
//!
//! All are closed forms of quotients and at most one square root, without trigonometry or allocation. An empty interval means
//! that the limit alone refuses every arc.

mod apex;
mod blocked;
mod blocked_ball;
mod blocked_box;
mod commanded;
mod cones;
mod convex_hull;
mod flight_time;
mod speed;
mod terrain;

pub use apex::apex_height;
pub use blocked::blocked_lofts;
pub use blocked_ball::{BALL_BOUND, BALL_CORNERS, blocked_lofts_of_ball};
pub use blocked_box::{BoxBorder, FlownBox, blocked_lofts_of_box, border_of_box};
pub use commanded::{takeoff_speed_level, takeoff_speed_min};
pub use cones::{landing_cone, takeoff_cone};
pub use flight_time::flight_time;
pub use speed::{landing_speed, speeds, takeoff_speed};
pub use terrain::{ClearanceProfile, clearing_loft};
