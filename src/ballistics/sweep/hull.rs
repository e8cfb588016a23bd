//! The upper hull of the ground in slope space, as one take-off sees it.
//!
//! ```text
//!   s                 divided by the distance d, the arc is a straight line s = m - c d, and the ground the points
//!   |  o               (d_p, s_p), s_p = (z_p + eps - z_t) / d_p;
//!   |    \  o          the arc that just clears them and lands at (X, b) is the upper tangent from there:
//!   |  o   `--o        its loft is the greatest s_p - t_p, and a point below the hull never is the greatest.
//!   |   o    o  `\
//!   +--------------x--- d
//!                (X, b)
//! ```

use crate::quantity::ChainPoint;

/// The vertices on the upper hull, nearest first: a monotone chain, each vertex pushed once, in the order of distance.
///
/// A vertex leaves only where it is below the hull by more than rounding can tell, so that the greatest `s - t` over the hull is the
/// greatest over all vertices, to the last bit.
#[derive(Clone, Debug, Default)]
pub(super) struct Hull {
    /// Columns of equal length, at least that of the hull.
    x_m: Vec<f64>,
    z_m: Vec<f64>,
    distance_m: Vec<f64>,
    seen: Vec<f64>,
    len: usize,
    /// No vertex was seen, and no landing, at a steeper slope than this: rounding goes with it.
    steepest: f64,
}

/// A vertex in slope space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// From the take-off.
    pub(super) distance_m: f64,
    /// Slope at which the take-off sees it, with the clearance.
    pub(super) slope: f64,
}

/// How many vertices the tangent's inner loop takes at once: as many as a register of any x86-64 holds.
const ABREAST: usize = 2;

/// Up to so many vertices, looking at all is quicker than choosing.
const SCANNED: usize = 32;

/// A vertex is kept unless it is this far below the hull, times the steepest slope: 512 roundings, of which a tangent commits some 32.
const KEPT: f64 = 256.0 * f64::EPSILON;

impl Hull {
    /// Forgets all vertices; keeps its memory. Slopes up to `steepest` will be told apart rightly.
    pub(super) fn clear(&mut self, steepest: f64) {
        self.len = 0;
        self.steepest = steepest;
    }

    /// The greatest slope that this hull was made for.
    pub(super) const fn steepest(&self) -> f64 {
        self.steepest
    }

    /// Adds a vertex beyond those before.
    pub(super) fn push(&mut self, point: ChainPoint, seen: Seen) {
        while self.len >= 2 && self.hides([self.seen_at(self.len - 2), self.seen_at(self.len - 1), seen]) {
            self.len -= 1;
        }
        if self.len == self.x_m.len() {
            let room = (2 * self.len).max(SCANNED);
            for column in [&mut self.x_m, &mut self.z_m, &mut self.distance_m, &mut self.seen] {
                column.resize(room, 0.0);
            }
        }
        self.x_m[self.len] = point.x_m;
        self.z_m[self.len] = point.z_m;
        self.distance_m[self.len] = seen.distance_m;
        self.seen[self.len] = seen.slope;
        self.len += 1;
    }

    /// A vertex of the hull as the take-off sees it.
    fn seen_at(&self, i: usize) -> Seen {
        Seen { distance_m: self.distance_m[i], slope: self.seen[i] }
    }

    /// Whether a vertex lies clearly below the straight line from one before it to one beyond it: whatever the landing, one of these asks
    /// for more.
    #[inline]
    pub(super) fn hides(&self, [before, vertex, beyond]: [Seen; 3]) -> bool {
        let span_m = beyond.distance_m - before.distance_m;
        let part_m = vertex.distance_m - before.distance_m;
        let below = (before.slope - vertex.slope) * span_m + (beyond.slope - before.slope) * part_m;
        below > KEPT * self.steepest * span_m
    }

    /// The greatest loft that any vertex asks of an arc to a landing, run `run_m` from the take-off; minus infinity for no vertex.
    pub(super) fn clearing_loft(&self, landing: ChainPoint, run_m: f64, clearance_m: f64) -> f64 {
        if self.len <= SCANNED {
            return self.greatest(0, self.len, landing, clearance_m);
        }
        self.tangent(landing, run_m, clearance_m)
    }

    /// The greatest loft over a stretch of the hull.
    #[inline]
    fn greatest(&self, first: usize, end: usize, landing: ChainPoint, clearance_m: f64) -> f64 {
        let (x_m, z_m, seen) = (&self.x_m[first..end], &self.z_m[first..end], &self.seen[first..end]);
        let (x_m, x_left) = x_m.as_chunks::<ABREAST>();
        let (z_m, z_left) = z_m.as_chunks::<ABREAST>();
        let (seen, seen_left) = seen.as_chunks::<ABREAST>();
        let mut best = [f64::NEG_INFINITY; ABREAST];
        for ((x_m, z_m), seen) in x_m.iter().zip(z_m).zip(seen) {
            for i in 0..ABREAST {
                let loft = seen[i] - ((landing.z_m - z_m[i]) - clearance_m) / (landing.x_m - x_m[i]).abs();
                best[i] = if loft > best[i] { loft } else { best[i] };
            }
        }
        let mut greatest = best[0].max(best[1]);
        for ((x_m, z_m), seen) in x_left.iter().zip(z_left).zip(seen_left) {
            greatest = greatest.max(seen - ((landing.z_m - z_m) - clearance_m) / (landing.x_m - x_m).abs());
        }
        greatest
    }

    /// The loft that one vertex of the hull asks for.
    fn loft(&self, i: usize, landing: ChainPoint, clearance_m: f64) -> f64 {
        self.seen[i] - ((landing.z_m - self.z_m[i]) - clearance_m) / (landing.x_m - self.x_m[i]).abs()
    }

    /// The upper tangent of a long hull: by bisection, since the lofts rise and then fall along it, then by looking at all vertices
    /// about the place found whose lofts rounding cannot tell apart.
    fn tangent(&self, landing: ChainPoint, run_m: f64, clearance_m: f64) -> f64 {
        let (mut low, mut high) = (0, self.len - 1);
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.loft(middle, landing, clearance_m) < self.loft(middle + 1, landing, clearance_m) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        let (mut first, mut end) = (low.saturating_sub(SCANNED / 4), (low + SCANNED / 4).min(self.len));
        let mut best = self.greatest(first, end, landing, clearance_m);
        // What rounding may have done to a vertex's loft.
        let blur = |i: usize| KEPT * self.steepest * run_m / (landing.x_m - self.x_m[i]).abs();
        let peak = blur(low);
        while first > 0 && self.loft(first, landing, clearance_m) + blur(first) + peak >= best {
            let next = first.saturating_sub(SCANNED / 2);
            best = best.max(self.greatest(next, first, landing, clearance_m));
            first = next;
        }
        while end < self.len && self.loft(end - 1, landing, clearance_m) + blur(end - 1) + peak >= best {
            let next = (end + SCANNED / 2).min(self.len);
            best = best.max(self.greatest(end, next, landing, clearance_m));
            end = next;
        }
        best
    }
}
