//! Local bounds on the length of a hop, and the lower bound on the number of hops to a goal that follows.

use std::collections::VecDeque;

use crate::{
    chain::{Site, Station},
    hop::HopTest,
    quantity::ChainPoint,
};

/// A bound, for each segment, on the length of every hop that begins, ends or passes over it.
///
/// The bound is the parabola of safety with the relief that such a hop can meet: the relief within the bound on either side.
/// The relief of the whole chain gives a first bound, the relief within that a second one, and so on; on a long chain a few
/// rounds halve the bound.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LocalReach {
    /// By segment, m.
    reach_m: Vec<f64>,
    /// For each vertex, a potential: each segment adds its length divided by the bound on all hops that touch it. A hop in
    /// either direction therefore changes the potential by at most 1.
    potential: Vec<f64>,
    first_m: Vec<f64>,
}

impl LocalReach {
    /// More rounds no longer improve the bound.
    const ROUNDS: usize = 5;
    /// A safety factor on the bound: far more than the rounding error of sums of it, without noticeable loss.
    const SLACK: f64 = 1.0 + 1e-6;

    /// The bounds for a chain and a hopper.
    ///
    /// # Complexity
    /// Linear in the vertices.
    pub(super) fn of(test: &HopTest) -> Self {
        let vertices = test.chain().geometry().vertices();
        let mut within_m = test.greatest_reach_m();
        let mut reach_m = vec![within_m; vertices.len() - 1];
        for _ in 0..Self::ROUNDS {
            for (reach_m, relief_m) in reach_m.iter_mut().zip(reliefs_m(vertices, within_m)) {
                *reach_m = test.reach_over_relief_m(relief_m);
            }
            let greatest_m = reach_m.iter().copied().fold(0.0, f64::max);
            let done = greatest_m > 0.95 * within_m;
            within_m = greatest_m;
            if done {
                break;
            }
        }
        let mut potential = Vec::with_capacity(vertices.len());
        let mut sum = 0.0;
        potential.push(sum);
        for (pair, reach_m) in vertices.windows(2).zip(&mut reach_m) {
            *reach_m = (*reach_m * Self::SLACK).max(f64::MIN_POSITIVE);
            sum += (pair[1].x_m - pair[0].x_m) / *reach_m;
            potential.push(sum);
        }
        Self { reach_m, potential, first_m: vertices.iter().map(|v| v.x_m).collect() }
    }

    /// The bound at a station, m.
    pub(super) fn at_m(&self, station: &Station) -> f64 {
        let of = |segment: usize| self.reach_m.get(segment).copied().unwrap_or(0.0);
        match station.site {
            Site::Inside(segment) => of(segment.index()),
            Site::Vertex(vertex) => of(vertex.index()).max(vertex.index().checked_sub(1).map_or(0.0, of)),
        }
    }

    /// The potential at a station.
    fn potential_at(&self, station: &Station) -> f64 {
        match station.site {
            Site::Vertex(vertex) => self.potential[vertex.index()],
            Site::Inside(segment) => {
                let i = segment.index();
                self.potential[i] + (station.point.x_m - self.first_m[i]) / self.reach_m[i]
            }
        }
    }
}

/// A lower bound on the number of hops from any station to the goals of one search.
#[derive(Clone, Copy, Debug)]
pub(super) struct HopsLeft<'r> {
    reach: &'r LocalReach,
    /// The least and greatest potential of all goals; `None` without goals.
    goals: Option<(f64, f64)>,
}

impl<'r> HopsLeft<'r> {
    /// The bound for a set of goals.
    pub(super) fn to(reach: &'r LocalReach, goals: &[Station]) -> Self {
        let potentials = goals.iter().map(|goal| reach.potential_at(goal));
        let span =
            potentials.fold(None, |span, p| span.map_or(Some((p, p)), |(low, high): (f64, f64)| Some((low.min(p), high.max(p)))));
        Self { reach, goals: span.filter(|(low, high)| low.is_finite() && high.is_finite()) }
    }

    /// The bound on hops from a station to the nearest of the goals; 0 between them, without goals, and without finite bounds.
    ///
    /// Along an edge of n hops the potential changes by less than n, so the bound never falls by more than n: it is
    /// consistent, and A* settles each node once.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates: a bound of 2^64 hops is as good as more"
    )]
    pub(super) fn from(&self, station: &Station) -> u64 {
        let Some((low, high)) = self.goals else { return 0 };
        let here = self.reach.potential_at(station);
        (low - here).max(here - high).max(0.0).ceil() as u64
    }
}

/// For each segment, the relief of its ends and of all vertices up to a distance away, including the first vertex beyond.
fn reliefs_m(vertices: &[ChainPoint], distance_m: f64) -> impl Iterator<Item = f64> {
    let mut highest = Extreme::new(|a, b| a >= b);
    let mut lowest = Extreme::new(|a, b| a <= b);
    let (mut first, mut end) = (0, 0);
    vertices.windows(2).map(move |pair| {
        while end < vertices.len() && (end == 0 || vertices[end - 1].x_m < pair[1].x_m + distance_m) {
            highest.enter(end, vertices[end].z_m);
            lowest.enter(end, vertices[end].z_m);
            end += 1;
        }
        while first + 1 < end && vertices[first + 1].x_m <= pair[0].x_m - distance_m {
            first += 1;
        }
        highest.of(first) - lowest.of(first)
    })
}

/// The extreme of a window that moves to the right: values that a later one dominates are discarded.
struct Extreme<F> {
    outdoes: F,
    waiting: VecDeque<(usize, f64)>,
}

impl<F: Fn(f64, f64) -> bool> Extreme<F> {
    const fn new(outdoes: F) -> Self {
        Self { outdoes, waiting: VecDeque::new() }
    }

    fn enter(&mut self, at: usize, value: f64) {
        while self.waiting.back().is_some_and(|(_, last)| (self.outdoes)(value, *last)) {
            self.waiting.pop_back();
        }
        self.waiting.push_back((at, value));
    }

    /// The extreme from an index on; the index never decreases.
    fn of(&mut self, first: usize) -> f64 {
        while self.waiting.front().is_some_and(|(at, _)| *at < first) {
            self.waiting.pop_front();
        }
        self.waiting.front().map_or(0.0, |(_, value)| *value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ballistics::TakeoffChoice,
        chain::{ConstrainedChain, PolygonalChain},
        graph::{Effort, HopGraph, NodeSet, PointSpacing},
        hop::Split,
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    /// A plain, a canyon and a hill, with short and long segments; landings may be fast, so that the relief bounds a hop.
    fn chain(hopper: &Hopper) -> ConstrainedChain {
        let height = |i: i32| match i {
            20..=24 => -6.0 - f64::from(i % 2),
            35..=40 => f64::from(i - 34) * 0.8,
            41..=50 => 4.8,
            _ => 0.2 * f64::from(i % 3),
        };
        let points = (0..60).map(|i| ChainPoint::new(f64::from(i) * if i > 50 { 2.0 } else { 1.0 }, height(i))).collect();
        let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.9).unwrap())), rest: RestSlope::Unlimited };
        ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), hopper, Gravity::new(3.711).unwrap(), &surface).unwrap()
    }

    #[test]
    fn no_edge_exceeds_the_bound_along_it_or_the_potential_of_its_hops() {
        let hopper = Hopper::with_speeds(5.0, 25.0).unwrap();
        let chain = chain(&hopper);
        let test = HopTest::new(chain.clone());
        let nodes = NodeSet::of_chain(&chain, PointSpacing::PerSegment(2)).unwrap();
        let graph = HopGraph::new(&test, &nodes, Effort::Time, TakeoffChoice::LeastSpeed, Split::FullReach);
        let reach = LocalReach::of(&test);
        let stations = nodes.stations();
        let (mut edges, mut greatest_share) = (0, 0.0f64);
        for (i, takeoff) in stations.iter().enumerate() {
            for (j, landing) in stations.iter().enumerate().filter(|(j, _)| *j != i) {
                let Ok(edge) = graph.edge(takeoff, landing) else { continue };
                let run_m = (landing.point.x_m - takeoff.point.x_m).abs();
                let gained = (reach.potential_at(landing) - reach.potential_at(takeoff)).abs();
                if edge.hops() == 1 {
                    assert!(stations[i.min(j)..=i.max(j)].iter().all(|over| reach.at_m(over) >= run_m), "from {i} to {j}");
                    greatest_share = greatest_share.max(gained);
                }
                assert!(gained < f64::from(u32::try_from(edge.hops()).unwrap()), "from {i} to {j}: {gained}");
                let goal = HopsLeft::to(&reach, &[stations[90]]);
                assert!(goal.from(takeoff) <= edge.hops() + goal.from(landing), "the bound falls by more than the edge's hops");
                edges += 1;
            }
        }
        assert!(edges > 1000 && greatest_share > 0.5, "{edges} edges, greatest share of the bound {greatest_share}");
        assert!(
            reach.reach_m.iter().copied().fold(f64::INFINITY, f64::min) < test.greatest_reach_m(),
            "the bound is smaller on flat ground than for the whole chain"
        );
    }

    #[test]
    fn reliefs_equal_those_of_each_window_evaluated_separately() {
        let heights = [0.0, 3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, 6.0, 5.0, 3.0, 5.0];
        let vertices: Vec<ChainPoint> = (0i32..).zip(heights).map(|(x, z)| ChainPoint::new(f64::from(x * x), z)).collect();
        for distance_m in [0.0, 0.5, 3.0, 7.0, 20.0, 1e3] {
            let found: Vec<f64> = reliefs_m(&vertices, distance_m).collect();
            for (i, found) in found.into_iter().enumerate() {
                let (low, high) = (vertices[i].x_m - distance_m, vertices[i + 1].x_m + distance_m);
                let first = vertices.iter().rposition(|v| v.x_m <= low).unwrap_or(0);
                let last = vertices.iter().position(|v| v.x_m >= high).unwrap_or(vertices.len() - 1);
                let z = || vertices[first..=last].iter().map(|v| v.z_m);
                assert_eq!(found, z().fold(f64::MIN, f64::max) - z().fold(f64::MAX, f64::min), "segment {i} within {distance_m} m");
            }
        }
    }
}
