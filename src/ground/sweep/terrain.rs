//! The terrain limit of one take-off, for landings in the order of distance.

use std::sync::Arc;

use super::hull::Hull;
use crate::{
    chain::{ConstrainedChain, PolygonalChain, Site, Station},
    quantity::ChainPoint,
    world::Direction,
};

/// The ground below hops from one take-off, extended as the landings move outwards.
#[derive(Clone, Debug)]
pub(super) struct Overflight {
    chain: Arc<ConstrainedChain>,
    clearance_m: f64,
    takeoff: ChainPoint,
    direction: Direction,
    /// The first vertex flown over.
    first: usize,
    /// Number of vertices that the bounds below cover.
    bounded: usize,
    /// The steepest slope from the take-off to a vertex flown over, including clearance.
    highest_seen: f64,
    /// The same from absolute values, without cancellation: the rounding error is proportional to it.
    steepest_seen: f64,
    /// The least slope of any segment between vertices flown over.
    lowest_slope: f64,
    /// Number of vertices that the hull covers.
    hulled: usize,
    hull: Hull,
}

/// A relative margin larger than all rounding errors of the bound that avoids the hull.
const SLACK: f64 = 1e-12;

impl Overflight {
    pub(super) fn new(chain: Arc<ConstrainedChain>) -> Self {
        Self {
            clearance_m: chain.hopper().limits().clearance_m,
            chain,
            takeoff: ChainPoint::new(0.0, 0.0),
            direction: Direction::Forward,
            first: 0,
            bounded: 0,
            highest_seen: f64::NEG_INFINITY,
            steepest_seen: 0.0,
            lowest_slope: f64::INFINITY,
            hulled: 0,
            hull: Hull::default(),
        }
    }

    /// Starts at a take-off.
    pub(super) fn begin(&mut self, takeoff: &Station, direction: Direction) {
        self.takeoff = takeoff.point;
        self.direction = direction;
        self.first = match (takeoff.site, direction) {
            (Site::Vertex(vertex), Direction::Forward) => vertex.index() + 1,
            // At the chain's first vertex there is nothing behind, and no landing to evaluate.
            (Site::Vertex(vertex), Direction::Reverse) => vertex.index().saturating_sub(1),
            (Site::Inside(segment), Direction::Forward) => segment.index() + 1,
            (Site::Inside(segment), Direction::Reverse) => segment.index(),
        };
        self.bounded = 0;
        self.highest_seen = f64::NEG_INFINITY;
        self.steepest_seen = 0.0;
        self.lowest_slope = f64::INFINITY;
        self.hulled = 0;
        self.hull.clear(0.0);
    }

    #[inline]
    fn geometry(&self) -> &PolygonalChain {
        self.chain.geometry()
    }

    /// The number of vertices strictly between the take-off and a landing.
    #[inline]
    fn flown_past(&self, landing: &Station) -> usize {
        match (landing.site, self.direction) {
            (Site::Vertex(vertex), Direction::Forward) => vertex.index().saturating_sub(self.first),
            (Site::Inside(segment), Direction::Forward) => (segment.index() + 1).saturating_sub(self.first),
            (Site::Vertex(vertex), Direction::Reverse) => self.first.saturating_sub(vertex.index()),
            (Site::Inside(segment), Direction::Reverse) => self.first.saturating_sub(segment.index()),
        }
    }

    /// A vertex flown over, counted from the take-off.
    #[inline]
    fn vertex(&self, count: usize) -> ChainPoint {
        match self.direction {
            Direction::Forward => self.geometry().vertices()[self.first + count],
            Direction::Reverse => self.geometry().vertices()[self.first - count],
        }
    }

    /// The slope, along the direction of travel, of the segment that ends at a vertex flown over (not the first).
    #[inline]
    fn slope_before(&self, count: usize) -> f64 {
        match self.direction {
            Direction::Forward => self.geometry().slopes()[self.first + count - 1],
            Direction::Reverse => -self.geometry().slopes()[self.first - count],
        }
    }

    /// The slope from the take-off to a vertex (including clearance), and its distance: the terms of
    /// [`clearing_loft`](crate::ballistics::limits::clearing_loft).
    #[inline]
    fn seen(&self, point: ChainPoint) -> (f64, f64) {
        let distance_m = (point.x_m - self.takeoff.x_m).abs();
        (distance_m, ((point.z_m - self.takeoff.z_m) + self.clearance_m) / distance_m)
    }

    /// The least loft, not below `lower`, that clears every vertex between the take-off and a landing at the slope
    /// `sight_slope` from it.
    ///
    /// Landings have to be passed in the order of distance.
    #[inline]
    pub(super) fn lower_end(&mut self, landing: &Station, sight_slope: f64, lower: f64) -> f64 {
        let count = self.flown_past(landing);
        if count == 0 || self.bound(landing.point, count) < lower {
            return lower;
        }
        self.by_hull(landing.point, count, sight_slope).max(lower)
    }

    /// An upper bound on the loft that the first `count` vertices require.
    ///
    /// ```text
    ///     s_p - t_p <= max s - min t,   t_p >= min(min slope - eps / gap, t_last)
    /// ```
    ///
    /// since the slope from any vertex to the last is a mean of segment slopes, and the clearance changes `t_p` most over the
    /// gap from the last vertex to the landing.
    #[inline]
    fn bound(&mut self, landing: ChainPoint, count: usize) -> f64 {
        while self.bounded < count {
            let point = self.vertex(self.bounded);
            let (distance_m, seen) = self.seen(point);
            self.highest_seen = self.highest_seen.max(seen);
            self.steepest_seen = self.steepest_seen.max(seen.abs() + 2.0 * self.clearance_m / distance_m);
            if self.bounded > 0 {
                self.lowest_slope = self.lowest_slope.min(self.slope_before(self.bounded));
            }
            self.bounded += 1;
        }
        let last = self.vertex(count - 1);
        let per_gap = 1.0 / (landing.x_m - last.x_m).abs();
        let clearance = self.clearance_m * per_gap;
        let ahead = ((landing.z_m - last.z_m) - self.clearance_m) * per_gap;
        let lowest = if self.lowest_slope - clearance < ahead { self.lowest_slope - clearance } else { ahead };
        // The size of every term; the highest slope may itself have suffered cancellation.
        let terms = self.steepest_seen + self.lowest_slope.abs().min(f64::MAX) + clearance + ahead.abs();
        self.highest_seen - lowest + SLACK * terms
    }

    /// The greatest loft that the first `count` vertices require.
    fn by_hull(&mut self, landing: ChainPoint, count: usize, sight_slope: f64) -> f64 {
        let steepest = self.steepest_seen.max(sight_slope.abs());
        if steepest > self.hull.steepest() {
            // Rounding exceeds what the hull was made for: rebuild it for twice as much, so that this happens rarely.
            self.hull.clear(2.0 * steepest);
            self.hulled = 0;
        }
        while self.hulled < count {
            let point = self.vertex(self.hulled);
            let (distance_m, seen) = self.seen(point);
            self.hull.push(point, distance_m, seen);
            self.hulled += 1;
        }
        self.hull.clearing_loft(landing, (landing.x_m - self.takeoff.x_m).abs(), self.clearance_m)
    }
}
