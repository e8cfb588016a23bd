//! The lofts that a convex obstacle in the plane of travel blocks, given by points of which it is the hull.

use super::{ClearanceProfile, blocked_lofts};
use crate::quantity::{ChainPoint, SlopeInterval, part_between};

/// The most points of a hull.
pub(super) const HULL_POINTS: usize = 128;

/// The lofts of the arcs that meet the part of a convex hull between two distances from the take-off.
///
/// # Arguments
/// `points`: horizontal distances from the take-off and heights over the line of sight, m; at most [`HULL_POINTS`], sorted here. `between_m`:
/// within the line of sight.
pub(super) fn blocked_by_hull(
    run_m: f64,
    between_m: [f64; 2],
    points: &mut [ChainPoint],
    clearance: ClearanceProfile,
) -> SlopeInterval {
    let mut border = [ChainPoint::new(0.0, 0.0); HULL_POINTS + 1];
    let border = convex_hull(points, &mut border);
    let mut blocked = SlopeInterval::EMPTY;
    for (i, from) in border.iter().enumerate() {
        let to = border[(i + 1) % border.len()];
        if let Some(part) = part_between(between_m, [*from, to]) {
            let lofts = blocked_lofts(run_m, part, clearance);
            blocked = SlopeInterval { lower: blocked.lower.min(lofts.lower), upper: blocked.upper.max(lofts.upper) };
        }
    }
    blocked
}

/// The corners of the convex hull of points, in order around it.
///
/// Source: A. M. Andrew 1979, *Another efficient algorithm for convex hulls in two dimensions*.
pub(super) fn convex_hull<'a>(points: &mut [ChainPoint], hull: &'a mut [ChainPoint]) -> &'a [ChainPoint] {
    points.sort_unstable_by(|a, b| a.x_m.total_cmp(&b.x_m).then(a.z_m.total_cmp(&b.z_m)));
    let turns_left =
        |a: ChainPoint, b: ChainPoint, c: ChainPoint| (b.x_m - a.x_m) * (c.z_m - a.z_m) - (b.z_m - a.z_m) * (c.x_m - a.x_m) > 0.0;
    let mut count = 0;
    let mut add = |point: ChainPoint, count: &mut usize, least: usize| {
        while *count >= least + 2 && !turns_left(hull[*count - 2], hull[*count - 1], point) {
            *count -= 1;
        }
        hull[*count] = point;
        *count += 1;
    };
    for point in points.iter() {
        add(*point, &mut count, 0);
    }
    let lower = count - 1;
    for point in points.iter().rev().skip(1) {
        add(*point, &mut count, lower);
    }
    // The first point came twice.
    &hull[..count.saturating_sub(1).max(1)]
}
