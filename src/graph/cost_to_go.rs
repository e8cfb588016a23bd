//! The cost-to-go: the cost of the cheapest path from every node to the goal.

use std::{cmp::Reverse, collections::BinaryHeap};

use super::{
    Cost, Edge, HopGraph, Leg, NodeSet, ReliabilityOptions, SearchError, SearchOptions, judge::Judge, nodes::around,
    reliability_policy::ReliabilityPolicy,
};
use nalgebra::Vector2;

use crate::{
    ballistics::{LineOfSight, TakeoffChoice},
    chain::Station,
    ground::MapPosition,
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
    quantity::{NodeId, SlopeInterval},
    world::{Direction, tolerant_speed_m_s},
};

/// The cost of the cheapest path from every node to the goal, computed once, for replanning after each landing.
///
/// A hop from any station to a node, plus the cost-to-go of that node, is the cost of a whole path. The best of these is the
/// best plan from that station whose landings after the first are nodes.
#[derive(Clone, Debug)]
pub struct CostToGo {
    nodes: NodeSet,
    options: SearchOptions,
    costs: Vec<Option<Cost>>,
    /// The nodes from which the goal can be reached, in ascending order of cost.
    in_order: Vec<NodeId>,
    /// With reliability options: the successors of every node, the most reliable first.
    policy: Option<ReliabilityPolicy>,
}

impl CostToGo {
    /// Runs Dijkstra's algorithm from the goal against the direction of the hops.
    ///
    /// `options` defines the costs; its spacing is ignored, since the nodes are given.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// With V nodes, W of them in reach of each and S vertices flown over: O(V W S + V W log V) time, O(V W) heap entries at
    /// worst.
    pub fn of(test: &HopTest, nodes: NodeSet, options: &SearchOptions, progress: &dyn Progress) -> Result<Self, Cancelled> {
        let meter = Meter::new(progress, Stage::CostToGo);
        meter.report(Detail::None)?;
        let costs = costs_to_go(&HopGraph::new(test, &nodes, options.effort, options.takeoff, options.split), &meter)?;
        let mut in_order: Vec<NodeId> = (0..costs.len()).map(NodeId).filter(|node| costs[node.index()].is_some()).collect();
        in_order.sort_by_key(|node| (costs[node.index()], *node));
        Ok(Self { nodes, options: options.clone(), costs, in_order, policy: None })
    }

    /// The same with a reliability policy: the successors of every node, sorted by the reliability of the rest of the path
    /// within the extra hops allowed, weighted as in [`most_reliable_paths`](super::most_reliable_paths).
    ///
    /// # Errors
    /// [`SearchError`]: invalid deviations, or cancelled.
    ///
    /// # Complexity
    /// That of [`of`](Self::of), plus a risk estimate for every edge on some path within the hop budget.
    pub fn with_reliability(
        test: &HopTest,
        nodes: NodeSet,
        options: &SearchOptions,
        reliability: &ReliabilityOptions,
        progress: &dyn Progress,
    ) -> Result<Self, SearchError> {
        reliability.model.check()?;
        let costs = Self::of(test, nodes, options, progress)?;
        let policy = ReliabilityPolicy::of(&costs.graph(test), &costs.costs, options, reliability, progress)?;
        Ok(Self { policy: Some(policy), ..costs })
    }

    /// The same for a journey of this many hops from the start: its reliability policy allows as many beyond the fewest, at most those that
    /// it was computed for. Without a policy, or without a path from the start, unchanged.
    #[must_use]
    pub fn with_hops(&self, hops: u64) -> Self {
        let Some(fewest) = self.of_node(self.nodes.start()).map(Cost::hops) else { return self.clone() };
        let policy = self.policy.as_ref().map(|policy| policy.with_fewer_extra_hops(hops.saturating_sub(fewest)));
        Self { policy, ..self.clone() }
    }

    /// Whether there is a reliability policy.
    #[inline]
    pub const fn weighs_reliability(&self) -> bool {
        self.policy.is_some()
    }

    /// The successors of a node, the most reliable first; empty without a reliability policy, at the goal, and if the goal
    /// cannot be reached from the node.
    #[inline]
    pub fn reliable_successors(&self, node: NodeId) -> &[NodeId] {
        self.policy.as_ref().map_or(&[], |policy| policy.successors(node))
    }

    /// Whether the reliability policy leads over a node; true without a policy.
    pub fn leads_over(&self, node: NodeId) -> bool {
        self.policy.as_ref().is_none_or(|policy| policy.leads_over(node))
    }

    /// The node nearest to a position along the chain, of those that the reliability policy leads over.
    pub fn nearest_node(&self, x_m: f64) -> NodeId {
        let stations = self.nodes.stations();
        let leads = |node: &usize| self.leads_over(NodeId(*node));
        let at = stations.partition_point(|station| station.point.x_m < x_m).min(stations.len() - 1);
        let goal = self.nodes.goal().index();
        let after = (at..stations.len()).find(leads).unwrap_or(goal);
        let before = (0..at).rev().find(leads).unwrap_or(after);
        let away_m = |node: usize| (stations[node].point.x_m - x_m).abs();
        NodeId(if away_m(before) <= away_m(after) { before } else { after })
    }

    /// The graph that defines the costs.
    fn graph(&self, test: &HopTest) -> HopGraph {
        HopGraph::new(test, &self.nodes, self.options.effort, self.options.takeoff, self.options.split)
    }

    /// The nodes.
    pub const fn nodes(&self) -> &NodeSet {
        &self.nodes
    }

    /// The options that define the costs.
    pub const fn options(&self) -> &SearchOptions {
        &self.options
    }

    /// The cost-to-go of a node: zero at the goal, `None` if the goal cannot be reached from it.
    ///
    /// # Panics
    /// Panics if there is no such node.
    #[inline]
    pub fn of_node(&self, node: NodeId) -> Option<Cost> {
        self.costs[node.index()]
    }

    /// The nodes from which the goal can be reached, in ascending order of cost-to-go.
    pub fn in_order(&self) -> &[NodeId] {
        &self.in_order
    }

    /// A lower bound on the cost of a hop over this line of sight.
    #[inline]
    pub fn least_cost(&self, sight: LineOfSight, gravity_m_s2: f64) -> Cost {
        self.options.effort.least_cost(sight, gravity_m_s2)
    }

    /// The best first leg from any station of the chain, which need not be a node. `None` if no node that leads to the goal
    /// is in reach.
    ///
    /// With a reliability policy: the most reliable successor of the nearest node that is feasible from the station itself
    /// (between a node and positions near it the risk changes little, but feasibility may change). Without a policy, and if
    /// no such successor is feasible: the [cheapest leg](Self::cheapest_leg).
    pub fn best_leg(&self, test: &HopTest, from: &Station) -> Option<Leg> {
        self.reliable_leg(test, from).or_else(|| {
            let (leg, _) = self.cheapest_leg(test, from)?;
            Some(Leg { loft: self.chosen_loft(&leg.takeoff, &leg.landing, leg.edge), ..leg })
        })
    }

    /// The most reliable successor of the nearest node that is feasible from a station; `None` without a policy.
    fn reliable_leg(&self, test: &HopTest, from: &Station) -> Option<Leg> {
        let policy = self.policy.as_ref()?;
        let graph = self.graph(test);
        policy.successors(self.nearest_node(from.point.x_m)).iter().find_map(|node| {
            let landing = *self.nodes.station(*node);
            let edge = graph.edge(from, &landing).ok()?;
            Some(Leg { takeoff: *from, landing, edge, loft: self.chosen_loft(from, &landing, edge) })
        })
    }

    /// The loft of the most reliable command of a single hop, if the options choose it and the costs know the errors.
    fn chosen_loft(&self, from: &Station, landing: &Station, edge: Edge) -> Option<f64> {
        let Edge::Hop(lofts) = edge else { return None };
        let judge = self.judge()?;
        judge.single((from, landing), lofts, judge.takeoff_m2([0.0; 2]), false, f64::INFINITY).loft
    }

    /// The judge of commands, where the options choose the most reliable one.
    fn judge(&self) -> Option<&Judge> {
        self.policy.as_ref().map(ReliabilityPolicy::judge).filter(|_| self.options.takeoff == TakeoffChoice::MostReliable)
    }

    /// The loft of the most reliable command of a hop over the map, if the options choose it and the costs know the errors.
    pub(crate) fn loft_on_map(
        &self,
        ends: (&MapPosition, &MapPosition),
        heading: Vector2<f64>,
        window: (LineOfSight, SlopeInterval),
    ) -> Option<f64> {
        self.judge()?.loft_on_map(ends, heading, window)
    }

    /// The first leg of the cheapest path from any station of the chain, and the cost of that path.
    /// `None` if no node that leads to the goal is in reach.
    ///
    /// Nodes are tried in ascending order of their cost-to-go, until no further node can give a cheaper path, so that most
    /// need no hop test. Of two legs with equal total cost, the one tried first is returned.
    ///
    /// # Complexity
    /// A hop test for each node in reach that could still improve on the best leg.
    pub fn cheapest_leg(&self, test: &HopTest, from: &Station) -> Option<(Leg, Cost)> {
        let graph = self.graph(test);
        let stations = self.nodes.stations();
        let reach = OneHop::of(test);
        let mut best: Option<(Leg, Cost)> = None;
        let in_reach = around(stations, from, test.reach_bound_m(from));
        let goal_ahead = self.nodes.station(self.nodes.goal()).point.x_m > from.point.x_m;
        let count = in_reach.len();
        for i in 0..count {
            let node = if goal_ahead { in_reach.end - 1 - i } else { in_reach.start + i };
            let landing = &stations[node];
            let Some(to_go) = self.costs[node] else { continue };
            let too_dear = |cost: Cost| best.as_ref().is_some_and(|(_, known)| cost >= *known);
            if too_dear(Cost::of_hops(1) + to_go) {
                continue;
            }
            let Some(sight) = test.line_of_sight(from, landing) else { continue };
            let too_far = reach.excludes(sight) && from.shared_segment(landing).is_none();
            if too_far || too_dear(self.least_cost(sight, test.gravity_m_s2()) + to_go) {
                continue;
            }
            let Ok(edge) = graph.edge(from, landing) else { continue };
            let cost = graph.cost(from, landing, edge) + to_go;
            if !too_dear(cost) {
                best = Some((Leg { takeoff: *from, landing: *landing, edge, loft: None }, cost));
            }
        }
        best
    }
}

/// The parabolas of safety of a chain's greatest speeds: those speeds squared, m^2/s^2, and gravity, m/s^2.
#[derive(Clone, Copy)]
struct OneHop {
    takeoff_squared: f64,
    landing_squared: f64,
    gravity: f64,
}

impl OneHop {
    fn of(test: &HopTest) -> Self {
        // Relatively 1e-9 more than the tolerance allows: rounding must not exclude a hop exactly on the limit.
        let squared = |speed_m_s: f64| tolerant_speed_m_s(tolerant_speed_m_s(speed_m_s)) * tolerant_speed_m_s(speed_m_s);
        let (takeoff_m_s, landing_m_s) = test.chain().speed_bounds_m_s();
        Self { takeoff_squared: squared(takeoff_m_s), landing_squared: squared(landing_m_s), gravity: test.gravity_m_s2() }
    }

    /// Whether no hop can span a line of sight.
    #[inline]
    fn excludes(&self, sight: LineOfSight) -> bool {
        let g_x = self.gravity * sight.run_m();
        g_x * sight.min_speed_ratio() > self.takeoff_squared || g_x * sight.min_speed_ratio_reversed() > self.landing_squared
    }
}

/// The least costs of all nodes, from Dijkstra's algorithm.
fn costs_to_go(graph: &HopGraph, meter: &Meter<'_>) -> Result<Vec<Option<Cost>>, Cancelled> {
    let mut counter = meter.counter();
    let nodes = graph.nodes();
    let mut costs: Vec<Option<Cost>> = vec![None; nodes.stations().len()];
    let mut done = vec![false; nodes.stations().len()];
    let goal = nodes.goal();
    costs[goal.index()] = Some(Cost::default());
    let mut queue = BinaryHeap::from([Reverse((Cost::default(), goal))]);
    while let Some(Reverse((cost, node))) = queue.pop() {
        if std::mem::replace(&mut done[node.index()], true) {
            continue;
        }
        let landing = nodes.station(node);
        let reach_m =
            Direction::BOTH.map(|direction| graph.test().takeoff_reach_m(landing, direction)).into_iter().fold(0.0, f64::max);
        for from in around(nodes.stations(), landing, reach_m) {
            if done[from] {
                continue;
            }
            counter.pair()?;
            let takeoff = nodes.station(NodeId(from));
            let Ok(edge) = graph.edge(takeoff, landing) else { continue };
            let total = graph.cost(takeoff, landing, edge) + cost;
            if costs[from].is_none_or(|known| total < known) {
                costs[from] = Some(total);
                queue.push(Reverse((total, NodeId(from))));
            }
        }
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::{ConstrainedChain, PolygonalChain},
        graph::{Effort, Outcome, PointSpacing, search},
        quantity::ChainPoint,
        world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
    };

    fn rough_chain() -> ConstrainedChain {
        let points = (0..60).map(|i| ChainPoint::new(f64::from(i), 0.5 * f64::from(i * i % 7) - 0.02 * f64::from(i))).collect();
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(6.0, 6.0) }).unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(1.1).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
        ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, Gravity::new(1.6).unwrap(), &surface).unwrap()
    }

    #[test]
    fn the_cost_to_go_of_every_node_equals_the_cost_of_a_search_from_it() {
        let chain = rough_chain();
        let test = HopTest::new(chain.clone());
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        for effort in Effort::ALL {
            let spacing = PointSpacing::PerSegment(1);
            let options = SearchOptions { spacing: Some(spacing), effort, ..SearchOptions::default() };
            let nodes = NodeSet::new(&chain, station(3.0), station(50.0), spacing).unwrap();
            let to_go = CostToGo::of(&test, nodes, &options, &()).unwrap();
            let (mut reached, mut cut_off) = (0, 0);
            for (i, from) in to_go.nodes().stations().iter().enumerate().step_by(5) {
                let answer = search(&test, *from, station(50.0), &options, &()).unwrap();
                match (answer.outcome, to_go.of_node(NodeId(i))) {
                    (Outcome::Path { cost, .. }, Some(found)) => {
                        assert_eq!(cost.hops(), found.hops());
                        assert!((cost.effort() - found.effort()).abs() <= 1e-9 * cost.effort(), "{cost:?} {found:?}");
                        reached += 1;
                    }
                    (Outcome::Path { .. }, None) => panic!("node {i} leads to the goal"),
                    (_, found) => {
                        assert_eq!(found, None, "node {i} does not lead to the goal");
                        cut_off += 1;
                    }
                }
            }
            assert!(reached > 10 && reached + cut_off > 20, "{reached} reached, {cut_off} cut off");
        }
    }

    #[test]
    fn the_cheapest_leg_is_the_cheapest_of_all_legs() {
        let chain = rough_chain();
        let test = HopTest::new(chain.clone());
        let station = |x_m| chain.geometry().station(x_m).unwrap();
        let spacing = PointSpacing::PerSegment(1);
        for effort in Effort::ALL {
            let options = SearchOptions { spacing: Some(spacing), effort, ..SearchOptions::default() };
            let nodes = NodeSet::new(&chain, station(3.0), station(50.0), spacing).unwrap();
            let to_go = CostToGo::of(&test, nodes, &options, &()).unwrap();
            let graph = to_go.graph(&test);
            let mut found = 0;
            for i in 0..200 {
                let from = station(0.05 + 0.29 * f64::from(i));
                let of_all = (0..to_go.nodes().stations().len())
                    .filter_map(|node| {
                        let landing = to_go.nodes().station(NodeId(node));
                        let edge = graph.edge(&from, landing).ok()?;
                        Some(graph.cost(&from, landing, edge) + to_go.of_node(NodeId(node))?)
                    })
                    .min();
                assert_eq!(to_go.cheapest_leg(&test, &from).map(|(_, cost)| cost), of_all, "from {from:?}");
                found += u32::from(of_all.is_some());
            }
            assert!(found > 50, "only {found} positions lead to the goal");
        }
    }
}
