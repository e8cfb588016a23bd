//! The terrain limit of one take-off, for landings in the order of distance.

use super::{
    hull::{Hull, Seen},
    near::NearGround,
};
use crate::{
    ballistics::limits::{ClearanceProfile, clearing_loft},
    chain::{PolygonalChain, Site, Station},
    hop::{HopTest, first_ahead, ground_slope, slope_beyond},
    quantity::{ChainPoint, VertexId},
    world::Direction,
};

/// The ground below hops from one take-off, extended as the landings move outwards.
#[derive(Clone, Debug)]
pub(super) struct Overflight {
    test: HopTest,
    clearance: ClearanceProfile,
    from: Station,
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
    /// Number of vertices that the hull covers: of a tapered clearance, those where the landing does not reduce it.
    hulled: usize,
    hull: Hull,
    /// The first vertices at or beyond the middle of the hop, from the take-off and seen back from the landing.
    middles: [usize; 2],
    seen_at_ramp: f64,
}

/// A relative margin larger than all rounding errors of the bound that avoids the hull.
const SLACK: f64 = 1e-12;

/// The vertices next to the landing, where it reduces the clearance, which the hull does not cover.
#[derive(Clone, Copy, Debug)]
pub(super) enum Near<'t> {
    /// They ask for no more than the loft already required.
    Skipped,
    /// Those of them that may ask for the most.
    Front(&'t NearGround),
    /// All of them.
    Scanned,
}

/// The ground from the last vertex flown over to a landing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// Its slope along the direction of travel.
    slope: f64,
    /// The clearance at that vertex over its distance: `min(eps / gap, k)`.
    clearance: f64,
}

impl Approach {
    /// For a landing reached in a direction of travel; flat at the end of the chain, where no vertex is flown over before it.
    pub(super) fn to(test: &HopTest, landing: &Station, direction: Direction) -> Self {
        let back = if direction == Direction::Forward { Direction::Reverse } else { Direction::Forward };
        let last = test.chain().geometry().vertices().get(first_ahead(landing, back));
        let Some(last) = last.filter(|last| last.x_m != landing.point.x_m) else { return Self { slope: 0.0, clearance: 0.0 } };
        let per_gap = 1.0 / (landing.point.x_m - last.x_m).abs();
        let clearance = (test.clearance().height_m() * per_gap).min(test.clearance().taper());
        Self { slope: (landing.point.z_m - last.z_m) * per_gap, clearance }
    }
}

impl Overflight {
    pub(super) fn new(test: &HopTest) -> Self {
        let start = test.chain().geometry().vertex_station(VertexId(0));
        Self {
            test: test.clone(),
            clearance: test.clearance(),
            from: start,
            takeoff: start.point,
            direction: Direction::Forward,
            first: 0,
            bounded: 0,
            highest_seen: f64::NEG_INFINITY,
            steepest_seen: 0.0,
            lowest_slope: f64::INFINITY,
            hulled: 0,
            hull: Hull::default(),
            middles: [0; 2],
            seen_at_ramp: 0.0,
        }
    }

    /// The length of a hop from which the two kinks of a tapered clearance are apart, m; 0 without a taper.
    #[inline]
    pub(super) const fn two_ramps_m(&self) -> f64 {
        2.0 * self.clearance.ramp_m()
    }

    /// Starts at a take-off.
    pub(super) fn begin(&mut self, takeoff: &Station, direction: Direction) {
        self.from = *takeoff;
        self.takeoff = takeoff.point;
        self.direction = direction;
        // At the chain's first vertex there is nothing behind, and no landing to evaluate.
        self.first = first_ahead(takeoff, direction);
        self.bounded = 0;
        self.highest_seen = f64::NEG_INFINITY;
        self.steepest_seen = 0.0;
        self.lowest_slope = f64::INFINITY;
        self.hulled = 0;
        self.hull.clear(0.0);
        self.middles = [self.first; 2];
        if self.clearance.has_kinks() {
            self.seen_at_ramp = ground_slope(self.geometry(), takeoff, direction, self.clearance.ramp_m());
        }
    }

    /// The slope from the take-off to the ground one ramp of a tapered clearance away.
    #[inline]
    pub(super) const fn seen_at_ramp(&self) -> f64 {
        self.seen_at_ramp
    }

    /// The loft that both kinks of a hop longer than two ramps require; `seen_back` is the slope back from the landing to the ground
    /// one ramp before it.
    #[inline]
    pub(super) fn kinks_loft(&self, seen_back: f64, run_m: f64, sight_slope: f64) -> f64 {
        let (from, to) = (self.seen_at_ramp - sight_slope, sight_slope + seen_back);
        self.clearance.kink_loft(if to > from { to } else { from }, run_m)
    }

    #[inline]
    fn geometry(&self) -> &PolygonalChain {
        self.test.chain().geometry()
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

    /// A vertex from the take-off, with the clearance that it has far from the landing: the terms of [`clearing_loft`].
    #[inline]
    fn seen(&self, point: ChainPoint) -> Seen {
        let distance_m = (point.x_m - self.takeoff.x_m).abs();
        let raised_m = self.clearance.near_m(distance_m);
        Seen { distance_m, raised_m, slope: ((point.z_m - self.takeoff.z_m) + raised_m) / distance_m }
    }

    /// The loft that the only kink of a hop not longer than two ramps requires: at its middle.
    ///
    /// Landings have to be passed in the order of distance.
    #[inline(never)]
    pub(super) fn middle_loft(&mut self, landing: &Station, run_m: f64, sight_slope: f64) -> f64 {
        let half_m = self.clearance.kink_m(run_m);
        let (geometry, towards) = (self.test.chain().geometry(), self.direction);
        let vertices = geometry.vertices();
        let [mut ahead, mut back] = self.middles;
        let backwards = if towards == Direction::Forward { Direction::Reverse } else { Direction::Forward };
        match towards {
            Direction::Forward => {
                while ahead + 1 < vertices.len() && vertices[ahead].x_m - self.takeoff.x_m < half_m {
                    ahead += 1;
                }
                // The last vertex at least half a hop before the landing; before the first one, the segment of the take-off.
                let first = first_ahead(landing, backwards);
                back = back.max(self.first) - 1;
                while back < first && landing.point.x_m - vertices[back + 1].x_m >= half_m {
                    back += 1;
                }
            }
            Direction::Reverse => {
                while ahead > 0 && self.takeoff.x_m - vertices[ahead].x_m < half_m {
                    ahead -= 1;
                }
                let first = first_ahead(landing, backwards);
                back = (back + 1).min(vertices.len() - 1);
                while back > first && vertices[back - 1].x_m - landing.point.x_m >= half_m {
                    back -= 1;
                }
            }
        }
        self.middles = [ahead, if towards == Direction::Forward { back + 1 } else { back - 1 }];
        let seen = slope_beyond(geometry, &self.from, towards, (self.first, ahead), half_m);
        let seen_back = slope_beyond(geometry, landing, backwards, (first_ahead(landing, backwards), back), half_m);
        let (from, to) = (seen - sight_slope, sight_slope + seen_back);
        self.clearance.kink_loft(if to > from { to } else { from }, run_m)
    }

    /// The least loft, not below `lower`, that clears every vertex between the take-off and a landing at the slope
    /// `sight_slope` from it.
    ///
    /// Landings have to be passed in the order of distance.
    #[inline]
    pub(super) fn lower_end<const TAPERED: bool>(
        &mut self,
        landing: &Station,
        approach: Approach,
        sight_slope: f64,
        lower: f64,
        near: Near<'_>,
    ) -> f64 {
        let count = self.flown_past(landing);
        if count == 0 || self.bound::<TAPERED>(approach, count) < lower {
            return lower;
        }
        self.by_hull(landing.point, (count, lower), sight_slope, near).max(lower)
    }

    /// An upper bound on the loft that the first `count` vertices require.
    ///
    /// ```text
    ///     s_p - t_p <= max s - min t,   t_p >= min(min slope, t_last) - min(eps / gap, k)
    /// ```
    ///
    /// with the clearance `min(eps, k d)` in `s`, and without one in `t_last`: the slope from any vertex to the last is a mean of
    /// segment slopes, and the clearance changes `t_p` most over the gap from the last vertex to the landing.
    #[inline]
    fn bound<const TAPERED: bool>(&mut self, approach: Approach, count: usize) -> f64 {
        while self.bounded < count {
            let point = self.vertex(self.bounded);
            let Seen { distance_m, raised_m, slope } = self.seen(point);
            self.highest_seen = self.highest_seen.max(slope);
            let raised = if TAPERED { self.clearance.taper() } else { raised_m / distance_m };
            self.steepest_seen = self.steepest_seen.max(slope.abs() + 2.0 * raised);
            if self.bounded > 0 {
                self.lowest_slope = self.lowest_slope.min(self.slope_before(self.bounded));
            }
            self.bounded += 1;
        }
        let Approach { slope, clearance } = approach;
        let lowest = if self.lowest_slope < slope { self.lowest_slope } else { slope } - clearance;
        // The size of every term; the highest slope may itself have suffered cancellation.
        let terms = self.steepest_seen + self.lowest_slope.abs().min(f64::MAX) + clearance + slope.abs();
        self.highest_seen - lowest + SLACK * terms
    }

    /// The greatest loft that the first `count` vertices require, or less than `lower`.
    #[inline(never)]
    fn by_hull(&mut self, landing: ChainPoint, (count, lower): (usize, f64), sight_slope: f64, near: Near<'_>) -> f64 {
        let steepest = self.steepest_seen.max(sight_slope.abs());
        if steepest > self.hull.steepest() {
            // Rounding exceeds what the hull was made for: rebuild it for twice as much, so that this happens rarely.
            self.hull.clear(2.0 * steepest);
            self.hulled = 0;
        }
        while self.hulled < count {
            let point = self.vertex(self.hulled);
            let seen = self.seen(point);
            if self.clearance.taper() * (landing.x_m - point.x_m).abs() < seen.raised_m {
                break;
            }
            self.hull.push(point, seen);
            self.hulled += 1;
        }
        let run_m = (landing.x_m - self.takeoff.x_m).abs();
        let greatest = self.hull.clearing_loft(landing, run_m);
        let loft = |point: ChainPoint| clearing_loft(self.takeoff, landing, point, self.clearance);
        match near {
            Near::Skipped => greatest,
            Near::Front(ground) if ground.is_whole() => {
                let vertices = self.geometry().vertices();
                let taper = (self.clearance.taper(), self.clearance.ramp_m());
                ground.greatest(greatest.max(lower), (run_m, sight_slope), taper, |vertex| loft(vertices[vertex]))
            }
            Near::Front(_) | Near::Scanned => (self.hulled..count).map(|i| loft(self.vertex(i))).fold(greatest, f64::max),
        }
    }
}
