//! The lofts that an obstacle blocks for a ball: those of the arcs on which the ball's centre comes too near to it.
//!
//! ```text
//!        .-------.                 The obstacle's part within a radius r beside the plane of travel, seen along the normal of that
//!      .'  _____  '.               plane, is a convex polygon. Added to a regular octagon of inradius r it holds every point of the
//!      |  |_____|  |  r            plane that is nearer to the obstacle than r, and none that is farther away than
//!      '.         .'
//!        '-------'                     r sqrt(1 + 1 / cos^2 22.5 deg) = 1.474 r.
//! ```

use super::{ClearanceProfile, convex_hull::blocked_by_hull};
use crate::{
    ballistics::LineOfSight,
    quantity::{ChainPoint, SlopeInterval},
};

/// No arc is refused on which the ball's centre is farther away from all facets than this many radii: `sqrt(1 + 1 / cos^2 22.5 deg)`.
pub const BALL_BOUND: f64 = 1.473_625_758_207_900_6;

/// `tan 22.5 deg`.
const T: f64 = std::f64::consts::SQRT_2 - 1.0;

/// The corners of a regular octagon of inradius 1.
const OCTAGON: [[f64; 2]; 8] = [[1.0, T], [T, 1.0], [-T, 1.0], [-1.0, T], [-1.0, -T], [-T, -1.0], [T, -1.0], [1.0, -T]];

/// The most corners of a triangle clipped to a slab.
pub const BALL_CORNERS: usize = 5;

/// The lofts of the arcs on which the centre of a ball comes nearer than its radius to an obstacle, and of some that pass it within
/// [`BALL_BOUND`] radii.
///
/// # Arguments
/// `obstacle`: 1 to [`BALL_CORNERS`] points of the plane of travel whose convex hull holds all of the obstacle within a radius beside the
/// plane, as horizontal distance from the centre at take-off and height over it, m. The clearance is added over and under.
///
/// # Returns
/// As [`blocked_lofts`](super::blocked_lofts); everything for an obstacle too near to an end of the line of sight.
///
/// # Examples
/// ```
/// use chta::{ballistics::{LineOfSight, limits::{ClearanceProfile, blocked_lofts_of_ball}}, quantity::ChainPoint};
/// // A point 1 m over the middle of 4 m, n = z X / (d e): from under the octagon to over it, 0.75 to 1.25.
/// let sight = LineOfSight::new(4.0, 0.0);
/// let blocked = blocked_lofts_of_ball(sight, &[ChainPoint::new(2.0, 1.0)], 0.25, ClearanceProfile::NONE);
/// assert!((blocked.lower - 0.75).abs() < 1e-12 && blocked.upper > 1.25 && blocked.upper < 1.26);
/// ```
pub fn blocked_lofts_of_ball(
    sight: LineOfSight,
    obstacle: &[ChainPoint],
    radius_m: f64,
    clearance: ClearanceProfile,
) -> SlopeInterval {
    let mut points = [ChainPoint::new(0.0, 0.0); 8 * BALL_CORNERS];
    let mut count = 0;
    for corner in obstacle.iter().take(BALL_CORNERS) {
        for [x, z] in OCTAGON {
            let (x_m, z_m) = (corner.x_m + radius_m * x, corner.z_m + radius_m * z);
            // Over the line of sight straight lines stay straight.
            points[count] = ChainPoint::new(x_m, z_m - sight.slope() * x_m);
            count += 1;
        }
    }
    blocked_by_hull(sight.run_m(), [0.0, sight.run_m()], &mut points[..count], clearance)
}
