//! The upper hull of the ground in slope space, seen from one take-off.
//!
//! ```text
//!   s                 divided by the distance d, the arc is a straight line s = m - c d, and a vertex is the point
//!   |  o               (d_p, s_p), s_p = (z_p + eps - z_t) / d_p;
//!   |    \  o          the arc that just clears them and lands at (X, b) is the upper tangent from there:
//!   |  o   `--o        its loft is the greatest s_p - t_p, and a point below the hull never is the greatest.
//!   |   o    o  `\
//!   +--------------x--- d
//!                (X, b)
//! ```

use crate::quantity::ChainPoint;

/// The vertices on the upper hull, nearest first: a monotone chain, built by pushing each vertex once in the order of
/// distance.
///
/// A vertex is removed only if it is below the hull by more than the rounding error, so that the greatest `s - t` over the
/// hull is the greatest over all vertices, to the last bit.
#[derive(Clone, Debug, Default)]
pub(super) struct Hull {
    /// Columns of equal length, at least `PADDING` longer than the hull.
    x_m: Vec<f64>,
    z_m: Vec<f64>,
    distance_m: Vec<f64>,
    seen: Vec<f64>,
    /// The clearance over each vertex, m.
    raised_m: Vec<f64>,
    len: usize,
    /// The steepest slope, of a vertex or of a landing seen from the take-off, that the margin for rounding allows for.
    steepest: f64,
}

/// A vertex as seen from the take-off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Its distance, m.
    pub(super) distance_m: f64,
    /// The clearance over it, m.
    pub(super) raised_m: f64,
    /// The slope from the take-off to that height over it.
    pub(super) slope: f64,
}

/// Number of vertices that the inner loop of the tangent evaluates at once.
const PADDING: usize = 4;

/// Up to this many vertices, evaluating all is faster than bisection.
const SCANNED: usize = 32;

/// A vertex is kept unless it is below the hull by this factor times the steepest slope: 512 rounding errors, of which a
/// tangent makes some 32.
const KEPT: f64 = 256.0 * f64::EPSILON;

impl Hull {
    /// Removes all vertices and keeps the memory. The margin for rounding holds for slopes up to `steepest`.
    pub(super) fn clear(&mut self, steepest: f64) {
        self.len = 0;
        self.steepest = steepest;
    }

    /// The steepest slope that this hull was made for.
    pub(super) const fn steepest(&self) -> f64 {
        self.steepest
    }

    /// Adds a vertex beyond the previous ones.
    pub(super) fn push(&mut self, point: ChainPoint, Seen { distance_m, raised_m, slope: seen }: Seen) {
        while self.len >= 2 && self.hides_last(distance_m, seen) {
            self.len -= 1;
        }
        if self.len + PADDING >= self.x_m.len() {
            let room = 2 * self.x_m.len() + 4 * PADDING;
            for column in [&mut self.x_m, &mut self.z_m, &mut self.distance_m, &mut self.seen, &mut self.raised_m] {
                column.resize(room, 0.0);
            }
        }
        self.x_m[self.len] = point.x_m;
        self.z_m[self.len] = point.z_m;
        self.distance_m[self.len] = distance_m;
        self.seen[self.len] = seen;
        self.raised_m[self.len] = raised_m;
        self.len += 1;
    }

    /// Whether the last vertex lies clearly below the straight line from the one before it to a new one.
    fn hides_last(&self, distance_m: f64, seen: f64) -> bool {
        let (before, last) = (self.len - 2, self.len - 1);
        let span_m = distance_m - self.distance_m[before];
        let part_m = self.distance_m[last] - self.distance_m[before];
        let below = (self.seen[before] - self.seen[last]) * span_m + (seen - self.seen[before]) * part_m;
        below > KEPT * self.steepest * span_m
    }

    /// The greatest loft that any vertex requires of an arc to a landing at a distance `run_m` from the take-off; minus
    /// infinity without vertices.
    pub(super) fn clearing_loft(&mut self, landing: ChainPoint, run_m: f64) -> f64 {
        for spare in self.len..(self.len + PADDING).min(self.x_m.len()) {
            // Requires no loft, for any landing.
            self.seen[spare] = f64::NEG_INFINITY;
            self.x_m[spare] = self.x_m[0];
            self.z_m[spare] = self.z_m[0];
        }
        if self.len <= SCANNED {
            return self.greatest(0, self.len, landing);
        }
        self.tangent(landing, run_m)
    }

    /// The greatest loft over part of the hull (and at most `PADDING` vertices more).
    #[inline]
    fn greatest(&self, first: usize, end: usize, landing: ChainPoint) -> f64 {
        let end = first + (end - first).next_multiple_of(PADDING);
        let (x_m, z_m) = (&self.x_m[first..end], &self.z_m[first..end]);
        let (seen, raised_m) = (&self.seen[first..end], &self.raised_m[first..end]);
        let mut best = [f64::NEG_INFINITY; PADDING];
        let points = x_m.chunks_exact(PADDING).zip(z_m.chunks_exact(PADDING));
        let heights = seen.chunks_exact(PADDING).zip(raised_m.chunks_exact(PADDING));
        for ((x_m, z_m), (seen, raised_m)) in points.zip(heights) {
            for i in 0..PADDING {
                let loft = seen[i] - ((landing.z_m - z_m[i]) - raised_m[i]) / (landing.x_m - x_m[i]).abs();
                best[i] = if loft > best[i] { loft } else { best[i] };
            }
        }
        best[0].max(best[1]).max(best[2].max(best[3]))
    }

    /// The loft that one vertex of the hull requires.
    fn loft(&self, i: usize, landing: ChainPoint) -> f64 {
        self.seen[i] - ((landing.z_m - self.z_m[i]) - self.raised_m[i]) / (landing.x_m - self.x_m[i]).abs()
    }

    /// The upper tangent of a long hull: bisection, since the lofts rise and then fall along it, then an evaluation of all
    /// vertices around the result whose lofts are equal within rounding.
    fn tangent(&self, landing: ChainPoint, run_m: f64) -> f64 {
        let (mut low, mut high) = (0, self.len - 1);
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.loft(middle, landing) < self.loft(middle + 1, landing) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        let (mut first, mut end) = (low.saturating_sub(SCANNED / 4), (low + SCANNED / 4).min(self.len));
        let mut best = self.greatest(first, end, landing);
        // The possible rounding error of a vertex's loft.
        let blur = |i: usize| KEPT * self.steepest * run_m / (landing.x_m - self.x_m[i]).abs();
        let peak = blur(low);
        while first > 0 && self.loft(first, landing) + blur(first) + peak >= best {
            let next = first.saturating_sub(SCANNED / 2);
            best = best.max(self.greatest(next, first, landing));
            first = next;
        }
        while end < self.len && self.loft(end - 1, landing) + blur(end - 1) + peak >= best {
            let next = (end + SCANNED / 2).min(self.len);
            best = best.max(self.greatest(end, next, landing));
            end = next;
        }
        best
    }
}
