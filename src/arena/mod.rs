//! A flat floor with boxes, and a wheeled robot that jumps onto them: the world of the Jumping Sumo.
//!
//! ```text
//!    +-------------------------------+      drive    round the boxes and over their tops
//!    |        +-------+              |      jump     up over a face, where the rise allows it
//!    |        |  0.8  |        goal  |      drop     down over a face
//!    |  start +-------+              |      turn     costs time on the spot
//!    +-------------------------------+
//! ```
//!
//! Three planners answer by different rules, and every path is re-summed by [`check_path`], which shares nothing with them:
//!
//! - [`grid_path`]: A* over nodes with the heading in the state, by the rules of the paper on the Jumping Sumo, in two [`Reading`]s.
//! - [`any_angle_path`]: the exact optimum over the boxes as drawn. Its time is the bound that the others are compared with.
//! - [`grow_rrt_star`]: RRT* by the paper's rules, seeded.
//!
//! A box is an open rectangle: driving along its face is allowed, a gap of no width between two boxes is closed. Where boxes overlap the
//! higher one counts.

mod any_angle;
mod bound;
mod check;
mod corner;
mod flight;
mod floor;
mod grid;
mod jumper;
mod keys;
mod labels;
mod levels;
mod path;
mod problem;
mod random;
mod rrt_star;
mod tariff;

pub use any_angle::any_angle_path;
pub use bound::{LowerBound, lower_bound};
pub use check::{CheckedPath, PathFault, check_path};
pub use flight::Flight;
pub use floor::{Arena, ArenaBox};
pub use grid::grid_path;
pub use jumper::Jumper;
pub use keys::{ArenaKeys, BoxKeys, FlightKeys, FloorKeys, GridKeys, JumperKeys};
pub use path::{ArenaPath, Move, PathPoint};
pub use problem::{ArenaProblem, Refusal};
pub use random::{RandomBoxes, random_arena};
pub use rrt_star::{GrownTree, HISTORY_NODES, Joined, RrtStarOptions, TreeNode, grow_rrt_star};
pub use tariff::{Reading, Tariff};
