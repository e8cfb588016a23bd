//! The terrain limit of one take-off, for landings that move outwards.

use super::{
    hull::{Hull, Seen},
    support::Support,
};
use crate::{
    chain::{Direction, PolygonalChain, Site, Station},
    quantity::ChainPoint,
};

/// The ground that one take-off flies over, followed outwards.
#[derive(Clone, Debug)]
pub(super) struct Overflight<'a> {
    chain: &'a PolygonalChain,
    clearance_m: f64,
    takeoff: ChainPoint,
    direction: Direction,
    /// The first vertex flown past.
    first: usize,
    /// The vertices flown past, nearest first: how far from the take-off.
    distance_m: Vec<f64>,
    /// The slopes at which the take-off sees them, with the clearance.
    seen: Vec<f64>,
    /// The steepest of these slopes without regard to sign or to what cancels: rounding goes with it.
    steepest_seen: f64,
    /// Spares most landings the hull.
    support: Support,
    /// Up to this run the support's nodes stay where they are.
    laid_until_m: f64,
    /// What rounding may do to the support.
    blur: f64,
    /// How many vertices the hull covers.
    hulled: usize,
    hull: Hull,
}

/// One landing that all limits but the terrain allow.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenLanding {
    /// Its distance from the take-off.
    pub(super) run_m: f64,
    /// Slope of the line of sight.
    pub(super) sight_slope: f64,
    /// The least loft that the other limits allow, over the run.
    pub(super) fall: f64,
    /// The take-off slope of that loft, less the share of the roundings that goes with it.
    pub(super) slope: f64,
    /// The greatest `lower` of the landings about this one.
    pub(super) greatest_lower: f64,
}

/// More than all roundings of the bound that spares the hull, relative to its terms.
pub(super) const SLACK: f64 = 1e-12;

impl<'a> Overflight<'a> {
    pub(super) fn new(chain: &'a PolygonalChain, clearance_m: f64) -> Self {
        Self {
            chain,
            clearance_m,
            takeoff: ChainPoint::new(0.0, 0.0),
            direction: Direction::Forward,
            first: 0,
            distance_m: Vec::new(),
            seen: Vec::new(),
            steepest_seen: 0.0,
            support: Support::new(),
            laid_until_m: 0.0,
            blur: 0.0,
            hulled: 0,
            hull: Hull::default(),
        }
    }

    /// Begins at a take-off.
    pub(super) fn begin(&mut self, takeoff: &Station, direction: Direction) {
        self.takeoff = takeoff.point;
        self.direction = direction;
        self.first = match (takeoff.site, direction) {
            (Site::Vertex(vertex), Direction::Forward) => vertex.index() + 1,
            // At the chain's first vertex nothing lies behind, and nothing is asked.
            (Site::Vertex(vertex), Direction::Reverse) => vertex.index().saturating_sub(1),
            (Site::Inside(segment), Direction::Forward) => segment.index() + 1,
            (Site::Inside(segment), Direction::Reverse) => segment.index(),
        };
        self.distance_m.clear();
        self.seen.clear();
        self.steepest_seen = 0.0;
        self.laid_until_m = 0.0;
        self.hulled = 0;
        self.hull.clear(0.0);
    }

    /// How many vertices lie strictly between the take-off and a landing.
    #[inline]
    fn flown_past(&self, landing: &Station) -> usize {
        match (landing.site, self.direction) {
            (Site::Vertex(vertex), Direction::Forward) => vertex.index().saturating_sub(self.first),
            (Site::Inside(segment), Direction::Forward) => (segment.index() + 1).saturating_sub(self.first),
            (Site::Vertex(vertex), Direction::Reverse) => self.first.saturating_sub(vertex.index()),
            (Site::Inside(segment), Direction::Reverse) => self.first.saturating_sub(segment.index()),
        }
    }

    /// A vertex flown past, counted from the take-off.
    #[inline]
    fn vertex(&self, count: usize) -> ChainPoint {
        match self.direction {
            Direction::Forward => self.chain.vertices()[self.first + count],
            Direction::Reverse => self.chain.vertices()[self.first - count],
        }
    }

    /// Looks at all vertices before a landing, the farthest of those asked for next.
    pub(super) fn look_as_far_as(&mut self, landing: &Station) {
        let (looked, count) = (self.seen.len(), self.flown_past(landing));
        if count <= looked {
            return;
        }
        let vertices = self.chain.vertices();
        match self.direction {
            Direction::Forward => self.look_at(vertices[self.first + looked..self.first + count].iter()),
            Direction::Reverse => self.look_at(vertices[self.first + 1 - count..=self.first - looked].iter().rev()),
        }
        // Where dz and clearance cancel, rounding goes with the clearance, which weighs most at the nearest vertex.
        let clearance = 3.0 * self.clearance_m / self.distance_m[0];
        let steepest =
            self.seen[looked..].iter().fold(0.0, |steepest: f64, seen| if seen.abs() > steepest { seen.abs() } else { steepest });
        self.steepest_seen = self.steepest_seen.max(steepest + clearance);
        self.note_blur();
    }

    /// Notes distances and slopes: the terms of [`clearing_loft`](crate::ballistics::limits::clearing_loft).
    #[inline]
    fn look_at<'p>(&mut self, points: impl ExactSizeIterator<Item = &'p ChainPoint> + Clone) {
        let (takeoff, clearance_m) = (self.takeoff, self.clearance_m);
        self.distance_m.extend(points.clone().map(|point| (point.x_m - takeoff.x_m).abs()));
        self.seen.extend(points.map(|point| ((point.z_m - takeoff.z_m) + clearance_m) / (point.x_m - takeoff.x_m).abs()));
    }

    /// The support's roundings go with the slopes seen and the falls at its nodes.
    fn note_blur(&mut self) {
        self.blur = SLACK * (self.steepest_seen + self.support.greatest() * self.laid_until_m);
    }

    /// The greatest loft that the vertices between the take-off and a landing ask for; `None` where it surely is no more than that of the
    /// other limits.
    ///
    /// Landings have to be asked for in the order of distance, after a look as far as them.
    #[inline]
    pub(super) fn asked(&mut self, landing: &Station, open: &OpenLanding) -> Option<f64> {
        let count = self.flown_past(landing);
        if count == 0 || self.spares(count, open) { None } else { Some(self.by_hull(landing.point, count, open)) }
    }

    /// Whether the first `count` vertices surely ask for no more loft than the other limits.
    ///
    /// A vertex cleared with a margin in `s + c d <= b + n` asks for a loft less than n by that margin times X / (X - d), which is more
    /// than the roundings of that loft: these go with `|b|`, n and the slopes seen over the same (X - d) / X.
    #[inline]
    fn spares(&mut self, count: usize, open: &OpenLanding) -> bool {
        if open.run_m >= self.laid_until_m {
            // Runs double from one laying to the next, so that all of them together look at each vertex a few times.
            self.laid_until_m = 2.0 * open.run_m;
            self.support.lay(open.greatest_lower / open.run_m);
            self.note_blur();
        }
        if self.support.covered() < count {
            self.support.cover(count, &self.distance_m, &self.seen);
        }
        self.support.bound(open.fall) + self.blur < open.slope
    }

    /// A vertex flown past, counted from the take-off, as this one sees it.
    #[inline]
    fn seen_at(&self, i: usize) -> Seen {
        Seen { distance_m: self.distance_m[i], slope: self.seen[i] }
    }

    /// The greatest loft that the first `count` vertices ask for.
    fn by_hull(&mut self, landing: ChainPoint, count: usize, open: &OpenLanding) -> f64 {
        let steepest = self.steepest_seen.max(open.sight_slope.abs());
        if steepest > self.hull.steepest() {
            // Rounding grew beyond what the hull was made for: once more, for twice as much, so seldom.
            self.hull.clear(2.0 * steepest);
            self.hulled = 0;
        }
        while self.hulled < count {
            let i = self.hulled;
            if i == 0 || i + 1 >= count || !self.hull.hides([self.seen_at(i - 1), self.seen_at(i), self.seen_at(i + 1)]) {
                self.hull.push(self.vertex(i), self.seen_at(i));
            }
            self.hulled += 1;
        }
        self.hull.clearing_loft(landing, open.run_m, self.clearance_m)
    }
}
