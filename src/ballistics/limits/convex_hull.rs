//! The lofts that a convex obstacle in the plane of travel blocks, given by points of which it is the hull.

use super::{ClearanceProfile, blocked_lofts};
use crate::quantity::{ChainPoint, SlopeInterval};

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
        let ends = if from.x_m <= to.x_m { [*from, to] } else { [to, *from] };
        if let Some(part) = within(between_m, ends) {
            let lofts = blocked_lofts(run_m, part, clearance);
            blocked = SlopeInterval { lower: blocked.lower.min(lofts.lower), upper: blocked.upper.max(lofts.upper) };
        }
    }
    blocked
}

/// The part of a segment between two distances; `None` where it has none, or touches only the end of what it lies beside.
fn within([first_m, last_m]: [f64; 2], [from, to]: [ChainPoint; 2]) -> Option<[ChainPoint; 2]> {
    if to.x_m <= first_m || from.x_m >= last_m {
        return None;
    }
    let at = |x_m: f64| ChainPoint::new(x_m, from.z_m + (to.z_m - from.z_m) * ((x_m - from.x_m) / (to.x_m - from.x_m)));
    Some([if from.x_m < first_m { at(first_m) } else { from }, if to.x_m > last_m { at(last_m) } else { to }])
}

/// The corners of the convex hull of points, in order around it.
///
/// Source: A. M. Andrew 1979, *Another efficient algorithm for convex hulls in two dimensions*.
fn convex_hull<'a>(points: &mut [ChainPoint], hull: &'a mut [ChainPoint]) -> &'a [ChainPoint] {
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
