//! The fewest hops from a start to a goal over nodes on a DEM, then the least effort, found towards the goal.
//!
//! A* with the bounds that no path can beat ([`PathBounds`]): consistent, so that the first label of the goal that is taken is the least.

use std::{
    cmp::Reverse,
    collections::{BinaryHeap, HashSet},
};

use super::{SurfaceNode, SurfaceNodes, TooManyNodes};
use crate::{
    ballistics::{Arc, LineOfSight, PathBounds, TakeoffChoice, safety_range_m},
    graph::{Cost, Effort},
    ground::{DemGround, MapPosition, Surface},
    hop::HopTest,
    progress::{Cancelled, Meter, Progress, Stage},
    quantity::{MapPoint, SlopeInterval, VertexId},
};

/// What a route is for: its ends, and what is minimised after the number of hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteGoal {
    /// Where it begins: a single place of the nodes.
    pub start: MapPoint,
    /// Where it ends: a single place of the nodes.
    pub goal: MapPoint,
    /// The second criterion, after the number of hops.
    pub effort: Effort,
    /// Which of the feasible take-off angles each hop has.
    pub takeoff: TakeoffChoice,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RouteError {
    /// More nodes than fit.
    #[error(transparent)]
    Nodes(#[from] TooManyNodes),
    /// A start or goal without ground.
    #[error("there is no ground at ({} m, {} m), expected a start and a goal with an elevation", .0.x, .0.y)]
    NoGround(MapPoint),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The result of a search, and its work.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeRoute {
    /// The places from start to goal, one hop from each to the next; `None` if the goal was not reached over these nodes.
    pub places: Option<Vec<MapPosition>>,
    /// Its hops and effort; those of no hops without a path.
    pub cost: Cost,
    /// Pairs of nodes whose hop was computed.
    pub pairs_tested: u64,
    /// Nodes reached, the start included.
    pub reached: usize,
    /// The reached place nearest to the goal, horizontally.
    pub nearest: MapPosition,
}

/// The best path to a node so far.
#[derive(Clone, Copy, Debug)]
struct Label {
    cost: Cost,
    from: u32,
}

/// The nodes, the hops between them, and what is minimised.
struct Search<'s> {
    ground: &'s DemGround,
    nodes: &'s SurfaceNodes,
    question: &'s RouteGoal,
    goal: MapPosition,
    bounds: PathBounds,
    gravity_m_s2: f64,
    takeoff_max_m_s: f64,
    /// Half of the sum of the squares of both greatest speeds over gravity: no hop is longer.
    span_max_m: f64,
    lowest_m: f64,
}

/// Finds the path of fewest hops from a start to a goal over nodes on a DEM, then of least effort.
///
/// The machine is taken to fly any command up to its greatest. Equal costs leave the path that was found first; the answer depends on the
/// question alone.
///
/// # Errors
/// [`RouteError`].
///
/// # Complexity
/// 32 bytes for each node ([`bytes`](FreeRoute::bytes)), and some 56 for each label waiting. Only nodes towards the goal are expanded; each
/// looks at all nodes within reach of one hop, and computes a hop where it may improve on what is known.
pub fn free_route(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    question: &RouteGoal,
    progress: &dyn Progress,
) -> Result<FreeRoute, RouteError> {
    let node = |at: MapPoint| {
        let node = nodes.place(at).ok_or(RouteError::NoGround(at))?;
        Ok::<_, RouteError>((node, nodes.position(ground, node).ok_or(RouteError::NoGround(at))?))
    };
    let (start, goal) = (node(question.start)?, node(question.goal)?);
    let meter = Meter::new(progress, Stage::Search);
    let search = Search::new(ground, nodes, question, goal.1);
    let mut refused = HashSet::new();
    let mut pairs_tested = 0;
    loop {
        let mut found = search.run((start, goal.0), &refused, &meter)?;
        pairs_tested += found.1.pairs_tested;
        found.1.pairs_tested = pairs_tested;
        // The fast walk equals the slice up to rounding: a hop on the very edge of a limit may be one for the walk alone.
        let wrong = found.0.windows(2).filter(|pair| !search.is_feasible([pair[0], pair[1]]));
        let before = refused.len();
        refused.extend(wrong.map(|pair| (pair[0], pair[1])));
        if refused.len() == before {
            return Ok(found.1);
        }
    }
}

impl FreeRoute {
    /// The bytes that a search over so many nodes takes at least.
    pub const fn bytes(nodes: &SurfaceNodes) -> u64 {
        (nodes.count() * size_of::<Label>()) as u64
    }
}

impl<'s> Search<'s> {
    fn new(ground: &'s DemGround, nodes: &'s SurfaceNodes, question: &'s RouteGoal, goal: MapPosition) -> Self {
        let (limits, gravity_m_s2) = (ground.hopper().limits(), ground.gravity_m_s2());
        let (takeoff_max_m_s, landing_max_m_s) = (limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s());
        Self {
            ground,
            nodes,
            question,
            goal,
            bounds: PathBounds::new(takeoff_max_m_s, landing_max_m_s, gravity_m_s2),
            gravity_m_s2,
            takeoff_max_m_s,
            span_max_m: (takeoff_max_m_s * takeoff_max_m_s + landing_max_m_s * landing_max_m_s) / (2.0 * gravity_m_s2),
            lowest_m: ground.terrain().dem().elevation_range_m().0,
        }
    }

    /// What every path on from a position costs at least; `None` where there is none.
    fn least_to_go(&self, from: &MapPosition) -> Option<Cost> {
        let (run_m, climb_m) = (libm::hypot(self.goal.at.x - from.at.x, self.goal.at.y - from.at.y), self.goal.z_m - from.z_m);
        let hops = self.bounds.hops(run_m, climb_m)?;
        let effort = match self.question.effort {
            Effort::TakeoffSpeed => self.bounds.takeoff_speeds_m_s(run_m, climb_m),
            Effort::Energy => self.bounds.energy_j_kg(run_m, climb_m),
            Effort::Time => self.bounds.flight_time_s(run_m, climb_m),
            Effort::PeakSpeed => 0.0,
        };
        Some(self.question.effort.cost_of_path(hops, effort))
    }

    /// The lofts of the hop from one node to another, exactly as a slice and the hop test find them: those that all limits allow, of a
    /// machine that can be commanded one of them.
    fn by_slice(&self, [from, to]: [&MapPosition; 2]) -> Option<SlopeInterval> {
        let test = HopTest::new(self.ground.chain(from.at, to.at).ok()?);
        let geometry = test.chain().geometry();
        let ends = [VertexId(0), VertexId(geometry.segment_count())].map(|vertex| geometry.vertex_station(vertex));
        test.lofts(&ends[0], &ends[1]).ok()
    }

    fn is_feasible(&self, nodes: [SurfaceNode; 2]) -> bool {
        let [from, to] = nodes.map(|node| self.nodes.position(self.ground, node));
        from.zip(to).is_some_and(|(from, to)| self.by_slice([&from, &to]).is_some())
    }

    /// The cost of the hop from one node to another; `None` if there is none.
    fn hop(&self, nodes: [SurfaceNode; 2], [from, to]: [&MapPosition; 2], sight: LineOfSight) -> Option<Cost> {
        let lofts = if self.nodes.may_run_along_edges(self.ground, nodes, [from.at, to.at]) {
            self.by_slice([from, to])
        } else {
            let (_, heading) = self.ground.course(from, to)?;
            self.ground.lofts_by_walk(from, to, sight, heading)
        }?;
        let loft = self.ground.envelope().loft(self.question.takeoff, sight, lofts);
        Some(self.question.effort.cost(&Arc::new(sight, loft, self.gravity_m_s2), 1))
    }

    /// How far one hop from a position goes at most, horizontally, m.
    fn reach_m(&self, from: &MapPosition) -> f64 {
        let down_m = safety_range_m((from.z_m - self.lowest_m).max(0.0), self.takeoff_max_m_s, self.gravity_m_s2);
        down_m.min(self.span_max_m) * (1.0 + 1e-6)
    }

    /// One search: the nodes of the path, none without one, and the answer.
    fn run(
        &self,
        ((start, at), goal): ((SurfaceNode, MapPosition), SurfaceNode),
        refused: &HashSet<(SurfaceNode, SurfaceNode)>,
        meter: &Meter<'_>,
    ) -> Result<(Vec<SurfaceNode>, FreeRoute), RouteError> {
        let mut labels = vec![Label { cost: Cost::UNREACHED, from: u32::MAX }; self.nodes.count()];
        let mut waiting = BinaryHeap::new();
        let (mut pairs_tested, mut reached, mut nearest) = (0, 1, at);
        let mut counter = meter.counter();
        if let Some(least) = self.least_to_go(&at) {
            labels[start.index()].cost = Cost::default();
            waiting.push(Reverse((least, start, Cost::default())));
        }
        while let Some(Reverse((_, node, cost))) = waiting.pop() {
            if node == goal {
                break;
            }
            // A better label has been taken since.
            if labels[node.index()].cost != cost {
                continue;
            }
            counter.check()?;
            let Some(from) = self.nodes.position(self.ground, node) else { continue };
            for next in self.nodes.about(from.at, self.reach_m(&from)) {
                // By the hops alone: a bound that needs no ground.
                if next == node || labels[next.index()].cost <= cost + Cost::of_hops(1) || refused.contains(&(node, next)) {
                    continue;
                }
                let Some(to) = self.nodes.position(self.ground, next) else { continue };
                let run_m = libm::hypot(to.at.x - from.at.x, to.at.y - from.at.y);
                if run_m <= self.ground.position_rounding_m() || self.bounds.hops(run_m, to.z_m - from.z_m) != Some(1) {
                    continue;
                }
                let (sight, Some(rest)) = (LineOfSight::new(run_m, to.z_m - from.z_m), self.least_to_go(&to)) else { continue };
                let least = cost + self.question.effort.least_cost(sight, self.gravity_m_s2);
                if least >= labels[next.index()].cost || least + rest >= labels[goal.index()].cost {
                    continue;
                }
                pairs_tested += 1;
                counter.pair()?;
                let Some(hop) = self.hop([node, next], [&from, &to], sight) else { continue };
                let label = &mut labels[next.index()];
                if cost + hop >= label.cost {
                    continue;
                }
                reached += usize::from(label.cost == Cost::UNREACHED);
                *label = Label { cost: cost + hop, from: node.0 };
                if (to.at - self.goal.at).norm() < (nearest.at - self.goal.at).norm() {
                    nearest = to;
                }
                waiting.push(Reverse((cost + hop + rest, next, cost + hop)));
            }
        }
        let cost = labels[goal.index()].cost;
        let mut path = Vec::new();
        if cost != Cost::UNREACHED {
            path.push(goal);
            while let Some(last) = path.last().copied().filter(|last| *last != start) {
                path.push(SurfaceNode(labels[last.index()].from));
            }
            path.reverse();
        }
        let places = (!path.is_empty()).then(|| path.iter().filter_map(|node| self.nodes.position(self.ground, *node)).collect());
        let cost = if path.is_empty() { Cost::default() } else { cost };
        Ok((path, FreeRoute { places, cost, pairs_tested, reached, nearest }))
    }
}
