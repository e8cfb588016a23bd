//! The lofts that an obstacle in the plane of travel blocks: ground that is no function of the distance, such as the cut of a mesh.
//!
//! ```text
//!        h |          n hits it here            a point of the plane of travel, d from the take-off, e from the landing, h over
//!          |      ____/                         the line of sight, lies on exactly one arc, that of the loft
//!          |   .-'    / obstacle
//!          | .'      /                              n = h X / (d e)
//!          |/_______________________ d
//!          t     line of sight     l            so a segment, which is connected, blocks one closed interval of lofts.
//! ```

use super::ClearanceProfile;
use crate::quantity::{ChainPoint, SlopeInterval};

/// A straight line over the whole line of sight, by its heights over both ends, m.
#[derive(Clone, Copy, Debug)]
struct Line {
    at_takeoff_m: f64,
    at_landing_m: f64,
}

impl Line {
    /// Moved up by the heights of another line.
    fn raised(self, by: Self, sign: f64) -> Self {
        Self { at_takeoff_m: self.at_takeoff_m + sign * by.at_takeoff_m, at_landing_m: self.at_landing_m + sign * by.at_landing_m }
    }
}

/// The loft of the arc through a point that is `h_m` over the line of sight: `n = h X / (d e)`.
///
/// Over a contact itself an arc has no height: the loft is infinite with the sign of the height, and for a line through the contact the
/// limit along that line, `B / X` or `A / X`.
fn loft_through(run_m: f64, d_m: f64, h_m: f64, line: Line) -> f64 {
    let e_m = run_m - d_m;
    if d_m > 0.0 && e_m > 0.0 {
        return h_m * (run_m / (d_m * e_m));
    }
    let limit_m = if d_m <= 0.0 { line.at_landing_m } else { line.at_takeoff_m };
    match h_m {
        h_m if h_m > 0.0 => f64::INFINITY,
        h_m if h_m < 0.0 => f64::NEG_INFINITY,
        _ => limit_m / run_m,
    }
}

/// The least loft of an arc through a part of a line, from `from_m` to `to_m` from the take-off.
///
/// ```text
///     n(d) = A / d + B / e,   least inside at d = X sqrt(A) / (sqrt(A) + sqrt(B)) where A, B > 0:   (sqrt(A) + sqrt(B))^2 / X
/// ```
#[inline]
fn least_loft(run_m: f64, [from, to]: [ChainPoint; 2], line: Line) -> f64 {
    let ends = loft_through(run_m, from.x_m, from.z_m, line).min(loft_through(run_m, to.x_m, to.z_m, line));
    let (a_m, b_m) = (line.at_takeoff_m, line.at_landing_m);
    if a_m > 0.0 && b_m > 0.0 {
        let (a, b) = (a_m.sqrt(), b_m.sqrt());
        let at_m = run_m * (a / (a + b));
        if from.x_m < at_m && at_m < to.x_m {
            return ends.min((a + b) * ((a + b) / run_m));
        }
    }
    ends
}

/// The lofts of the arcs that meet an obstacle: a segment of the plane of travel, or come nearer to it than the clearance.
///
/// The clearance is vertical and holds over the obstacle and under it. Tapered, it is a straight line over each of three parts of the
/// line of sight, so every part of the segment stays a segment:
///
/// ```text
///     n >= that of the line h + eps,   or   n <= that of the line h - eps           (below an obstacle, as under a ceiling)
/// ```
///
/// Under the rule of vertices the whole clearance holds over and under both ends of the segment, and nothing is added between.
///
/// # Arguments
/// `run_m`: the length X of the line of sight. `from`, `to`: the ends of the segment, as horizontal distance from the take-off and
/// height over the line of sight, m; `from` no farther than `to`, both within the line of sight.
///
/// # Returns
/// The interval from the flattest to the steepest such arc; arcs of its ends graze. Its ends may be negative or infinite. Empty for what
/// lies wholly over one contact, where arcs have no height.
///
/// # Degenerate
/// An end exactly on a contact (`d = 0`, `h = 0`) gives the loft of the arc along the segment.
///
/// # Examples
/// ```
/// use chta::{ballistics::limits::{ClearanceProfile, blocked_lofts}, quantity::ChainPoint};
/// // A level bar 1 m over the middle third of 3 m: n = 3 h / (d e), 1.5 at its ends, 4 / 3 under its middle.
/// let bar = [ChainPoint::new(1.0, 1.0), ChainPoint::new(2.0, 1.0)];
/// let blocked = blocked_lofts(3.0, bar, ClearanceProfile::NONE);
/// assert!((blocked.lower - 4.0 / 3.0).abs() < 1e-12 && (blocked.upper - 1.5).abs() < 1e-12);
/// ```
#[inline]
pub fn blocked_lofts(run_m: f64, [from, to]: [ChainPoint; 2], clearance: ClearanceProfile) -> SlopeInterval {
    if to.x_m <= 0.0 || from.x_m >= run_m {
        return SlopeInterval::EMPTY;
    }
    let length_m = to.x_m - from.x_m;
    let line = if length_m > 0.0 {
        let slope = (to.z_m - from.z_m) / length_m;
        Line {
            // Exactly 0 for an end on a contact.
            at_takeoff_m: from.z_m - slope * from.x_m,
            at_landing_m: to.z_m + slope * (run_m - to.x_m),
        }
    } else {
        Line { at_takeoff_m: 0.0, at_landing_m: 0.0 }
    };
    if !clearance.has_kinks() {
        return between_vertices(run_m, [from, to], line, clearance.height_m());
    }
    let (kink_m, taper, full_m) = (clearance.kink_m(run_m), clearance.taper(), clearance.height_m());
    let parts = [
        (0.0, kink_m, Line { at_takeoff_m: 0.0, at_landing_m: taper * run_m }),
        (kink_m, run_m - kink_m, Line { at_takeoff_m: full_m, at_landing_m: full_m }),
        (run_m - kink_m, run_m, Line { at_takeoff_m: taper * run_m, at_landing_m: 0.0 }),
    ];
    let mut blocked = SlopeInterval::EMPTY;
    for (begin_m, end_m, eps) in parts {
        let (begin_m, end_m) = (begin_m.max(from.x_m), end_m.min(to.x_m));
        // Hops of up to twice the ramp have no middle part.
        if begin_m > end_m || (begin_m == end_m && length_m > 0.0) {
            continue;
        }
        let eps_m = |d_m: f64| eps.at_takeoff_m + (eps.at_landing_m - eps.at_takeoff_m) * (d_m / run_m);
        let z_m = |d_m: f64| match d_m {
            d_m if d_m == from.x_m => from.z_m,
            d_m if d_m == to.x_m => to.z_m,
            d_m => from.z_m + (to.z_m - from.z_m) * ((d_m - from.x_m) / length_m),
        };
        // A vertical segment has two heights at one distance.
        let [low, high] =
            if length_m > 0.0 { [[z_m(begin_m), z_m(end_m)]; 2] } else { [[from.z_m.min(to.z_m); 2], [from.z_m.max(to.z_m); 2]] };
        let moved = |z_m: [f64; 2], sign: f64| {
            [ChainPoint::new(begin_m, z_m[0] + sign * eps_m(begin_m)), ChainPoint::new(end_m, z_m[1] + sign * eps_m(end_m))]
        };
        let (under, over) = (line.raised(eps, -1.0), line.raised(eps, 1.0));
        blocked.lower = blocked.lower.min(least_loft(run_m, moved(low, -1.0), if length_m > 0.0 { under } else { line }));
        for end in moved(high, 1.0) {
            blocked.upper = blocked.upper.max(loft_through(run_m, end.x_m, end.z_m, over));
        }
    }
    blocked
}

/// The same without a taper: with a height kept at the ends of the segment alone, where they are inside the line of sight.
fn between_vertices(run_m: f64, [from, to]: [ChainPoint; 2], line: Line, height_m: f64) -> SlopeInterval {
    let mut blocked = SlopeInterval { lower: least_loft(run_m, [from, to], line), upper: f64::NEG_INFINITY };
    for end in [from, to] {
        let inside = 0.0 < end.x_m && end.x_m < run_m;
        let eps_m = if inside { height_m } else { 0.0 };
        blocked.lower = blocked.lower.min(loft_through(run_m, end.x_m, end.z_m - eps_m, line));
        blocked.upper = blocked.upper.max(loft_through(run_m, end.x_m, end.z_m + eps_m, line));
    }
    blocked
}
